"""The measures of one walker on a set of trials, each with its interval over clips.

Names, values, units.

`score` takes arrays, so it can also score the data themselves.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from motiondiff_edu.metrics.bodies import bone_lengths
from motiondiff_edu.metrics.distributions import spread
from motiondiff_edu.metrics.walks import adherence, planted_share, skating
from motiondiff_edu.motion.skeleton import BONE_LENGTHS

from ..intervals import interval, interval_over_seeds

FPS = 20
SKATING_FLOOR = 0.02  # m/s: this is used for data that slide less
EDGE = 3 * FPS  # drift compares the first three seconds with the last three


@dataclass(frozen=True)
class Measure:
    """One measured number, before it becomes a record."""

    name: str
    value: float
    low: float
    high: float
    unit: str

    def as_record(self, prefix: str, seeds: dict, command: str) -> dict:
        """The record for docs/results: five digits, None for NaN."""
        value, low, high = (
            float(f"{x:.5g}") if np.isfinite(x) else None for x in (self.value, self.low, self.high)
        )
        name, about = prefix + self.name, {"unit": self.unit, "paper": None, "command": command}
        return dict(name=name, value=value, low=low, high=high, seeds=seeds) | about


@dataclass(frozen=True)
class Kind:
    """A measure: its unit, the rows that it is computed from, and the function of them."""

    unit: str
    rows: tuple[str, ...]
    value: Callable[..., float]


def measures(
    kinds: Mapping[str, Kind], rows: Mapping[str, np.ndarray], groups: np.ndarray | None = None
) -> list[Measure]:
    """The measures of rows that have a number for each clip, with intervals over clips or groups.

    Those whose rows are not there are left out.
    """
    return [
        measure_of(name, kind.unit, kind.value, *(rows[key] for key in kind.rows), groups=groups)
        for name, kind in kinds.items()
        if set(kind.rows) <= set(rows)
    ]


def measures_over_seeds(
    kinds: Mapping[str, Kind], rows: Mapping[str, np.ndarray], groups: np.ndarray | None = None
) -> list[Measure]:
    """The same for rows of several trainings, (seeds, clips): intervals are over both."""
    return [
        Measure(
            name,
            *interval_over_seeds(kind.value, *(rows[key] for key in kind.rows), groups=groups),
            kind.unit,
        )
        for name, kind in kinds.items()
    ]


def squared_bone_error(poses: Float[np.ndarray, "N T J 3"]) -> Float[np.ndarray, "N"]:
    """Mean squared bone-length error of each clip, cm^2; its mean's root is the paper's RMSE."""
    return 1e4 * ((bone_lengths(poses) - BONE_LENGTHS) ** 2).mean((-2, -1))


def squared_stretch(poses: Float[np.ndarray, "N T J 3"]) -> Float[np.ndarray, "N"]:
    """The same against each clip's own mean lengths."""
    return 1e4 * bone_lengths(poses).var(-2).mean(-1)


def shuffled_adherence(poses: Float[np.ndarray, "N T J 3"], control: Float[np.ndarray, "N T 3"]):
    """Adherence of every motion to the controls of three other clips.

    It is their mean; these clips are 1/4, 1/2 and 3/4 of the set away.
    """
    n = len(poses)
    shifts = sorted({max(1, n * k // 4) for k in (1, 2, 3)})
    return np.mean([adherence(poses, np.roll(control, shift, axis=0)) for shift in shifts], axis=0)


def score(
    poses: Float[np.ndarray, "N n J 3"],
    control: Float[np.ndarray, "N n 3"],
    truth: Float[np.ndarray, "N n J 3"],
) -> list[Measure]:
    """The measures of `poses` generated under `control`, and those of the data's own `truth`."""
    rows = {
        "bones": squared_bone_error(poses),
        "stretch": squared_stretch(poses),
        "bones_data": squared_bone_error(truth),
        "own": adherence(poses, control),
        "data": adherence(truth, control),
        "shuffled": shuffled_adherence(poses, control),
        "slide": skating(poses, control),
        "slide_data": skating(truth, control),
        "planted": planted_share(poses),
        "planted_data": planted_share(truth),
    }
    for name, part in (("first", slice(None, EDGE)), ("last", slice(-EDGE, None))):
        rows[f"bones_{name}"] = squared_bone_error(poses[:, part])
        rows[f"own_{name}"] = adherence(poses[:, part], control[:, part])
    return measures(WALKS, rows)


def diversity(
    rollouts: Float[np.ndarray, "P n T J 3"], drawn: Float[np.ndarray, "P n T J 3"]
) -> list[Measure]:
    """Spread of the rollouts, of the data's continuations, and their ratio, over pasts."""
    return measures(DIVERSITY, {"own": spread(rollouts), "data": spread(drawn)})


def measure_of(
    name: str,
    unit: str,
    value: Callable[..., float],
    *rows: np.ndarray,
    groups: np.ndarray | None = None,
) -> Measure:
    """The number `value(*rows)` with its interval over the rows; NaN when there is none."""
    return Measure(name, *interval(value, *rows, groups=groups), unit)


def root_mean(squares: Float[np.ndarray, "N"]) -> float:
    """sqrt(mean of squares): an RMSE from each clip's mean squared error."""
    return np.sqrt(squares.mean())


def ratio_of_roots(over: Float[np.ndarray, "N"], under: Float[np.ndarray, "N"]) -> float:
    """RMSE over RMSE, of squared errors."""
    return root_mean(over) / root_mean(under)


def ratio(over: Float[np.ndarray, "N"], under: Float[np.ndarray, "N"]) -> float:
    """Mean divided by mean (not the mean of ratios); each leaves out clips without a number."""
    return np.nanmean(over) / np.nanmean(under)


def excess(own: Float[np.ndarray, "N"], data: Float[np.ndarray, "N"]) -> float:
    """Mean minus mean; each leaves out clips without a number."""
    return np.nanmean(own) - np.nanmean(data)


def over_floor(own: Float[np.ndarray, "N"], data: Float[np.ndarray, "N"]) -> float:
    """Mean sliding over that of the data, which counts as SKATING_FLOOR at least."""
    return np.nanmean(own) / max(np.nanmean(data), SKATING_FLOOR)


WALKS = {
    "bone_rmse_cm": Kind("cm", ("bones",), root_mean),
    "bone_rmse_within_clip_cm": Kind("cm", ("stretch",), root_mean),
    "bone_rmse_data_cm": Kind("cm", ("bones_data",), root_mean),
    "adherence_mps": Kind("m/s", ("own",), np.nanmean),
    "adherence_data_mps": Kind("m/s", ("data",), np.nanmean),
    "adherence_excess_mps": Kind("m/s", ("own", "data"), excess),
    "adherence_shuffled_over_own": Kind("ratio", ("shuffled", "own"), ratio),
    "drift_bone_ratio": Kind("ratio", ("bones_last", "bones_first"), ratio_of_roots),
    "drift_adherence_ratio": Kind("ratio", ("own_last", "own_first"), ratio),
    "drift_ratio": Kind(
        "ratio",
        ("bones_last", "bones_first", "own_last", "own_first"),
        lambda a, b, c, d: max(ratio_of_roots(a, b), ratio(c, d)),
    ),
    "skating_mps": Kind("m/s", ("slide",), np.nanmean),
    "skating_data_mps": Kind("m/s", ("slide_data",), np.nanmean),
    "skating_over_data": Kind("ratio", ("slide", "slide_data"), over_floor),
    "planted_share": Kind("share", ("planted",), np.nanmean),
    "planted_share_data": Kind("share", ("planted_data",), np.nanmean),
}
CLEANED = {
    "finished_skating_over_data": Kind("ratio", ("skating_clean", "skating_data"), over_floor),
    "cleanup_moves_toes_cm": Kind("cm", ("toes_moved",), lambda far: 100 * far.mean()),
}
FINISHED = CLEANED | {
    "finished_adherence_excess_mps": Kind("m/s", ("adherence_clean", "adherence_data"), excess)
}
DIVERSITY = {
    "diversity_m": Kind("m", ("own",), np.mean),
    "diversity_data_m": Kind("m", ("data",), np.mean),
    "diversity_over_data": Kind("ratio", ("own", "data"), ratio),
    "diversity_over_data_median": Kind("ratio", ("own", "data"), lambda a, b: np.median(a / b)),
}
