"""Does the figure follow the control?

The root cannot answer this, because it follows the control by construction. The feet can. A planted
toe implies how the root must move for the toe to stay still; the control says how it does move. In
a good walk the difference averages out over each step. It is large if the figure walks at its own
speed. In metres a second.   Notebook: 08
"""

import numpy as np
from jaxtyping import Float

from ..motion.root_frame import FPS
from .skating import PLANTED_BELOW, check_rows, mean_where, planted_velocity


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
