"""What recordings and variations in training are worth for in-betweens: trainings of equal length.

Each row differs from the recipe `inbetweener` in one choice, or in the choices that its words name.
It is trained with three seeds, for 800 of the recipe's 10,000 steps. All are judged on recordings
of people whom none has seen, with a keyframe a second.
"""

from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

from motiondiff_edu._files import digest_of_tensors
from motiondiff_edu.performers.inbetweener import STEPS, Inbetweener
from motiondiff_edu.recipes.inbetweener import INBETWEENER, InbetweenerRecipe, train_inbetweener

from ..walks.scores import Measure
from ..words.budget import over_trainings
from .inbetweens import SECOND, measures_of, rows_of, windows_and_walks
from .windows import RecordedSize

# name: (what differs, in words, changes of the recipe)
VARIANTS: dict[str, tuple[str, dict]] = {
    "ours": ("the recipe", {}),
    "no-recordings": ("no recordings in training", {"recordings": 0}),
    "no-activity": (
        "scales do not know how much the figure moves (`beyond/activity.py`)",
        {"config": replace(INBETWEENER.config, activity=False)},
    ),
    "no-turning": (
        "poses are seen in the heading of the first one (`beyond/turning_frame.py`)",
        {"config": replace(INBETWEENER.config, turning=False)},
    ),
    "no-variations": (
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
    {"steps": 3, "motions": 2, "acts": 1, "recordings": 1, "seconds": 6.0, "save_every": 2},
)


def recipe_of(name: str, seed: int, budget: Budget) -> InbetweenerRecipe:
    """The training of one variant with one seed."""
    settings = {"name": f"inbetween-budget.{name}", "seed": seed}
    return replace(INBETWEENER, **settings, **budget.training | VARIANTS[name][1])


def trained(name: str, seed: int, budget: Budget, runs: Path) -> Inbetweener:
    """The network of a variant.

    A run that was killed continues; one that is finished is only read.
    """
    runs.mkdir(parents=True, exist_ok=True)
    run = runs / f"{name}-{seed}.safetensors"
    return train_inbetweener(recipe_of(name, seed, budget), run, log=partial(print, flush=True))


def budget_records(name: str, budget: Budget, runs: Path, command: str) -> list[dict]:
    """Train (or continue) a variant with each seed, and measure it.

    The values are means over trainings; the intervals hold those of all trainings.
    """
    found, weights = [], []
    for seed in budget.seeds:
        inbetweener = trained(name, seed, budget, runs)
        weights.append(digest_of_tensors(inbetweener.model.state_dict())[:16])
        found.append(measured(inbetweener, budget.size))
    about = {"trainings": list(budget.seeds), "trained_steps": recipe_of(name, 0, budget).steps}
    about |= {"samples": budget.size.samples, "steps": STEPS, "weights": weights}
    measures = over_trainings(found)
    return [one.as_record(f"inbetween-budget.{name}.", about, command) for one in measures]


def measured(inbetweener: Inbetweener, size: RecordedSize) -> list[Measure]:
    """The measures of one training."""
    windows, walks = windows_and_walks(size)
    rows = rows_of(inbetweener, windows, SECOND, size.samples)
    return measures_of(rows, walks, [source for source, _ in windows])
