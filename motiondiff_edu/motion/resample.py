"""Motion at a higher frame rate, by a cubic spline through its frames.

Dances are compared at 60 frames/s.

Beats, speeds and energies depend on the frame rate at which they are measured. Resample to the 60
frames/s of the published numbers before you compare with them.   Notebook: 14
"""

import numpy as np
from jaxtyping import Float
from scipy.interpolate import CubicSpline

DANCE_FPS = 60.0  # of AIST++, and of every published score on it


def resample(
    positions: Float[np.ndarray, "T *shape"], fps: float | int, to: float | int = DANCE_FPS
) -> Float[np.ndarray, "F *shape"]:
    """The same motion with `to` frames a second.

    new[k] = spline(k / to), cubic, through positions[t] at t / fps.

    The first frame stays as it is. The last frame does too if `to` is a whole multiple of `fps`;
    otherwise the new motion ends less than 1 / to before the old one. Movement up to a quarter of
    `fps` (5 Hz at 20 frames/s) is kept.
    Raises ValueError for a lower rate (motion.normalise.resample does that, with a low-pass), for a
    rate that is not positive, for fewer than two frames, and for NaN.
    Notebook: 14
    """
    if not (fps > 0 and to > 0):
        raise ValueError(f"frame rates must be positive, not {fps} and {to}")
    if to < fps - 1e-6:
        raise ValueError(
            f"from {fps:g} down to {to:g} frames/s, fast movement must be filtered out first: "
            "motion.normalise.resample"
        )
    if len(positions) < 2:
        raise ValueError(f"a motion of {len(positions)} frames cannot be resampled; 2 are needed")
    if not np.isfinite(positions).all():
        bad = int(np.flatnonzero(~np.isfinite(positions).reshape(len(positions), -1).all(1))[0])
        raise ValueError(f"frame {bad} is not finite: fill it or cut it off before resampling")
    positions = np.asarray(positions, np.float64)
    if abs(fps - to) < 1e-6:
        return positions
    count = int(np.floor((len(positions) - 1) * to / fps + 1e-6)) + 1
    new = CubicSpline(np.arange(len(positions)) / fps, positions)(np.arange(count) / to)
    new[0] = positions[0]
    if abs((count - 1) / to - (len(positions) - 1) / fps) < 1e-9:
        new[-1] = positions[-1]  # a spline passes through its knots only up to rounding
    return new
