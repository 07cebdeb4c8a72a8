"""Is a generated motion plausible beside what was given?

The network of the in-betweens has seen synthetic walks and dances. On other motions it can fail
badly: the figure jumps by metres between keyframes that are close together.
"""

import numpy as np
from jaxtyping import Bool, Float

from ..motion.root_frame import FPS
from ..motion.skeleton import HIPS

FACTOR, SLACK = 3.0, 1.0  # the pelvis may be so many times, plus m/s, as fast as is needed
FASTEST = 15.0  # m/s: no joint of an actor is faster


def wilder_than_given(
    made: Float[np.ndarray, "samples T J 3"],
    given: Float[np.ndarray, "T J 3"],
    known: Bool[np.ndarray, "T J"],
) -> str:
    """What is not plausible about generated motions, in words; "" if nothing was found.

    Between two frames with a known pelvis, the given motion asks for a speed: the distance over the
    time. A pelvis that moves much faster is not plausible, nor is a joint faster than any actor's.
    Frames before the first and after the last known pelvis are not judged by this speed.
    """
    there = np.flatnonzero(known[:, HIPS])
    paces = FPS * np.linalg.norm(np.diff(made[:, :, HIPS], axis=1), axis=-1).max(0)
    found = []
    for first, last in zip(there[:-1], there[1:], strict=True):
        if last - first < 2:
            continue
        asked = FPS * np.linalg.norm(given[last, HIPS] - given[first, HIPS]) / (last - first)
        pace = paces[first:last].max()
        if pace > FACTOR * asked + SLACK:
            found.append((pace, asked, first, last))
    if found:
        pace, asked, first, last = max(found)
        return (
            f"the generated figure moves at up to {pace:.1f} m/s between frames {first} and {last},"
            f" where {asked:.1f} m/s would do ({len(found)} such gaps). The network knows walks and"
            f" dances, and this motion may be too different"
        )
    joints = FPS * np.linalg.norm(np.diff(made, axis=1), axis=-1)
    joints = np.where((known[1:] & known[:-1])[None], 0.0, joints)
    if joints.size and joints.max() > FASTEST:
        frame = int(np.unravel_index(joints.argmax(), joints.shape)[1])
        return (
            f"a generated joint moves at {joints.max():.0f} m/s near frame {frame}, faster than any"
            f" actor's"
        )
    return ""
