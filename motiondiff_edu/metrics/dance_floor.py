"""How a dance uses the floor: do its feet stand, does it turn, does it travel?

Three numbers of world positions (metres, y up). They do not see whether a step is a good one:
a figure that slides along, or spins like a top, uses the floor as well.
Source: ours, after measures of recorded dances.  Notebook: 14
"""

import numpy as np
import scipy.ndimage
from jaxtyping import Float

from ..motion.root_frame import FPS, estimate_root
from ..motion.skeleton import HEELS, check_joints

STANDS = 0.15  # m/s: a Foot joint that is slower stands; a foot that rolls or turns is faster
TURN_SECONDS = 8.0  # four bars in four at 120 beats a minute: time for a dancer to face elsewhere
TRAVEL_SMOOTHING = 0.25  # seconds, as the root path of a recording (`root_frame`)


def standing_feet(positions: Float[np.ndarray, "T 21 3"], fps: float | int = FPS) -> float:
    """The share of time in which a foot stands, 0 to 1: the mean of both feet.

    A foot stands while its Foot joint is slower than 0.15 m/s, |p[t+1] - p[t-1]| fps / 2. 1 is a
    figure that never moves a foot; two recorded dances of CMU have 0.33 and 0.31.
    Raises ValueError for fewer than three frames, NaN, and another skeleton.
    """
    _check(positions)
    if len(positions) < 3:
        raise ValueError(
            f"whether a foot stands needs three frames, and this motion has {len(positions)}"
        )
    foot = positions[:, list(HEELS)]
    speed = np.linalg.norm(foot[2:] - foot[:-2], axis=-1) * fps / 2
    return float((speed < STANDS).mean())


def turning(
    positions: Float[np.ndarray, "T 21 3"],
    fps: float | int = FPS,
    seconds: float | int = TURN_SECONDS,
) -> float:
    """The angle within which a figure faces during `seconds`, in degrees.

    mean over all spans of that length of (largest - smallest heading in the span); the heading is
    unwrapped, and smoothed as in `root_frame.estimate_root`. A turn there and back counts once,
    and swaying counts as far as it goes; two full turns are 720.
    Raises ValueError for a shorter clip, NaN, and another skeleton.
    """
    _check(positions)
    span = round(seconds * fps)
    if len(positions) <= span:
        raise ValueError(
            f"turning within {seconds:g} s needs a longer clip than {len(positions) / fps:g} s"
        )
    heading = estimate_root(positions, fps)[1]
    windows = np.lib.stride_tricks.sliding_window_view(heading, span + 1)
    return float(np.degrees(np.ptp(windows, axis=-1).mean()))


def travel(positions: Float[np.ndarray, "T 21 3"], fps: float | int = FPS) -> float:
    """Mean horizontal speed of the pelvis in m/s, its velocity smoothed by a Gaussian of 0.25 s.

    A sway from foot to foot counts a little: 0 is a figure whose pelvis stays where it is.
    Raises ValueError for fewer than two frames, NaN, and another skeleton.
    """
    _check(positions)
    if len(positions) < 2:
        raise ValueError("a speed needs two frames, and this motion has one")
    velocity = np.diff(positions[:, 0][:, [0, 2]], axis=0) * fps
    smooth = scipy.ndimage.gaussian_filter1d(velocity, TRAVEL_SMOOTHING * fps, 0, mode="nearest")
    return float(np.linalg.norm(smooth, axis=-1).mean())


def _check(positions: Float[np.ndarray, "T 21 3"]) -> None:
    check_joints(positions)
    if not np.isfinite(positions).all():
        raise ValueError("positions contain NaN or infinity: fill or cut them first")
