"""Motion with other poses: limbs turned, the pelvis turned, and the upper body of one motion on
another's legs.

Walks, dances and recordings hold their arms in a few ways, and synthetic ones hold their trunks
still. A network that has seen these alone generates them where a figure moves otherwise, and is
too sure of itself there.
"""

import numpy as np
import scipy
from jaxtyping import Float

from motiondiff_edu.motion.dance_frame import GROUND, Place, facing
from motiondiff_edu.motion.directions import UPLEGS, unit
from motiondiff_edu.motion.inverse_kinematics import descendants, pelvis_ahead
from motiondiff_edu.motion.planting import needed_drop, on_feet
from motiondiff_edu.motion.skeleton import HEELS, HIPS, J, joint_index

from .levels import LEGS, wave
from .warps import drawn

# radians, at most
TURNS = {
    "LeftArm": 2.5, "RightArm": 2.5, "LeftForeArm": 1.8, "RightForeArm": 1.8,
    "Spine": 1.5, "Neck1": 1.0,
}  # fmt: skip
PELVIS, SWAY = 1.2, 0.3  # radians and metres, at most
PACE = (0.2, 2.0)  # seconds from one turn to the next
UPPER = [joint for joint in range(J) if joint not in LEGS and joint != HIPS]
SPINE = joint_index("Spine")
CHEST = [joint for joint in UPPER if joint != SPINE]


def limbs_turned(
    positions: Float[np.ndarray, "T 21 3"], rng: np.random.Generator, fps: float = 20.0
) -> Float[np.ndarray, "T 21 3"]:
    """The motion (metres, world) with arms, trunk and head turned, by angles that come and go.

    Axes are fixed to the pelvis' heading. Bones keep their lengths, and the legs are as they were.
    """
    place = place_of(positions)
    moved = place.enter(positions[:, None])[:, 0]
    for name, most in TURNS.items():
        joint, turn = joint_index(name), drawn_turn(len(positions), most, rng, fps)
        for below in descendants(joint):
            moved[:, below] = moved[:, joint] + turn.apply(moved[:, below] - moved[:, joint])
    return place.leave(moved[:, None])[:, 0]


def pelvis_moved(
    positions: Float[np.ndarray, "T 21 3"], rng: np.random.Generator, fps: float = 20.0
) -> Float[np.ndarray, "T 21 3"]:
    """The motion (metres, world) with its pelvis turned, tilted and swaying, and all above it, too.

    Feet stay where they were, and bones keep their lengths: knees make up for it, and where a leg
    would have to be too long, the pelvis comes down.
    """
    place = place_of(positions)
    moved, home = (place.enter(positions[:, None])[:, 0] for _ in range(2))
    turn, pelvis = drawn_turn(len(moved), PELVIS, rng, fps), home[:, HIPS]
    for joint in (*UPLEGS, *UPPER):
        moved[:, joint] = pelvis + turn.apply(home[:, joint] - pelvis)
    moved += rng.uniform(0, SWAY) * drawn_swings(len(moved), rng, fps)[:, None]
    moved[..., 1] -= needed_drop(moved[:, list(UPLEGS)], home[:, list(HEELS)], fps)[:, None]
    moved = on_feet(moved, home[:, list(HEELS)], home, pelvis_ahead(moved))
    return place.leave(moved[:, None])[:, 0]


def drawn_turn(
    T: int, most: float, rng: np.random.Generator, fps: float
) -> scipy.spatial.transform.Rotation:
    """T turns about axes that move: a pose that is held for a while, and swings to and fro."""
    held = 0.6 * wave(T, rng, fps)[:, None] * unit(rng.normal(size=3))
    swings = wave(T, rng, fps)[:, None] * drawn_swings(T, rng, fps)
    vectors = rng.uniform(0, most, size=2) @ np.stack([held, swings], 1)
    return scipy.spatial.transform.Rotation.from_rotvec(vectors)


def drawn_swings(T: int, rng: np.random.Generator, fps: float) -> Float[np.ndarray, "{T} 3"]:
    """Three smooth curves between -1 and 1, which turn back at a pace of their own."""
    pace = drawn(*PACE, rng)
    times = np.cumsum([0.0, *rng.uniform(0.5 * pace, 1.5 * pace, size=int(2 * T / fps / pace) + 2)])
    turns = rng.uniform(-1, 1, size=(len(times), 3))
    return scipy.interpolate.PchipInterpolator(times, turns)(np.arange(T) / fps)


def with_upper_body_of(
    legs: Float[np.ndarray, "T 21 3"], upper: Float[np.ndarray, "U 21 3"]
) -> Float[np.ndarray, "T 21 3"]:
    """Pelvis and legs of one motion; chest, arms and head of another.

    The lowest joint of the spine belongs to the pelvis. Both face the way that the legs go. A
    shorter upper body goes there and back.
    """
    more = max(0, len(legs) - len(upper))
    upper = np.pad(upper, ((0, more), (0, 0), (0, 0)), mode="reflect")[: len(legs)]
    place = place_of(legs)
    moved = place.enter(legs[:, None])[:, 0]
    other = place_of(upper).enter(upper[:, None])[:, 0]
    moved[:, CHEST] = moved[:, SPINE, None] + other[:, CHEST] - other[:, SPINE, None]
    return place.leave(moved[:, None])[:, 0]


def place_of(positions: Float[np.ndarray, "T 21 3"]) -> Place:
    """A place for each frame, as if each were a motion: below the pelvis, facing as it does."""
    return Place(positions[:, HIPS] * GROUND, facing(positions))
