"""Footsteps counted as in MoDiff's Tables I, II and Fig. 3.

A step is an interval in which a heel is slower over the ground than a tolerance v. Too small a
tolerance finds no steps. Noise or sliding near the tolerance cuts each step into fragments, and the
paper's count then counts fragments. Speeds are in cm/s, durations in seconds.
Source: MoDiff IV-B, Fig. 3.   Notebook: 08
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from ..motion.finite import check_finite
from ..motion.planting import runs
from ..motion.root_frame import FPS
from ..motion.skeleton import HEELS
from .skating import ground_velocity

TOLERANCES = np.arange(1.0, 61.0)  # cm/s; the paper's own values are 5 and 6


@dataclass(frozen=True)
class StepRule:
    """What counts as a step. The default is the paper's rule; every other setting is ours.

    min_duration_s: shorter steps are dropped.
    merge_gap_s: gaps up to this long are closed first.
    """

    min_duration_s: float | int = 0.0
    merge_gap_s: float | int = 0.0


PAPER = StepRule()
ROBUST = StepRule(min_duration_s=0.1, merge_gap_s=0.05)


@dataclass(frozen=True)
class Footsteps:
    """The curve f_est(v) (`tolerances`, `counts`), and the row of MoDiff's Table I at v95."""

    tolerances: Float[np.ndarray, "V"]
    counts: Float[np.ndarray, "V"]
    count: float
    v95: float
    mean_s: float
    std_s: float


def heel_speed(
    poses: Float[np.ndarray, "*B T J 3"],
    control: Float[np.ndarray, "*B T 3"],
    fps: float | int = FPS,
) -> Float[np.ndarray, "*B T-1 2"]:
    """Horizontal speed over the ground of the left and the right heel joint, in cm/s.

    Raises ValueError for NaN.
    Source: MoDiff IV-B.  Notebook: 08
    """
    return 100 * np.linalg.norm(ground_velocity(poses[..., HEELS, :], control, fps), axis=-1)


def steps_of_heel(
    speed: Float[np.ndarray, "N"],
    tolerance: float | int,
    rule: StepRule = PAPER,
    fps: float | int = FPS,
) -> Int[np.ndarray, "n 2"]:
    """The steps of one heel: runs of speed < tolerance (cm/s), merged and filtered by `rule`."""
    found = runs(speed < tolerance)
    if rule.merge_gap_s > 0:
        found = _merged(found, rule.merge_gap_s * fps)
    return found[(found[:, 1] - found[:, 0]) >= rule.min_duration_s * fps - 1e-9]


def _merged(found: Int[np.ndarray, "a 2"], gap: float | int) -> Int[np.ndarray, "b 2"]:
    if len(found) == 0:
        return found
    breaks = np.flatnonzero(found[1:, 0] - found[:-1, 1] > gap + 1e-9)
    return np.stack(
        [found[np.append(0, breaks + 1), 0], found[np.append(breaks, len(found) - 1), 1]], -1
    )


def step_durations(
    speeds: Sequence[Float[np.ndarray, "_ 2"]],
    tolerance: float | int,
    rule: StepRule = PAPER,
    fps: float | int = FPS,
) -> Float[np.ndarray, "n"]:
    """Duration in seconds of every step of both heels in all clips."""
    found = [
        steps_of_heel(clip[:, heel], tolerance, rule, fps) for clip in speeds for heel in (0, 1)
    ]
    return np.diff(np.concatenate(found), axis=-1)[:, 0] / fps


def footsteps(
    speeds: Sequence[Float[np.ndarray, "_ 2"]],
    rule: StepRule = PAPER,
    tolerances: Float[np.ndarray, "V"] = TOLERANCES,
    fps: float | int = FPS,
) -> Footsteps:
    """Footsteps of a set of clips, each given by its `heel_speed`.

    f_est(v) = number of steps at tolerance v;  v95 = min{ v : f_est(v) >= 0.95 max_u f_est(u) };
    count, mean_s and std_s are the number, mean and population standard deviation of the step
    durations at v95.
    Without a step at any tolerance, count is 0 and the others are NaN. Raises ValueError for no
    clips, and for NaN.
    Source: MoDiff IV-B, Tables I and II, Fig. 3.  Notebook: 08
    """
    if len(speeds) == 0:
        raise ValueError("footsteps needs at least one clip's heel speeds")
    for number, speed in enumerate(speeds):
        check_finite(speed, f"heel speeds of clip {number}")
    durations = [step_durations(speeds, float(v), rule, fps) for v in tolerances]
    counts = np.array([float(len(d)) for d in durations])
    if counts.max() == 0:
        return Footsteps(tolerances, counts, 0.0, np.nan, np.nan, np.nan)
    at = int(np.argmax(counts >= 0.95 * counts.max()))
    mean, std = float(durations[at].mean()), float(durations[at].std())
    return Footsteps(tolerances, counts, float(counts[at]), float(tolerances[at]), mean, std)
