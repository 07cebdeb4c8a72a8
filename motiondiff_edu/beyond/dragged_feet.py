"""A foot that is dragged over the floor is lifted, and so takes a step.

A continuation that is blended into a walk brings each foot to where the walk has it, by decimetres
and at the floor; so does an in-between that is not sure when the foot steps. The foot lock leaves
such a foot alone, since it does not stand. Where both feet are dragged at once, the figure glides
and none is lifted: it would float.
Gain: docs/RESULTS.md, *On recordings* (`real.continuation_skating_mps` beside
`real.dragged.continuation_skating_mps`).
Source: the ankle's arc over a step; bones keep their lengths (`motion/inverse_kinematics.py`)
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from ..motion.directions import UP
from ..motion.inverse_kinematics import ankles_moved
from ..motion.planting import runs
from ..motion.skeleton import HEELS, TOES
from .foot_lock import free_legs

# a dragged toe is lower than this over the floor (m), faster than this (m/s), and goes so far (m)
LOW = 0.015
FAST = 0.2
FAR = 0.1
RISE = 0.15  # the height of a step, as a share of its length
LEAST, MOST = 0.03, 0.06  # metres


@dataclass(frozen=True, eq=False)
class Drag:
    """Frames in which a foot (0 left, 1 right) is dragged, and its way up to each (metres)."""

    side: int
    frames: slice
    way: Float[np.ndarray, " n"]


def lift_dragged_feet(
    positions: Float[np.ndarray, "T 21 3"],
    known: Bool[np.ndarray, "T 21"],
    fps: float = 20.0,
    floor: float = 0.0,
) -> Float[np.ndarray, "T 21 3"]:
    """Lift feet that are dragged over `floor` (metres, world, y up); feet keep their slope.

    Legs with a known joint stay as they are, and bones keep their lengths.
    """
    moved = np.array(positions, np.float64)
    found = list(drags(moved, known, fps, floor))
    dragged = np.zeros((len(moved), 2), bool)
    for drag in found:
        dragged[drag.frames, drag.side] = True
    for drag in found:
        if dragged[drag.frames, 1 - drag.side].any():
            continue
        toe, heel = TOES[drag.side], HEELS[drag.side]
        step = moved[drag.frames]
        height = np.clip(RISE * drag.way[-1], LEAST, MOST)
        height = floor + height * np.sin(np.pi * drag.way / drag.way[-1])
        up = np.maximum(height - step[:, toe, 1], 0)
        moved[drag.frames] = ankles_moved(step, heel, up[:, None] * UP)
    return moved


def drags(
    positions: Float[np.ndarray, "T 21 3"],
    known: Bool[np.ndarray, "T 21"],
    fps: float,
    floor: float,
) -> Iterator[Drag]:
    """Where feet that may be moved are low over the floor and fast, and go far."""
    for side, (toe, heel) in enumerate(zip(TOES, HEELS, strict=True)):
        at = positions[:, toe]
        moves = np.linalg.norm(np.diff(at[:, [0, 2]], axis=0), axis=-1)
        low = np.minimum(at[1:, 1], at[:-1, 1]) < floor + LOW
        dragged = low & (moves * fps > FAST)  # from a frame to the next
        frames = np.append(dragged, False) | np.append(False, dragged)
        for first, last in runs(frames & free_legs(known, heel, toe)):
            way = np.append(0.0, np.cumsum(moves[first : last - 1]))
            if way[-1] > FAR:
                yield Drag(side, slice(first, last), way)
