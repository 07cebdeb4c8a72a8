"""In-betweens of motions in metres: known entries are kept, bit by bit, and the rest is generated.

The sampling itself is `inbetweening.inpaint_steps`.  Source: MoFusion 4.4.  Notebook: 15
"""

import math
from dataclasses import dataclass, replace
from typing import Protocol, runtime_checkable

import numpy as np
import torch
from jaxtyping import Bool, Float
from torch import Tensor

from ..beyond.guidance import blended, guided
from ..beyond.turning_frame import View
from ..ddpm import Denoiser, Generators, Schedule, draw, final, timesteps
from ..inbetweening import inpaint_steps, resampled
from ..motion.cleanup import clean_up
from ..motion.dance_frame import GROUND, PATH, Place, heading, placed_features, to_positions
from ..motion.directions import ARMS, UPLEGS
from ..motion.root_frame import FPS
from ..motion.scaler import Scaler
from ..motion.skeleton import HIPS, J
from .edit import Make
from .masks import checked_given, known_columns

AHEAD, SOMEWHERE = 20, 0.5  # frames of the path that tell where it leads, if so far (metres)


@dataclass(frozen=True)
class Departures:
    """Where `inbetween` departs from masked sampling as in 4.4.

    `blend`: x0_hat is corrected at each step so that it goes through the given entries. Before the
    first and after the last of them the correction fades within so many frames; None: no blending
    (`beyond.guidance.blended`).
    `shown`: a network that can see what is given sees it, and generates the remainder around lines
    (`beyond.around_lines`); it needs no guidance and no blending.
    `guidance`: > 0 applies `beyond.guidance.guided` first where the network does not see it; it
    doubles the cost. A larger value follows sparse keyframes better, but the motion jumps more at
    the ends of a gap.
    `clean`: seams, bones and feet are cleaned up in the end (`motion.cleanup`).
    `remainder`: times what such a network adds to the lines; below 1 the result is nearer to them.
    `resample`: how often each step is made (`inbetweening.resampled`).
    """

    blend: int | None = 10
    shown: bool = True
    guidance: float = 0.5
    clean: bool = True
    remainder: float = 1.0
    resample: int = 1


OURS = Departures()
PAPER = Departures(blend=None, shown=False, guidance=0.0, clean=False)


@runtime_checkable
class AnyDancer(Protocol):
    """What `inbetween` needs of a dancer: schedule, units, and a denoiser for the music.

    If it has `can_be_shown`, its `view`, `shown` and `shown_denoiser` are used.
    """

    schedule: Schedule
    motion_scaler: Scaler

    def denoiser(self, mel: Tensor | None, frames: int, fast: bool = True) -> Denoiser: ...


def inbetween(
    dancer: AnyDancer,
    positions: Float[np.ndarray, "T 21 3"],
    known: Bool[np.ndarray, "T 21"],
    mel: Float[Tensor, "M C"] | None = None,
    *,
    samples: int = 1,
    steps: int = 50,
    departures: Departures = OURS,
    generator: Generators | None = None,
) -> Float[np.ndarray, "samples T 21 3"]:
    """Generate what is not known of a motion (metres, 20 frames/s), `samples` times.

    `mel`: the log-Mel spectrogram of the song, for a dancer with music.
    Known entries come back bit by bit as they were given; the others may be NaN. For the network
    the motion is moved and turned, so that it starts at its first known pose (`seen_from`). Without
    a `generator` the seed is 0.
    `departures`: `OURS`, or `PAPER` for masked sampling as printed. Where nothing is known the
    result is a plain sample in both cases.
    Raises ValueError where a joint is given without the pelvis, or is given but NaN or infinite,
    for music and a network without, and for shapes that do not fit.
    Source: MoFusion 4.4.   Notebook: 15
    """
    positions, known = checked_given(positions, known)
    generator = generator or torch.Generator().manual_seed(0)
    columns, place = torch.from_numpy(known_columns(known)), seen_from(positions, known)
    device = dancer.motion_scaler.mean.device
    at_home = np.where(known[..., None], place.enter(np.nan_to_num(positions)), 0.0)
    features = torch.from_numpy(placed_features(at_home)).float().to(device)[None]
    sees = departures.shown and getattr(dancer, "can_be_shown", False)
    if sees and mel is not None:
        raise ValueError("this network sees what is given, and takes no music: leave `mel` out")
    mask = torch.from_numpy(known)[None].to(device)
    view = dancer.view(features, mask) if sees else View.none(features)
    given = dancer.motion_scaler.transform(view.enter(features))[0]
    shape = (samples, *given.shape)
    music = None if mel is None else mel[None].expand(samples, -1, -1)
    held, schedule = (given.expand(shape), columns.to(device).expand(shape)), dancer.schedule
    start, shown = draw(held[0], generator), None
    if sees:
        shown = dancer.shown(*held, view.expand(samples))
        denoise = dancer.shown_denoiser(shown)
        held = torch.zeros(shape, device=device), held[1]
    else:
        denoise = steered(dancer, music, held, departures)
    visited = resampled(timesteps(schedule.S, steps), departures.resample)
    loop = inpaint_steps(denoise, start, schedule, *held, steps=visited, generator=generator)
    x0 = final(loop).x_s if shown is None else shown.whole(departures.remainder * final(loop).x_s)
    poses = to_positions(view.leave(dancer.motion_scaler.inverse(x0)))
    made = place.leave(poses.double().cpu().numpy())
    whole = np.where(known[..., None], positions, made)
    if not departures.clean or not known.any():
        return whole
    return np.stack([clean_up(one, FPS, known) for one in whole])


def steered(
    dancer: AnyDancer,
    mel: Float[Tensor, "B M C"] | None,
    held: tuple[Float[Tensor, "B T 63"], Bool[Tensor, "B T 63"]],
    departures: Departures,
) -> Denoiser:
    """The denoiser of a network that sees nothing of what is given: guided and blended.

    `held`: the given entries, and which they are.
    """
    guidance = departures.guidance if held[1].any() else 0.0
    denoise = dancer.denoiser(mel, held[0].shape[1], fast=not guidance)
    if guidance:
        denoise = guided(denoise, dancer.schedule, *held, guidance)
    if departures.blend is not None:
        fade = fading(departures.blend).to(held[0].device)
        denoise = blended(denoise, dancer.schedule, *held, fade)
    return denoise


def maker(dancer: AnyDancer, *, steps: int = 50) -> Make:
    """A function that generates the rest of an edit, for the editor and `edit.make_between`.
    Notebook: 15"""

    def make(positions, known, *, samples, resample, generator):
        how = {"steps": steps, "departures": replace(OURS, resample=resample)}
        return inbetween(dancer, positions, known, samples=samples, generator=generator, **how)

    return make


def fading(frames: int) -> Float[Tensor, "63"]:
    """Fade lengths for `blended`: `frames` for every column, infinity for the pelvis' x and z.

    So the figure does not return to where it started.
    """
    fade = torch.full((3 * J,), float(frames))
    fade[PATH] = math.inf
    return fade


def seen_from(positions: Float[np.ndarray, "T 21 3"], known: Bool[np.ndarray, "T 21"]) -> Place:
    """The place and the heading of the first known pose; the network's motions start near it.

    The first frame with pelvis and hips decides, or else with pelvis and shoulders, or else the
    path of the pelvis, which is taken to go forward (along z if it does not move at first). If
    nothing is known, it is the world's origin.
    """
    for left, right in (UPLEGS, ARMS):
        whole = known[:, [HIPS, left, right]].all(-1)
        if whole.any():
            pose = positions[whole.argmax()]
            return Place(pose[HIPS] * GROUND, heading(pose[left] - pose[right]))
    path = positions[known[:, HIPS], HIPS]
    if not len(path):
        return Place(np.zeros(3), np.zeros(()))
    ahead = path[min(AHEAD, len(path) - 1)] - path[0]
    goes = np.hypot(ahead[0], ahead[2]) > SOMEWHERE
    return Place(path[0] * GROUND, np.array(np.arctan2(ahead[0], ahead[2]) if goes else 0.0))
