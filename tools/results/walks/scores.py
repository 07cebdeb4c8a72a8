"""The measures of one walker on a set of trials, each with its interval over clips.

Names, values, units.

`score` takes arrays, so it can also score the data themselves.
"""

import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from motiondiff_edu.metrics.adherence import adherence
from motiondiff_edu.metrics.bone_lengths import bone_lengths
from motiondiff_edu.metrics.diversity import spread
from motiondiff_edu.metrics.skating import planted_share, skating
from motiondiff_edu.motion.skeleton import BONE_LENGTHS

from ..intervals import interval

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

    def as_record(self, prefix: str, seeds: dict, command: str, paper: float | None = None) -> dict:
        """The record for docs/results: five digits, None for NaN."""
        value, low, high = (
            float(f"{x:.5g}") if np.isfinite(x) else None for x in (self.value, self.low, self.high)
        )
        return dict(
            name=prefix + self.name,
            value=value,
            low=low,
            high=high,
            seeds=seeds,
            unit=self.unit,
            paper=paper,
            command=command,
        )


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
    own, data = adherence(poses, control), adherence(truth, control)
    slide, slide_data = skating(poses, control), skating(truth, control)
    first, last = slice(None, EDGE), slice(-EDGE, None)
    bones = [squared_bone_error(poses[:, part]) for part in (first, last)]
    kept = [adherence(poses[:, part], control[:, part]) for part in (first, last)]
    measures = {
        "bone_rmse_cm": ("cm", root_mean, squared_bone_error(poses)),
        "bone_rmse_within_clip_cm": ("cm", root_mean, squared_stretch(poses)),
        "bone_rmse_data_cm": ("cm", root_mean, squared_bone_error(truth)),
        "adherence_mps": ("m/s", np.nanmean, own),
        "adherence_data_mps": ("m/s", np.nanmean, data),
        "adherence_excess_mps": ("m/s", _difference, own, data),
        "adherence_shuffled_over_own": ("ratio", ratio, shuffled_adherence(poses, control), own),
        "drift_bone_ratio": ("ratio", lambda a, b: root_mean(a) / root_mean(b), bones[1], bones[0]),
        "drift_adherence_ratio": ("ratio", ratio, kept[1], kept[0]),
        "drift_ratio": ("ratio", _larger, *bones, *kept),
        "skating_mps": ("m/s", np.nanmean, slide),
        "skating_data_mps": ("m/s", np.nanmean, slide_data),
        "skating_over_data": ("ratio", over_floor, slide, slide_data),
        "planted_share": ("share", np.nanmean, planted_share(poses)),
        "planted_share_data": ("share", np.nanmean, planted_share(truth)),
    }
    return [measure_of(name, unit, value, *rows) for name, (unit, value, *rows) in measures.items()]


def diversity(
    rollouts: Float[np.ndarray, "P n T J 3"], drawn: Float[np.ndarray, "P n T J 3"]
) -> list[Measure]:
    """Spread of the rollouts, of the data's continuations, and their ratio.

    The interval is over pasts.
    """
    own, data = spread(rollouts), spread(drawn)
    return [
        measure_of("diversity_m", "m", np.mean, own),
        measure_of("diversity_data_m", "m", np.mean, data),
        measure_of("diversity_over_data", "ratio", ratio, own, data),
        measure_of("diversity_over_data_median", "ratio", lambda a, b: np.median(a / b), own, data),
    ]


def measure_of(
    name: str,
    unit: str,
    value: Callable[..., float],
    *rows: np.ndarray,
    groups: np.ndarray | None = None,
) -> Measure:
    """The number `value(*rows)` with its interval over the rows.

    It is NaN, without a warning, when there is no number.
    """
    with warnings.catch_warnings():
        warnings.simplefilter(
            "ignore", RuntimeWarning
        )  # the mean of no numbers is NaN, and is shown as NaN
        return Measure(name, *interval(value, *rows, groups=groups), unit)


def root_mean(squares: Float[np.ndarray, "N"]) -> float:
    """sqrt(mean of squares): an RMSE from each clip's mean squared error."""
    return np.sqrt(squares.mean())


def ratio(over: Float[np.ndarray, "N"], under: Float[np.ndarray, "N"]) -> float:
    """Mean divided by mean (not the mean of ratios); each leaves out clips without a number."""
    return np.nanmean(over) / np.nanmean(under)


def _difference(own, data):
    return np.nanmean(own) - np.nanmean(data)


def over_floor(own: Float[np.ndarray, "N"], data: Float[np.ndarray, "N"]) -> float:
    """Mean sliding over that of the data, which counts as SKATING_FLOOR at least."""
    return np.nanmean(own) / max(np.nanmean(data), SKATING_FLOOR)


def _larger(bones_first, bones_last, adherence_first, adherence_last):
    return max(
        root_mean(bones_last) / root_mean(bones_first), ratio(adherence_last, adherence_first)
    )
