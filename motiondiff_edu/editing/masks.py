"""What is given of a motion: masks over frames and joints.

Here is also what they mean for the network's columns.

`known` is (T, J): True where a joint's place is given. The network sees the pelvis in the world and
the other joints about it, so a joint can be held only where the pelvis is held, too.
Source: MoFusion 4.4 (the mask delta).  Notebook: 15
"""

from collections.abc import Iterable, Sequence, Sized

import numpy as np
from jaxtyping import Bool

from ..motion.checks import checked_count
from ..motion.motion import Motion, MotionError
from ..motion.skeleton import COURSE, HIPS, JOINTS, J, joint_index

LOWER = tuple(name for name in JOINTS if name.endswith(("UpLeg", "Leg", "Foot", "ToeBase")))
UPPER = tuple(name for name in JOINTS if name not in LOWER and name != JOINTS[HIPS])
PARTS = {
    "whole body": JOINTS,
    "upper body": UPPER,
    "lower body": LOWER,
    "trajectory": (),
}  # with the pelvis each


def known_frames(
    T: int, frames: Iterable[int], joints: Sequence[str] = JOINTS
) -> Bool[np.ndarray, "{T} J"]:
    """These frames are given, of these joints and the pelvis.  Negative numbers count from the end.

    Raises IndexError for a frame that the motion has not, KeyError for a name that no joint has.
    """
    known, columns = np.zeros((T, J), bool), [HIPS, *(joint_index(name) for name in joints)]
    for frame in frames:
        if not -T <= frame < T:
            raise IndexError(f"frame {frame} is not within a motion of {T} frames (0 to {T - 1})")
        known[frame, columns] = True
    return known


def seed(T: int, frames: int = 40) -> Bool[np.ndarray, "{T} J"]:
    """The first frames are given, the rest is to be made: 40 frames, 2 s.  Source: MoFusion 4.4.
    Notebook: 15

    Raises ValueError for a seed that is longer than the motion.
    """
    if not 0 <= frames <= T:
        raise ValueError(
            f"a seed of {frames} frames does not fit into {T}: say how many with frames="
        )
    return known_frames(T, range(frames))


def keyframes(T: int, every: int) -> Bool[np.ndarray, "{T} J"]:
    """Every so many frames one is given, the last one as well.

    Notebook: 15

    Raises ValueError for every < 1.
    """
    if every < 1:
        raise ValueError(f"a keyframe every {every} frames: it takes 1 (all of them) or more")
    return known_frames(T, sorted({*range(0, T, every), T - 1}))


def keyframes_of(motion: Sized | int, every: int = 20) -> Bool[np.ndarray, "T J"]:
    """`keyframes` of a motion, or of so many frames.

    Raises ValueError for every < 1, or no frame.
    """
    T = motion if isinstance(motion, int) else len(motion)
    return keyframes(checked_count(T, "a motion's number of frames"), checked_count(every, "every"))


def checked_known(motion: Motion, known) -> Bool[np.ndarray, "T J"]:
    """A mask that fits a motion of the course's skeleton: True where a joint is given.

    Raises MotionError for another skeleton, another shape, what is not True or False, and a joint
    that is given and missing.
    """
    if motion.skeleton != COURSE:
        raise MotionError(
            f"{motion.name} has {len(motion.skeleton)} joints; the course's networks know the {J} "
            f"of their own skeleton. Read the figure from a BVH file: it is retargeted"
        )
    array = np.asarray(known)
    if array.shape != (len(motion), J) or array.dtype != bool:
        raise MotionError(
            f"known is {array.dtype} {array.shape}; it is bool ({len(motion)}, {J}), a row for "
            f"each frame and True where the joint is given. md.keyframes(motion) makes one"
        )
    wrong = np.argwhere(array & ~motion.known)
    if len(wrong):
        frame, joint = wrong[0]
        raise MotionError(
            f"{JOINTS[joint]} in frame {frame} is given and has no position (NaN): "
            f"known & motion.known lets such joints go"
        )
    return array


def gap(T: int, first: int, length: int) -> Bool[np.ndarray, "{T} J"]:
    """All is given but `length` frames from `first` on.

    Notebook: 15

    Raises ValueError for a gap that is not inside.
    """
    if not (0 < length and 0 <= first and first + length <= T):
        raise ValueError(f"a gap of {length} frames from frame {first} is not within {T} frames")
    return known_frames(T, [t for t in range(T) if not first <= t < first + length])


def body_part(T: int, part: str) -> Bool[np.ndarray, "{T} J"]:
    """A part of the body, by its name in PARTS, is given throughout.

    "trajectory" is the pelvis alone.
    Notebook: 15

    Raises KeyError with the names there are.
    """
    if part not in PARTS:
        raise KeyError(f"no part is called {part!r}; there are {', '.join(PARTS)}")
    return known_frames(T, range(T), PARTS[part])


def known_columns(known: Bool[np.ndarray, "*B T J"]) -> Bool[np.ndarray, "*B T 63"]:
    """The mask over the network's 63 numbers.

    Raises ValueError where a joint is given and the pelvis is not: its place in the world is then
    no column.
    """
    loose = known.any(-1) & ~known[..., HIPS]
    if loose.any():
        frame = int(np.argwhere(loose)[0][-1])
        name = JOINTS[int(np.argmax(known[tuple(np.argwhere(loose)[0])]))]
        raise ValueError(
            f"frame {frame} gives {name} without the pelvis ({JOINTS[HIPS]}): give that as well"
        )
    return np.repeat(known, 3, axis=-1)
