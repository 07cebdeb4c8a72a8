"""How does a person walk? Four numbers of style: trunk lean, step width, arm swing, cadence.

They are compared between a past and its continuation, so each is in units of its spread over
several pasts.
Source: what differs most between recorded walkers at the same speed; the four numbers are ours.
"""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from ..motion.dance_frame import facing
from ..motion.finite import check_finite
from ..motion.root_frame import FPS, forward_left
from ..motion.skeleton import HEELS, HIPS, joint_index

NECK, HANDS = joint_index("Neck1"), (joint_index("LeftHand"), joint_index("RightHand"))
MOVED = 0.03  # m
NAMES = ("trunk lean, radians", "step width, m", "arm swing, m", "steps a second")


def gait_style(
    positions: Float[np.ndarray, "T 21 3"], fps: float | int = FPS
) -> Float[np.ndarray, "4"]:
    """The four numbers of a motion (metres, world); NAMES says which.

    Lean is positive forwards. Width is the mean distance of the ankles across the way that the
    figure faces. Swing is the standard deviation of how far the left hand is ahead of the right
    one. A step is where the distance of the ankles along the way goes from MOVED over its mean to
    MOVED under it, or back; a figure that stands takes none.
    Raises ValueError for fewer than two frames.
    """
    if len(positions) < 2:
        raise ValueError(f"a style needs two frames or more, not {len(positions)}")
    ahead, aside = forward_left(facing(positions))

    def along(way: Float[np.ndarray, "T 2"], start: int, end: int) -> Float[np.ndarray, "T"]:
        return ((positions[:, end] - positions[:, start])[:, [0, 2]] * way).sum(-1)

    upright = positions[:, NECK, 1] - positions[:, HIPS, 1]
    lean = np.arctan2(along(ahead, HIPS, NECK), upright).mean()
    width = np.abs(along(aside, *HEELS)).mean()
    swing = along(ahead, *HANDS).std()
    strides = along(ahead, *HEELS)
    away = strides - strides.mean()
    sides = np.sign(away[np.abs(away) > MOVED])
    steps = (np.diff(sides) != 0).sum()
    return np.array([lean, width, swing, steps * fps / (len(positions) - 1)])


def style_kept(
    pasts: Float[np.ndarray, "N 4"],
    made: Float[np.ndarray, "N 4"],
    persons: Sequence[str],
) -> Float[np.ndarray, "N"]:
    """For each continuation the share of other persons' pasts that are farther away than its own.

    A half is chance, if all were continued under the same control. Equally far counts half.
    Raises ValueError for fewer than two persons, and for NaN.
    """
    names = np.array(list(persons))
    if len(set(persons)) < 2:
        raise ValueError("styles are compared between two persons or more")
    check_finite(pasts, "styles of the pasts")
    check_finite(made, "styles of the continuations")
    scale = np.maximum(pasts.std(0), 1e-9)
    away = np.linalg.norm((made[:, None] - pasts[None]) / scale, axis=-1)  # (made, past)
    own = np.diag(away)[:, None]
    nearer = (away > own) + 0.5 * (away == own)
    others = names[:, None] != names
    return np.where(others, nearer, 0.0).sum(1) / others.sum(1)
