"""Feet stay above the floor: a toe or an ankle under it is lifted, and the leg follows.

Generated and blended motions dip into the floor by centimetres. Bones keep their lengths, and given
joints stay where they are.
Gain: docs/RESULTS.md, *On recordings* (`real.continuation_floor_cm` beside
`real.unblended.continuation_floor_cm`).
Source: two bones and a distance form a triangle (`motion/inverse_kinematics.py`)
"""

import numpy as np
from jaxtyping import Bool, Float

from ..motion.directions import UP
from ..motion.inverse_kinematics import ankles_moved
from ..motion.skeleton import HEELS, TOES
from .foot_lock import free_legs


def feet_above_floor(
    positions: Float[np.ndarray, "T 21 3"],
    known: Bool[np.ndarray, "T 21"],
    floor: float = 0.0,
) -> Float[np.ndarray, "T 21 3"]:
    """Lift ankles and toes that are under `floor` (metres, world, y up); feet keep their slope."""
    moved = np.array(positions, np.float64)
    for toe, heel in zip(TOES, HEELS, strict=True):
        depth = floor - moved[:, [heel, toe], 1].min(1)
        at = free_legs(known, heel, toe) & (depth > 0)
        moved[at] = ankles_moved(moved[at], heel, depth[at, None] * UP)
    return moved


def lowest_given(positions: Float[np.ndarray, "T 21 3"], known: Bool[np.ndarray, "T 21"]) -> float:
    """The floor (metres): 0, or the lowest given joint if one is under it. Some joint is known."""
    return min(0.0, positions[known][:, 1].min())
