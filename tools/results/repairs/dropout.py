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

from motiondiff_edu.metrics.adherence import adherence
from motiondiff_edu.performers.walker import Walker
from motiondiff_edu.pretrained import checkpoints
from motiondiff_edu.recipes.train_walker import train, training_clips
from motiondiff_edu.recipes.walkers import MEND_PLAIN, Recipe

from ..intervals import interval_over_seeds
from ..sweep import Rows, Sweep, Variant
from ..walks.parts import weights_digest
from ..walks.scores import Kind, Measure, root_mean, squared_bone_error
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
MEASURES = {"bone": ("cm", root_mean), "adherence": ("mps", np.nanmean)}


def gains(plain: dict[str, np.ndarray], dropout: dict[str, np.ndarray]) -> list[Measure]:
    """Errors without dropout minus those with it, on incomplete pasts; arrays (seeds, clips)."""
    found = []
    for kind, (unit, mean) in MEASURES.items():
        values = interval_over_seeds(
            lambda a, b, mean=mean: mean(a) - mean(b), plain[kind], dropout[kind]
        )
        found.append(
            Measure(f"dropout_gain_{kind}_{unit}", *values, "cm" if unit == "cm" else "m/s")
        )
    return found


def cost(name: str, plain: dict[str, np.ndarray], dropout: dict[str, np.ndarray]) -> Measure:
    """Errors with dropout over those without, on complete pasts: the larger of the two ratios."""

    def larger(*parts: np.ndarray) -> float:
        pairs = zip(MEASURES.values(), (parts[:2], parts[2:]), strict=True)
        return max(mean(b) / mean(a) for (_, mean), (a, b) in pairs)

    arrays = [both[kind] for kind in MEASURES for both in (plain, dropout)]
    return Measure(name, *interval_over_seeds(larger, *arrays), "ratio")


def measured(walkers: list, trials: Trials, share: float) -> dict[str, np.ndarray]:
    """`rows` of several walkers, (seeds, clips); each draws with the same seed."""
    each = [rows(continued(walker, trials, share, NEXT), trials) for walker in walkers]
    return {kind: np.stack([one[kind] for one in each]) for kind in MEASURES}


def dropout_measures(pairs: Comparison, trials: Trials, weights: dict[str, Path]) -> list[Measure]:
    """Gains, cost, and the errors of both kinds with and without faults."""
    walkers = {
        kind: [checkpoints.load_walker(weights[name]) for name in names]
        for kind, names in (("plain", pairs.plain), ("dropout", pairs.dropout))
    }
    whole, broken = (
        {k: measured(w, trials, share) for k, w in walkers.items()} for share in (0.0, SHARE)
    )
    found = [*gains(broken["plain"], broken["dropout"])]
    for words, both in (("complete", whole), ("missing", broken)):
        for kind, arrays in both.items():
            for what, (unit, mean) in MEASURES.items():
                values = interval_over_seeds(mean, arrays[what])
                found.append(
                    Measure(
                        f"{kind}_{words}_{what}_{unit}", *values, "cm" if unit == "cm" else "m/s"
                    )
                )
    found = [replace(measure, name=f"{pairs.prefix}{measure.name}") for measure in found]
    return [*found, cost(pairs.cost, whole["plain"], whole["dropout"])]


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
    save_every: int = 200


MAP_FULL = MapBudget()
MAP_QUICK = MapBudget(steps=3, clips=2, save_every=2)


VARIANTS = {
    name: Variant("no dropout" if rate == 0 else f"a rate of {rate:.0%}", rate)
    for name, rate in RATES.items()
}
KINDS = {
    f"missing-{round(100 * share)}.{kind}_{unit}": Kind(
        "cm" if unit == "cm" else "m/s", (f"{kind}-{round(100 * share)}",), mean
    )
    for share in SHARES
    for kind, (unit, mean) in MEASURES.items()
}


def map_recipe(name: str, budget: MapBudget) -> Recipe:
    """The recipe of a walker with one constant rate of dropout."""
    rate = VARIANTS[name].recipe
    return replace(
        MEND_PLAIN, name=f"mend-map.{name}", dropout=(rate,) if rate else (), dropout_start=0.0,
        steps=budget.steps, clips=budget.clips, save_every=budget.save_every,
    )  # fmt: skip


@cache
def _clips(budget: MapBudget):
    return training_clips(map_recipe("00", budget))


def sweep(budget: MapBudget, runs: Path, trials: Trials) -> Sweep:
    """A walker for each rate, measured for every share of missing joints."""

    def trained(name: str, seed: int) -> Walker:
        runs.mkdir(parents=True, exist_ok=True)
        return train(map_recipe(name, budget), runs / f"{name}.safetensors", _clips(budget))

    def measure(name: str, walker: Walker, seed: int) -> Rows:
        found = {share: measured([walker], trials, share) for share in SHARES}
        return {
            f"{kind}-{round(100 * share)}": one[kind][0]
            for share, one in found.items()
            for kind in MEASURES
        }

    def about(name: str) -> dict:
        found = {"data": UNSEEN, "clips": len(trials.past), "frames": NEXT, "rollouts": 0}
        return found | {"trained_steps": budget.steps, "trained_clips": budget.clips}

    return Sweep("mend-map", VARIANTS, trained, measure, KINDS, about=about)
