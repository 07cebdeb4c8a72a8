"""Masks over frames and joints that say what is given of a motion, and the network's columns.

`known` is (T, J): True where a joint's position is given. The network has the pelvis in the world
and the other joints relative to it, so a joint can be given only where the pelvis is given, too.
Source: MoFusion 4.4 (the mask delta).  Notebook: 15
"""

from collections.abc import Iterable, Sequence
from numbers import Integral

import numpy as np
from jaxtyping import Bool, Float

from ..motion.checks import checked_count
from ..motion.motion import Motion, MotionError, as_motion
from ..motion.skeleton import COURSE, HIPS, JOINTS, J, joint_index

LOWER = tuple(name for name in JOINTS if name.endswith(("UpLeg", "Leg", "Foot", "ToeBase")))
UPPER = tuple(name for name in JOINTS if name not in LOWER and name != JOINTS[HIPS])
PARTS = {
    "whole body": JOINTS,
    "upper body": UPPER,
    "lower body": LOWER,
    "trajectory": (),
}  # each with the pelvis


def known_frames(
    T: int, frames: Iterable[int], joints: Sequence[str] = JOINTS
) -> Bool[np.ndarray, "{T} J"]:
    """In these frames, these joints and the pelvis are given. Negative frames count from the end.

    Raises IndexError for a frame outside the motion, KeyError for an unknown joint.
    """
    known, columns = np.zeros((T, J), bool), [HIPS, *(joint_index(name) for name in joints)]
    for frame in frames:
        if not -T <= frame < T:
            raise IndexError(f"frame {frame} is not within a motion of {T} frames (0 to {T - 1})")
        known[frame, columns] = True
    return known


def seed(T: int, frames: int = 40) -> Bool[np.ndarray, "{T} J"]:
    """The first frames are given; 40 frames are 2 s.

    Raises ValueError for a seed that is longer than the motion.
    Source: MoFusion 4.4.  Notebook: 15
    """
    if not 0 <= frames <= T:
        raise ValueError(
            f"a seed of {frames} frames does not fit into {T}: pass a smaller number as frames="
        )
    return known_frames(T, range(frames))


def keyframes(T: int, every: int) -> Bool[np.ndarray, "{T} J"]:
    """One frame in `every` is given, and so is the last one.

    Raises ValueError for every < 1.  Notebook: 15
    """
    if every < 1:
        raise ValueError(f"every must be 1 (all frames) or more, not {every}")
    return known_frames(T, sorted({*range(0, T, every), T - 1}))


def keyframes_of(motion: Motion | int, every: int = 20) -> Bool[np.ndarray, "T J"]:
    """The mask for a keyframe every `every` frames and at the last one: True where it is given.

    Pass a motion, or its number of frames. Joints that a motion lacks (NaN) are not given, and a
    frame without the pelvis is not given at all: every=1 asks for the lost frames alone.
    Raises ValueError for every < 1, or no frames, TypeError for anything but a motion or a number.
    """
    T = int(motion) if isinstance(motion, Integral) else len(as_motion(motion))
    made = keyframes(checked_count(T, "a motion's number of frames"), checked_count(every, "every"))
    if isinstance(motion, Integral) or motion.skeleton != COURSE:
        return made
    return made & motion.known & motion.known[:, [HIPS]]


def checked_known(motion: Motion, known) -> Bool[np.ndarray, "T J"]:
    """The mask, after a check that it fits a motion of the course's skeleton.

    Raises MotionError for another skeleton, another shape, values other than True and False, and a
    joint that is given but has no position.
    """
    if motion.skeleton != COURSE:
        raise MotionError(
            f"{motion.name} has {len(motion.skeleton)} joints; the course's networks know the {J} "
            f"of their own skeleton. Read the figure from a BVH file, which retargets it"
        )
    array = np.asarray(known)
    if array.dtype.kind in "UO":
        raise MotionError(
            f"known is a table of True and False, not {known!r:.60}. motion.all_but(['LeftArm']) "
            "leaves joints out, editing.masks.body_part(len(motion), 'lower body') keeps a part, "
            "md.keyframes(motion) keeps frames"
        )
    if array.shape != (len(motion), J) or array.dtype != bool:
        raise MotionError(
            f"known is {array.dtype} {array.shape}; it must be bool ({len(motion)}, {J}): a row "
            f"for each frame, True where a joint is given. md.keyframes(motion) makes one"
        )
    wrong = np.argwhere(array & ~motion.known)
    if len(wrong):
        frame, joint = wrong[0]
        raise MotionError(
            f"{JOINTS[joint]} in frame {frame} is given but has no position (NaN): pass "
            f"known & motion.known, which leaves out such joints"
        )
    return array


def gap(T: int, first: int, length: int) -> Bool[np.ndarray, "{T} J"]:
    """Everything is given except for `length` frames from `first` on.

    Raises ValueError for a gap outside the motion.  Notebook: 15
    """
    if not (0 < length and 0 <= first and first + length <= T):
        raise ValueError(f"a gap of {length} frames from frame {first} is not within {T} frames")
    return known_frames(T, [t for t in range(T) if not first <= t < first + length])


def body_part(T: int, part: str) -> Bool[np.ndarray, "{T} J"]:
    """A part of the body, by its name in PARTS, is given in every frame.

    "trajectory" is the pelvis alone.
    Raises KeyError for another name, with a list of the parts.  Notebook: 15
    """
    return known_frames(T, range(T), PARTS[checked_part(part)])


def checked_part(part: str) -> str:
    """A name of PARTS.  Raises KeyError for another, with a list of the parts."""
    if part not in PARTS:
        raise KeyError(f"no part is called {part!r}; there are {', '.join(PARTS)}")
    return part


def known_columns(known: Bool[np.ndarray, "*B T J"]) -> Bool[np.ndarray, "*B T 63"]:
    """The mask over the network's 63 features.

    Raises ValueError where a joint is given without the pelvis: no feature is then known.
    """
    loose = known.any(-1) & ~known[..., HIPS]
    if loose.any():
        frame = int(np.argwhere(loose)[0][-1])
        name = JOINTS[int(np.argmax(known[tuple(np.argwhere(loose)[0])]))]
        raise ValueError(
            f"frame {frame} gives {name} without the pelvis ({JOINTS[HIPS]}); give the pelvis too"
        )
    return np.repeat(known, 3, axis=-1)


def checked_given(positions, known) -> tuple[Float[np.ndarray, "T 21 3"], Bool[np.ndarray, "T 21"]]:
    """Both as arrays of numpy.

    Raises ValueError unless they fit and all that is known is finite.
    """
    positions, known = np.asarray(positions), np.asarray(known)
    if positions.shape[1:] != (J, 3) or known.shape != positions.shape[:2] or known.dtype != bool:
        raise ValueError(
            f"it takes positions (T, {J}, 3) and a mask (T, {J}) of True and False, "
            f"not {positions.shape} and {known.shape} of {known.dtype}"
        )
    wrong = np.argwhere(known & ~np.isfinite(positions).all(-1))
    if len(wrong):
        frame, joint = wrong[0]
        raise ValueError(
            f"{JOINTS[joint]} in frame {frame} is given but not finite: "
            "correct it, or set known to False there"
        )
    return positions, known
