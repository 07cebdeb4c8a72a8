"""Where a generated motion leaves the one that it was made from: reach, speed, floor, seams.

A continuation that raises a hand which hung in all of the past invents a gesture; a foot that is
twice as fast as any of the given frames jumps, and so does one that goes far between a given and a
generated frame. Such a result may be right, but whoever made it should look. Heights and reaches
are about the pelvis, in the heading of the body, so that the way that the figure takes does not
matter.
Ours.
"""

import numpy as np
from jaxtyping import Bool, Float

from ..motion.root_frame import FPS, body_heading, forward_left
from ..motion.skeleton import HIPS, JOINTS, TOES, joint_index
from .keyframes import seam_step

Points = Float[np.ndarray, "T 21 3"]
Given = Float[np.ndarray, "N 21 3"]
ENDS = [joint_index(side + part) for side in ("Left", "Right") for part in ("Hand", "Foot")]
WAYS = ("above", "ahead of", "to the side of")  # of where the given motion has it
REACH = (0.3, 0.35, 0.35)  # metres, in these directions, before it is told
SPEED, FAST = 1.6, 4.0  # times the fastest of the given motion, and at least so many m/s
SECOND = 1.0  # s of a toe in neighbouring frames. Keyframes have less: then no speed is judged,
POSES = 1.5  # and the limit is so many times REACH
UNDER = 0.05  # metres: deeper than this a joint is in the floor
JUMP = 0.1  # metres in a frame; at keyframes a second apart recordings have 0.07 at most


def strays(made: Points, given: Given, new: Bool[np.ndarray, "T 21"] | None = None) -> list[str]:
    """Where a motion leaves the given one, in words, the worst of each kind; [] where it does not.

    new   True for what was generated (default: all); the rest is not judged
    """
    new = np.ones(made.shape[:2], bool) if new is None else new
    return [words for ask in (reach, speed, floor, seam) if (words := ask(made, given, new))]


def about_the_pelvis(points: Points) -> Points:
    """Up, ahead and aside (to either side) of the pelvis, in the heading of the body."""
    forward, left = forward_left(body_heading(points))
    own = points - points[:, HIPS][:, None]
    return np.stack(
        [
            own[..., 1],
            np.einsum("tjc,tc->tj", own, with_height(forward)),
            np.abs(np.einsum("tjc,tc->tj", own, with_height(left))),
        ],
        -1,
    )


def with_height(flat: Float[np.ndarray, "T 2"]) -> Float[np.ndarray, "T 3"]:
    """A direction on the ground as one in space."""
    return np.stack([flat[:, 0], 0 * flat[:, 0], flat[:, 1]], -1)


def has_steps(given: Given) -> bool:
    """Whether a hand or toe is given for a second in neighbouring frames; keyframes are poses."""
    ends = np.isfinite(given[:, list(ENDS)]).all(-1)
    return bool((ends[1:] & ends[:-1]).any(1).sum() >= SECOND * FPS)


def reach(made: Points, given: Given, new: Bool[np.ndarray, "T 21"]) -> str:
    """A hand or foot that goes much farther than in any given frame, a foot than either foot."""
    had = about_the_pelvis(given)[:, ENDS]
    most = np.where(np.isfinite(had), had, -np.inf).max(0)
    most[1::2] = most[1::2].max(0)  # keyframes as far apart as steps show each foot on one side
    limits = np.array(REACH) * (1 if has_steps(given) else POSES)
    beyond = about_the_pelvis(made)[:, ENDS] - most - limits
    judged = new[:, ENDS, None] & np.isfinite(beyond) & np.isfinite(most)
    beyond = np.where(judged, beyond, -np.inf)
    frame, joint, way = np.unravel_index(int(beyond.argmax()), beyond.shape)
    if not beyond[frame, joint, way] > 0:
        return ""
    far = 100 * (beyond[frame, joint, way] + limits[way])
    what = "a foot" if joint % 2 else "it"
    return (
        f"{JOINTS[ENDS[joint]]} goes {far:.0f} cm {WAYS[way]} where the given motion ever has "
        f"{what} ({frame / FPS:.1f} s)"
    )


def speed(made: Points, given: Given, new: Bool[np.ndarray, "T 21"]) -> str:
    """A joint that is much faster than any of the given motion, if that has steps."""
    if len(made) < 2 or not has_steps(given):
        return ""
    steps = np.linalg.norm(np.diff(made, axis=0), axis=-1) * FPS
    had = np.nanmax(np.linalg.norm(np.diff(given, axis=0), axis=-1)) * FPS
    steps = np.where((new[1:] | new[:-1]) & np.isfinite(steps), steps, 0.0)
    frame, joint = np.unravel_index(int(steps.argmax()), steps.shape)
    fastest = steps[frame, joint]
    if fastest < max(FAST, SPEED * had):
        return ""
    return (
        f"{JOINTS[joint]} moves at {fastest:.1f} m/s ({frame / FPS:.1f} s); the given motion has "
        f"{had:.1f} m/s at most"
    )


def floor(made: Points, given: Given, new: Bool[np.ndarray, "T 21"]) -> str:
    """A joint deep under the lowest one of the given motion, if that has a toe."""
    if not np.isfinite(given[:, list(TOES)]).any():
        return ""
    depth = np.nanmin(given[..., 1]) - made[..., 1]
    depth = np.where(new & np.isfinite(depth), depth, -np.inf)
    frame, joint = np.unravel_index(int(depth.argmax()), depth.shape)
    if depth[frame, joint] < UNDER:
        return ""
    return (
        f"{JOINTS[joint]} is {100 * depth[frame, joint]:.0f} cm under the lowest place of the "
        f"given motion ({frame / FPS:.1f} s)"
    )


def seam(made: Points, given: Given, new: Bool[np.ndarray, "T 21"]) -> str:
    """A joint that goes much farther from a given frame to a generated one than beside them."""
    changes = np.argwhere(new[1:] != new[:-1]).tolist()
    seams = [(last + 1, joint) for last, joint in changes if 1 <= last < len(made) - 2]
    jumps = [
        (seam_step(made[max(k - 4, 0) : k + 4, [joint]], min(k, 4)), k, joint) for k, joint in seams
    ]
    far, k, joint = max(jumps, default=(0.0, 0, 0))
    if far < JUMP:
        return ""
    return (
        f"{JOINTS[joint]} jumps by {100 * far:.0f} cm where given and generated frames meet "
        f"({k / FPS:.1f} s)"
    )
