"""Masks over frames and joints that say what is given of a motion (`motion.known`).

A joint is given only where the pelvis is given, too.
Source: MoFusion 4.4 (the mask delta).  Notebook: 15
"""

from collections.abc import Iterable, Sequence
from numbers import Integral

import numpy as np
from jaxtyping import Bool

from ..motion.arguments import checked_count
from ..motion.motion import Motion, as_motion
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


def keyframes_of(
    motion: Motion | int, every: int = 20, at: Sequence[int] | None = None
) -> Bool[np.ndarray, "T J"]:
    """The mask for a keyframe every `every` frames, or at the frames `at`: True where it is given.

    The first and the last frame are keyframes, too. Pass a motion, or its number of frames. Joints
    that a motion lacks (NaN) are not given. A frame without the pelvis is not given at all, and the
    nearest that has one takes its place: every=1 asks for the lost frames alone.
    Raises ValueError for every < 1, no frames, or a frame outside the motion, TypeError for
    anything but a motion or a number.
    """
    T = int(motion) if isinstance(motion, Integral) else len(as_motion(motion))
    checked_count(T, "a motion's number of frames")
    if at is None:
        made = keyframes(T, checked_count(every, "every"))
    else:
        for frame in at:
            if not isinstance(frame, Integral) or not 0 <= frame < T:
                raise ValueError(f"a keyframe at {frame!r:.40}: the motion has frames 0 to {T - 1}")
        made = known_frames(T, sorted({0, *map(int, at), T - 1}))
    if not isinstance(motion, Motion) or motion.skeleton != COURSE:
        return made
    there, wanted = np.flatnonzero(motion.known[:, HIPS]), np.flatnonzero(made.any(1))
    if not len(there):
        return np.zeros_like(made)
    nearest = there[np.abs(there - wanted[:, None]).argmin(1)]
    return known_frames(T, nearest.tolist()) & motion.known


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
