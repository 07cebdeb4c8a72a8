"""Control for the walker: from a joystick, or constant (`drawn_path`: along a path).

A control is (T, 3): forward m/s, left m/s, yaw rad/s (counter-clockwise from above); row t takes
root[t] to root[t+1]. Further columns are a condition of your own (docs/EXTENDING.md).
Notebook: 00, 07
"""

import math
from collections.abc import Sequence
from numbers import Real

import numpy as np
from jaxtyping import Float

from ..motion.arguments import LONGEST, checked_rate, is_number
from ..motion.root_frame import FPS

FASTEST = 1000.0  # m/s, rad/s: beyond any control that is meant
RAMP = 0.5  # seconds that a joystick takes from one position to the next


def constant_control(
    forward: float | int = 0.0,
    left: float | int = 0.0,
    yaw: float | int = 0.0,
    seconds: float | int = 4.0,
    fps: float | int = FPS,
) -> Float[np.ndarray, "T 3"]:
    """The same velocities for all of `seconds`; m/s, m/s, rad/s.

    Notebook: 00
    """
    return np.tile([float(forward), float(left), float(yaw)], (round(seconds * fps), 1))


def splice(
    past: Float[np.ndarray, "T 3"], new: Float[np.ndarray, "n 3"], T_h: int
) -> Float[np.ndarray, "m 3"]:
    """The control for a rollout: m = T_h + n rows, of the last T_h past frames and of n new ones.

    The last row of a recording's control only repeats the one before, because its next frame is not
    known. Here it leads into the first new frame, so it becomes the first row of `new`.
    Raises ValueError where the past has fewer than T_h frames.  Notebook: 00
    """
    if len(past) < T_h:
        raise ValueError(
            f"the walker needs control for {T_h} past frames; this past has {len(past)}"
        )
    return np.concatenate([past[len(past) - T_h : -1], new[:1], new])


def as_long(
    control: Float[np.ndarray, "n C"], rows: int | None, columns: int = 3
) -> Float[np.ndarray, "m C"]:
    """A control of `rows` rows: cut, or continued by its last row; None keeps its length.

    Raises ValueError for another shape, no row, and rows that are not finite.
    """
    if isinstance(control, str):
        raise ValueError(
            f"a control is an array, not the text {control!r:.40}; "
            "joystick([(seconds, forward, left, turning), ...]) makes one"
        )
    array = np.array(np.asarray(control), np.float64)
    if array.ndim != 2 or array.shape[1] != columns or not len(array):
        raise ValueError(
            f"a control is (rows, {columns}): forward m/s, left m/s, turning rad/s"
            f"{f', {columns - 3} of your own' if columns > 3 else ''}, {FPS:g} rows a second; this "
            f"is {array.shape}. joystick([(seconds, forward, left, turning), ...]) makes one"
        )
    possible = np.isfinite(array).all(1) & (np.abs(array[:, :3]) <= FASTEST).all(1)
    bad = np.flatnonzero(~possible)
    if len(bad):
        raise ValueError(
            f"row {bad[0]} of the control is {array[bad[0]]}: give numbers (m/s, m/s, rad/s) from "
            f"-{FASTEST:g} to {FASTEST:g}"
        )
    if rows is None:
        return array
    if rows < 1:
        raise ValueError(f"a control of {rows} rows has no frame: a frame is {1 / FPS:g} s")
    return array[np.minimum(np.arange(rows), len(array) - 1)]


def _four_numbers(segment: object) -> bool:
    if not isinstance(segment, (list, tuple, np.ndarray)) or len(segment) != 4:
        return False
    return all(isinstance(value, Real) and math.isfinite(value) for value in segment)


def joystick(
    segments: Sequence[tuple], fps: float | int = FPS, ramp: float | int = RAMP
) -> Float[np.ndarray, "T 3"]:
    """Control from a list of (seconds, forward m/s, left m/s, turning rad/s).

    The first segment begins at its own speeds. Each later one is reached within `ramp` seconds:

    old + (new - old) u^2 (3 - 2u), with u from 0 to 1.
    Raises ValueError for no segment, one that is not four finite numbers, negative seconds, less
    than a frame or more than an hour in all, a frame rate that is not positive, or a ramp that is
    not 0 or more.
    """
    fps = checked_rate(fps)
    if not is_number(ramp) or not 0 <= ramp < math.inf:
        raise ValueError(f"ramp must be a number of seconds, 0 or more, not {ramp!r:.40}")
    there = isinstance(segments, (list, tuple, np.ndarray)) and len(segments) > 0
    bad = [one for one in segments if not _four_numbers(one)][:1] if there else [segments]
    if bad:
        raise ValueError(
            "joystick takes a list of segments, and a segment is four finite numbers, "
            f"(seconds, forward, left, turning), not {bad[0]!r:.80}"
        )
    backwards = next((segment for segment in segments if segment[0] < 0), None)
    if backwards is not None:
        raise ValueError(f"a segment lasts 0 seconds or more, not {backwards[0]:g}: {backwards}")
    if (total := sum(segment[0] for segment in segments)) > LONGEST:
        raise ValueError(f"the segments last {total:g} s; {LONGEST:g} s is the most")
    rows, value = [], np.array(segments[0][1:], dtype=np.float64)
    for seconds, *target in segments:
        goal = np.array(target, dtype=np.float64)
        u = np.clip(np.arange(1, round(seconds * fps) + 1) / max(1.0, ramp * fps), 0, 1)[:, None]
        rows.append(value + smoothstep(u) * (goal - value))
        value = rows[-1][-1] if len(u) else value
    control = np.concatenate(rows)
    if not len(control):
        raise ValueError(f"the segments last less than a frame ({1 / fps:g} s), all together")
    return control


def smoothstep(u: Float[np.ndarray, "*n"]) -> Float[np.ndarray, "*n"]:
    """u^2 (3 - 2u): from 0 to 1, at rest at both ends."""
    return u * u * (3 - 2 * u)
