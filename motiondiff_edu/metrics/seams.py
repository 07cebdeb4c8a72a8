"""Does a motion jump where generated frames begin?"""

import numpy as np
from jaxtyping import Float

AROUND = 1.0  # seconds, before and after the seam


def seam_over_past(
    positions: Float[np.ndarray, "T J 3"], seam: int, fps: float | int = 20.0
) -> float:
    """The speed of the fastest joint at the seam over the fastest within the second before it.

    As `seam_over_motion`, but what was generated cannot excuse a jump by being fast itself.
    """
    speeds = _fastest(positions, seam)
    before = speeds[max(0, seam - 1 - round(AROUND * fps)) : seam - 1]
    return float(speeds[seam - 1] / max(before.max(), 1e-9))


def seam_over_motion(
    positions: Float[np.ndarray, "T J 3"], seam: int, fps: float | int = 20.0
) -> float:
    """The speed of the fastest joint at the seam over the fastest within a second around it.

    `seam` is the first generated frame (world, metres). 1 or less: no joint is faster there than
    elsewhere. Raises ValueError for a seam without two frames before it and one after it.
    """
    speeds = _fastest(positions, seam)
    n = round(AROUND * fps)
    around = np.r_[speeds[max(0, seam - 1 - n) : seam - 1], speeds[seam : seam + n]]
    return float(speeds[seam - 1] / max(around.max(), 1e-9))


def seam_step(positions: Float[np.ndarray, "T J 3"], seam: int) -> float:
    """How much farther a joint goes at the seam than in the two frames before and after it, metres.

    The largest over joints. A hand that jumps while a foot swings is seen here, and not by
    `seam_over_motion`. Raises ValueError as `seam_over_motion` does.
    """
    steps = _steps(positions, seam)
    beside = np.concatenate([steps[max(0, seam - 3) : seam - 1], steps[seam : seam + 2]])
    return float((steps[seam - 1] - beside.max(0)).max())


def _fastest(positions, seam: int) -> Float[np.ndarray, "n"]:
    """The fastest joint from each frame to the next, in metres a frame."""
    return _steps(positions, seam).max(-1)


def _steps(positions, seam: int) -> Float[np.ndarray, "n J"]:
    """How far each joint goes from each frame to the next, metres."""
    if not 2 <= seam < len(positions) - 1:
        raise ValueError(f"the seam must be from 2 to {len(positions) - 2}, not {seam}")
    return np.linalg.norm(np.diff(positions, axis=0), axis=-1)
