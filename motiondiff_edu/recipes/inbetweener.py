"""Train the in-betweener: its recipe, data, loss and card.

It is shown what is given of a motion, and learns eq. 4 of the remainder around the lines. Every
motion of a batch gets a mask of its own (`drawn_masks`). Kinematic losses are those of the whole
motion, lines and remainder together. Errors are weighted as those of the whole motion, so that the
middle of a gap counts more than its ends; and motions count alike, whatever is given. At every step
they count as errors of x0, also where the network predicts v. A killed run continues from its last
save.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import torch
from jaxtyping import Bool, Float
from torch import Tensor

from ..beyond.around_lines import GivenLines
from ..beyond.loss_terms import (
    as_x0_errors,
    changes,
    toe_changes,
    total,
    weighted,
    weighted_by_step,
)
from ..beyond.schedules import shifted
from ..ddpm import Schedule, cosine_schedule, squared_error
from ..kinematic_loss import Body, training_loss, weight_by_step
from ..motion import dance_frame
from ..motion.known import first_place
from ..motion.scaler import Scaler
from ..performers.dance_windows import DanceWindows, toes_moved
from ..performers.inbetweener import Inbetweener, KeyframeConfig
from ..performers.networks import network
from ..training import LossFn
from .dancer import bones_of, digest
from .drawn_masks import drawn_masks, uniform
from .mofusion import MoFusionRecipe
from .recordings import CREDIT, Recorded, training_recordings
from .training import Provenance, on_device, train_recipe


@dataclass(frozen=True)
class InbetweenerRecipe(MoFusionRecipe):
    """One training run of an in-betweener."""

    config: KeyframeConfig
    snr: float = 1.0  # factor on the signal-to-noise ratio of the cosine schedule
    frames: int = 100  # per window
    batch: int = 32
    seconds: float = 20.0  # of each walk and dance
    motions: int = 0  # so many walks and dances without music
    acts: int = 0  # so many performed sentences beside the walks and dances
    recordings: int = 0  # so many versions of each training recording, some of them unvaried
    unvaried: float = 0.0  # share of the motions that stay as they were made
    # of the others:
    levels: float = 0.0  # share of the synthetic motions that are performed lower and leaning
    paces: float = 0.0  # share of the synthetic motions whose pace changes, with pauses; that of
    # every recording changes, but for its first version's
    variations: float = 0.0  # share with limbs turned; with pelvis moved; with another upper body
    path_scale: float = 0.3  # m: the unit of the pelvis' path (`with_path_scale`)
    # of all, whenever they are drawn:
    sizes: float = 0.0  # bodies are so much larger or smaller, at most (share)
    stages: float = 0.0  # share of all motions that are higher than the floor, by up to a metre


INBETWEENER = InbetweenerRecipe(
    "inbetweener",
    KeyframeConfig(activity=True),
    steps=10_000,
    snr=0.3,
    motions=1500,
    acts=1000,
    recordings=40,
    levels=0.3,
    paces=0.5,
    variations=0.6,
    unvaried=0.5,
    sizes=0.1,
    stages=0.2,
)


def training_windows(recipe: InbetweenerRecipe) -> DanceWindows:
    """The recipe's data, generated from its seed, and recordings.

    The last data set is kept, because it takes minutes to generate.
    """
    return with_path_scale(_windows(data_of(recipe)), recipe.path_scale)


NOT_DATA = (
    "name", "config", "steps", "snr", "lr", "optimizer", "batch", "decay", "seed", "path_scale",
    "sizes", "stages", "kinematic", "changes", "toes",
)  # fmt: skip


def data_of(recipe: InbetweenerRecipe) -> InbetweenerRecipe:
    """The recipe without all that does not change its data, so that trainings share them."""
    plain = InbetweenerRecipe("", KeyframeConfig(), steps=0)
    return replace(recipe, **{name: getattr(plain, name) for name in NOT_DATA})


@lru_cache(maxsize=1)
def _windows(recipe: InbetweenerRecipe) -> DanceWindows:
    positions, contacts = zip(*varied(recipe), strict=True)
    return DanceWindows.of(positions, contacts, None, recipe.frames)


def varied(recipe: InbetweenerRecipe) -> Iterator[Recorded]:
    """Walks, dances, performed sentences and recordings, each in a variation that is drawn.

    Levels, upper body, pelvis, limbs, pace: in this order, so that feet stand where they stood and
    a pace is that of the whole figure. The first version of a recording keeps its pace. The share
    `unvaried` of all stays as it was made.
    """
    from data_synth import levels, mixed, variations, warps

    seed = recipe.data_seed
    recorded = training_recordings() if recipe.recordings else []  # at first: they can be missing
    made = [
        *mixed.motions(recipe.motions, seed, recipe.seconds),
        *mixed.sentences(recipe.acts, seed),
    ]
    every = [*made, *recorded * recipe.recordings]
    for k, (positions, contacts) in enumerate(every):
        if np.random.default_rng([seed, 9, k]).uniform() < recipe.unvaried:
            yield positions.astype(np.float32), contacts
            continue
        rng = np.random.default_rng([seed, 8, k])
        if k < len(made) and rng.uniform() < recipe.levels:
            positions = levels.at_levels(positions, rng)
        if rng.uniform() < recipe.variations:
            upper, _ = every[rng.integers(len(every))]
            positions = variations.with_upper_body_of(positions, upper)
        if rng.uniform() < recipe.variations:
            positions = variations.pelvis_moved(positions, rng)
        if rng.uniform() < recipe.variations:
            positions = variations.limbs_turned(positions, rng)
        share = recipe.paces if k < len(made) else float(k >= len(made) + len(recorded))
        if rng.uniform() < share:
            positions, contacts = warps.warped(positions, contacts, rng)
        yield positions.astype(np.float32), contacts


def with_path_scale(windows: DanceWindows, metres: float) -> DanceWindows:
    """The same windows, in which a change of the pelvis' path by `metres` counts as 1.

    A path goes on for metres, so in standard deviations the centimetres between two keyframes are
    next to nothing.
    """
    scaler = windows.motion_scaler
    std = scaler.std.clone()
    std[dance_frame.PATH] = metres
    return replace(windows, motion_scaler=Scaler(scaler.mean, std))


def train_inbetweener(
    recipe: InbetweenerRecipe,
    run_file: Path,
    windows: DanceWindows | None = None,
    log=print,
    device: str | None = None,
) -> Inbetweener:
    """Train by a recipe, or continue the run in `run_file`; the weights are averaged ones.

    `device`: as in `training.on_device`.
    Raises ValueError when the run in `run_file` was begun with other settings.
    """
    windows = training_windows(recipe) if windows is None else windows
    schedule = shifted(cosine_schedule(recipe.config.S), recipe.snr)
    torch.manual_seed(recipe.seed)
    model = network(recipe.config)
    about = {"network": type(model).__name__, "data": digest(windows)}
    facts = {"windows": len(windows)} | bones_of(windows)
    source = "data_synth.mixed, synthetic"
    if recipe.recordings:
        source = f"data_synth.mixed and recordings. {CREDIT}"
    trained, card = train_recipe(
        recipe,
        run_file,
        on_device(model, device),
        loss_of(recipe, windows, schedule),
        Provenance(about, facts, source),
        warmup=300,
        log=log,
    )
    return Inbetweener(trained, schedule, windows.motion_scaler, card)


def loss_of(recipe: InbetweenerRecipe, windows: DanceWindows, schedule: Schedule) -> LossFn:
    """Eq. 4 of the remainder around the lines, each motion with a mask, a size and a height.

    Source: MoFusion eq. 4; the other terms, and the lines, are ours.
    """
    scaler, weights = windows.motion_scaler, recipe.kinematic
    data = total(squared_error, changes(recipe.changes))
    if recipe.toes:
        moved = toes_moved(windows)
        data = total(data, toe_changes(recipe.toes, dance_frame.moves, scaler.std, moved))
    if recipe.config.target == "v":
        data = weighted_by_step(data, as_x0_errors(schedule))
    lambda_k = weight_by_step(schedule, weights.over_time) if weights else None

    def loss_fn(model: Any, generator: torch.Generator) -> Tensor:
        device = next(model.parameters()).device
        motion, _, planted = windows.draw(recipe.batch, generator)
        known = drawn_masks(len(motion), windows.n, generator)
        sizes = 1 + recipe.sizes * (2 * uniform(generator, len(motion)) - 1)
        high = (uniform(generator, len(motion)) < recipe.stages) & known.flatten(1).any(1)
        heights = high * uniform(generator, len(motion))
        seen = as_seen(scaler.inverse(motion), known, sizes, heights)
        motion = scaler.transform(seen).to(device)
        columns = known.repeat_interleave(3, dim=-1).to(device)
        lines = model.lines(motion, columns)
        squares = lines.scale.square()
        loss = weighted(data, squares / squares.mean((1, 2), keepdim=True))
        kinematic = None
        if weights:
            body = body_around(lines, scaler.to(device))
            kinematic = weights.loss_for(body, planted.to(device))
        return training_loss(
            model, (lines.remainder(motion), lines), schedule, generator,
            kinematic=kinematic, lambda_k=lambda_k, loss=loss,
        )  # fmt: skip

    return loss_fn


def as_seen(
    motion: Float[Tensor, "B T 63"],
    known: Bool[Tensor, "B T 21"],
    sizes: Float[Tensor, "B"],
    heights: Float[Tensor, "B"],
) -> Float[Tensor, "B T 63"]:
    """Motions (features in metres) as `Inbetweener.fill` has them, from their first given pose.

    They are resized, and stand on stages of these heights (m).
    """
    positions = dance_frame.to_positions(motion).double().numpy()
    masks = known.numpy()
    drawn = zip(positions, masks, sizes.tolist(), heights.tolist(), strict=True)
    for one, mask, size, height in drawn:
        one[:] = size * first_place(one, mask).enter(one) + [0.0, height, 0.0]
    return torch.from_numpy(dance_frame.placed_features(positions)).float()


def body_around(lines: GivenLines, scaler: Scaler) -> Body:
    """The figure of remainders: their joints in metres are those of lines and remainder."""
    body = dance_frame.body_of(scaler)
    return replace(body, to_positions=lambda remainder: body.to_positions(lines.whole(remainder)))
