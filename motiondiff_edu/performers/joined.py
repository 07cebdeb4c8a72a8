"""A continuation that goes on from the motion that it continues, without a jump.

A walker that gets a pose unlike its training begins with one that it knows: a joint may move by
half a metre from the last given frame to the first new one. Then the first half second takes over
pose and speed of the given motion, and a warning says so. Continuations that do not jump stay as
they are.
"""

from collections.abc import Callable

import numpy as np
from jaxtyping import Float
from torch import Tensor

from ..beyond.above_floor import feet_above_floor
from ..beyond.foot_lock import FADE, steady_feet
from ..beyond.inertialize import SECONDS, inertialized
from ..metrics.seams import AROUND, seam_over_motion
from ..motion.root_frame import FPS
from ..motion.scaler import Scaler
from ..motion.skeleton import JOINTS, J

JUMP = 1.1  # times the fastest joint of the second before and after: faster is a jump at the seam
# standard deviations of the training, over the coordinates of a joint; no frame of 120 unseen
# synthetic walks is as far (at most 4.64)
UNLIKE = 5.0
NAMED = 3  # joints in a message


def joined(
    given: Float[np.ndarray, "N 21 3"],
    past: Float[np.ndarray, "T_h 21 3"],
    new: Float[np.ndarray, "T 21 3"],
    in_world: Callable[[np.ndarray], np.ndarray],
) -> tuple[Float[np.ndarray, "T 21 3"], float]:
    """The new frames in the world, and how much faster the seam was than what is around it.

    given     the motion that is continued, in the world (metres)
    past      its last frames in the root frame; `new` frames follow them
    in_world  places past and new frames, all in the root frame, in the world
    """
    before = given[-round(AROUND * FPS) - 1 :]
    k, T_h = len(before), len(past)

    def placed(frames: np.ndarray) -> np.ndarray:
        return np.concatenate([before, in_world(np.concatenate([past, frames]))[T_h:]])

    whole = placed(new)
    jump = seam_over_motion(whole, k) if 2 <= k < len(whole) - 1 else 0.0
    if jump <= JUMP:
        return whole[k:], jump
    known = np.zeros((len(whole), J), bool)
    known[:k] = True
    known[k + round(SECONDS * FPS) + FADE :] = True
    whole = steady_feet(placed(inertialized(past, new, FPS)), known)
    return feet_above_floor(whole, known)[k:], jump


def unlike_training(scaler: Scaler, past: Float[Tensor, "T_h D"]) -> dict[str, float]:
    """Joints that are far from the training's poses, in its standard deviations, farthest first.

    Of each joint the frame that is furthest away.
    """
    away = scaler.transform(past.to(scaler.mean)).reshape(len(past), J, 3)
    far = away.square().mean(-1).sqrt().amax(0).tolist()
    order = sorted(range(J), key=far.__getitem__, reverse=True)
    return {JOINTS[joint]: far[joint] for joint in order if far[joint] > UNLIKE}


def in_words(jump: float, unlike: dict[str, float]) -> str:
    """What there is to say about a continuation; "" if there is nothing."""
    if not unlike and jump <= JUMP:
        return ""
    words = "the poses to continue are unlike the walker's training"
    if unlike:
        most = [f"{name} {far:.1f}" for name, far in list(unlike.items())[:NAMED]]
        words += f" (standard deviations away: {', '.join(most)})"
    if jump > JUMP:
        words += f". The first {SECONDS:g} s are blended, because the figure would jump"
    return words
