"""How movers are made: described clips, words, MoFusion's loss with a recipe's departures.

The paper gives no widths, no steps and no weights of its losses, so all numbers are ours. A killed
run continues from its last save.
"""

import copy
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import torch
from jaxtyping import Float, Int
from torch import Tensor

from .._files import digest_of_tensors, digest_of_texts
from ..beyond import loss_terms
from ..beyond.schedules import shifted
from ..beyond.timeline import Timed, timeline
from ..conditions import clip
from ..conditions.clip import ClipModel, check
from ..conditions.clip import load as load_clip
from ..conditions.text import base_vocabulary, read_words
from ..conditions.word_encoder import NOTHING, PADDING, ids_of
from ..ddpm import Schedule, cosine_schedule, squared_error
from ..kinematic_loss import KinematicWeights, training_loss, weight_by_step
from ..motion import moving_frame
from ..motion.skeleton import TOES
from ..performers.described_windows import GRID, DescribedWindows
from ..performers.mover import Mover
from ..performers.networks import network
from ..performers.planned_mofusion import Performing, PlannedConfig, PlannedMoFusion
from ..performers.text_mofusion import TextMoFusionConfig, Texts
from ..training import LossFn
from .mofusion import KINEMATIC, MoFusionRecipe
from .training import Provenance, final_loss, on_device, train_recipe


# ---- recipes -------------------------------------------------------------------------------------
@dataclass(frozen=True)
class MoverRecipe(MoFusionRecipe):
    """The sizes and rates of one training run of a mover.

    The data are `clips` described clips of `data_synth.actions`; every clip is also mirrored, with
    its words. The words of the configuration are those of the captions, unless it names a CLIP.
    """

    config: TextMoFusionConfig
    plan_steps: int = 0  # afterwards, of the network for timelines alone, which needs more of them
    kinematic: KinematicWeights | None = replace(KINEMATIC, slide=1.0)
    metres: float = 1.0  # power of `beyond.loss_terms.metre_weights`; 0: all columns alike
    snr: float = 0.1  # factor on the signal-to-noise ratio of the cosine schedule
    frames: int = 3072  # of a batch, all motions together
    no_text: float = 0.1  # share of the texts left out: `beyond.classifier_free`
    lr: float = 2e-3
    clips: int = 12_000


MOVER = MoverRecipe("mover", PlannedConfig(), steps=10_000, plan_steps=14_000)
MOVER_PLAIN = replace(MOVER, name="mover-plain", kinematic=None)
# The paper's own way to read. Never trained here, because no weights of CLIP were at hand.
MOVER_CLIP = replace(
    MOVER, name="mover-clip", config=replace(MOVER.config, clip=clip.NAME, clip_width=clip.WIDTH)
)
MOVER_RECIPES = {recipe.name: recipe for recipe in (MOVER, MOVER_PLAIN, MOVER_CLIP)}


# ---- training ------------------------------------------------------------------------------------
WARMUP = 300  # steps

Truths = dict[int, list[tuple[Hashable, Hashable]]]


def training_clips(clips: int, seed: int) -> DescribedWindows:
    """The data of a training, generated from its seed; the last data set is kept."""
    return described(clips, seed).windows


@dataclass(frozen=True, eq=False)
class DescribedData:
    """Clips for a training, and what judges need besides.

    truths  `truths[n]` has for each motion of n frames its sentence, and that of its mirrored twin
    wrong   `wrong[n]` has for each motion the ids of a caption that differs in one thing (K, M)
    """

    windows: DescribedWindows
    truths: Truths
    wrong: dict[int, Int[Tensor, "K M"]]


@lru_cache(maxsize=1)
def described(clips: int, seed: int) -> DescribedData:
    """The data of a training, generated from its seed."""
    # here, because data_synth imports this package
    from data_synth.actions import caption, captions
    from data_synth.actions import clips as drawn
    from data_synth.actions.dataset import mirrored_sentence
    from data_synth.actions.neighbours import neighbour

    positions = []
    contacts = []
    texts = []
    timelines = []
    truths: Truths = {}
    others: dict[int, list[tuple[str, ...]]] = {}
    words = base_vocabulary(captions.vocabulary())
    for k, one in enumerate(drawn(clips, seed)):
        acted, rng = one.acted, np.random.default_rng([seed, k, 3])
        positions.append(acted.positions)
        contacts.append(acted.contacts)
        texts.append(one.captions)
        timelines.append(timeline_of(acted.spans, len(acted)))
        n, other = len(acted) // GRID * GRID, neighbour(acted.sentence, rng)
        truths.setdefault(n, []).append((acted.sentence, mirrored_sentence(acted.sentence)))
        wrong = read_words(caption(other, rng), words, {}).words if other else ()
        others.setdefault(n, []).append(wrong)
    windows = DescribedWindows.of(positions, contacts, texts, words, timelines)
    return DescribedData(windows, truths, {n: ids_of(x, words) for n, x in others.items()})


@lru_cache(maxsize=1)
def training_texts(clips: int, seed: int) -> DescribedWindows:
    """The same data with whole captions, for a network that reads by CLIP."""
    from data_synth.actions import clips as drawn

    made = list(drawn(clips, seed))
    return DescribedWindows.of_texts(
        [one.acted.positions for one in made],
        [one.acted.contacts for one in made],
        [one.captions for one in made],
        [timeline_of(one.acted.spans, len(one.acted)) for one in made],
    )


def timeline_of(spans: Sequence, frames: int) -> Float[np.ndarray, "{frames} 24"]:
    """The timeline of a clip of `data_synth.actions`, from its spans."""
    acts = [Timed(one.act.verb, one.act.side, one.act.count, one.first, one.last) for one in spans]
    return timeline(acts, frames)


def train_mover(
    recipe: MoverRecipe,
    run_file: Path,
    windows: DescribedWindows | None = None,
    log=print,
    clip: ClipModel | None = None,
    device: str | None = None,
) -> Mover:
    """Train by a recipe, or continue the run in `run_file`; return a mover with averaged weights.

    `device`: as in `training.on_device`.
    With `plan_steps`, the network for timelines is then trained further (`train_planner`).

    A network for motions alone (`config.D` = 66) is not shown the timelines of the windows.
    A recipe that names a CLIP takes it from `clip`, or looks for it on this machine by its name; it
    needs windows of whole texts (`DescribedWindows.of_texts`).
    Raises ValueError when the run in `run_file` was begun with other settings, or windows, `clip`
    or `plan_steps` do not fit the recipe; ClipError for a CLIP that is missing or has tokens of
    another width.
    """
    clip = clip_for(recipe, clip)
    windows = windows_for(recipe, windows, clip)
    facts: dict[str, Any] = {"clips": len(windows)}
    if clip:
        facts |= {"clip_sample": clip.sample()}
        log(f"{recipe.name}: CLIP reads {len(windows.words)} captions")
    else:
        recipe = replace(recipe, config=replace(recipe.config, words=windows.words))
    schedule = shifted(cosine_schedule(recipe.config.S), recipe.snr)
    torch.manual_seed(recipe.seed)
    model = network(recipe.config)
    about = {"network": type(model).__name__, "data": digest(windows)}
    if clip:
        about |= {"texts": digest_of_texts({"texts": "\n".join(windows.words)})[:16]}
        about |= {"clip": " ".join(f"{x:.1f}" for x in facts["clip_sample"])}
    provenance = Provenance(about, facts, "data_synth.actions, synthetic")
    texts_of = texts_by(clip, windows) if clip else texts_as_ids
    loss_fn = loss_of(recipe, windows, schedule, texts_of)
    both = replace(recipe, plan_steps=0)
    model = on_device(model, device)
    trained, card = train_recipe(both, run_file, model, loss_fn, provenance, warmup=WARMUP, log=log)
    if recipe.plan_steps:
        plan_loss = plan_loss_of(recipe, windows, schedule, texts_of)
        further = train_planner(recipe, run_file, trained, plan_loss, provenance, log, device)
        card["recipe"]["plan_steps"] = recipe.plan_steps
        card["planner"] = further
        card["minutes"] = round(card["minutes"] + further["minutes"], 1)
        card["final_loss"] = final_loss(both, loss_fn, trained)
    return Mover(trained, schedule, windows.scaler, card, clip)


def clip_for(recipe: MoverRecipe, clip: ClipModel | None) -> ClipModel | None:
    """The CLIP by which a recipe reads, the given one or one found by its name; None for none."""
    if not recipe.config.clip:
        if clip is not None:
            raise ValueError(
                f"{recipe.name} reads words of its own: its configuration names no CLIP"
            )
        return None
    clip = clip or load_clip(recipe.config.clip)
    check(clip, recipe.config.clip_width)
    return clip


def windows_for(
    recipe: MoverRecipe, windows: DescribedWindows | None, clip: ClipModel | None
) -> DescribedWindows:
    """The windows that a recipe trains on, given or made from its seed."""
    if recipe.plan_steps and not isinstance(recipe.config, PlannedConfig):
        raise ValueError(f"{recipe.name} has plan_steps, and its network makes no timelines")
    if windows is None:
        windows = (training_texts if clip else training_clips)(recipe.clips, recipe.data_seed)
    if any(" " in word for word in windows.words) and not clip:
        raise ValueError(f"{recipe.name} reads words, and these windows hold whole texts")
    return windows.without_timeline() if recipe.config.D == moving_frame.D else windows


def train_planner(
    recipe: MoverRecipe,
    run_file: Path,
    model: PlannedMoFusion,
    loss_fn: LossFn,
    provenance: Provenance,
    log: Callable[[str], object],
    device: str | None = None,
) -> dict:
    """Train the network for timelines of a trained mover further, alone; return the run's card.

    A timeline decides what is done and how often, and a step of this network takes a quarter of a
    step of both. Its run lies beside `run_file`.
    """
    alone = replace(
        recipe, name=f"{recipe.name}-planner", config=model.planner.config, steps=recipe.plan_steps
    )
    begins = {"begins_with": digest_of_tensors(model.planner.state_dict())[:16]}
    own = replace(provenance, about=provenance.about | begins)
    file = run_file.with_name(f"{run_file.stem}-planner{run_file.suffix}")
    planner = copy.deepcopy(model.planner).requires_grad_(True)
    planner = on_device(planner, device)
    trained, card = train_recipe(alone, file, planner, loss_fn, own, warmup=WARMUP, log=log)
    model.planner.load_state_dict(trained.state_dict())
    return {name: card[name] for name in ("minutes", "sittings", "final_loss")} | begins


def texts_as_ids(ids: Int[Tensor, "B M"]) -> Texts:
    """What a network with words of its own takes: their ids as they are."""
    return ids


def texts_by(clip: ClipModel, windows: DescribedWindows) -> Callable[[Tensor], Texts]:
    """What a network that reads by CLIP takes: the tokens of all captions, which are encoded now.

    Raises ValueError for windows that hold words instead of whole texts.
    """
    if any(ids.shape[-1] > 1 for ids in windows.captions.values()):
        raise ValueError("CLIP reads whole texts, and these windows hold words: use `of_texts`")
    clip.model.to("cuda" if torch.cuda.is_available() else "cpu")
    table = clip.table(["", "", *windows.words])  # the rows of PADDING, which none is, and NOTHING
    return lambda ids: table[ids[:, 0]]


def loss_of(
    recipe: MoverRecipe,
    windows: DescribedWindows,
    schedule: Schedule,
    texts_of: Callable[[Tensor], Texts] = texts_as_ids,
) -> LossFn:
    """Eq. 4 of motions, given texts and timelines, and eq. 4 of the timelines, given texts.

    `texts_of` makes of the windows' ids what the network takes.
    Source: MoFusion eq. 4; the other terms are ours.
    """
    scaler, weights = windows.scaler.part(slice(moving_frame.D)), recipe.kinematic
    columns = loss_terms.metre_weights(scaler.std, recipe.metres)
    poses = loss_terms.total(squared_error, loss_terms.changes(recipe.changes))
    data = loss_terms.weighted(poses, columns)
    if recipe.toes:
        moved = toes_moved(windows)
        toes = loss_terms.toe_changes(recipe.toes, moving_frame.moves, scaler.std, moved)
        data = loss_terms.total(data, toes)
    lambda_k = weight_by_step(schedule, weights.over_time) if weights else None
    batch = batches(recipe, windows, texts_of)

    def loss_fn(model: Any, generator: torch.Generator) -> Tensor:
        x0, plan, texts, planted = batch(next(model.parameters()).device, generator)
        contexts = model.listen(texts)
        planning, performing = 0.0, model
        if isinstance(model, PlannedMoFusion):
            planning = training_loss(model.planner, (plan, contexts.plan), schedule, generator)
            performing = Performing(model, plan)
        kinematic = None
        if weights:
            kinematic = weights.loss_for(moving_frame.body_of(scaler.to(x0.device)), planted)
        return planning + training_loss(
            performing, (x0, contexts), schedule, generator,
            kinematic=kinematic, lambda_k=lambda_k, loss=data,
        )  # fmt: skip

    return loss_fn


def plan_loss_of(
    recipe: MoverRecipe,
    windows: DescribedWindows,
    schedule: Schedule,
    texts_of: Callable[[Tensor], Texts] = texts_as_ids,
) -> LossFn:
    """The loss of the network for timelines alone: eq. 4 without kinematics."""
    batch = batches(recipe, windows, texts_of)

    def loss_fn(planner: Any, generator: torch.Generator) -> Tensor:
        _, plan, texts, _ = batch(next(planner.parameters()).device, generator)
        return training_loss(planner, (plan, planner.listen(texts)), schedule, generator)

    return loss_fn


def batches(
    recipe: MoverRecipe, windows: DescribedWindows, texts_of: Callable[[Tensor], Texts]
) -> Callable[[torch.device, torch.Generator], tuple[Tensor, Tensor, Texts, Tensor]]:
    """What draws the batches of a recipe: motions, timelines, texts and planted toes."""

    def batch(
        device: torch.device, generator: torch.Generator
    ) -> tuple[Tensor, Tensor, Texts, Tensor]:
        x0, ids, planted = windows.draw(recipe.frames, generator)
        ids = without_some(ids, recipe.no_text, generator)
        x0, planted = x0.to(device), planted.to(device)
        texts = texts_of(ids).to(device)
        return x0[..., : moving_frame.D], x0[..., moving_frame.D :], texts, planted

    return batch


def without_some(
    ids: Int[Tensor, "B M"], share: float, generator: torch.Generator
) -> Int[Tensor, "B M"]:
    """The texts, of which a share is replaced by the empty text."""
    empty = torch.full_like(ids, PADDING)
    empty[:, 0] = NOTHING
    left_out = torch.rand(len(ids), generator=generator) < share
    return torch.where(left_out[:, None], empty, ids)


def toes_moved(windows: DescribedWindows) -> float:
    """The mean square change of a toe's coordinate from frame to frame, m^2, over many clips."""
    generator = torch.Generator().manual_seed(0)
    moved = []
    for _ in range(8):
        features = windows.scaler.inverse(windows.draw(4000, generator)[0])[..., : moving_frame.D]
        moved.append(moving_frame.moves(features)[:, :, list(TOES)].square().mean())
    return float(torch.stack(moved).mean())


def digest(windows: DescribedWindows) -> str:
    """A checksum of all clips and captions; a run is resumed only with the data it began with."""
    parts = {f"{name}.{n}": x for name in ("motions", "captions", "contacts")
             for n, x in getattr(windows, name).items()}  # fmt: skip
    return digest_of_tensors(parts)[:16]
