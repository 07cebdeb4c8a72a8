"""The size of a figure, and the same motion at another size.

Networks know figures of one size, the course's. A child that keeps its own size would float over
the floor in what they generate: its legs are too short for the height of the pelvis.
"""

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from .motion import Motion
from .planting import SHANK, THIGH
from .skeleton import PARENTS, joint_index

LEGS = [joint_index(f"{side}{part}") for side in ("Left", "Right") for part in ("Leg", "Foot")]
SAME = 1e-3  # a size that differs from 1 by less is 1


def leg_size(positions: Float[np.ndarray, "T 21 3"]) -> float:
    """How long the legs are, over those of the course's skeleton; missing joints do not count.

    Thigh and shank of both legs; the median over frames. 1 where no leg is given.
    """
    long = np.linalg.norm(positions[:, LEGS] - positions[:, PARENTS[LEGS]], axis=-1).sum(-1)
    if not np.isfinite(long).any():
        return 1.0
    size = float(np.nanmedian(long) / (2 * (THIGH + SHANK)))
    return 1.0 if abs(size - 1) < SAME else size


def resized(motion: Motion, factor: float) -> Motion:
    """The motion with all lengths times `factor`: a figure of another size, and its path."""
    root = None if motion.root is None else motion.root * [factor, factor, 1.0]
    return replace(motion, positions=factor * motion.positions, root=root)
