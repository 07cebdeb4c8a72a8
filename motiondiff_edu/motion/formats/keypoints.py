"""Joints that are known by their names alone, as the keypoints of COCO, OpenPose or MediaPipe.

They have no hierarchy and no skeleton at rest. Hips and head that are missing follow from the
thighs, and from ears or nose; toes, hand tips and spine as for a BVH file (`directions.complete`).
"""

from collections import Counter
from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from ..motion import Motion, MotionError
from ..retarget import Figure, retarget_figure
from ..skeleton import JOINTS, joint_index
from .dialects import LIMBS, NEEDED, by_names, by_plain, unlike

# Joints that are the middle of others: the first of these groups that is there.
MIDDLES = {
    "Hips": (("lefthip", "righthip"), ("lhip", "rhip")),
    "Head": (("leftear", "rightear"), ("lear", "rear"), ("nose",)),
}


def motion_of_keypoints(
    points: Float[np.ndarray, "T N 3"],
    names: Sequence[str],
    fps: float,
    source: str = "",
    stated: str = "",
    up: str = "",
) -> Motion:
    """The course's figure that moves as these joints do, in metres at 20 frames/s.

    points   world positions in any unit, with any axis up
    names    of the N joints, in any of the usual spellings
    stated   the axis that points up by the format, such as "+z"
    up       the one that the user names; without it, it is found (`motion/upright.py`)
    Raises MotionError for joints that are missing, make no figure or have gaps, and BvhError for
    less than half a second.
    """
    if points.ndim != 3 or points.shape[1:] != (len(names), 3):
        raise MotionError(
            f"{source}: positions of {len(names)} named joints must be (frames, {len(names)}, 3), "
            f"not {points.shape}"
        )
    sources = sources_of(names, source)
    figure = np.full((len(points), len(JOINTS), 3), np.nan)
    for joint, of in sources.items():
        figure[:, joint_index(joint)] = points[:, [names.index(name) for name in of]].mean(1)
    _refuse_gaps(figure, sources, source)
    _refuse_points(figure, source)
    _refuse_no_figure(figure, sources, source)
    mapping = {joint: " + ".join(of) for joint, of in sources.items()}
    rate = "correct the `fps` of the file"
    found = Figure(figure, fps, None, source, stated, up, rate)
    clip = retarget_figure(found, {"mapping": mapping})
    return Motion.of_clip(clip, clip.info["start"])


def sources_of(names: Sequence[str], source: str = "") -> dict[str, tuple[str, ...]]:
    """{course joint: the names whose middle it is}.

    Raises MotionError, with all names, where a needed joint is missing or a name stands twice.
    """
    twice = next((name for name, count in Counter(names).items() if count > 1), None)
    if twice is not None:
        raise MotionError(f"{source}: {twice!r} stands twice in `names`; each joint needs its own")
    found: dict[str, tuple[str, ...]] = {joint: (name,) for joint, name in by_names(names).items()}
    bare = by_plain(names)
    for joint in MIDDLES.keys() - found.keys():
        groups = (group for group in MIDDLES[joint] if bare.keys() >= set(group))
        for group in list(groups)[:1]:
            found[joint] = tuple(bare[word] for word in group)
    lacking = [joint for joint in NEEDED if joint not in found]
    if lacking:
        raise MotionError(
            f"{source}: no joint found for {', '.join(lacking)}. The names are: "
            f"{', '.join(names)}. Rename them in `names`, for example to {lacking[0]}"
        )
    return found


def _refuse_gaps(figure: np.ndarray, sources: dict[str, tuple[str, ...]], source: str) -> None:
    for joint in NEEDED:
        gaps = np.flatnonzero(~np.isfinite(figure[:, joint_index(joint)]).all(-1))
        if len(gaps):
            raise MotionError(
                f"{source}: {' or '.join(sources[joint])} is missing in {len(gaps)} of "
                f"{len(figure)} frames, first in frame {gaps[0]}; cut them off, or fill them in "
                "the program that found the joints"
            )


def _refuse_points(figure: np.ndarray, source: str) -> None:
    """Raise MotionError for frames whose joints all lie in one place, as if they had been lost."""
    needed = figure[:, [joint_index(joint) for joint in NEEDED]]
    lost = np.flatnonzero(np.ptp(needed, axis=1).max(-1) == 0)
    if len(lost):
        raise MotionError(
            f"{source}: all joints are in one place in {len(lost)} of {len(figure)} frames, first "
            f"in frame {lost[0]}, as where a program writes zeros for a figure that it lost; cut "
            "them off, or fill them in that program"
        )


def _refuse_no_figure(figure: np.ndarray, sources: dict, source: str) -> None:
    names = {joint: of[0] for joint, of in sources.items()}
    for bones in LIMBS:
        ends = np.array([[joint_index(joint) for joint in bone] for bone in bones])
        apart = figure[:, ends[:, 0]] - figure[:, ends[:, 1]]
        lengths = np.median(np.linalg.norm(apart, axis=-1), axis=0).tolist()
        if words := unlike(bones, lengths, names):
            raise MotionError(f"{source}: the joints make no figure: {words}. Check `names`")
