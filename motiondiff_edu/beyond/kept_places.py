"""Feet that are given twice at the same place stay there in between.

A toe that is in the same place (SAME) in two keyframes a second apart has hardly ever left it: in
the recordings of training, by more than 10 cm in two of a hundred such seconds. A network that
knows walking makes it step nevertheless. So the toe keeps its place, the ankle follows, and the
knee bends. Given joints stay where they are.
Gain: docs/RESULTS_ALL.md (`inbetween-departures.no-feet.*`, with the foot lock).
Source: ours.
"""

from itertools import pairwise

import numpy as np
from jaxtyping import Bool, Float

from ..motion.inverse_kinematics import ankles_moved
from ..motion.skeleton import HEELS, TOES
from .foot_lock import free_legs

SAME = 0.03  # m
LONGEST = 45  # frames; in three seconds one of five has been elsewhere


def kept_places(
    positions: Float[np.ndarray, "*B T 21 3"],
    given: Float[np.ndarray, "T 21 3"],
    known: Bool[np.ndarray, "T 21"],
) -> Float[np.ndarray, "*B T 21 3"]:
    """Generated motions (metres, world) whose feet keep the places that they are given twice."""
    every = np.array(positions, np.float64).reshape(-1, *positions.shape[-3:])
    for toe, heel in zip(TOES, HEELS, strict=True):
        place, stays = lines_between_plants(given[:, toe], known[:, toe])
        at = stays & free_legs(known, heel, toe)
        for moved in every if at.any() else ():
            moved[at] = ankles_moved(moved[at], heel, place[at] - moved[at, toe])
    return np.where(known[..., None], positions, every.reshape(positions.shape))


def lines_between_plants(
    toe: Float[np.ndarray, "T 3"], known: Bool[np.ndarray, " T"]
) -> tuple[Float[np.ndarray, "T 3"], Bool[np.ndarray, " T"]]:
    """Where the toe stays, and in which frames: between given ones at nearly the same place."""
    place, stays = np.zeros_like(toe), np.zeros(len(toe), bool)
    for first, last in pairwise(np.flatnonzero(known)):
        near = np.linalg.norm(toe[last] - toe[first]) < SAME
        if 1 < last - first <= LONGEST and near:
            share = np.linspace(0, 1, last - first + 1)[:, None]
            place[first : last + 1] = (1 - share) * toe[first] + share * toe[last]
            stays[first + 1 : last] = True
    return place, stays
