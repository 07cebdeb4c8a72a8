"""What is asked of every motion that is read: is it a person, whole, on the floor, at its own rate?

Each question is answered in words, "" if nothing is wrong. They are asked of geometry alone: feet
that bear a body stand still, nobody floats for longer than a jump, bones keep their lengths, and
limbs swing neither like those of an insect nor as under water. Positions are in metres, y up.
"""

from collections.abc import Callable, Iterator

import numpy as np
import scipy
from jaxtyping import Bool, Float

from .cleanup import runs
from .skeleton import BONES, HEELS, HIPS, JOINTS, PARENTS, TOES, joint_index
from .upright import body_axis, ground_points, lowest

Points = Float[np.ndarray, "T 21 3"]
NECK = joint_index("Neck1")
UPLEGS = (1, 5)
ARMS = (13, 17)
ENDS_OF_LIMBS = [2, 4, 6, 8, 14, 15, 18, 19]  # knees, toes, elbows, wrists
NO_FEET = [j for j in range(1, 21) if j not in (*TOES, *HEELS)]

SWINGS = 0.6  # m/s against the hips: a foot that takes a step
SLIDES = 0.3  # m/s: no foot that bears a body is faster
WALKED = 0.7  # metres by the feet
PATH = 0.35  # so much of it the hips go at least
FLOATS = 0.12  # metres off the floor
JUMP = 1.2  # seconds: no jump lasts as long
CLIMBS = 0.1  # metres that a standing foot gains or loses in all
STRETCHED = 0.5  # of a bone
LONGER = 0.12  # metres: by so much no bone changes
COLLAPSED = 0.7  # of all bones together: less is no figure
FROZEN = 0.4  # seconds
HELD = 1e-4  # metres a frame
AWAY = 0.1  # metres that the body goes meanwhile
SMOOTH = 0.015  # seconds
FASTEST = 17.6  # rad/s: acceleration over velocity of limbs
SLOWEST = 8.0  # rad/s: jerk over acceleration
LEAST = 0.06  # metres: who moves less shows no pace
TILTED = 0.85  # of a unit vector along a body that stands
STEADY = 0.93  # the length of the mean of such vectors over time
UNBENT = -0.35  # cosine between trunk and legs: who never opens the hips so far does not stand


def speed(points: Float[np.ndarray, "T ... 3"], fps: float) -> Float[np.ndarray, "T ..."]:
    """|p(t+1) - p(t-1)| fps / 2, one-sided at the ends."""
    return np.linalg.norm(np.gradient(points, 1 / fps, axis=0), axis=-1)


def bone_lengths(points: Points) -> Float[np.ndarray, "T 20"]:
    """The length of each bone in each frame; NaN where a joint is missing."""
    return np.linalg.norm(np.diff(points[:, np.array(BONES)], axis=2)[:, :, 0], axis=-1)


def seconds(frames: np.ndarray, fps: float) -> str:
    """From the first to the last of some frames, in seconds."""
    return f"{frames[0] / fps:.1f} to {frames[-1] / fps:.1f} s"


def stretched_bones(points: Points, fps: float) -> str:
    """A joint that leaves its neighbours, as a marker that was lost or mistaken for another."""
    lengths = bone_lengths(points)
    there = np.flatnonzero(np.isfinite(lengths).any(0))
    lengths = lengths[:, there]
    usual = np.nanmedian(lengths, axis=0)
    bad = np.abs(lengths - usual) > np.maximum(LONGER, STRETCHED * usual)
    if not bad.any():
        return ""
    frames = np.flatnonzero(bad.any(1))
    parent, child = BONES[there[bad.sum(0).argmax()]]
    return (
        f"the bone from {JOINTS[parent]} to {JOINTS[child]} changes its length in {len(frames)} of "
        f"{len(points)} frames ({seconds(frames, fps)}): a marker lost or exchanged?"
    )


def held_joints(points: Points, fps: float) -> str:
    """A joint that stays in one place while the body goes on; a foot may stand."""
    still = np.linalg.norm(np.diff(points, axis=0), axis=-1) < HELD
    for joint in NO_FEET:
        for first, last in runs(still[:, joint]):
            part = points[first : last + 1, PARENTS[joint]]
            gone = np.linalg.norm(part - part[:1], axis=-1)
            if (last - first) / fps > FROZEN and np.nanmax(gone) > AWAY:
                when = seconds(np.array([first, last]), fps)
                return f"{JOINTS[joint]} stays where it is from {when}, while the body moves"
    return ""


def no_path(points: Points, fps: float) -> str:
    """Hips that stay behind the way that the feet walk, as where a file has rotations alone.

    The foot that is lower stands, and goes back against the hips as fast as they go ahead.
    """
    feet = ground_points(points)
    if np.isnan(feet).any() or len(points) < 3:
        return ""
    lower = feet[..., 1].argmin(1)[1:]
    against = np.diff(feet - points[:, :1], axis=0)[np.arange(len(lower)), lower]
    walked, gone = -np.cumsum(against, axis=0), points[1:, HIPS] - points[:1, HIPS]
    far, came = (np.linalg.norm(way[:, [0, 2]], axis=-1).max() for way in (walked, gone))
    if far < WALKED or came > PATH * far:
        return ""
    return (
        f"the feet walk {far:.1f} m, and the hips go {came:.1f} m: the file has no path of its own "
        "(joints seen from the hips, rotations alone, or a treadmill?)"
    )


def off_the_floor(points: Points, fps: float) -> str:
    """A figure that floats for longer than a jump, or a floor that rises under its feet."""
    feet = ground_points(points)
    if np.isnan(feet).any() or len(points) < 3:
        return ""
    rises = np.diff(feet[..., 1], axis=0)[speed(feet, fps)[1:] < SLIDES]
    gain = float(np.median(rises)) * len(points) if len(rises) else 0.0
    low = lowest(points)
    window = min(len(low), round(JUMP * fps))
    floor = scipy.ndimage.minimum_filter1d(low, max(1, window), mode="nearest")
    if np.ptp(floor) > FLOATS and abs(gain) > CLIMBS:
        way = "rises" if gain > 0 else "sinks"
        return f"the floor {way} by {100 * abs(gain):.0f} cm under feet that stand: does it drift?"
    return ""


def pace(points: Points, fps: float) -> str:
    """Limbs that swing as no person's do: the file is played too fast, or too slowly."""
    smooth = scipy.ndimage.gaussian_filter1d(np.nan_to_num(points), SMOOTH * fps, axis=0)
    limbs = (smooth - smooth[:, :1])[:, ENDS_OF_LIMBS]
    whole = np.nan_to_num((points - points[:, :1])[:, ENDS_OF_LIMBS])
    if len(points) < 20 or np.sqrt(np.mean((whole - whole.mean(0)) ** 2)) < LEAST:
        return ""
    change, sizes = limbs, []
    for _ in range(3):
        change = np.gradient(change, 1 / fps, axis=0)
        sizes.append(max(float(np.sqrt(np.mean(change**2))), 1e-9))
    velocity, acceleration, jerk = sizes
    fast, slow = acceleration / velocity > FASTEST, jerk / acceleration < SLOWEST
    if fast == slow:
        return ""
    what = "fast" if fast else "slowly"
    return f"the limbs move too {what} for a person at {fps:g} frames/s: is that the right rate?"


def tilted(points: Points, fps: float) -> str:
    """A figure that leans far to one side for most of the time."""
    along = np.nanmean(body_axis(points), axis=0)
    steady = float(np.linalg.norm(along))
    if steady < STEADY or not 0.3 < along[1] / steady < TILTED:
        return ""
    angle = np.degrees(np.arccos(along[1] / steady))
    return f"the figure leans by {angle:.0f} degrees in most frames: are its axes tilted?"


def crossed_arms(points: Points, fps: float) -> str:
    """Arms whose left is the right of the legs."""
    legs, arms = (points[:, a] - points[:, b] for a, b in (UPLEGS, ARMS))
    if not np.nanmedian(np.einsum("ti,ti->t", legs, arms)) < 0:
        return ""
    return "left and right of the arms are those of the legs exchanged: check the names of joints"


def no_person(points: Points, fps: float) -> str:
    """Hips that never open, as those of an animal on four legs."""
    trunk = points[:, NECK] - points[:, HIPS]
    legs = points[:, list(HEELS)].mean(1) - points[:, HIPS]
    sizes = np.linalg.norm(trunk, axis=-1) * np.linalg.norm(legs, axis=-1)
    bent = np.einsum("ti,ti->t", trunk, legs) / np.maximum(sizes, 1e-9)
    if not np.nanpercentile(bent, 5) > UNBENT:
        return ""
    return "trunk and legs are at a right angle in all frames: who sits throughout, or four legs?"


QUESTIONS: tuple[Callable[[Points, float], str], ...] = (
    no_person,
    tilted,
    crossed_arms,
    stretched_bones,
    held_joints,
    no_path,
    off_the_floor,
    pace,
)


def answers(points: Points, fps: float) -> Iterator[str]:
    """What is wrong with a motion, in words; of what is no person nothing else is asked."""
    for ask in QUESTIONS:
        if words := ask(points, fps):
            yield words
            if ask is no_person:
                return


def on_the_floor(points: Points, fps: float) -> float:
    """The share of frames in which a foot stands within 5 cm of the lowest place of the motion."""
    feet = ground_points(points)
    floor = np.nanpercentile(feet[..., 1], 2)
    stands = (speed(feet, fps) < SLIDES) & (feet[..., 1] < floor + 0.05)
    return float(stands.any(1).mean())


def collapsed(points: Points) -> Bool[np.ndarray, "T"]:
    """Frames whose bones, all together, are far too short for a figure."""
    whole = np.nansum(bone_lengths(points), axis=1)
    return whole < COLLAPSED * np.median(whole)
