"""The value of each choice of a mover, and two baselines, by trainings of equal length.

Each row differs from the recipe of the mover in one choice, and is trained with three seeds. The
bag of words and the regression have no timeline either: compare them with that row. Without a
timeline the network is a fifth smaller, and a step is faster. All else is equal: data, steps,
sampler, and the unseen clips. The networks are half as wide as the shipped mover's and see a
twelfth of the frames that it saw; so the numbers say what a choice is worth, and not how good a
mover can be.
Source: MoFusion 3; choices are ours
"""

from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

import numpy as np

from motiondiff_edu._files import digest_of_tensors
from motiondiff_edu.baselines.text import BagConfig, RegressionConfig
from motiondiff_edu.metrics.actions import actions
from motiondiff_edu.metrics.sentences import KINDS, rows_of
from motiondiff_edu.motion import moving_frame
from motiondiff_edu.performers.mover import Mover
from motiondiff_edu.recipes.dancers import DanceLossWeights
from motiondiff_edu.recipes.movers import MOVER, MoverRecipe
from motiondiff_edu.recipes.train_mover import train_mover

from ..repairs.trials import interval_over_seeds
from ..walks.scores import Measure, ratio, root_mean, squared_bone_error
from .rows import STEPS, performed
from .scores import Panel, by_trial, nearer, retrieved, sliding
from .trials import UNSEEN, Positions

SIZES = replace(MOVER.config, widths=(48, 48, 64), plan_widths=(24, 24, 32))
SMALL = replace(MOVER, config=SIZES, steps=2400, plan_steps=0, frames=1024)
ALONE = replace(SIZES.of_one(), D=moving_frame.D)


def network_of(config: type) -> dict:
    """Another network with the sizes of the mover without a timeline."""
    return {"config": config(**vars(ALONE))}


# name: (what differs, in words, changes of the recipe)
VARIANTS: dict[str, tuple[str, dict]] = {
    "ours": ("the mover's recipe", {}),
    "no-timeline": ("no timeline", {"config": ALONE}),
    "no-kinematic": ("no kinematic losses", {"kinematic": None}),
    "shallow": ("no further layers in the middle", {"config": replace(SIZES, depth=0)}),
    "columns-alike": ("all columns alike, without weights by their spread", {"metres": 0.0}),
    "plain-loss": ("errors of poses alone", {"loss_weights": DanceLossWeights()}),
    "cosine": ("the cosine schedule as it is", {"snr": 1.0}),
    "bag": ("no timeline, a bag of words", network_of(BagConfig)),
    "regression": ("no timeline, no noise: regression", network_of(RegressionConfig)),
}


@dataclass(frozen=True)
class Budget:
    """The seeds of the trainings, the number of unseen captions, and changes of all recipes."""

    seeds: tuple[int, ...] = (0, 1, 2)
    trials: int = 256
    training: dict = field(default_factory=dict)


FULL = Budget()
QUICK = Budget((0, 1), 40, {"steps": 3, "clips": 12, "frames": 300, "save_every": 2})


def recipe_of(name: str, seed: int, budget: Budget) -> MoverRecipe:
    """The training of one variant with one seed."""
    settings = {"name": f"words-budget.{name}", "seed": seed}
    return replace(SMALL, **settings, **budget.training, **VARIANTS[name][1])


def trained(name: str, seed: int, budget: Budget, runs: Path) -> Mover:
    """The mover of a variant.

    A run that was killed continues; one that is finished is only read.
    """
    runs.mkdir(parents=True, exist_ok=True)
    run = runs / f"{name}-{seed}.safetensors"
    return train_mover(recipe_of(name, seed, budget), run, log=partial(print, flush=True))


def budget_records(name: str, budget: Budget, panel: Panel, runs: Path, command: str) -> list[dict]:
    """Train (or continue) a variant with each seed, and measure it; the intervals hold both."""
    made, weights = [], []
    for seed in budget.seeds:
        mover = trained(name, seed, budget, runs)
        weights.append(digest_of_tensors(mover.model.state_dict())[:16])
        made.append(performed(mover)(panel.trials, seed))
    about = {"data": UNSEEN, "trials": budget.trials, "trainings": list(budget.seeds)}
    about |= {"trained_steps": recipe_of(name, 0, budget).steps, "steps": STEPS}
    about |= {"weights": weights}
    measures = measured(panel, made)
    return [one.as_record(f"words-budget.{name}.", about, command) for one in measures]


def measured(panel: Panel, made: list[list[Positions]]) -> list[Measure]:
    """The measures of several trainings; made[seed][trial]."""
    points = [panel.row(one) for one in made]
    agreed = [rows_of(panel.trials.phrases, [actions(x) for x in one]) for one in made]
    near = [by_trial(panel, nearer(panel, row)) for row in points]
    rows = {f"{kind}_accuracy": np.stack([one[kind] for one in agreed]) for kind in KINDS}
    found = [
        Measure(key, *interval_over_seeds(np.nanmean, row), "share") for key, row in rows.items()
    ]
    for name in near[0]:
        both = (np.stack([one[name][part] for one in near]) for part in (0, 1))
        found.append(Measure(f"minimal_pair{name}", *interval_over_seeds(ratio, *both), "share"))
    bones = np.array([[squared_bone_error(x[None])[0] for x in one] for one in made])
    slides = np.array([[sliding(x) for x in one] for one in made])
    found.append(Measure("bone_rmse_cm", *interval_over_seeds(root_mean, bones), "cm"))
    found.append(Measure("skating_mps", *interval_over_seeds(np.nanmean, slides), "m/s"))
    return found + over_trainings([retrieved(panel, row) for row in points])


def over_trainings(each: list[list[Measure]]) -> list[Measure]:
    """The mean of each measure, from the least to the largest interval's end."""
    return [
        replace(
            same[0],
            value=float(np.mean([one.value for one in same])),
            low=min(one.low for one in same),
            high=max(one.high for one in same),
        )
        for same in zip(*each, strict=True)
    ]
