"""The value of diffusion dropout when part of the past is missing.

Walkers trained with and without it. Two comparisons, all weights shipped:
three pairs of small walkers, and `walker` beside `walker-plain`. Both sides of a comparison have
the same network, data and steps.
Source: MoDiff III-D, IV-B, Table II.   Notebook: 09
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from motiondiff_edu.metrics.walks import adherence
from motiondiff_edu.pretrained import checkpoints

from ..sweep import minus
from ..walks.parts import weights_digest
from ..walks.scores import Kind, Measure, measures_over_seeds, root_mean, squared_bone_error
from ..walks.trials import UNSEEN, Trials
from .trials import SHARE, continued, names_of

NEXT = 10  # frames


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
        walkers = [checkpoints.load(weights[name]) for name in names]
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
