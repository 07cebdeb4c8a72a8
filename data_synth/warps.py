"""Motion at another pace: the same movement slower, faster, and with pauses.

A network that has seen only steady steps gives a step to a figure that stands still in a stride.
Here the pace changes smoothly within a motion, and now and then it stops.
"""

import numpy as np
import scipy
from jaxtyping import Bool, Float

SLOWEST, FASTEST = 0.3, 2.2  # times the pace of the motion
CHANGES = (0.4, 2.5)  # seconds from one drawn pace to the next
PAUSE, PAUSES = 0.03, 0.2  # times the pace in a pause, and the share of drawn paces that are one


def warped(
    positions: Float[np.ndarray, "T 21 3"],
    contacts: Bool[np.ndarray, "T 2"],
    rng: np.random.Generator,
    fps: float = 20.0,
) -> tuple[Float[np.ndarray, "F 21 3"], Bool[np.ndarray, "F 2"]]:
    """The motion (metres, world) and its contacts, in a pace that is drawn.

    Some motions are slow in parts, others not. The motion is as long as its pace makes it, at most
    three times as long as it was.
    """
    at = times_of(len(positions), drawn(SLOWEST, 1.0, rng), rng, fps)
    spline = scipy.interpolate.CubicSpline(np.arange(len(positions)), positions)
    return spline(at), contacts[np.round(at).astype(int)]


def times_of(
    T: int, slowest: float, rng: np.random.Generator, fps: float
) -> Float[np.ndarray, "F"]:
    """The frame of the motion, a fraction, that each new frame shows: 0 at first, rising."""
    knots, paces = [0.0], [drawn_pace(slowest, rng)]
    longest = 3 * T
    while knots[-1] < longest:
        knots.append(knots[-1] + fps * rng.uniform(*CHANGES))
        paces.append(drawn_pace(slowest, rng))
    pace = scipy.interpolate.PchipInterpolator(knots, paces)(np.arange(longest - 1) + 0.5)
    at = np.concatenate([[0.0], np.cumsum(pace)])
    return at[at <= T - 1]


def drawn_pace(slowest: float, rng: np.random.Generator) -> float:
    """A pause, or a pace from the slowest to the fastest one."""
    return PAUSE if rng.uniform() < PAUSES else drawn(slowest, FASTEST, rng)


def drawn(low: float, high: float, rng: np.random.Generator) -> float:
    """Small numbers are as frequent as large ones: uniform in the logarithm."""
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))
