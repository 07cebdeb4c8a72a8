"""Clean-up of generated motions: seam, bones, floor, feet, in this order, for every verb.

A network's joints are free points: bones stretch by centimetres, feet slide and sink into the
floor, and a continuation can jump where it begins. Each part is a function that moves generated
joints only. Scores of networks are taken before it.
"""

import numpy as np
from jaxtyping import Bool, Float

from .bones import Body, clean_bones
from .feet import lift_to_floor, lock_feet
from .seam import blend_seams


def clean_up(
    positions: Float[np.ndarray, "T 21 3"],
    fps: float,
    known: Bool[np.ndarray, "T 21"] | None = None,
    *,
    body: Body | None = None,
    floor: float | None = None,
) -> Float[np.ndarray, "T 21 3"]:
    """A generated motion (metres, world, y up) with constant bones and feet that stand.

    known  joints that are given; they stay where they are, bit by bit (default: none)
    body   the lengths of its parts (default: as they are given, or else this motion's medians)
    floor  the height of the floor (default: `floor_under` what is given, or else 0)
    """
    if known is None:
        known = np.zeros(positions.shape[:-1], bool)
    given = known if known.any() else ~known
    body = Body.of(positions, given) if body is None else body
    if floor is None:
        floor = floor_under(positions, known) if known.any() else 0.0
    made = blend_seams(positions, known, fps)
    made = clean_bones(made, known, body.completed())
    made = lift_to_floor(made, known, floor)
    return lock_feet(made, known, fps, floor)


def floor_under(
    positions: Float[np.ndarray, "T 21 3"], known: Bool[np.ndarray, "T 21"] | None = None
) -> float:
    """The height of the floor (metres): 0, or the lowest given joint if one is lower.

    Without `known` every joint is given.
    """
    given = positions if known is None else positions[known]
    return min(0.0, float(given[..., 1].min()))
