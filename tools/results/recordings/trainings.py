"""What departures and recordings are worth for in-betweens: trainings of equal length.

Each row differs from another, or from the recipe `inbetweener`, in what its words name. It is
trained for 2,500 of the recipe's 10,000 steps. `not-shown` trains nothing: it is the shipped dancer
without music, as notebook 15 steers it. All are judged on recordings of people whom none has seen,
with a keyframe a second.
"""

from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

import numpy as np
from jaxtyping import Float

from motiondiff_edu.editing.inpaint import guide_and_blend, inpaint
from motiondiff_edu.performers.dancer import Dancer
from motiondiff_edu.performers.inbetweener import Inbetweener
from motiondiff_edu.performers.performer import STEPS
from motiondiff_edu.pretrained import checkpoints
from motiondiff_edu.recipes.inbetweener import INBETWEENER, InbetweenerRecipe, train_inbetweener

from ..inbetweens.departures import NOT_SHOWN as UNCONDITIONAL
from ..sweep import Sweep, Variant, differences
from ..walks.parts import weights_digest
from .inbetweens import KINDS, SECOND, columns, measured_alone, windows_of
from .windows import RecordedSize

NOT_SHOWN = "not-shown"
VARIANTS = {
    "plain": Variant("lines alone", {"config": replace(INBETWEENER.config, activity=False)}),
    "ours": Variant(
        "the recipe: scales know how much the figure moves (`beyond/activity.py`)", {},
        {"plain": "plain"},
    ),
    "no-recordings": Variant("no recordings in training", {"recordings": 0}, {"ours": "ours"}),
    "cosine": Variant("the cosine schedule as it is", {"snr": 1.0}, {"ours": "ours"}),
    NOT_SHOWN: Variant(
        "a network that is not shown what is given, guided and blended; no recordings either",
        rivals={"no-recordings": "no-recordings"},
    ),
}  # fmt: skip


@dataclass(frozen=True)
class Budget:
    """The seeds of the trainings, the amount of measurement, and changes of all recipes.

    The samples are half as many as in the tables, since there are several trainings.
    """

    seeds: tuple[int, ...] = (0,)
    size: RecordedSize = RecordedSize(each=2, samples=5)
    training: dict = field(default_factory=lambda: {"steps": 2_500})


FULL = Budget()
QUICK = Budget(
    (0, 1),
    RecordedSize(files=3, each=1, samples=2),
    {"steps": 3, "motions": 2, "acts": 1, "recordings": 1, "seconds": 6.0},
)


def recipe_of(name: str, seed: int, budget: Budget) -> InbetweenerRecipe:
    """The training of one variant with one seed."""
    settings = {"name": f"inbetween-budget.{name}", "seed": seed}
    return replace(INBETWEENER, **settings, **budget.training | VARIANTS[name].recipe)


@dataclass(frozen=True)
class NotShown:
    """In-betweens by a dancer without music, which is guided and blended."""

    dancer: Dancer

    def fill(
        self, positions, known, *, samples: int, steps: int, remainder: float, generator
    ) -> Float[np.ndarray, "S T J 3"]:
        """As `Inbetweener.fill`; `remainder` has no meaning, so that a second try is a draw."""
        how = {"samples": samples, "steps": steps, "generator": generator}
        return inpaint(self.dancer, positions, known, steer=guide_and_blend, **how)


def trained(name: str, seed: int, budget: Budget, runs: Path) -> Inbetweener | NotShown:
    """The network of a variant.

    A run that was killed continues; one that is finished is only read.
    """
    if name == NOT_SHOWN:
        return NotShown(checkpoints.load(UNCONDITIONAL))
    runs.mkdir(parents=True, exist_ok=True)
    run = runs / f"{name}-{seed}.safetensors"
    return train_inbetweener(recipe_of(name, seed, budget), run, log=partial(print, flush=True))


def sweep(budget: Budget, runs: Path) -> Sweep:
    """The trainings, with a keyframe a second; intervals are over trainings and persons."""

    def measure(name: str, inbetweener: Inbetweener | NotShown, seed: int) -> dict:
        windows, samples = windows_of(budget.size), budget.size.samples
        rows = [measured_alone((inbetweener, motion, SECOND, samples)) for _, motion in windows]
        return columns(rows, [source for source, _ in windows])

    def about(name: str) -> dict:
        if name == NOT_SHOWN:
            network = {"weights": weights_digest(checkpoints.available()[UNCONDITIONAL])}
        else:
            network = {"trained_steps": recipe_of(name, 0, budget).steps}
        return network | {"samples": budget.size.samples, "steps": STEPS}

    return Sweep(
        "inbetween-budget", VARIANTS, lambda name, seed: trained(name, seed, budget, runs), measure,
        KINDS, differences(KINDS), about,
        budget.seeds,
    )  # fmt: skip
