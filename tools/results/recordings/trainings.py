"""What recordings and variations in training are worth for in-betweens: trainings of equal length.

Each row differs from the recipe `inbetweener` in one choice, or in the choices that its words name.
It is trained with three seeds, for 800 of the recipe's 10,000 steps. All are judged on recordings
of people whom none has seen, with a keyframe a second.
"""

from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

from motiondiff_edu.performers.inbetweener import STEPS, Inbetweener
from motiondiff_edu.recipes.inbetweener import INBETWEENER, InbetweenerRecipe, train_inbetweener

from ..sweep import Sweep, Variant
from .inbetweens import KINDS, SECOND, columns, in_turn, windows_of
from .windows import RecordedSize

VARIANTS = {
    "ours": Variant("the recipe", {}),
    "no-recordings": Variant("no recordings in training", {"recordings": 0}),
    "no-activity": Variant(
        "scales do not know how much the figure moves (`beyond/activity.py`)",
        {"config": replace(INBETWEENER.config, activity=False)},
    ),
    "no-turning": Variant(
        "poses are seen in the heading of the first one (`beyond/turning_frame.py`)",
        {"config": replace(INBETWEENER.config, turning=False)},
    ),
    "no-variations": Variant(
        "no other limbs, pelvises, upper bodies and levels, no stages; other paces for recordings "
        "alone",
        {"variations": 0.0, "levels": 0.0, "paces": 0.0, "stages": 0.0},
    ),
}


@dataclass(frozen=True)
class Budget:
    """The seeds of the trainings, the amount of measurement, and changes of all recipes.

    The samples are half as many as in the tables, since there are several trainings.
    """

    seeds: tuple[int, ...] = (0, 1, 2)
    size: RecordedSize = RecordedSize(each=2, samples=5)
    training: dict = field(default_factory=lambda: {"steps": 800})


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


def trained(name: str, seed: int, budget: Budget, runs: Path) -> Inbetweener:
    """The network of a variant.

    A run that was killed continues; one that is finished is only read.
    """
    runs.mkdir(parents=True, exist_ok=True)
    run = runs / f"{name}-{seed}.safetensors"
    return train_inbetweener(recipe_of(name, seed, budget), run, log=partial(print, flush=True))


def sweep(budget: Budget, runs: Path) -> Sweep:
    """The trainings, with a keyframe a second; intervals are over trainings and persons."""

    def measure(name: str, inbetweener: Inbetweener, seed: int) -> dict:
        windows, samples = windows_of(budget.size), budget.size.samples
        rows = in_turn([(inbetweener, motion, SECOND, samples) for _, motion in windows])
        return columns(rows, [source for source, _ in windows])

    def about(name: str) -> dict:
        found = {"trained_steps": recipe_of(name, 0, budget).steps}
        return found | {"samples": budget.size.samples, "steps": STEPS}

    return Sweep(
        "inbetween-budget", VARIANTS, lambda name, seed: trained(name, seed, budget, runs), measure,
        KINDS, about=about, seeds=budget.seeds,
    )  # fmt: skip
