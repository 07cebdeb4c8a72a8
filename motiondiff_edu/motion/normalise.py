"""A figure from a BVH file in the course's terms: metres, y up, 20 frames/s, no T-pose, floor at 0.

The file states none of this; each rule derives it from the body or the motion.
Notebook: 00
"""

import warnings
from collections.abc import Mapping

import numpy as np
from jaxtyping import Float

from .directions import UP, has_our_bones, rotation_between, unit
from .formats.bvh import Bvh
from .formats.bvh.tokens import BvhError
from .motion import MotionWarning
from .skeleton import HEELS, JOINTS, TOES, joint_index

LEG = 0.835  # m, thigh plus shank of the course's figure
SLOW = 0.35  # m/s, a toe slower than this is taken as standing
STEEPEST = 0.06  # a larger slope of the floor is not a fault of the capture, and is kept
POINTED = 0.3  # feet with a smaller share of their length across the body point along it
FLIP_X = np.array([-1.0, 1.0, 1.0])  # positions seen in a mirror


def pick(
    world: Float[np.ndarray, "T N 3"], bvh: Bvh, mapping: Mapping[str, str]
) -> Float[np.ndarray, "T 21 3"]:
    """The course's 21 joints out of all nodes of a file; NaN where the file has no counterpart."""
    points = np.full((len(world), len(JOINTS), 3), np.nan)
    for joint, name in mapping.items():
        points[:, joint_index(joint)] = world[:, bvh.names.index(name)]
    return points


def leg_length(points: Float[np.ndarray, "T 21 3"]) -> float:
    """Median thigh plus shank, both sides averaged, in the unit of `points`."""
    thigh_shank = [np.linalg.norm(points[:, j] - points[:, j - 1], axis=-1) for j in (2, 3, 6, 7)]
    return float(np.median(thigh_shank, axis=1).sum() / 2)


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
    length = leg_length(points)
    if not length > 1e-9:
        raise BvhError(
            (
                "the legs have no length, so the unit of the file is unknown; "
                "check the mapping of UpLeg, Leg, Foot."
            ),
            source,
        )
    return points * (LEG / length), LEG / length


def up_axis(
    points: Float[np.ndarray, "T 21 3"], rest: Float[np.ndarray, "21 3"] | None = None
) -> str:
    """The axis along which the head is above the feet: "+y", "+z" and so on.

    The motion decides if the figure is upright for most of the clip, else the rest pose does, if
    there is one.
    """
    upright = np.median(body_axis(points), axis=0)
    if np.abs(upright).max() < 0.8 and rest is not None:
        upright = body_axis(rest[None])[0]
    axis = int(np.abs(upright).argmax())
    return "+-"[int(upright[axis] < 0)] + "xyz"[axis]


def body_axis(points: Float[np.ndarray, "T 21 3"]) -> Float[np.ndarray, "T 3"]:
    """Unit vector from the middle between the feet to the head."""
    axis = points[:, joint_index("Head")] - points[:, list(HEELS)].mean(1)
    return axis / np.linalg.norm(axis, axis=-1, keepdims=True)


def rotate_y_up(points: Float[np.ndarray, "... 3"], up: str) -> Float[np.ndarray, "... 3"]:
    """Rotate (never mirror) so that the axis `up` becomes +y."""
    sign = -1.0 if up[0] == "-" else 1.0
    first, second = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[up[1]]
    turned = points[..., [second, "xyz".index(up[1]), first]] * np.array([1.0, sign, sign])
    return turned


def unmirror(points: Float[np.ndarray, "T 21 3"]) -> tuple[Float[np.ndarray, "T 21 3"], bool]:
    """Reflect x when left and right are exchanged; also return whether that was so.

    The cross product left x up must point where the toes do, seen along the body. Frames in which
    the feet point straight down tell nothing.
    """
    left = points[:, joint_index("LeftUpLeg")] - points[:, joint_index("RightUpLeg")]
    up = body_axis(points)
    feet = (points[:, list(TOES)] - points[:, list(HEELS)]).sum(1)
    flat = feet - np.einsum("ti,ti->t", feet, up)[:, None] * up
    length = np.linalg.norm(flat, axis=-1)
    seen = length > POINTED * np.linalg.norm(feet, axis=-1)  # false where the toes are unknown
    ahead = np.cross(left, up)[seen]
    cosine = np.einsum("ti,ti->t", ahead, flat[seen]) / (
        np.linalg.norm(ahead, axis=-1) * length[seen]
    )
    if not seen.any() or not np.median(cosine) < -0.3:
        return points, False
    return points * FLIP_X, True


def calibration_frames(points: Float[np.ndarray, "T 21 3"]) -> int:
    """How many frames at the start are a calibration pose (a T-pose) and not motion.

    Such a pose ends with a jump: a joint moves more than 20 cm and five times its usual step.
    Jumps of more than 12 cm directly after it, a blend into the take, are counted too.
    """
    leap = np.nanmax(np.linalg.norm(np.diff(points[:40], axis=0), axis=-1), axis=1)
    usual = np.median(leap) if len(leap) > 3 else np.inf
    if not leap[:1].max(initial=0) > max(0.2, 5 * usual):
        return 0
    wild = leap > max(0.12, 5 * usual)
    return int(wild.argmin()) if not wild.all() else 1


def speed(points: Float[np.ndarray, "T ... 3"], fps: float) -> Float[np.ndarray, "T ..."]:
    """|p(t+1) - p(t-1)| fps / 2, one-sided at the ends."""
    return np.linalg.norm(np.gradient(points, 1 / fps, axis=0), axis=-1)


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
