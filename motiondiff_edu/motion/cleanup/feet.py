"""Foot lock: a standing toe is held in place, a stepping toe passes over the floor.

A network's feet slide by centimetres in each frame, and that is the first fault a viewer sees. Each
foot gets a path for its toe, and the leg follows it; bones keep their lengths.

    a toe that is low and slow stands: it stays at its median place, or where it is given
    between two stands the shift is interpolated, and the toe is lifted like that of a step
    a toe that is given twice at the same place, with a second between, has not left it
In-betweens of recordings, a keyframe a second: planted toes slide by .06 m/s, without this by .40,
without the lift by .13. Toes that have not left their place are .8 cm from the truth, else 2.5 cm.
Source: foot-skate cleanup for motion capture (Kovar and others, 2002), shortened; the lift is ours.
"""

from itertools import pairwise

import numpy as np
import scipy
from jaxtyping import Bool, Float

from ..dance_frame import GROUND
from ..directions import UP
from ..inverse_kinematics import ankles_moved
from ..planting import runs
from ..skeleton import HEELS, HIPS, TOES

# m above its floor, and m/s: a toe under both counts as standing, even if it slides. In small steps
# of dances a toe is lifted by 3 to 6 cm. Where the pelvis is faster than SLOW, a standing toe is
# one that is slower than the pelvis
LOW, SLOW = 0.025, 1.0
SMOOTH = 5  # frames that the speed of the pelvis is a mean of
FLOOR = 5  # percentile of a toe's height
FARTHEST = 0.5  # m: a foot that goes farther from its place glides, and is not held
SAME, LONGEST = 0.03, 45  # m, frames: a toe that is given twice so near, so soon, has not left
CLEARANCE, SHARE = 0.05, 0.1  # m in the middle of a step, or this share of its length if less


def lift_to_floor(
    positions: Float[np.ndarray, "T 21 3"], known: Bool[np.ndarray, "T 21"], floor: float = 0.0
) -> Float[np.ndarray, "T 21 3"]:
    """Lift ankles and toes that are under `floor` (metres, world, y up); feet keep their slope.

    Legs with a known joint stay as they are.
    """
    moved = np.array(positions, np.float64)
    for toe, heel in zip(TOES, HEELS, strict=True):
        depth = floor - moved[:, [heel, toe], 1].min(1)
        at = free_legs(known, heel, toe) & (depth > 0)
        moved[at] = ankles_moved(moved[at], heel, depth[at, None] * UP)
    return moved


def lock_feet(
    positions: Float[np.ndarray, "T 21 3"],
    known: Bool[np.ndarray, "T 21"],
    fps: float,
    floor: float = 0.0,
) -> Float[np.ndarray, "T 21 3"]:
    """Move legs without a known joint (metres, world, y up) so that standing feet do not slide.

    An ankle out of the leg's reach slides as little as possible.
    """
    moved = np.array(positions, np.float64)
    for toe, heel in zip(TOES, HEELS, strict=True):
        free, path = free_legs(known, heel, toe), kept_places(moved[:, toe], known[:, toe])
        standing = stands(path, fps, slow_for(moved, fps))
        by = toe_path(path, ~free, standing, floor) - moved[:, toe]
        at = free & by.any(1)
        moved[at] = ankles_moved(moved[at], heel, by[at])
    return moved


def free_legs(known: Bool[np.ndarray, "T 21"], heel: int, toe: int) -> Bool[np.ndarray, " T"]:
    """Frames in which knee, ankle and toe may be moved, since none of them is known."""
    return ~np.any(known[:, [heel - 1, heel, toe]], axis=1)


def slow_for(positions: Float[np.ndarray, "T 21 3"], fps: float) -> Float[np.ndarray, " T"]:
    """The speed (m/s) under which a toe counts as standing: SLOW, or that of the pelvis."""
    if len(positions) < 2:
        return np.full(len(positions), SLOW)
    pelvis = np.linalg.norm(np.diff(positions[:, HIPS] * GROUND, axis=0), axis=-1) * fps
    smooth = scipy.ndimage.uniform_filter1d(pelvis, SMOOTH, mode="nearest")
    return np.maximum(SLOW, np.append(smooth, smooth[-1]))


def stands(
    toe: Float[np.ndarray, "T 3"], fps: float, slow: float | Float[np.ndarray, " T"] = SLOW
) -> Bool[np.ndarray, " T"]:
    """Frames in which a toe is low, and slow over the ground to the next or from the last frame.

    Runs have at least two frames.
    """
    ground = np.linalg.norm(np.diff(toe[:, [0, 2]], axis=0), axis=-1) * fps
    still = np.minimum(np.append(ground, np.inf), np.append(np.inf, ground)) < slow
    found = still & (toe[:, 1] < np.percentile(toe[:, 1], FLOOR) + LOW)
    return found & (np.append(found[1:], False) | np.append(False, found[:-1]))


def kept_places(
    toe: Float[np.ndarray, "T 3"], known: Bool[np.ndarray, " T"]
) -> Float[np.ndarray, "T 3"]:
    """The toe's path (metres), on a line between frames that give it at nearly the same place.

    In recordings such a toe has been elsewhere between in two of a hundred seconds.
    """
    path = np.array(toe)
    for first, last in pairwise(np.flatnonzero(known)):
        near = np.linalg.norm(toe[last] - toe[first]) < SAME
        if near and last - first <= LONGEST:
            path[first : last + 1] = np.linspace(toe[first], toe[last], last - first + 1)
    return path


def toe_path(
    toe: Float[np.ndarray, "T 3"],
    given: Bool[np.ndarray, " T"],
    standing: Bool[np.ndarray, " T"],
    floor: float = 0.0,
) -> Float[np.ndarray, "T 3"]:
    """The toe's path (metres), with stands that do not slide and steps that clear the floor.

    Where the toe is `given` the path is as it was.
    """
    shift, anchored = np.zeros_like(toe), given.copy()
    for first, last in runs(standing):
        back = (place_of(toe[first:last], given[first:last]) - toe[first:last]) * GROUND
        if np.linalg.norm(back, axis=-1).max() > FARTHEST:
            continue
        shift[first:last] = back
        anchored[first:last] = True
    path = toe + between_anchors(shift, anchored)
    for first, last in runs(~anchored):
        if first == 0 or last == len(toe):  # where the step begins, or ends, is not known
            continue
        u = (np.arange(first, last) - (first - 1)) / (last - first + 1)
        length = np.linalg.norm((path[last] - path[first - 1]) * GROUND)
        least = floor + min(CLEARANCE, SHARE * length) * np.sin(np.pi * u)
        path[first:last, 1] = np.maximum(path[first:last, 1], least)
    return path


def place_of(
    toe: Float[np.ndarray, "n 3"], given: Bool[np.ndarray, " n"]
) -> Float[np.ndarray, "#n 3"]:
    """Where a standing toe stays: its median place, or lines between the given places."""
    at = np.flatnonzero(given)
    if not len(at):
        return np.median(toe, axis=0, keepdims=True)
    return np.stack([np.interp(np.arange(len(toe)), at, toe[at, k]) for k in range(3)], -1)


def between_anchors(
    shift: Float[np.ndarray, "T D"], anchored: Bool[np.ndarray, " T"]
) -> Float[np.ndarray, "T D"]:
    """The shift of the anchored frames, and smoothly from each to the next between them."""
    at, frames = np.flatnonzero(anchored), np.arange(len(shift))
    if not len(at):
        return shift
    before = at[np.clip(np.searchsorted(at, frames, "right") - 1, 0, None)]
    after = at[np.clip(np.searchsorted(at, frames, "left"), None, len(at) - 1)]
    u = np.clip((frames - before) / np.maximum(after - before, 1), 0, 1)[:, None]
    return shift[before] + (shift[after] - shift[before]) * (3 * u**2 - 2 * u**3)
