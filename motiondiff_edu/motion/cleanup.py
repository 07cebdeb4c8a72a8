"""Clean-up of generated motions: seam, bones, floor, feet, in this order, for every verb.

A network's joints are free points: bones stretch by centimetres, feet slide and sink into the
floor, and a continuation can jump where it begins. Each part is a function that moves generated
joints only. Scores of networks are taken before it. The numbers are of in-betweens of 35
recordings, a keyframe a second.

Seam: the difference to what is given, in each bone's direction and in the place of the pelvis, is
added to the generated frames and fades within a third of a second, or within longer where a joint
has far to go, at both ends of a gap. At keyframes the velocity changes by .32 m/s, without this by
.45; in the recordings by .34. In 47 continuations, without this, a joint steps 30 cm farther at the
seam than beside it.

Bones: generated joints are moved until every bone has the length that it has where it is given.
Hips and spine are fixed to one bone in a body, so their distances are kept, too (1.2 cm of error
without, .02 with it). With distances between neighbours alone, a spine that came out too short
would be folded like a ruler: so joints of the trunk that are two bones apart come no nearer to each
other than where they are given (.8 cm without, .04 with it).

Feet: each foot gets a path for its toe, and the leg follows it; bones keep their lengths.
    a toe that is low and slow stands: it stays at its median place, or where it is given
    between two stands the shift is interpolated, and the toe is lifted like that of a step
    a toe that is given twice at the same place, with a second between, has not left it
Planted toes slide by .06 m/s, without this by .40, without the lift by .13. Toes that have not left
their place are .8 cm from the truth, else 2.5 cm.
Source: inertialisation: Bollo (Game Developers Conference 2018), with vectors for quaternions;
position-based dynamics (Müller and others, 2007), distances only, with the aim of MoFusion eq. 6;
foot-skate cleanup (Kovar and others, 2002), shortened; the lift is ours.
"""

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import scipy
from jaxtyping import Bool, Float, Int

from .dance_frame import GROUND
from .directions import UP, plain_directions, positions_from, unit
from .inverse_kinematics import ankles_dragged
from .skeleton import BONE_LENGTHS, BONES, HEELS, HIPS, OFFSETS, PARENTS, TOES, joint_index

# ---- seam ----------------------------------------------------------------------------------------
SECONDS, LONGEST = 0.35, 1.5  # until the generated motion is on its own
PACE = 1.0  # m/s: the mean speed at which the joint that has farthest to go gets there


def blend_seams(
    positions: Float[np.ndarray, "T 21 3"], known: Bool[np.ndarray, "T 21"], fps: float
) -> Float[np.ndarray, "T 21 3"]:
    """Generated frames (metres, world) that join whole given frames without a jump.

    Only frames without any known joint are moved.
    """
    made, whole = np.array(positions, np.float64), np.all(known, axis=1)
    for first, last in runs(~np.any(known, axis=1)).tolist():
        new = made[first:last]
        if first > 1 and whole[first - 1]:
            new = continue_smoothly(positions[first - 2 : first], new, fps)
        if last < len(made) - 1 and whole[last]:
            new = continue_smoothly(positions[last : last + 2][::-1], new[::-1], fps)[::-1]
        made[first:last] = new
    return made


def continue_smoothly(
    past: Float[np.ndarray, "2 21 3"], new: Float[np.ndarray, "T 21 3"], fps: float
) -> Float[np.ndarray, "T 21 3"]:
    """`new` poses that go on from the given pose `past[1]` without a jump (metres)."""
    far = np.linalg.norm(new[0] - past[-1], axis=-1).max()
    n = min(len(new), round(float(np.clip(far / PACE, SECONDS, LONGEST)) * fps))
    if n < 2:
        return new
    bones, parents = plain_directions(new[:n]), PARENTS[1:]
    lengths = np.linalg.norm(new[:n, 1:] - new[:n, parents], axis=-1).T
    hips = new[:n, HIPS] + correction(past[:, HIPS], new[:n, HIPS])
    bones = unit(bones + correction(plain_directions(past), bones))
    return np.concatenate([positions_from(hips, bones, lengths), new[n:]])


def correction(
    past: Float[np.ndarray, "2 *J 3"], new: Float[np.ndarray, "n *J 3"]
) -> Float[np.ndarray, "n *J 3"]:
    """What to add to `new`, so that it goes on from the last frame of the past.

    It goes on by the mean of the steps before and after. So a motion of constant acceleration gets
    no offset.
    """
    before, after = past[1] - past[0], new[1] - new[0]
    step = (before + after) / 2
    return fade_out(past[1] + step - new[0], step - after, len(new))


def fade_out(
    offset: Float[np.ndarray, "*J 3"], speed: Float[np.ndarray, "*J 3"], n: int
) -> Float[np.ndarray, "n *J 3"]:
    """`offset` at frame 0, changing by `speed` a frame there; from frame n on it would be 0.

    A polynomial of degree five in the time; at frame n its first three derivatives are 0, too.
    """
    u = (np.arange(n) / n).reshape(-1, *[1] * offset.ndim)
    # (1 - u)^4 (offset + (4 offset + n speed) u): value and slope at 0, and four zeros at 1
    return (1 - u) ** 4 * (offset + (4 * offset + n * speed) * u)


# ---- bones ---------------------------------------------------------------------------------------
# rounds through all distances; errors of centimetres fall to a few mm at most, unless the given
# joints contradict the lengths
ROUNDS = 30

_LEFT, _RIGHT, _SPINE, _SPINE1, _NECK, _HEAD = map(
    joint_index, ("LeftUpLeg", "RightUpLeg", "Spine", "Spine1", "Neck1", "Head")
)
PELVIS = ((_LEFT, _RIGHT), (_LEFT, _SPINE), (_RIGHT, _SPINE))  # beside the bones from the pelvis
REST_PELVIS = np.array([np.linalg.norm(OFFSETS[b] - OFFSETS[a]) for a, b in PELVIS])
TRUNK = ((HIPS, _SPINE1), (_SPINE, _NECK), (_SPINE1, _HEAD))


@dataclass(frozen=True, eq=False)
class Body:
    """How long a body's parts are, in metres; NaN where nothing is known of one."""

    bones: Float[np.ndarray, "*B 20"]
    pelvis: Float[np.ndarray, "*B 3"]  # of PELVIS
    trunk: Float[np.ndarray, "*B 3"]  # of TRUNK; at least

    @classmethod
    def of(
        cls,
        positions: Float[np.ndarray, "*B T J 3"],
        known: Bool[np.ndarray, "*#B T J"] | None = None,
        bones: Float[np.ndarray, "20"] | None = None,
    ) -> "Body":
        """Medians over the frames that give both ends; in the trunk, the least.

        known  joints that are given (default: all)
        bones  the lengths of the bones, if they are known from elsewhere
        """
        if known is None:
            known = np.ones(positions.shape[:-1], bool)

        def distances(pairs, of_all):
            found = []
            for a, b in pairs:
                apart = np.linalg.norm(positions[..., b, :] - positions[..., a, :], axis=-1)
                given = np.broadcast_to(known[..., a] & known[..., b], apart.shape)
                shown = np.where(given, apart, np.nan)
                there = given.any(-1)
                one = np.full(there.shape, np.nan)
                one[there] = of_all(shown[there], axis=-1)
                found.append(one)
            return np.stack(found, -1)

        bones = distances(BONES, np.nanmedian) if bones is None else bones
        return cls(bones, distances(PELVIS, np.nanmedian), distances(TRUNK, np.nanmin))

    def completed(self) -> "Body":
        """The same, with unknown bones and pelvises as those of a course figure of the same size.

        Its size is the median over known bones; 1 where none is known.
        """
        shares = np.where(
            np.isnan(self.bones).all(-1, keepdims=True), 1.0, self.bones / BONE_LENGTHS
        )
        size = np.nanmedian(shares, axis=-1, keepdims=True)
        bones = np.where(np.isnan(self.bones), size * BONE_LENGTHS, self.bones)
        pelvis = np.where(np.isnan(self.pelvis), size * REST_PELVIS, self.pelvis)
        return replace(self, bones=bones, pelvis=pelvis)


def clean_bones(
    positions: Float[np.ndarray, "*B T J 3"], known: Bool[np.ndarray, "*#B T J"], body: Body
) -> Float[np.ndarray, "*B T J 3"]:
    """Move the joints that are not known (metres) until the body has these lengths.

    Each of ROUNDS rounds corrects one distance after the other. If both of its joints are free,
    each moves by half of the error; if one is known, the free joint moves by all of it. If known
    joints are farther apart than the bones reach, the remaining error is shared between the bones.
    """
    moved, free = np.array(positions, np.float64), (~known).astype(np.float64)
    wanted = [
        (*pair, length, most)
        for pairs, of, most in (
            (TRUNK, body.trunk, 0.0),  # these are not shortened
            (PELVIS, body.pelvis, np.inf),
            (BONES, body.bones, np.inf),
        )
        for pair, length in zip(pairs, np.moveaxis(of, -1, 0), strict=True)
    ]
    for _ in range(ROUNDS):
        for a, b, length, most in wanted:
            mobile = free[..., a] + free[..., b]
            if np.isnan(length).all() or not mobile.any():
                continue
            apart = moved[..., b, :] - moved[..., a, :]
            now = np.maximum(np.linalg.norm(apart, axis=-1), 1e-9)
            error = np.nan_to_num(1 - length[..., None] / now)  # positive: too far apart
            share = np.minimum(error, most) / np.maximum(mobile, 1.0)
            moved[..., a, :] += (free[..., a] * share)[..., None] * apart
            moved[..., b, :] -= (free[..., b] * share)[..., None] * apart
    return np.where(known[..., None], positions, moved)


# ---- floor and feet ------------------------------------------------------------------------------
# m above its floor, and m/s: a toe under both counts as standing, even if it slides. In small steps
# of dances a toe is lifted by 3 to 6 cm. Where the pelvis is faster than SLOW, a standing toe is
# one that is slower than the pelvis
LOW, SLOW = 0.025, 1.0
SMOOTH = 5  # frames that the speed of the pelvis is a mean of
FLOOR = 5  # percentile of a toe's height
FARTHEST = 0.5  # m: a foot that goes farther from its place glides, and is not held
SAME, SOON = 0.03, 45  # m, frames: a toe that is given twice so near, so soon, has not left
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
        moved[at] = ankles_dragged(moved[at], heel, moved[at, heel] + depth[at, None] * UP)
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
    moved, slow = np.array(positions, np.float64), slow_for(positions, fps)
    for toe, heel in zip(TOES, HEELS, strict=True):
        free, path = free_legs(known, heel, toe), kept_places(moved[:, toe], known[:, toe])
        standing = stands(path, fps, slow)
        by = toe_path(path, ~free, standing, floor) - moved[:, toe]
        at = free & by.any(1)
        moved[at] = ankles_dragged(moved[at], heel, moved[at, heel] + by[at])
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
        if near and last - first <= SOON:
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
        back = (standing_place(toe[first:last], given[first:last]) - toe[first:last]) * GROUND
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


def standing_place(
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


def runs(mask: Bool[np.ndarray, "N"]) -> Int[np.ndarray, "n 2"]:
    """First frame of every run of True, and the first frame after the run.  Notebook: 08"""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]]).astype(int)))
    return edges.reshape(-1, 2)


# ---- the whole -----------------------------------------------------------------------------------
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
