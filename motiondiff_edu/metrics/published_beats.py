"""The beat scores of the published tables as their code computes them, with its faults.

Use them only to compare with published scores. Both count in frames and assume 60 frames/s: at 20
frames/s the same code, with its sigma of 3 frames, gives a chance level of .68 and not .25.
Resample first (motion.resample). `beats.py` has the corrected scores.

                      AIST++'s authors                      Bailando; the formula of MoFusion eq. 10
averaged over         kinematic beats                       music beats, which rewards many stops
speed                 unsmoothed, so jitter makes stops     smoothed by 5 frames
minima                lowest within 10 frames either side   any local minimum
time of a minimum     half a frame late                     half a frame early
no kinematic beat     0                                     an error
Notebook: 14
"""

import numpy as np
import scipy
from jaxtyping import Float, Int, Real

from .beats import mean_speed

SIGMA_FRAMES = 3.0


def aist_beats(positions: Float[np.ndarray, "T J 3"]) -> Int[np.ndarray, "K"]:
    """Kinematic beats as AIST++'s authors find them: frame numbers at 60 frames/s.

    A beat is a minimum of the unsmoothed sum of joint speeds. A 0 is put before the speeds, so
    entry t is the step from t-1 to t.  Source: MoFusion 4.1.  Notebook: 14
    """
    speed = np.concatenate(
        [[0.0], mean_speed(positions, 1)]
    )  # a mean has its minima where the sum has them
    return scipy.signal.argrelextrema(speed, np.less, order=10)[0]


def aist_score(
    kinematic: Real[np.ndarray, "K"],
    music: Real[np.ndarray, "M"],
    sigma: float | int = SIGMA_FRAMES,
) -> float:
    """Mean over kinematic beats (frames at 60 frames/s) of exp(-min_m |b - m|^2 / 2 sigma^2).

    It is 0 without kinematic beats. Raises ValueError for music without a beat.
    Source: MoFusion 4.1.  Notebook: 14
    """
    return _mean_over(kinematic, music, sigma) if len(kinematic) else 0.0


def bailando_beats(positions: Float[np.ndarray, "T J 3"]) -> Int[np.ndarray, "K"]:
    """Kinematic beats as Bailando finds them: frame numbers at 60 frames/s.

    A beat is a minimum of the mean joint speed, smoothed by 5 frames. Entry t is the step from t to
    t+1.  Source: MoFusion 4.1.  Notebook: 14
    """
    return scipy.signal.argrelextrema(
        scipy.ndimage.gaussian_filter1d(mean_speed(positions, 1), 5), np.less
    )[0]


def bailando_score(
    kinematic: Real[np.ndarray, "K"],
    music: Real[np.ndarray, "M"],
    sigma: float | int = SIGMA_FRAMES,
) -> float:
    """Mean over music beats (frames at 60 frames/s) of exp(-min_b |b - m|^2 / 2 sigma^2).

    Raises ValueError where either side has no beat, as Bailando's code does.
    Source: MoFusion eq. 10.  Notebook: 14
    """
    return _mean_over(music, kinematic, sigma)


def _mean_over(
    these: Real[np.ndarray, "K"], others: Real[np.ndarray, "M"], sigma: float | int
) -> float:
    if len(these) == 0 or len(others) == 0:
        raise ValueError(
            "one side has no beats, and this form of the score is then undefined; "
            "metrics.beats has one that is defined"
        )
    nearest = np.abs(these[:, None] - others[None, :]).min(1)
    return float(np.exp(-(nearest**2) / (2 * sigma**2)).mean())
