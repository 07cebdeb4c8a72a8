"""Editing by words: a motion is noised part of the way, and denoised under another sentence.

    x_s0 = noised x0,  then sampling from s0 with the new text
The more noise, the more the text decides; the less, the more of the motion stays. A part of the
body or a span of time can be kept besides, by masks as in in-betweening.
A mover that plans makes a timeline of the new sentence first. What legs or arms do where they are
kept is read off the motion (`metrics.texts`), and the rest of the timeline is generated to it.
MoFusion says that its motions can be edited by text, but not how; this way is ours.
Source: SDEdit (Meng and others, 2022); the masks of MoFusion 4.4.
Notebook: 17
"""

import numpy as np
import torch
from jaxtyping import Bool, Float
from torch import Tensor

from ..beyond import timeline
from ..beyond.guidance import blended
from ..conditions.text import Read
from ..ddpm import Generators, draw, final, q_sample, timesteps
from ..inbetweening import inpaint_steps
from ..metrics.texts import HANDS, actions
from ..motion.arguments import checked_strength
from ..motion.dance_frame import Place
from ..motion.known import checked_given
from ..motion.moving_frame import D
from ..motion.root_frame import estimate_root
from ..motion.skeleton import HIPS, TOES, J
from ..performers.continuation import leg_size
from ..performers.mover import ETA, Mover
from ..performers.performer import STEPS, Watch, float32
from ..performers.text_mofusion import Texts

STRENGTH = 0.3  # share of the diffusion steps that the motion is noised by
FEET = (HIPS, *TOES)  # known where the legs are kept
FADE = 10  # frames within which a generated part joins a kept span of time


@float32()
def edit_by_words(
    mover: Mover,
    positions: Float[np.ndarray, "T 21 3"],
    text: str | Read,
    known: Bool[np.ndarray, "T 21"] | None = None,
    *,
    strength: float = STRENGTH,
    plan: Float[Tensor, "samples T 24"] | None = None,
    generator: Generators | None = None,
    watch: Watch = iter,
) -> Float[np.ndarray, "samples T 21 3"]:
    """Motions (metres, 20 frames/s) that do what `text` says, made out of this motion.

    known     what stays, seen from the figure: a joint keeps its place about the root. Where the
              pelvis is known in a frame and the next, the root keeps its velocity, too. Default:
              nothing is masked
    strength  above 0, up to 1; with 1 nothing but the known part is left of the motion
    plan      timelines of what is not kept (default: generated), for a mover that plans
    watch     gets each sampling loop, and shows how far it is
    Of each generator comes one motion; without any the seed is 0. The first frame stays where it
    was, facing the same way. While the pelvis is known from the first frame on, known joints come
    back bit by bit.
    Raises TextError for a text that cannot be read, ValueError for a strength out of range, for
    positions that are not finite, and for another mask than T x 21 of True and False.
    """
    nothing = np.zeros(np.shape(positions)[:-1], bool)
    positions, mask = checked_given(positions, nothing if known is None else known)
    if not np.isfinite(positions).all():
        raise ValueError("positions contain NaN or infinity: fill or cut these frames first")
    every = timesteps(mover.schedule.S, min(STEPS, mover.schedule.S))
    # those of DDIM up to this share of S; the last one at least
    share = checked_strength(strength) * mover.schedule.S
    ways = [s for s in every if s <= round(share)] or every[-1:]
    found = text if isinstance(text, Read) else mover.reader.read(text)
    generator = generator or torch.Generator().manual_seed(0)
    samples = 1 if isinstance(generator, torch.Generator) else len(generator)
    ids = mover.reader.encoded([found.words] * samples)
    size = leg_size(positions)  # the mover knows figures of the course's size
    given, schedule = mover.units_of(positions / size).expand(samples, -1, -1), mover.schedule
    held = columns(torch.from_numpy(mask)).to(given.device).expand(given.shape)
    start = q_sample(given, ways[0], schedule, draw(given, generator))
    if mover.can_plan:
        seen = torch.from_numpy(recognised_timeline(positions / size)).float().to(mover.device)
        kept = kept_columns(mask).to(mover.device)
        if plan is None:
            plan = _plan(mover, seen, kept, ids, generator, watch)
        else:
            plan = torch.where(kept, seen, plan.to(mover.device))
    denoise = mover.denoiser(ids, len(positions), plan=plan)
    if held.any():
        denoise = blended(denoise, schedule, given, held, fade=FADE)
    loop = inpaint_steps(
        denoise, start, schedule, given, held, steps=ways, eta=ETA, generator=generator
    )
    made = size * mover.positions_of(final(watch(loop)).x_s).double().cpu().numpy()
    on_its_path = np.logical_and.accumulate(mask[:, HIPS])[:, None]
    same = (mask & on_its_path)[..., None]
    return np.where(same, positions, at_the_start_of(positions, made))


def _plan(
    mover: Mover,
    seen: Float[Tensor, "T 24"],
    held: Bool[Tensor, "T 24"],
    texts: Texts,
    generator: Generators,
    watch: Watch = iter,
) -> Float[Tensor, "samples T 24"]:
    """Timelines for the texts that have the columns `held` of a timeline that was seen."""
    given = mover.plan_scaler.transform(seen).expand(len(texts), -1, -1)
    loop = inpaint_steps(
        mover.plan_denoiser(texts, len(seen)), draw(given, generator), mover.schedule, given,
        held.expand_as(given), steps=min(STEPS, mover.schedule.S), eta=ETA, generator=generator,
    )  # fmt: skip
    return timeline.tidied(mover.plan_scaler.inverse(final(watch(loop)).x_s))


def recognised_timeline(positions: Float[np.ndarray, "T 21 3"]) -> Float[np.ndarray, "T 24"]:
    """The timeline of the actions that are recognised in a motion."""
    found = actions(positions)
    acts = [timeline.Timed(one.verb, one.side, one.count, one.first, one.last) for one in found]
    return timeline.timeline(acts, len(positions))


def kept_columns(known: Bool[np.ndarray, "T 21"]) -> Bool[Tensor, "T 24"]:
    """The columns of a timeline to keep: of the legs, or of the arms, where they are known."""
    legs, arms = (torch.from_numpy(known[:, list(part)].all(1)) for part in (FEET, HANDS))
    return torch.where(timeline.of_the_legs(), legs[:, None], arms[:, None])


def columns(known: Bool[Tensor, "T 21"]) -> Bool[Tensor, "T 66"]:
    """The network's columns of these joints.

    A velocity leads from a frame to the next one. So it is known where the pelvis is in both.
    """
    joints, here = known.repeat_interleave(3, dim=-1), known[:, HIPS]
    moves = torch.cat([here[:-1] & here[1:], here[-1:]])  # the last velocity leads nowhere
    return torch.cat([joints, moves[:, None].expand(-1, D - 3 * J)], -1)


def at_the_start_of(
    positions: Float[np.ndarray, "T 21 3"], made: Float[np.ndarray, "*B T 21 3"]
) -> Float[np.ndarray, "*B T 21 3"]:
    """Motions that begin at the origin, facing z, placed where this motion begins."""
    root, heading = estimate_root(positions)
    return Place(np.array([root[0, 0], 0.0, root[0, 1]]), np.asarray(heading[0])).leave(made)
