"""Does a motion jump where generated frames begin?"""

import numpy as np
from jaxtyping import Float

AROUND = 1.0  # seconds, before and after the seam


def seam_over_motion(
    positions: Float[np.ndarray, "T J 3"], seam: int, fps: float | int = 20.0
) -> float:
    """The speed of the fastest joint at the seam over the fastest within a second around it.

    `seam` is the first generated frame (world, metres). 1 or less: no joint is faster there than
    elsewhere. Raises ValueError for a seam without two frames before it and one after it.
    """
    if not 2 <= seam < len(positions) - 1:
        raise ValueError(f"the seam must be from 2 to {len(positions) - 2}, not {seam}")
    speeds = np.linalg.norm(np.diff(positions, axis=0), axis=-1).max(-1)  # of frame t to t + 1
    n = round(AROUND * fps)
    around = np.r_[speeds[max(0, seam - 1 - n) : seam - 1], speeds[seam : seam + n]]
    return float(speeds[seam - 1] / max(around.max(), 1e-9))
