"""Train the judges of words: spaces of texts and motions, learnt by contrast.

They see the captions and clips of the training split alone, as the movers do.
"""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import torch
from jaxtyping import Float
from torch import Tensor

from ..conditions.word_encoder import FIRST
from ..metrics.distributions import Space, contrast
from ..motion.moving_frame import D
from ..performers.described_windows import Chosen
from ..pretrained.judges import Judge
from ..training import LossFn
from .mover import DescribedData, Truths, described, digest
from .training import Provenance, Recipe, on_device, train_recipe

SEEDS = (0, 1, 2)


@dataclass(frozen=True)
class SpaceConfig:
    """What the card of a judge says of its network."""

    width: int = 128
    target: str = "contrast"


@dataclass(frozen=True)
class JudgeRecipe(Recipe):
    """One training run of a judge."""

    config: SpaceConfig = SpaceConfig()
    steps: int = 3000
    frames: int = 14_000  # of a batch, all motions together
    lr: float = 1e-3
    optimizer: str = "adam"
    clips: int = 12_000


JUDGES = {f"judge-{seed}": JudgeRecipe(f"judge-{seed}", seed=seed) for seed in SEEDS}


def train_judge(recipe: JudgeRecipe, run_file: Path, log=print, device: str | None = None) -> Judge:
    """Train by a recipe, or continue the run in `run_file`; return a judge with averaged weights.

    Raises ValueError when the run in `run_file` was begun with other settings.
    """
    data = shown_to_judges(recipe.clips, recipe.data_seed)
    windows = data.windows
    torch.manual_seed(recipe.seed)
    space = Space(D, FIRST + len(windows.words), recipe.config.width)
    trained, card = train_recipe(
        recipe,
        run_file,
        on_device(space, device),
        loss_of(recipe, data),
        Provenance({"data": digest(windows)}, {"clips": len(windows)}, "data_synth.actions"),
        warmup=100,
        log=log,
    )
    return Judge(trained, windows.scaler, windows.words, card)


def shown_to_judges(clips: int, seed: int) -> DescribedData:
    """The data of the movers without the timelines: a judge sees motions alone."""
    data = described(clips, seed)
    return replace(data, windows=data.windows.without_timeline())


def loss_of(recipe: JudgeRecipe, data: DescribedData) -> LossFn:
    """The loss by contrast over random batches; texts that say the same are not set apart."""

    def loss_fn(model: Any, generator: torch.Generator) -> Tensor:
        device = next(model.parameters()).device
        chosen = data.windows.choose(recipe.frames, generator)
        x, ids, _ = data.windows.take(chosen)
        wrong = data.wrong[chosen.length][chosen.which]
        wrong = torch.where(chosen.turned[:, None], data.windows.exchanged[wrong], wrong)
        parts = (x, ids, same(chosen, data.truths), wrong)
        return contrast(model, *(part.to(device) for part in parts))

    return loss_fn


def same(chosen: Chosen, truths: Truths) -> Float[Tensor, "B B"]:
    """1 where two motions of a batch show the same."""
    shown = [
        truths[chosen.length][k][int(turned)]
        for k, turned in zip(chosen.which.tolist(), chosen.turned.tolist(), strict=True)
    ]
    numbers = {truth: number for number, truth in enumerate(dict.fromkeys(shown))}
    rows = torch.tensor([numbers[truth] for truth in shown])
    return (rows[:, None] == rows).float()
