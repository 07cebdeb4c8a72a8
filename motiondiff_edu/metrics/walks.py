"""Measures of walks: sliding feet, following the control, footsteps, and style.

A toe counts as planted because it is low, never because it is slow: its speed is what is judged.

Does the figure follow the control? The root cannot answer this, because it follows the control by
construction. The feet can. A planted toe implies how the root must move for the toe to stay still;
the control says how it does move. In a good walk the difference averages out over each step. It is
large if the figure walks at its own speed. In metres a second.

Footsteps are counted as in MoDiff's Tables I, II and Fig. 3: intervals in which a heel is slower
over the ground than a tolerance v. Too small a tolerance finds no steps. Noise or sliding near the
tolerance cuts each step into fragments, and the paper's count then counts fragments. Speeds are in
cm/s, durations in seconds.

Style is trunk lean, step width, arm swing and cadence, compared between a past and its
continuation, so each is in units of its spread over several pasts.
Source: MoDiff IV-B, Fig. 3; style: what differs most between recorded walkers at the same speed.
Notebook: 08
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from ..motion.check import check_finite
from ..motion.cleanup import runs
from ..motion.dance_frame import facing
from ..motion.root_frame import FPS, forward_left
from ..motion.skeleton import HEELS, HIPS, TOES, joint_index

# ---- sliding -------------------------------------------------------------------------------------
PLANTED_BELOW = 0.03  # metres


def check_rows(points: np.ndarray, control: np.ndarray) -> None:
    """Raise ValueError unless control has a row for each frame: a single one would be repeated."""
    frames, rows = (tuple(map(int, shape)) for shape in (points.shape[:-2], control.shape[:-1]))
    if frames != rows:
        raise ValueError(
            f"poses for {frames} frames and control for {rows}: pass a row of control for each pose"
        )


def ground_velocity(
    points: Float[np.ndarray, "*B T K 3"],
    control: Float[np.ndarray, "*B T 3"],
    fps: float | int = FPS,
) -> Float[np.ndarray, "*B T-1 K 2"]:
    """Velocity over the ground, (left, forward) in m/s, of points in the root frame.

    Step t is expressed in the heading halfway between t and t+1, where the root moves by (v_left,
    v_forward) / fps. With d = yaw / (2 fps):  velocity = fps * (R(+d) p[t+1] - R(-d) p[t]) +
    (v_left, v_forward).
    Raises ValueError for NaN, or a control without a row for each frame.
    """
    check_rows(points, control)
    half_turn = np.asarray(control, np.float64)[..., :-1, None, 2] / (2 * fps)
    ground = np.asarray(points, np.float64)[..., [0, 2]]
    check_finite(ground, "x and z of the points")
    check_finite(control[..., :-1, :], "rows of control")
    moved = _turn(ground[..., 1:, :, :], half_turn) - _turn(ground[..., :-1, :, :], -half_turn)
    return moved * fps + control[..., :-1, None, 1::-1]


def _turn(
    xz: Float[np.ndarray, "*B K 2"], angle: Float[np.ndarray, "*B 1"]
) -> Float[np.ndarray, "*B K 2"]:
    """(left, forward) coordinates in a frame that faces `angle`, converted to one that faces 0."""
    x, z = xz[..., 0], xz[..., 1]
    sin, cos = np.sin(angle), np.cos(angle)
    return np.stack([x * cos + z * sin, z * cos - x * sin], -1)


def planted_toe(
    poses: Float[np.ndarray, "*B T J 3"], below: float | int = PLANTED_BELOW
) -> tuple[Int[np.ndarray, "*B T-1"], Bool[np.ndarray, "*B T-1"]]:
    """The lower toe in each step from t to t+1 (0 left, 1 right), and whether it is planted.

    It is planted if it is under `below` metres at both ends of the step. If both toes are equally
    low, the left one is taken. Raises ValueError for NaN.  Notebook: 08
    """
    height = poses[..., TOES, 1]
    check_finite(height, "heights of the toes")
    height = np.maximum(height[..., 1:, :], height[..., :-1, :])
    return height.argmin(-1), height.min(-1) < below


def planted_velocity(
    poses: Float[np.ndarray, "*B T J 3"],
    control: Float[np.ndarray, "*B T 3"],
    fps: float | int = FPS,
    below: float | int = PLANTED_BELOW,
) -> Float[np.ndarray, "*B T-1 2"]:
    """Velocity over the ground of the planted toe, (left, forward) in m/s; NaN without one."""
    side, planted = planted_toe(poses, below)
    velocity = ground_velocity(poses[..., TOES, :], control, fps)
    velocity = np.take_along_axis(velocity, side[..., None, None], axis=-2)[..., 0, :]
    return np.where(planted[..., None], velocity, np.nan)


def skating(
    poses: Float[np.ndarray, "*B T J 3"],
    control: Float[np.ndarray, "*B T 3"],
    fps: float | int = FPS,
    below: float | int = PLANTED_BELOW,
) -> float | Float[np.ndarray, "*B"]:
    """How fast the planted toe slides, in m/s; one value per clip.

    skating = mean_t |velocity over the ground of the planted toe|, over the steps with a planted
    toe. A clip where no toe is ever under `below` has NaN, not a flattering 0 (see
    `planted_share`). Raises ValueError for NaN, or a control without a row for each frame.
    Notebook: 08
    """
    return mean_where(np.linalg.norm(planted_velocity(poses, control, fps, below), axis=-1))


def planted_share(
    poses: Float[np.ndarray, "*B T J 3"], below: float | int = PLANTED_BELOW
) -> float | Float[np.ndarray, "*B"]:
    """The fraction of steps (frame to frame) with a planted toe.

    It is 1 in a walk, less in a run, and 0 for a figure that floats; NaN for a single frame.
    Raises ValueError for NaN.

    Notebook: 08
    """
    return mean_where(planted_toe(poses, below)[1].astype(np.float64))


def mean_where(values: Float[np.ndarray, "*B N"]) -> float | Float[np.ndarray, "*B"]:
    """Mean over the last axis without NaNs; NaN, without a warning, where no value is left."""
    known = ~np.isnan(values)
    total, count = np.where(known, values, 0.0).sum(-1), known.sum(-1)
    return np.where(count > 0, total / np.maximum(count, 1), np.nan)[()]


# ---- control -------------------------------------------------------------------------------------
def implied_root_velocity(
    poses: Float[np.ndarray, "*B T J 3"],
    control: Float[np.ndarray, "*B T 3"],
    fps: float | int = FPS,
    below: float | int = PLANTED_BELOW,
) -> Float[np.ndarray, "*B T-1 2"]:
    """The root velocity that would keep the planted toe still.

    It is (forward, left) in m/s at the halfway heading. With p the toe in the root frame, and
    d = yaw / (2 fps) from the control:  implied[t] = fps * (R(-d) p[t] - R(+d) p[t+1]).
    It is NaN in steps where no toe is planted.
    """
    turn_only = np.asarray(control, np.float64) * [0.0, 0.0, 1.0]
    return -planted_velocity(poses, turn_only, fps, below)[..., ::-1]


def residual_velocity(
    poses: Float[np.ndarray, "*B T J 3"],
    control: Float[np.ndarray, "*B T 3"],
    fps: float | int = FPS,
    below: float | int = PLANTED_BELOW,
) -> Float[np.ndarray, "*B T-1 2"]:
    """Implied root velocity - control, (forward, left) in m/s.

    It is also the negative velocity of the sliding toe. It is NaN in flight.  Notebook: 08
    """
    return implied_root_velocity(poses, control, fps, below) - control[..., :-1, :2]


def adherence(
    poses: Float[np.ndarray, "*B T J 3"],
    control: Float[np.ndarray, "*B T 3"],
    fps: float | int = FPS,
    below: float | int = PLANTED_BELOW,
) -> float | Float[np.ndarray, "*B"]:
    """Distance from the control in m/s (small is good).

    |mean of the residual over a second|, averaged over seconds.

    The seconds do not overlap; a last one shorter than half a second is dropped. A second's mean
    leaves out flight, and the average leaves out seconds that are all flight. A clip without any
    planted toe gives NaN. Recorded motion is not at 0 either: print the data's own value beside it.
    Raises ValueError for fewer than two frames, for NaN, or a control without a row for each frame.
    Notebook: 08
    """
    check_rows(poses, control)
    if poses.shape[-3] < 2:
        raise ValueError("a velocity needs two frames, and this motion has one")
    residual = residual_velocity(poses, control, fps, below)
    means = np.stack(
        [mean_where(np.moveaxis(second, -1, -2)) for second in _seconds(residual, fps)], -2
    )
    return mean_where(np.linalg.norm(means, axis=-1))


def _seconds(
    values: Float[np.ndarray, "*B N 2"], fps: float | int
) -> list[Float[np.ndarray, "*B n 2"]]:
    length, steps = round(fps), values.shape[-2]
    firsts = [
        first for first in range(0, steps, length) if first == 0 or steps - first >= length / 2
    ]
    return [values[..., first : first + length, :] for first in firsts]


# ---- footsteps -----------------------------------------------------------------------------------
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


# ---- style ---------------------------------------------------------------------------------------
NECK, HANDS = joint_index("Neck1"), (joint_index("LeftHand"), joint_index("RightHand"))
MOVED = 0.03  # m
NAMES = ("trunk lean, radians", "step width, m", "arm swing, m", "steps a second")


def gait_style(
    positions: Float[np.ndarray, "T 21 3"], fps: float | int = FPS
) -> Float[np.ndarray, "4"]:
    """The four numbers of a motion (metres, world); NAMES says which.

    Lean is positive forwards. Width is the mean distance of the ankles across the way that the
    figure faces. Swing is the standard deviation of how far the left hand is ahead of the right
    one. A step is where the distance of the ankles along the way goes from MOVED over its mean to
    MOVED under it, or back; a figure that stands takes none.
    Raises ValueError for fewer than two frames.
    """
    if len(positions) < 2:
        raise ValueError(f"a style needs two frames or more, not {len(positions)}")
    ahead, aside = forward_left(facing(positions))

    def along(way: Float[np.ndarray, "T 2"], start: int, end: int) -> Float[np.ndarray, "T"]:
        return ((positions[:, end] - positions[:, start])[:, [0, 2]] * way).sum(-1)

    upright = positions[:, NECK, 1] - positions[:, HIPS, 1]
    lean = np.arctan2(along(ahead, HIPS, NECK), upright).mean()
    width = np.abs(along(aside, *HEELS)).mean()
    swing = along(ahead, *HANDS).std()
    strides = along(ahead, *HEELS)
    away = strides - strides.mean()
    sides = np.sign(away[np.abs(away) > MOVED])
    steps = (np.diff(sides) != 0).sum()
    return np.array([lean, width, swing, steps * fps / (len(positions) - 1)])


def style_kept(
    pasts: Float[np.ndarray, "N 4"], made: Float[np.ndarray, "N 4"], persons: Sequence[str]
) -> Float[np.ndarray, "N"]:
    """For each continuation the share of other persons' pasts that are farther away than its own.

    A half is chance, if all were continued under the same control. Equally far counts half.
    Raises ValueError for fewer than two persons, and for NaN.
    """
    names = np.array(list(persons))
    if len(set(persons)) < 2:
        raise ValueError("styles are compared between two persons or more")
    check_finite(pasts, "styles of the pasts")
    check_finite(made, "styles of the continuations")
    scale = np.maximum(pasts.std(0), 1e-9)
    away = np.linalg.norm((made[:, None] - pasts[None]) / scale, axis=-1)  # (made, past)
    own = np.diag(away)[:, None]
    nearer = (away > own) + 0.5 * (away == own)
    others = names[:, None] != names
    return np.where(others, nearer, 0.0).sum(1) / others.sum(1)
