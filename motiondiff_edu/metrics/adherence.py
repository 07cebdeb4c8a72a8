"""Does the figure go where it is told?

Not to be read from the root, which follows the control by construction.

The feet tell. A planted toe says how the root must move for the toe to stay still; the control says
how it does move. Their difference is slow in a good walk (each step ripples, and the ripples
cancel) and large in one that walks at its own speed. Metres a second.   Notebook: 08
"""

import numpy as np
from jaxtyping import Float

from ..motion.root_frame import FPS
from .skating import PLANTED_BELOW, mean_where, planted_velocity


def implied_root_velocity(
    poses: Float[np.ndarray, "*B T J 3"],
    control: Float[np.ndarray, "*B T 3"],
    fps: float | int = FPS,
    below: float | int = PLANTED_BELOW,
) -> Float[np.ndarray, "*B T-1 2"]:
    """The root velocity that would keep the planted toe still.

    (forward, left) in m/s at the halfway heading.

    With p the toe in the root frame and d = yaw / (2 fps):  implied[t] = fps * (R(-d) p[t] - R(+d)
    p[t+1]). The yaw is the control's. NaN in steps where no toe is planted.
    """
    turn_only = np.asarray(control, np.float64) * [0.0, 0.0, 1.0]
    return -planted_velocity(poses, turn_only, fps, below)[..., ::-1]


def residual_velocity(
    poses: Float[np.ndarray, "*B T J 3"],
    control: Float[np.ndarray, "*B T 3"],
    fps: float | int = FPS,
    below: float | int = PLANTED_BELOW,
) -> Float[np.ndarray, "*B T-1 2"]:
    """What the feet say minus what the control says.

    Implied root velocity - control, (forward, left) in m/s.

    It is also minus the velocity at which the planted toe slides. NaN in flight.  Notebook: 08
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

    The seconds follow each other without overlap; a last one shorter than half is left out. Flight
    is left out of a second's mean, a second all in flight out of the average; a clip with no
    planted toe at all gives NaN. Recorded motion is not at 0 either: print the data's own value
    beside it.
    Raises ValueError for fewer than two frames, or a control that has not a row for each frame.
    Notebook: 08
    """
    if poses.shape[:-2] != control.shape[:-1]:
        frames, rows = (tuple(map(int, shape)) for shape in (poses.shape[:-2], control.shape[:-1]))
        raise ValueError(
            f"poses for frames {frames} and control for {rows}: pass a row of control for each pose"
        )
    if poses.shape[-3] < 2:
        raise ValueError("a velocity takes two frames, and this motion has one")
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
