"""A dance as three energies per joint: the features for FID, Diversity and MultiModality.

`kinetic_features` computes what the papers describe. `published_kinetic_features` computes what the
code behind the published tables does: there a missing bracket makes the third number measure the
distance from the origin. Both use 60 frames/s, metres, seconds, and y up.
Source: MoFusion 4.1 (FID, Div, MModality).   Notebook: 14
"""

import numpy as np
from jaxtyping import Float

from ..motion.resample import DANCE_FPS, resample
from ..motion.root_frame import FPS

WINDOW = 2  # frames to either side, at 60 frames/s


def kinetic_features(
    positions: Float[np.ndarray, "T J 3"], fps: float | int = FPS
) -> Float[np.ndarray, "F"]:
    """Energies of joint 0, of joint 1 and so on.

    Each has (horizontal energy, vertical energy, energy expenditure): F = 3 J numbers.

    v[t] and a[t] are velocity and acceleration at 60 frames/s, each averaged over two frames to
    either side. Horizontal = mean_t |v_xz|^2 and vertical = mean_t v_y^2, in (m/s)^2; expenditure =
    mean_t |a| in m/s^2. The dancer's place in the world makes no difference.
    Raises ValueError for fewer than three frames.  Source: MoFusion 4.1.  Notebook: 14
    """
    positions = _at_60(positions, fps)
    steps = np.diff(positions, axis=0) * DANCE_FPS
    return _together(steps, np.diff(steps, axis=0) * DANCE_FPS)


def published_kinetic_features(
    positions: Float[np.ndarray, "T J 3"], fps: float | int = FPS
) -> Float[np.ndarray, "F"]:
    """The same features with the fault of the public code, to compare with published numbers.

    The code is that of fairmotion, AIST++ and Bailando. Its earlier velocity is p[t] - p[t-1] / dt
    instead of (p[t] - p[t-1]) / dt, so the expenditure is about 59 * 60 * mean_t |p|. It measures
    the distance from the origin, and is not 0 for a motionless joint. Bailando first moves the root
    to the origin (`from_the_origin`) and AIST++ does not, so their numbers differ.
    Raises ValueError for fewer than three frames.  Source: MoFusion 4.1.  Notebook: 14
    """
    positions = _at_60(positions, fps)
    steps = np.diff(positions, axis=0) * DANCE_FPS
    earlier = positions[1:-1] - positions[:-2] * DANCE_FPS
    return _together(steps, (steps[1:] - earlier) * DANCE_FPS)


def from_the_origin(positions: Float[np.ndarray, "T J 3"]) -> Float[np.ndarray, "T J 3"]:
    """The motion moved so that joint 0 starts at (0, 0, 0), as in Bailando's code.

    Notebook: 14
    """
    return positions - positions[:1, :1]


def _at_60(positions: np.ndarray, fps: float | int) -> np.ndarray:
    if len(positions) < 3:
        raise ValueError(
            f"an acceleration needs three frames, and this motion has {len(positions)}"
        )
    return resample(positions, fps)


def _averaged(rates: Float[np.ndarray, "N J 3"], frames: int) -> Float[np.ndarray, "{frames} J 3"]:
    """Mean of the rates over a window around each frame; the window is cut at the ends."""
    total = np.concatenate([np.zeros((1, *rates.shape[1:])), np.cumsum(rates, axis=0)])
    at = np.arange(
        frames
    )  # a last frame without an acceleration of its own has the mean of those before
    first = np.maximum(at - WINDOW, 0)
    last = np.minimum(at + WINDOW + 1, len(rates))
    return (total[last] - total[first]) / (last - first)[:, None, None]


def _together(
    steps: Float[np.ndarray, "N J 3"], changes: Float[np.ndarray, "_ J 3"]
) -> Float[np.ndarray, "F"]:
    """The three energies of each joint, from velocities (`steps`) and accelerations (`changes`)."""
    velocity = _averaged(steps, len(steps))
    acceleration = _averaged(changes, len(steps))
    horizontal = (velocity[..., [0, 2]] ** 2).sum(-1).mean(0)
    vertical = (velocity[..., 1] ** 2).mean(0)
    expenditure = np.linalg.norm(acceleration, axis=-1).mean(0)
    return np.stack([horizontal, vertical, expenditure], -1).reshape(-1)
