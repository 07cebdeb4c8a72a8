"""The value of diffusion dropout when part of the past is missing.

Walkers trained with and without it, and a map over rates. Two comparisons, all weights shipped:
three pairs of small walkers, and `walker` beside `walker-plain`. Both sides of a comparison have
the same network, data and steps.
Source: MoDiff III-D, IV-B, Table II.   Notebook: 09
"""

from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np

from motiondiff_edu.metrics.walks import adherence
from motiondiff_edu.performers.walker import Walker
from motiondiff_edu.pretrained import checkpoints
from motiondiff_edu.recipes.walker import MEND_PLAIN, WalkerRecipe, train, training_clips

from ..sweep import Rows, Sweep, Variant, minus
from ..walks.parts import weights_digest
from ..walks.scores import Kind, Measure, measures_over_seeds, root_mean, squared_bone_error
from ..walks.trials import UNSEEN, Trials
from .trials import SHARE, continued, names_of

NEXT = 10  # frames
SHARES = (0.0, 0.15, 0.3, 0.5, 0.7, 1.0)  # of the joints missing
RATES = {
    f"{round(100 * rate):02d}": rate for rate in (0.0, 0.05, 0.1, 0.15, 0.25, 0.5, 0.75)
}  # by name, per cent


def rows(made: np.ndarray, trials: Trials) -> dict[str, np.ndarray]:
    """Squared bone error (cm^2) and distance from the control (m/s) of each clip."""
    frames = made.shape[1]
    return {
        "bone": squared_bone_error(made),
        "adherence": adherence(made, trials.asked[:, :frames]),
    }


@dataclass(frozen=True)
class Comparison:
    """Shipped weights without and with diffusion dropout, and how their measures are named."""

    plain: tuple[str, ...]
    dropout: tuple[str, ...]
    prefix: str = ""
    cost: str = "dropout_cost_complete"


SMALL_PAIRS = Comparison(
    tuple(names_of("plain")), tuple(names_of("dropout")), cost="pairs_dropout_cost_complete"
)
SHIPPED_PAIR = Comparison(("walker-plain",), ("walker",), prefix="walker_")
MEASURES = {  # name: (unit, the row, its mean)
    "bone_cm": ("cm", "bone", root_mean),
    "adherence_mps": ("m/s", "adherence", np.nanmean),
}
SIDES = ("plain", "dropout")
COMPARED = {  # errors without dropout minus those with it, on incomplete pasts
    f"dropout_gain_{name}": Kind(
        unit,
        tuple(f"{side}_missing_{row}" for side in SIDES),
        minus(Kind(unit, (row,), mean)).value,
    )
    for name, (unit, row, mean) in MEASURES.items()
} | {
    f"{side}_{past}_{name}": Kind(unit, (f"{side}_{past}_{row}",), mean)
    for past in ("complete", "missing")
    for side in SIDES
    for name, (unit, row, mean) in MEASURES.items()
}


def larger(*parts: np.ndarray) -> float:
    """The larger of the ratios of bone and control error: with dropout over without."""
    return max(
        mean(parts[2 * k + 1]) / mean(parts[2 * k])
        for k, (_, _, mean) in enumerate(MEASURES.values())
    )


COMPLETE = tuple(f"{side}_complete_{row}" for _, row, _ in MEASURES.values() for side in SIDES)
COST = Kind("ratio", COMPLETE, larger)


def measured(walkers: list, trials: Trials, share: float) -> dict[str, np.ndarray]:
    """`rows` of several walkers, (seeds, clips); each draws with the same seed."""
    each = [rows(continued(walker, trials, share, NEXT), trials) for walker in walkers]
    return {row: np.stack([one[row] for one in each]) for row in each[0]}


def dropout_measures(pairs: Comparison, trials: Trials, weights: dict[str, Path]) -> list[Measure]:
    """Gains, the errors of both sides with and without faults, and the cost."""
    found = {}
    for side, names in (("plain", pairs.plain), ("dropout", pairs.dropout)):
        walkers = [checkpoints.load_walker(weights[name]) for name in names]
        for past, share in (("complete", 0.0), ("missing", SHARE)):
            made = measured(walkers, trials, share)
            found |= {f"{side}_{past}_{row}": values for row, values in made.items()}
    kinds = {f"{pairs.prefix}{name}": kind for name, kind in COMPARED.items()} | {pairs.cost: COST}
    return measures_over_seeds(kinds, found)


def dropout_records(
    pairs: Comparison, trials: Trials, weights: dict[str, Path], command: str
) -> list[dict]:
    """The measures of one comparison as records."""
    seeds = {
        "data": UNSEEN,
        "clips": len(trials.past),
        "missing": SHARE,
        "frames": NEXT,
        "rollouts": 0,
    }
    seeds |= {
        "trainings": len(pairs.plain),
        "weights": [weights_digest(weights[name]) for name in (*pairs.plain, *pairs.dropout)],
    }
    found = dropout_measures(pairs, trials, weights)
    return [measure.as_record("mend.", seeds, command) for measure in found]


@dataclass(frozen=True)
class MapBudget:
    """The length and the data of the training of each walker of the map."""

    steps: int = 4000
    clips: int = 200


MAP_FULL = MapBudget()
MAP_QUICK = MapBudget(steps=3, clips=12)


VARIANTS = {
    name: Variant("no dropout" if rate == 0 else f"a rate of {rate:.0%}", rate)
    for name, rate in RATES.items()
}
KINDS = {
    f"missing-{round(100 * share)}.{name}": Kind(unit, (f"{row}-{round(100 * share)}",), mean)
    for share in SHARES
    for name, (unit, row, mean) in MEASURES.items()
}


def map_recipe(name: str, budget: MapBudget, seed: int = 0) -> WalkerRecipe:
    """The recipe of a walker with one constant rate of dropout."""
    rate = VARIANTS[name].recipe
    return replace(
        MEND_PLAIN, name=f"mend-map.{name}", seed=seed,
        dropout=(rate,) if rate else (), dropout_start=0.0,
        steps=budget.steps, clips=budget.clips,
    )  # fmt: skip


@cache
def _clips(budget: MapBudget):
    return training_clips(map_recipe("00", budget))


def sweep(budget: MapBudget, runs: Path, trials: Trials) -> Sweep:
    """A walker for each rate, measured for every share of missing joints."""

    def trained(name: str, seed: int) -> Walker:
        runs.mkdir(parents=True, exist_ok=True)
        return train(
            map_recipe(name, budget, seed), runs / f"{name}-{seed}.safetensors", _clips(budget)
        )

    def measure(name: str, walker: Walker, seed: int) -> Rows:
        found = {share: measured([walker], trials, share) for share in SHARES}
        return {
            f"{row}-{round(100 * share)}": values[0]
            for share, one in found.items()
            for row, values in one.items()
        }

    def about(name: str) -> dict:
        found = {"data": UNSEEN, "clips": len(trials.past), "frames": NEXT, "rollouts": 0}
        return found | {"trained_steps": budget.steps, "trained_clips": budget.clips}

    return Sweep("mend-map", VARIANTS, trained, measure, KINDS, about=about)
