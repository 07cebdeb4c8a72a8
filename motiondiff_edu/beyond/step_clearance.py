"""Step clearance: a planted toe lies on the floor, and a swinging toe is lifted over it.

A network's toes are wrong by centimetres in height. A planted toe hovers, a swinging one passes at
the height of the floor, and the eye takes the lower one for the one that carries the figure: it
slides. Bones keep their lengths, and given joints stay where they are.
Gain: docs/RESULTS_ALL.md (`inbetween-departures.no-clearance.*`): feet slide a little
less, and errors are the same; the synthetic walks there have toes that are nearly right.
Source: ours; people lift a toe by some centimetres as soon as it leaves the floor.
"""

import numpy as np
from jaxtyping import Bool, Float

from ..motion.directions import UP
from ..motion.inverse_kinematics import ankles_moved
from ..motion.planting import runs
from ..motion.skeleton import HEELS, TOES
from .foot_lock import between_anchors, closeness, free_legs, slow_for, stands

NEAR = 0.03  # m: a standing toe so near to the floor is put on it
CLEARANCE = 0.03  # m that a toe is lifted in the middle of a step, at least
SHARE = 0.1  # of the length of the step, if that is less


def clear_steps(
    positions: Float[np.ndarray, "T 21 3"],
    known: Bool[np.ndarray, "T 21"],
    floor: float = 0.0,
    fps: float = 20.0,
) -> Float[np.ndarray, "T 21 3"]:
    """Planted toes at the height `floor`, swinging toes higher (metres, world, y up).

    Only toes that stand near the floor are moved to it: a figure can stand on something.
    """
    moved = np.array(positions, np.float64)
    for toe, heel in zip(TOES, HEELS, strict=True):
        free = free_legs(known, heel, toe)
        standing = stands(moved[:, toe], fps, slow_for(moved, fps))
        lift = height_over(moved[:, toe], standing, ~free, floor) - moved[:, toe, 1]
        at = free & (np.abs(lift) > 1e-9)
        moved[at] = ankles_moved(moved[at], heel, lift[at, None] * UP)
    return moved


def height_over(
    toe: Float[np.ndarray, "T 3"],
    standing: Bool[np.ndarray, " T"],
    given: Bool[np.ndarray, " T"],
    floor: float,
) -> Float[np.ndarray, " T"]:
    """The toe's height in every frame; where it is given, and near there, it is as it was."""
    standing = standing & (np.abs(toe[:, 1] - floor) < NEAR)
    pull = 1 - closeness(given)
    shift = np.where(standing, pull * (floor - toe[:, 1]), 0.0)
    height = toe[:, 1] + between_anchors(shift[:, None], standing | given)[:, 0]
    for first, last in runs(~standing):
        if first == 0 or last == len(toe):  # nobody knows where the step began, or ends
            continue
        u = (np.arange(first, last) - (first - 1)) / (last - first + 1)
        length = np.linalg.norm((toe[last] - toe[first - 1])[[0, 2]])
        least = min(CLEARANCE, SHARE * length) * np.sin(np.pi * u)
        over = np.maximum(height[first:last], floor + least)
        height[first:last] += pull[first:last] * (over - height[first:last])
    return height
