"""Does the dance repeat itself? Every pose is compared with every other.

The comparison ignores where the figure stands and which way it faces. The matrix has a bright
diagonal, because each pose equals itself; a loop of two seconds adds bright lines two seconds
beside it. A dance needs some repetition, as music does: compare with the data's own value.
Source: MoFusion 4.1 (repetitive dances, judged there by eye).  Notebook: 14
"""

import numpy as np
from jaxtyping import Float

from ..motion.root_frame import FPS, body_heading, to_root_frame
from ..motion.skeleton import HIPS

LAGS = (1.0, 8.0)  # s: a shorter lag is a sway, and a short clip cannot show a longer one
OVERLAP = 2.0  # s to compare at each lag; a shorter overlap can agree by chance


def pose_changes(positions: Float[np.ndarray, "T 21 3"]) -> Float[np.ndarray, "T 63"]:
    """Poses with the pelvis above the origin, facing z in every frame, minus the clip's mean pose.

    In metres. The heading is that of hips and shoulders together.
    Raises ValueError for NaN.
    """
    if not np.isfinite(positions).all():
        raise ValueError(
            "positions contain NaN or infinity: fill or cut them before you look for repetition"
        )
    poses, _ = to_root_frame(positions, positions[:, HIPS][:, [0, 2]], body_heading(positions))
    flat = poses.reshape(len(poses), -1)
    return flat - flat.mean(0)


def self_similarity(positions: Float[np.ndarray, "T 21 3"]) -> Float[np.ndarray, "T T"]:
    """S[t, u] = <x_t, x_u> / (|x_t| |x_u|), with x the `pose_changes`.

    It is 1 for the same pose and -1 for the opposite one.
    Raises ValueError for NaN and for a figure that keeps one pose.  Notebook: 14
    """
    x = _moving(pose_changes(positions))
    x = x / np.maximum(np.linalg.norm(x, axis=1, keepdims=True), 1e-12)
    return x @ x.T


def autocorrelation(x: Float[np.ndarray, "T F"], lag: int) -> float:
    """Normalised autocorrelation of a motion at `lag` frames; 1 for a loop of that length.

    r = sum_t <x_t, x_{t+lag}> / sqrt(sum_t |x_t|^2 sum_t |x_{t+lag}|^2), summed over the overlap.
    """
    a, b = x[: len(x) - lag], x[lag:]
    return float((a * b).sum() / np.sqrt(max((a**2).sum() * (b**2).sum(), 1e-24)))


def lag_similarity(
    positions: Float[np.ndarray, "T 21 3"], fps: float | int = FPS
) -> Float[np.ndarray, "L"]:
    """The `autocorrelation` of the dance for lag = 0, 1, ... while 2 s are left to compare.

    Raises ValueError for a clip under 2 s, NaN, and a figure that keeps one pose.
    """
    return _similar(positions, fps, slice(None))


def _similar(positions: np.ndarray, fps: float | int, lags: slice) -> Float[np.ndarray, "L"]:
    """`lag_similarity` for some of the lags."""
    x = _moving(pose_changes(positions))
    overlap = round(OVERLAP * fps)
    if len(x) < overlap:
        raise ValueError(
            f"{len(x) / fps:g} s are too short to look for repetition: {OVERLAP:g} s are needed"
        )
    return np.array([autocorrelation(x, lag) for lag in range(len(x) - overlap + 1)[lags]])


def repeat_score(
    positions: Float[np.ndarray, "T 21 3"], fps: float | int = FPS, lags: tuple[float, float] = LAGS
) -> float:
    """The largest `lag_similarity` between 1 and 8 seconds: 1 for a loop, near 0 for noise.

    A clip of T seconds shows lags up to T - 2 s, so compare only clips of one length. Smooth
    movement without repetition is still a little similar to itself by chance.
    Raises ValueError as `lag_similarity` does, and when no such lag fits.   Notebook: 14
    """
    first, last = round(lags[0] * fps), round(lags[1] * fps)
    similarity = _similar(positions, fps, slice(first, last + 1))
    if not len(similarity):
        raise ValueError(
            f"{len(positions) / fps:g} s are too short for a lag of {lags[0]:g} s "
            f"with {OVERLAP:g} s to compare"
        )
    return float(similarity.max())


def _moving(x: Float[np.ndarray, "T F"]) -> Float[np.ndarray, "T F"]:
    if np.abs(x).max() < 1e-6:
        raise ValueError("this figure keeps one pose, so no movement can repeat")
    return x
