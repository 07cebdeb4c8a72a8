"""Motion at other levels: the same walk or dance on bent knees, and leaning.

A network that has seen upright figures alone has no answer to one that crouches. Here the pelvis of
a motion goes down and comes up again in smooth waves, the trunk leans, and the feet stay where they
were: the knees make up for it.
"""

import numpy as np
import scipy
from jaxtyping import Float

from motiondiff_edu.motion.directions import UPLEGS, unit
from motiondiff_edu.motion.inverse_kinematics import pelvis_ahead
from motiondiff_edu.motion.planting import on_feet
from motiondiff_edu.motion.skeleton import HEELS, HIPS, J

LOWEST = 0.5  # m that the pelvis goes down, at most
LEAN = (-0.35, 1.2)  # radians, forward is positive
WAVES = (2.0, 8.0)  # seconds that a change of level takes
LEGS = [joint for heel in HEELS for joint in (heel - 2, heel - 1, heel, heel + 1)]


def at_levels(
    positions: Float[np.ndarray, "T 21 3"], rng: np.random.Generator, fps: float = 20.0
) -> Float[np.ndarray, "T 21 3"]:
    """The motion (metres, world) lower and leaning, in ways that are drawn.

    Toes and ankles stay where they were, and all bones keep their lengths.
    """
    drop = rng.uniform(0.1, LOWEST) * wave(len(positions), rng, fps)
    lean = rng.uniform(*LEAN) * wave(len(positions), rng, fps)
    moved = leaning(positions, lean)
    moved[..., 1] -= drop[:, None]
    return on_feet(moved, positions[:, list(HEELS)], positions, pelvis_ahead(positions))


def leaning(
    positions: Float[np.ndarray, "T 21 3"], lean: Float[np.ndarray, "T"]
) -> Float[np.ndarray, "T 21 3"]:
    """The motion with all but the legs turned forward about the hips, by `lean` radians."""
    across = unit(positions[:, UPLEGS[0]] - positions[:, UPLEGS[1]])
    turn = scipy.spatial.transform.Rotation.from_rotvec(lean[:, None] * across)
    upper = [joint for joint in range(J) if joint not in LEGS and joint != HIPS]
    moved, pelvis = np.array(positions, np.float64), positions[:, HIPS]
    for joint in upper:
        moved[:, joint] = pelvis + turn.apply(positions[:, joint] - pelvis)
    return moved


def wave(T: int, rng: np.random.Generator, fps: float) -> Float[np.ndarray, "{T}"]:
    """A smooth curve between 0 and 1: it goes from one drawn level to the next, and stays there."""
    times, levels = [-rng.uniform(0, WAVES[1])], [rng.uniform()]
    while times[-1] < T / fps:
        times += [times[-1] + rng.uniform(*WAVES), 0.0]
        times[-1] = times[-2] + rng.uniform(0, WAVES[0])
        levels += [rng.uniform()] * 2
    curve = scipy.interpolate.PchipInterpolator(times, levels)
    return curve(np.arange(T) / fps)
