"""Seeded random numbers that can be redrawn from one frame on; those before stay the same.

All randomness of a walk is a causal function of one table of white noise, a row per frame. A
continuation keeps the rows of its past and draws new ones after it: it keeps what the past has
decided, and draws the rest again.
"""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float
from scipy.signal import lfilter
from scipy.special import ndtr

CHANNELS = 40
PREROLL = 400  # rows before the first frame, so that slow processes start in their stationary state


def white(
    seed: int, n: int, redraw: Sequence[tuple[int, int]] = ()
) -> Float[np.ndarray, "rows 40"]:
    """n + PREROLL rows of N(0, 1).

    From each (frame, seed) in `redraw` on, the rows come from that seed instead.

    A longer table begins with the shorter one.  Raises ValueError for a negative seed.
    """
    if seed < 0:
        raise ValueError(f"a seed is a whole number from 0 on, got {seed}")
    rows = np.random.default_rng([seed, 1]).standard_normal((PREROLL + n, CHANNELS))
    for frame, fresh in redraw:
        first = PREROLL + frame
        if first < len(rows):
            rows[first:] = np.random.default_rng([fresh, 2]).standard_normal(
                (len(rows) - first, CHANNELS)
            )
    return rows


def drift(rows: Float[np.ndarray, "rows *k"], tau: float, fps: float) -> Float[np.ndarray, "n *k"]:
    """Unit-variance smooth noise with memory of about 2 tau seconds: two low-passes in a row.

    The rows of PREROLL are cut off.
    """
    a = np.exp(-1.0 / (fps * tau))
    y = lfilter([1.0], [1.0, -2 * a, a * a], rows, axis=0)
    return (y / np.sqrt((1 + a * a) / (1 - a * a) ** 3))[PREROLL:]


def follow(
    target: Float[np.ndarray, "T *k"], tau: float, fps: float, poles: int = 2
) -> Float[np.ndarray, "T *k"]:
    """Low-pass of `target` by `poles` equal one-pole filters of time constant tau.

    It starts at target[0] and is causal.
    """
    a = np.exp(-1.0 / (fps * tau))
    y = np.asarray(target, dtype=np.float64)
    for _ in range(poles):
        y = lfilter([1 - a], [1.0, -a], y, axis=0, zi=a * y[:1])[0]
    return y


def uniform(rows: Float[np.ndarray, "rows *k"]) -> Float[np.ndarray, "n *k"]:
    """The rows as numbers uniform on (0, 1); the rows of PREROLL are cut off."""
    return ndtr(rows[PREROLL:])
