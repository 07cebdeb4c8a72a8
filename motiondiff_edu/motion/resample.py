"""Motion at another frame rate, by a cubic spline through its frames.

Beats, speeds and energies depend on the frame rate at which they are measured. Resample to the 60
frames/s of the published numbers before you compare with them.   Notebook: 14
"""

import numpy as np
import scipy
from jaxtyping import Float

DANCE_FPS = 60.0  # of AIST++, and of every published score on it
CUT = 0.4  # of the new rate: 8 Hz at 20 frames/s; 99 % of the velocity power is below


def resample(
    positions: Float[np.ndarray, "T *shape"], fps: float | int, to: float | int = DANCE_FPS
) -> Float[np.ndarray, "F *shape"]:
    """The same motion with `to` frames a second.

    new[k] = spline(k / to), cubic, through positions[t] at t / fps.

    To a higher rate the first frame stays as it is. The last frame does too if `to` is a whole
    multiple of `fps`; otherwise the new motion ends less than 1 / to before the old one. Movement
    up to a quarter of `fps` (5 Hz at 20 frames/s) is kept.
    To a lower rate a zero-phase low-pass at CUT times `to` comes first.
    Raises ValueError for a rate that is not positive, for fewer than two frames, and for NaN.
    Notebook: 14
    """
    if not (fps > 0 and to > 0):
        raise ValueError(f"frame rates must be positive, not {fps} and {to}")
    if len(positions) < 2:
        raise ValueError(f"a motion of {len(positions)} frames cannot be resampled; 2 are needed")
    if not np.isfinite(positions).all():
        bad = int(np.flatnonzero(~np.isfinite(positions).reshape(len(positions), -1).all(1))[0])
        raise ValueError(f"frame {bad} is not finite: fill it or cut it off before resampling")
    positions = np.asarray(positions, np.float64)
    if abs(fps - to) < 1e-6:
        return positions.copy()
    if to < fps:
        positions = low_pass(positions, fps, CUT * to)
    count = int(np.floor((len(positions) - 1) * to / fps + 1e-6)) + 1
    new = scipy.interpolate.CubicSpline(np.arange(len(positions)) / fps, positions)(
        np.arange(count) / to
    )
    new[0] = positions[0]
    if abs((count - 1) / to - (len(positions) - 1) / fps) < 1e-9:
        new[-1] = positions[-1]  # a spline passes through its knots only up to rounding
    return new


def resample_present(
    points: Float[np.ndarray, "T J 3"], fps: float | int, to: float | int
) -> Float[np.ndarray, "F J 3"]:
    """`resample` for joints of which some are missing (NaN); what is missing stays so.

    A gap is bridged by a straight line while the others are filtered. It reaches from the last new
    frame before the first missing one to the first new frame after the last.
    """
    there = np.isfinite(points).all(-1)
    bridged = np.zeros(points.shape)
    frames = np.arange(len(points))
    for joint in np.flatnonzero(there.any(0)):
        known = there[:, joint]
        for axis in range(3):
            bridged[:, joint, axis] = np.interp(frames, frames[known], points[known, joint, axis])
    moved = resample(bridged, fps, to)
    at = np.arange(len(moved)) * fps / to
    before, after = np.floor(at + 1e-6).astype(int), np.ceil(at - 1e-6).astype(int)
    moved[~(there[before] & there[after])] = np.nan
    return moved


def low_pass(
    positions: Float[np.ndarray, "T *shape"], fps: float | int, cut: float
) -> Float[np.ndarray, "T *shape"]:
    """Movement faster than `cut` hertz is removed, without delay (Butterworth, both directions)."""
    filters = scipy.signal.butter(4, cut, fs=fps, output="sos")
    ends = min(15, len(positions) - 1)  # frames mirrored at both ends; 15 is scipy's own number
    return scipy.signal.sosfiltfilt(filters, positions, axis=0, padlen=ends)
