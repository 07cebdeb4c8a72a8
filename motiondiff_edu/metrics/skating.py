"""Does the standing foot slide? The speed over the ground of the toe that carries the figure.

A toe counts as planted because it is low, never because it is slow: its speed is what is judged.
In metres and metres a second.  Notebook: 08
"""

import numpy as np
from jaxtyping import Bool, Float, Int

from ..motion.finite import check_finite
from ..motion.root_frame import FPS
from ..motion.skeleton import TOES

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
