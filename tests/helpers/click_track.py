"""A click track, and a figure that stands still but for jumps.

What is heard and what is seen have known moments.
"""

import numpy as np
from synthetic_walk import walk

RATE = 16_000


def clicks(times, seconds: float, rate: int = RATE) -> np.ndarray:
    """A short 1 kHz click that begins exactly at each time."""
    samples = np.zeros(round(seconds * rate))
    n = np.arange(round(0.03 * rate))
    for t in times:
        samples[round(t * rate) :][: len(n)] += (
            0.8 * np.exp(-n / rate / 0.005) * np.cos(2 * np.pi * 1000 * n / rate)
        )
    return samples


def jumping(frames: int, jumps) -> np.ndarray:
    """A standing figure (frames, 21, 3) that changes sides at each jump.

    It is 0.6 m to the left or the right.
    """
    pose = walk(frames=3)[0][1]
    side = np.cumsum(np.isin(np.arange(frames), jumps)) % 2
    return pose + (0.6 * side - 0.3)[:, None, None] * [1.0, 0.0, 0.0]
