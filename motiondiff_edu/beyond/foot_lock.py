"""Foot lock: a generated toe that is low and slow is held in place, and the leg follows.

A network's feet slide by centimetres in each frame, and that is the first fault a viewer sees. Only
legs are moved, and no given joint. Leave the foot lock out for motions that glide on purpose.
Gain: docs/RESULTS.md, *In-betweens* (`inbetween-departures.no-feet.*`).
Source: foot-skate cleanup for motion capture (Kovar and others, 2002), shortened.
"""

import numpy as np
import scipy
from jaxtyping import Bool, Float

from ..motion.dance_frame import GROUND
from ..motion.inverse_kinematics import ankles_moved
from ..motion.planting import runs
from ..motion.skeleton import HEELS, HIPS, TOES

FADE = 6  # frames
# m above the floor, and m/s: a toe under both counts as standing, even if it slides; where the
# pelvis is faster, a standing toe is one that is slower than the pelvis
LOW, SLOW = 0.05, 1.0
SMOOTH = 5  # frames that the speed of the pelvis is a mean of
FLOOR = 5  # percentile of a toe's height


def steady_feet(
    positions: Float[np.ndarray, "*B T 21 3"],
    known: Bool[np.ndarray, "T 21"],
    fps: float = 20.0,
    farthest: float = np.inf,
    low: float = LOW,
) -> Float[np.ndarray, "*B T 21 3"]:
    """Move legs that are not known (metres, world) so that feet do not slide; bones keep lengths.

    A stand is a run of frames in which a toe is low and slow. During a stand the toe stays at its
    median place, or where it is given. Between stands the correction is interpolated smoothly; it
    is zero where the foot is given. An ankle out of the leg's reach slides as little as possible.
    A toe that slides farther than `farthest` metres from its place does not stand, but glides: it
    is not held, since a held foot would drag its leg out behind the body. A toe is low if it is
    less than `low` metres over its floor; in steps that are lifted less, the foot would be held.
    """
    every = np.array(positions, np.float64).reshape(-1, *positions.shape[-3:])
    for moved in every:
        for toe, heel in zip(TOES, HEELS, strict=True):
            free = free_legs(known, heel, toe)
            still = stands(moved[:, toe], fps, slow_for(moved, fps), low)
            shift = to_stands(moved[:, toe], ~free, still, farthest)
            at = free & shift.any(1)
            moved[at] = ankles_moved(moved[at], heel, shift[at])
    return np.where(known[..., None], positions, every.reshape(positions.shape))


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


def to_stands(
    toe: Float[np.ndarray, "T 3"],
    given: Bool[np.ndarray, " T"],
    still: Bool[np.ndarray, " T"],
    farthest: float = np.inf,
) -> Float[np.ndarray, "T 3"]:
    """The shift that stops a toe from sliding while it stands (`still`); zero where it is given."""
    shift = np.zeros_like(toe)
    anchored = given.copy()
    for first, last in runs(still):
        inside = np.flatnonzero(given[first:last]) + first
        if len(inside):  # at the given places; linear between them if they differ
            pin = np.stack(
                [np.interp(np.arange(first, last), inside, toe[inside, k]) for k in range(3)], -1
            )
        else:
            pin = np.median(toe[first:last], axis=0)
        # only the horizontal movement is stopped; the foot still rolls up and down
        back = (pin - toe[first:last]) * GROUND
        if np.linalg.norm(back, axis=-1).max() > farthest:
            continue
        begin = max(0, first - FADE)  # what is given farther away does not matter
        near = given[begin : last + FADE].copy()
        near[first - begin : last - begin] = False
        pull = 1 - closeness(near)[first - begin : last - begin]
        shift[first:last] = pull[:, None] * back
        anchored[first:last] = True
    return between_anchors(shift, anchored)


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


def closeness(given: Bool[np.ndarray, " T"]) -> Float[np.ndarray, " T"]:
    """1 in given frames, 0 from `FADE` frames away, and smooth between.

    It lets a corrected foot move smoothly to where it is given next.
    """
    away = (
        scipy.ndimage.distance_transform_edt(~given) if given.any() else np.full(len(given), np.inf)
    )
    u = np.minimum(away / FADE, 1)
    return 1 - (3 * u**2 - 2 * u**3)


def stands(
    toe: Float[np.ndarray, "T 3"],
    fps: float,
    slow: float | Float[np.ndarray, " T"] = SLOW,
    low: float = LOW,
) -> Bool[np.ndarray, " T"]:
    """Frames in which a toe is low, and slow over the ground to the next or from the last frame.

    Runs have at least two frames.
    """
    ground = np.linalg.norm(np.diff(toe[:, [0, 2]], axis=0), axis=-1) * fps
    still = np.minimum(np.append(ground, np.inf), np.append(np.inf, ground)) < slow
    found = still & (toe[:, 1] < np.percentile(toe[:, 1], FLOOR) + low)
    return found & (np.append(found[1:], False) | np.append(False, found[:-1]))
