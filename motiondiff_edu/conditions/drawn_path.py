"""Control that walks along a path drawn on the floor, and paths ready made.

Points are [x, z] in metres; a control is (T, 3) as in `control`.
Notebook: 00
"""

from collections.abc import Sequence

import numpy as np
import scipy
from jaxtyping import Float

from ..motion.root_frame import FPS, control_from_path
from .control import smoothstep

SPACING = 0.01  # metres between the points that a path is resampled to
# m/s^2, speed times yaw rate: more than this and a runner would have to lean far into the bend
SIDEWAYS = 2.5

ACCELERATION, MAX_YAW = 1.2, 1.8  # m/s^2 along the path, rad/s about the vertical


def path_to_control(
    points: Float[np.ndarray, "n 2"],
    speed: float | int,
    fps: float | int = FPS,
    stops: Sequence[float | int] = (),
    pause: float | int = 1.5,
) -> Float[np.ndarray, "T 3"]:
    """Control that walks along `points` ([x, z], metres) at `speed` m/s.

    It starts at the first point with heading 0.

    The path is rounded (`round_path`); speed keeps to ACCELERATION, from and to rest, and drops
    where a bend would need more than MAX_YAW or SIDEWAYS. If the path does not start along z, the
    figure first turns on the spot. At each of `stops` (metres along the path) it rests for `pause`
    seconds. The integral of the control is the rounded path.
    Raises ValueError for a path without length, a position that is not finite, or a speed outside
    (0, 4].
    """
    if not 0 < speed <= 4:
        raise ValueError(f"speed must lie in (0, 4] m/s, got {speed}; the walker knows up to 3")
    curve = round_path(points)
    heading = _headings(curve)
    step = np.linalg.norm(np.diff(curve, axis=0), axis=1)
    where = np.concatenate([[0.0], np.cumsum(step)])
    turn = np.abs(np.diff(heading))
    halts = [int(np.argmin(np.abs(where - s))) for s in stops]
    v = _speeds(step, turn, float(speed), [*halts, 0, len(curve) - 1])
    dt = np.maximum(_times(step, v), turn / MAX_YAW)
    time = np.concatenate([[0.0], np.cumsum(dt)])
    for halt in halts:  # the pause sits in the step that leaves the halt
        time[halt + 1 :] += pause
    end = time[-1] + pause * (len(curve) - 1 in halts)
    frames = np.arange(int(np.ceil(end * fps)) + 1) / fps
    return _control_at(frames, time, curve, heading, halts, pause, fps)


def round_path(
    points: Float[np.ndarray, "n 2"], smoothing: float | int = 0.12
) -> Float[np.ndarray, "m 2"]:
    """The path through `points`, a point every centimetre, corners rounded by a Gaussian.

    Both ends stay in place.

    Raises ValueError for a path shorter than 5 cm or a position that is not finite.
    """
    points = np.asarray(points, dtype=np.float64)
    if not np.isfinite(points).all():
        raise ValueError(
            f"point {int(np.argwhere(~np.isfinite(points))[0, 0])} of the path is not finite"
        )
    where = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    if len(points) < 2 or where[-1] < 0.05:
        raise ValueError(
            "a path needs at least two points and 5 cm, "
            f"this one has {len(points)} point(s): draw on"
        )
    even = np.linspace(0, where[-1], int(np.ceil(where[-1] / SPACING)) + 1)
    line = np.stack([np.interp(even, where, column) for column in points.T], -1)
    return _smooth_fixed_ends(line, smoothing / SPACING)


def _smooth_fixed_ends(line: np.ndarray, sigma: float) -> np.ndarray:
    """Gaussian along the line, with both ends left in place.

    The line is continued past its ends by a half-turn about them.
    """
    n = min(len(line) - 1, int(4 * sigma) + 1)
    wide = np.concatenate([2 * line[0] - line[n:0:-1], line, 2 * line[-1] - line[-2 : -n - 2 : -1]])
    return (
        scipy.ndimage.gaussian_filter1d(wide, sigma, axis=0, mode="nearest")[n : n + len(line)]
        if sigma > 0
        else line
    )


def _headings(curve: np.ndarray) -> np.ndarray:
    """Direction of travel at each point, radians, continuous, the first one in (-pi, pi]."""
    tangent = np.gradient(curve, axis=0)
    return np.unwrap(np.arctan2(tangent[:, 0], tangent[:, 1]))


def _speeds(step: np.ndarray, turn: np.ndarray, speed: float, halts: list[int]) -> np.ndarray:
    """The fastest speed that is allowed at each point; zero at `halts`."""
    bend = np.concatenate([np.minimum(turn / np.maximum(step, 1e-9), 20.0), [0.0]])
    bend = np.maximum(scipy.ndimage.gaussian_filter1d(bend, 0.1 / SPACING, mode="nearest"), 1e-9)
    v = np.minimum(speed, np.minimum(MAX_YAW / bend, np.sqrt(SIDEWAYS / bend)))
    v[halts] = 0.0
    v[np.flatnonzero(turn > 0.5)] = 0.0  # half a radian within a centimetre: stop, turn on the spot
    for i in range(1, len(v)):
        v[i] = min(v[i], np.sqrt(v[i - 1] ** 2 + 2 * ACCELERATION * step[i - 1]))
    for i in range(len(v) - 2, -1, -1):
        v[i] = min(v[i], np.sqrt(v[i + 1] ** 2 + 2 * ACCELERATION * step[i]))
    return v


def _times(step: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Seconds from each point to the next; between two rests it starts and stops once more."""
    both, from_rest_to_rest = v[1:] + v[:-1], 2 * np.sqrt(step / ACCELERATION)
    return np.divide(2 * step, both, out=from_rest_to_rest, where=both > 0)


def _control_at(
    frames: np.ndarray,
    time: np.ndarray,
    curve: np.ndarray,
    heading: np.ndarray,
    halts: list[int],
    pause: float | int,
    fps: float | int,
) -> Float[np.ndarray, "T 3"]:
    """Read the timed curve at the frames, turn to it first where needed, and take velocities."""
    knots = np.insert(
        np.arange(len(time)), [h + 1 for h in halts], halts
    )  # a halted point stands twice
    leave = np.zeros(len(knots))
    for i, halt in enumerate(sorted(halts)):
        leave[halt + 1 + i] = pause
    clock = time[knots] + leave
    root = np.stack([np.interp(frames, clock, curve[knots, k]) for k in (0, 1)], -1)
    facing = np.interp(frames, clock, heading[knots])
    first = _turn_on_the_spot(facing[0], fps)
    root = np.concatenate([np.repeat(root[:1], len(first), 0), root])
    facing = scipy.ndimage.gaussian_filter1d(
        np.concatenate([first, facing]), 0.15 * fps, mode="nearest"
    )
    remaining = 1 - smoothstep(
        np.clip(np.arange(len(facing)) / fps, 0, 1)
    )  # what is left of an angle goes in a second
    return control_from_path(root, facing - facing[0] * remaining, float(fps))


def _turn_on_the_spot(angle: float, fps: float | int) -> np.ndarray:
    """Headings from 0 to just before `angle`, at MAX_YAW at most.

    None for a turn of less than three degrees.
    """
    if abs(angle) < np.radians(3):
        return np.zeros(0)
    frames = int(
        np.ceil(1.5 * abs(angle) / MAX_YAW * fps)
    )  # smoothstep is 1.5 times as steep as a straight line
    return angle * smoothstep(np.arange(frames) / frames)


def _circle(radius: float, side: int, turns: float = 1.0) -> np.ndarray:
    angle = np.linspace(0, 2 * np.pi * turns, int(80 * turns) + 1)
    return radius * np.stack([side * (1 - np.cos(angle)), np.sin(angle)], -1)


def _slalom() -> np.ndarray:
    z = np.linspace(0, 10, 101)
    return np.stack([0.9 * np.sin(2 * np.pi * z / 5) * np.minimum(1, z / 2), z], -1)


_PRESETS = {
    "straight": lambda: np.array([[0.0, 0.0], [0.0, 8.0]]),
    "circle": lambda: _circle(2.0, 1),
    "figure eight": lambda: np.concatenate([_circle(1.5, 1), _circle(1.5, -1)[1:]]),
    "slalom": _slalom,
    "stop and go": lambda: np.array([[0.0, 0.0], [0.0, 7.5]]),
}
PRESETS: tuple[str, ...] = tuple(_PRESETS)


def preset(name: str) -> tuple[Float[np.ndarray, "n 2"], list[float]]:
    """A named path and its stops (metres along it).

    Straight, circle, figure eight, slalom, stop and go.

    Raises KeyError with the names there are.  Notebook: 00
    """
    if name not in _PRESETS:
        raise KeyError(f"no path is called {name!r}; there are {', '.join(PRESETS)}")
    return _PRESETS[name](), [2.5, 5.0] if name == "stop and go" else []
