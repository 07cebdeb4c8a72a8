"""Train a mover by its recipe: described clips, words, loss, card.

The loss is MoFusion's with the departures of the recipe. A killed run continues from its last save.
"""

from collections.abc import Hashable
from dataclasses import replace
from functools import lru_cache, partial
from pathlib import Path

import torch
from jaxtyping import Int
from torch import Tensor, nn

from .._files import digest_of_tensors
from ..beyond.schedules import shifted
from ..conditions.text import base_vocabulary
from ..conditions.word_encoder import NOTHING, PADDING
from ..ddpm import Schedule, cosine_schedule
from ..motion import moving_frame
from ..motion.skeleton import TOES
from ..performers.described_windows import GRID, DescribedWindows
from ..performers.mover import Mover
from ..performers.networks import network
from ..training import LossFn
from .mofusion_loss import batch_loss, weighted_loss
from .movers import MoverRecipe
from .train_recipe import Provenance, train_recipe

Truths = dict[int, list[tuple[Hashable, Hashable]]]


def training_clips(clips: int, seed: int) -> DescribedWindows:
    """The data of a training, generated from its seed."""
    return training_data(clips, seed)[0]


@lru_cache(maxsize=1)
def training_data(clips: int, seed: int) -> tuple[DescribedWindows, Truths]:
    """The data, and what they show; the last data set is kept.

    `truths[n]` has for each motion of n frames its sentence, and that of its mirrored twin.
    """
    from data_synth.actions import captions  # here, because data_synth imports this package
    from data_synth.actions import clips as described
    from data_synth.actions.dataset import mirrored_sentence

    positions = []
    contacts = []
    texts = []
    truths: Truths = {}
    for one in described(clips, seed):
        acted = one.acted
        positions.append(acted.positions)
        contacts.append(acted.contacts)
        texts.append(one.captions)
        both = (acted.sentence, mirrored_sentence(acted.sentence))
        truths.setdefault(len(acted) // GRID * GRID, []).append(both)
    words = base_vocabulary(captions.vocabulary())
    return DescribedWindows.of(positions, contacts, texts, words), truths


def train_mover(
    recipe: MoverRecipe, run_file: Path, windows: DescribedWindows | None = None, log=print
) -> Mover:
    """Train by a recipe, or continue the run in `run_file`; return a mover with averaged weights.

    Raises ValueError when the run in `run_file` was begun with other settings.
    """
    if windows is None:
        windows = training_clips(recipe.clips, recipe.data_seed)
    recipe = replace(recipe, config=replace(recipe.config, words=windows.words))
    schedule = shifted(cosine_schedule(recipe.config.S), recipe.snr)
    torch.manual_seed(recipe.seed)
    model = network(recipe.config)
    about = {"network": type(model).__name__, "data": digest(windows)}
    trained, card = train_recipe(
        recipe,
        run_file,
        model,
        loss_of(recipe, windows, schedule),
        Provenance(about, {"clips": len(windows)}, "data_synth.actions, synthetic"),
        warmup=300,
        log=log,
    )
    return Mover(trained, schedule, windows.scaler, card)


def loss_of(recipe: MoverRecipe, windows: DescribedWindows, schedule: Schedule) -> LossFn:
    """The loss of a recipe: its data, MoFusion's eq. 4, and the departures that it names."""
    scaler = windows.scaler
    moved = partial(toes_moved, windows)
    loss = weighted_loss(recipe.loss_weights, schedule, scaler, moving_frame.moves, moved)
    of_batch = batch_loss(recipe.kinematic, loss, schedule, scaler, moving_frame.body_of)

    def loss_fn(model: nn.Module, generator: torch.Generator) -> Tensor:
        device = next(model.parameters()).device
        x0, ids, planted = windows.draw(recipe.frames, generator)
        ids = without_some(ids, recipe.no_text, generator)
        x0, ids, planted = (part.to(device) for part in (x0, ids, planted))
        return of_batch(model, x0, model.listen(ids), planted, generator)

    return loss_fn


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
        features = windows.scaler.inverse(windows.draw(4000, generator)[0])
        moved.append(moving_frame.moves(features)[:, :, list(TOES)].square().mean())
    return float(torch.stack(moved).mean())


def digest(windows: DescribedWindows) -> str:
    """A checksum of all clips and captions; a run is resumed only with the data it began with."""
    parts = {f"{name}.{n}": x for name in ("motions", "captions", "contacts")
             for n, x in getattr(windows, name).items()}  # fmt: skip
    return digest_of_tensors(parts)[:16]
