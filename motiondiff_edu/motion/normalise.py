"""A figure from a BVH file in the course's terms: metres, y up, 20 frames/s, no T-pose, floor at 0.

The file states none of this; each rule derives it from the body or the motion.
Notebook: 00
"""

import warnings
from collections.abc import Mapping

import numpy as np
from jaxtyping import Float

from .cleanup import runs
from .directions import UP, has_our_bones, rotation_between, unit
from .faults import WILD
from .formats.bvh import Bvh
from .formats.bvh.tokens import BvhError
from .motion import MotionWarning
from .questions import SWINGS, collapsed, speed
from .skeleton import HEELS, JOINTS, TOES, joint_index
from .upright import body_axis, ground_points, leg_of

LEG = 0.835  # m, thigh plus shank of the course's figure
SLOW = 0.35  # m/s, a toe slower than this is taken as standing
STEEPEST = 0.06  # a larger slope of the floor is not a fault of the capture, and is kept
POINTED = 0.3  # feet with a smaller share of their length across the body point along it
BENT = 0.25  # of the width of the hips: so much both knees together stand out, where they bend
LEAP = 0.25  # metres a frame: a cut between two takes
BLEND = 0.12  # metres a frame, directly after a calibration pose
MOST_CUT = 0.6  # of a motion: a longer part is no calibration
# of units of the path and of the bones
FACTORS = (1000.0, 100.0, 39.37, 10.0, 2.54, 1 / 2.54, 0.1, 1 / 39.37, 0.01, 0.001)
FLIP_X = np.array([-1.0, 1.0, 1.0])  # positions seen in a mirror


def pick(
    world: Float[np.ndarray, "T N 3"], bvh: Bvh, mapping: Mapping[str, str]
) -> Float[np.ndarray, "T 21 3"]:
    """The course's 21 joints out of all nodes of a file; NaN where the file has no counterpart."""
    points = np.full((len(world), len(JOINTS), 3), np.nan)
    for joint, name in mapping.items():
        points[:, joint_index(joint)] = world[:, bvh.names.index(name)]
    return points


def to_metres(
    points: Float[np.ndarray, "T 21 3"], source: str = ""
) -> tuple[Float[np.ndarray, "T 21 3"], float]:
    """Scale so that thigh plus shank is 0.835 m; also return the metres per unit of the file.

    Files with the course's bones are in centimetres or metres exactly: another scale would move
    them about the origin.
    Raises BvhError for a figure without legs.
    Source: the height of the course's figure, 1.70 m.
    """
    for size in (0.01, 1.0):
        if has_our_bones(size * points):
            return size * points, size
    length = leg_of(points)
    if not length > 1e-9:
        raise BvhError(
            (
                "the legs have no length, so the unit of the file is unknown; "
                "check the mapping of UpLeg, Leg, Foot."
            ),
            source,
        )
    return points * (LEG / length), LEG / length


def unmirror(points: Float[np.ndarray, "T 21 3"]) -> tuple[Float[np.ndarray, "T 21 3"], bool]:
    """Reflect x when left and right are exchanged; also return whether that was so.

    The cross product left x up must point where the toes do, and where the knees bend. Frames in
    which the feet point straight down, or the knees are straight, tell nothing.
    """
    left = points[:, joint_index("LeftUpLeg")] - points[:, joint_index("RightUpLeg")]
    up = body_axis(points)
    ahead = np.cross(left, up)
    feet = (points[:, list(TOES)] - points[:, list(HEELS)]).sum(1)
    ends = points[:, list(HEELS)] + points[:, [heel - 2 for heel in HEELS]]
    knees = (points[:, [heel - 1 for heel in HEELS]] - ends / 2).sum(1)
    toes = cosine(ahead, feet, up, POINTED * np.linalg.norm(feet, axis=-1))
    bends = cosine(ahead, knees, up, BENT * np.linalg.norm(left, axis=-1))
    told = [one[np.isfinite(one)] for one in (toes, bends)]
    wrong = [bool(np.median(one) < -0.3) for one in told if len(one)]
    if not wrong or not all(wrong):
        return points, False
    return points * FLIP_X, True


def cosine(
    ahead: Float[np.ndarray, "T 3"],
    other: Float[np.ndarray, "T 3"],
    up: Float[np.ndarray, "T 3"],
    least: Float[np.ndarray, "T"],
) -> Float[np.ndarray, "T"]:
    """The cosine between two directions seen along the body; NaN where the second is too short."""
    flat = other - np.einsum("ti,ti->t", other, up)[:, None] * up
    length = np.linalg.norm(flat, axis=-1)
    sizes = np.linalg.norm(ahead, axis=-1) * length
    found = np.einsum("ti,ti->t", ahead, flat) / np.maximum(sizes, 1e-12)
    return np.where(length > least, found, np.nan)


def whole_take(points: Float[np.ndarray, "T 21 3"], fps: float) -> tuple[int, int, str]:
    """The first frame of the motion, the frame after its last, and in words what lies outside.

    That is a calibration pose (a T-pose) at the beginning and a figure that is lost at the end:
    frames that a jump of more than 25 cm, and six times the usual step, cuts off, in which nothing
    moves; and frames in which the joints have come together.
    """
    lost = collapsed(points)
    first, last = 0, len(points)
    if lost.any() and not lost.all():
        kept = max(runs(~lost), key=lambda run: run[1] - run[0])
        first, last = int(kept[0]), int(kept[1])
    part = points[first:last] - points[first:last, :1]
    steps = np.nanmax(np.linalg.norm(np.diff(part, axis=0), axis=-1), axis=1, initial=0.0)
    roots = np.linalg.norm(np.diff(points[first:last, 0], axis=0), axis=-1)
    steps = np.maximum(steps, roots / 2)
    usual = np.median(steps) if len(steps) > 3 else np.inf
    cuts = np.flatnonzero(steps > max(LEAP, 6 * usual, 0.8 * WILD / fps))
    begin, end = 0, len(part)
    for cut in cuts:
        if cut + 1 < MOST_CUT * len(part) and still(part[: cut + 1]):
            begin = max(begin, int(cut) + 1)
        elif len(part) - cut - 1 < MOST_CUT * len(part) and still(part[cut + 1 :]):
            end = min(end, int(cut) + 1)
    while 0 < begin < len(steps) and steps[begin] > max(BLEND, 5 * usual):
        begin += 1  # a blend into the take
    words = []
    if first + begin:
        words.append(f"{frames(0, first + begin)} a calibration pose, not part of the motion")
    if first + end < len(points):
        words.append(f"{frames(first + end, len(points))} a lost figure, not part of the motion")
    return first + begin, first + end, "; ".join(words)


def still(part: Float[np.ndarray, "T 21 3"]) -> bool:
    """Whether nothing moves, or there is hardly time for it."""
    return len(part) < 3 or bool(np.nanmax(np.ptp(part, axis=0)) < 0.06)


def frames(first: int, end: int) -> str:
    """Frames by number, with their verb."""
    if end - first == 1:
        return f"frame {first} is"
    return f"frames {first} to {end - 1} are"


def unit_of_path(points: Float[np.ndarray, "T 21 3"], fps: float) -> float:
    """By how much the path must be multiplied, so that feet stand; 1 where they do, or none helps.

    In some files the hips travel in another unit than that of the bones.
    """
    against = ground_points(points - points[:, :1])
    if np.isnan(against).any():
        return 1.0
    swing = speed(against, fps).max(1) > SWINGS
    if swing.mean() < 0.2 or np.ptp(points[:, 0], axis=0).max() < 1e-6:
        return 1.0

    def slides(factor: float) -> float:
        moved = points + (factor - 1) * (points[:, :1] - points[:1, :1])
        return float(np.median(speed(ground_points(moved), fps).min(1)[swing]))

    now = slides(1.0)
    best = min(FACTORS, key=slides)
    return best if now > 0.4 and slides(best) < 0.5 * now else 1.0


def floor_plane(toes: Float[np.ndarray, "T 2 3"], fps: float) -> Float[np.ndarray, "3"]:
    """The floor through the standing toes: (height at the origin, slope along x, slope along z).

    It is a least-squares fit, repeated without the points more than 3 cm above it, which are toes
    held still in the air.
    """
    stand = toes[speed(toes, fps) < SLOW]
    if len(stand) < 10:
        return np.array([np.percentile(toes[..., 1], 2), 0.0, 0.0])
    middle = stand.mean(0)
    for _ in range(6):
        x, z = (stand - middle)[:, [0, 2]].T
        design = np.stack([np.ones_like(x), x, z], 1)
        # a figure that stays in one place does not determine the slope
        ridge = np.diag([0.0, 0.01, 0.01]) * len(stand)
        plane = np.linalg.solve(design.T @ design + ridge, design.T @ stand[:, 1])
        above = stand[:, 1] - design @ plane
        keep = above < max(0.03, np.percentile(above, 50))
        if keep.all():
            break
        stand = stand[keep]
    if np.hypot(*plane[1:]) > STEEPEST:
        return np.array([np.percentile(stand[:, 1], 10), 0.0, 0.0])
    return np.array([plane[0] - plane[1:] @ middle[[0, 2]], *plane[1:]])


def level(
    points: Float[np.ndarray, "T 21 3"], plane: Float[np.ndarray, "3"]
) -> Float[np.ndarray, "T 21 3"]:
    """Turn and shift everything so that the plane becomes y = 0."""
    normal = unit(np.array([-plane[1], 1.0, -plane[2]]))
    return (points - np.array([0.0, plane[0], 0.0])) @ rotation_between(normal, UP).T


def warn(message: str, source: str, notes: list[str]) -> None:
    """Issue a MotionWarning, and add the message to the clip's notes."""
    warnings.warn(f"{source}: {message}", MotionWarning, stacklevel=2)
    notes.append(message)
