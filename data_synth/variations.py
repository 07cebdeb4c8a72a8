"""Motion with other poses: limbs turned aside, and the upper body of one motion on another's legs.

Walks, dances and recordings hold their arms in a few ways. A network that has seen these alone
generates them where a figure holds its arms otherwise.
"""

import numpy as np
import scipy
from jaxtyping import Float

from motiondiff_edu.motion.dance_frame import GROUND, Place, facing
from motiondiff_edu.motion.directions import unit
from motiondiff_edu.motion.skeleton import HIPS, PARENTS, J, joint_index

from .levels import LEGS, wave

TURNS = {"LeftArm": 1.4, "RightArm": 1.4, "Spine": 0.4, "Neck1": 0.4}  # radians, at most
UPPER = [joint for joint in range(J) if joint not in LEGS and joint != HIPS]


def limbs_turned(
    positions: Float[np.ndarray, "T 21 3"], rng: np.random.Generator, fps: float = 20.0
) -> Float[np.ndarray, "T 21 3"]:
    """The motion (metres, world) with arms, trunk and head turned, by angles that come and go.

    Each limb has an axis of its own, fixed to the pelvis' heading. Bones keep their lengths, and
    the legs are as they were.
    """
    place = place_of(positions)
    moved = place.enter(positions[:, None])[:, 0]
    for name, most in TURNS.items():
        joint = joint_index(name)
        angle = rng.uniform(0, most) * wave(len(positions), rng, fps)
        axis = unit(rng.normal(size=3))
        turn = scipy.spatial.transform.Rotation.from_rotvec(angle[:, None] * axis)
        for below in below_of(joint):
            moved[:, below] = moved[:, joint] + turn.apply(moved[:, below] - moved[:, joint])
    return place.leave(moved[:, None])[:, 0]


def with_upper_body_of(
    legs: Float[np.ndarray, "T 21 3"], upper: Float[np.ndarray, "U 21 3"]
) -> Float[np.ndarray, "T 21 3"]:
    """Pelvis and legs of one motion, trunk, arms and head of another.

    Both face the way that the legs go. A shorter upper body goes there and back.
    """
    more = max(0, len(legs) - len(upper))
    upper = np.pad(upper, ((0, more), (0, 0), (0, 0)), mode="reflect")[: len(legs)]
    place = place_of(legs)
    moved = place.enter(legs[:, None])[:, 0]
    other = place_of(upper).enter(upper[:, None])[:, 0]
    moved[:, UPPER] = moved[:, HIPS, None] + other[:, UPPER] - other[:, HIPS, None]
    return place.leave(moved[:, None])[:, 0]


def place_of(positions: Float[np.ndarray, "T 21 3"]) -> Place:
    """A place for each frame, as if each were a motion: below the pelvis, facing as it does."""
    return Place(positions[:, HIPS] * GROUND, facing(positions))


def below_of(joint: int) -> list[int]:
    """All joints that hang on this one."""
    found = [joint]
    for other in range(joint + 1, J):
        if PARENTS[other] in found:
            found.append(other)
    return found[1:]
