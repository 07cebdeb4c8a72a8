"""Feet that stay where they stand: contacts, pinned toes, and two-bone inverse kinematics."""

import numpy as np
import scipy
from jaxtyping import Bool, Float

from .cleanup import between_anchors, runs
from .dance_frame import GROUND
from .directions import unit
from .inverse_kinematics import pelvis_ahead, perpendicular, triangle
from .questions import speed
from .skeleton import BONE_LENGTHS, HEELS, TOES

THIGH, SHANK = float(BONE_LENGTHS[1]), float(BONE_LENGTHS[2])
REACH = 0.9995 * (THIGH + SHANK)
LOW, STILL = 0.04, 0.4  # m and m/s: a toe lower and slower than this is planted


def find_contacts(toes: Float[np.ndarray, "T 2 3"], fps: float) -> Bool[np.ndarray, "T 2"]:
    """Toes that are low and slow; gaps and contacts of a single frame are removed."""
    contact = (toes[..., 1] < LOW) & (speed(toes, fps) < STILL)
    for value in (False, True):  # first fill single gaps, then drop single contacts
        alone = (contact[1:-1] == value) & (contact[:-2] != value) & (contact[2:] != value)
        contact[1:-1][alone] = not value
    return contact


def flat_feet(points: Float[np.ndarray, "T 21 3"], fps: float) -> Bool[np.ndarray, "T 2"]:
    """Feet whose toe and ankle both stand still: the sole lies on the floor."""
    toes, heels = points[:, list(TOES)], points[:, list(HEELS)]
    return (speed(toes, fps) < 0.3) & (speed(heels, fps) < 0.3) & (toes[..., 1] < 2 * LOW)


def shift_to_pins(
    toe: Float[np.ndarray, "T 3"], contact: Bool[np.ndarray, " T"]
) -> Float[np.ndarray, "T 3"]:
    """The shift that keeps a toe on one point of the floor during each contact.

    Between two contacts it changes smoothly. Before the first and after the last it is constant.
    """
    shift = np.zeros_like(toe)
    for first, last in runs(contact).tolist():
        shift[first:last] = np.median(toe[first:last], axis=0) * GROUND - toe[first:last]
    return between_anchors(shift, contact)


def plant(
    world: Float[np.ndarray, "T 21 3"], contacts: Bool[np.ndarray, "T 2"], fps: float
) -> Float[np.ndarray, "T 21 3"]:
    """Move the toes to their pinned places and keep every bone length.

    The body follows the mean shift of both feet; the legs bend to make up the rest. Between
    contacts no toe goes below the floor. Where a leg would have to be too long, the hips come down.
    """
    shift = np.stack(
        [shift_to_pins(world[:, toe], contacts[:, side]) for side, toe in enumerate(TOES)], axis=1
    )
    lifted = np.maximum(world[:, list(TOES), 1] + shift[..., 1], 0)
    shift[..., 1] = lifted - world[:, list(TOES), 1]
    ankles = world[:, list(HEELS)] + shift
    body = scipy.ndimage.gaussian_filter1d(shift.mean(1), 0.15 * fps, axis=0, mode="nearest")
    moved = world + body[:, None]
    moved[..., 1] -= needed_drop(moved[:, [1, 5]], ankles, fps)[:, None]
    return on_feet(moved, ankles, world, pelvis_ahead(world))


def on_feet(
    moved: Float[np.ndarray, "T 21 3"],
    ankles: Float[np.ndarray, "T 2 3"],
    world: Float[np.ndarray, "T 21 3"],
    ahead: Float[np.ndarray, "T 3"],
) -> Float[np.ndarray, "T 21 3"]:
    """The moved body with its legs bent so that the ankles are there; feet are those of `world`.

    Knees bend towards the mean of where the foot points and of `ahead`, a unit vector.
    """
    moved = moved.copy()
    for side, heel in enumerate(HEELS):
        foot = world[:, TOES[side]] - world[:, heel]
        front = unit(unit(foot) + ahead)
        knee, ankle = solve_leg(moved[:, heel - 2], ankles[:, side], moved[:, heel - 1], front)
        moved[:, heel - 1] = knee
        moved[:, heel] = ankle
        moved[:, heel + 1] = ankle + foot
    return moved


def needed_drop(
    hips: Float[np.ndarray, "T 2 3"], ankles: Float[np.ndarray, "T 2 3"], fps: float
) -> Float[np.ndarray, " T"]:
    """How far the hips must come down so that both ankles are in reach, smooth in time."""
    apart = ankles - hips
    flat = np.minimum((apart[..., [0, 2]] ** 2).sum(-1), (0.95 * REACH) ** 2)
    drop = np.maximum(-apart[..., 1] - np.sqrt(REACH**2 - flat), 0).max(1)
    wide = scipy.ndimage.maximum_filter1d(drop, 2 * round(0.15 * fps) + 1, mode="nearest")
    return scipy.ndimage.gaussian_filter1d(wide, 0.075 * fps, mode="nearest")


def solve_leg(
    hip: Float[np.ndarray, "T 3"],
    ankle: Float[np.ndarray, "T 3"],
    knee: Float[np.ndarray, "T 3"],
    ahead: Float[np.ndarray, "T 3"],
) -> tuple[Float[np.ndarray, "T 3"], Float[np.ndarray, "T 3"]]:
    """Knee and ankle, with the course's lengths of thigh and shank.

    The knee stays on the side to which it bends, and never bends backwards. An ankle out of reach
    is moved closer along the line from the hip.
    """
    line = unit(ankle - hip)
    distance = np.clip(np.linalg.norm(ankle - hip, axis=-1), 0.2, REACH)
    along, height = triangle(THIGH, SHANK, distance)
    side = perpendicular(knee - hip, line)
    front = unit(perpendicular(ahead, line))
    forward = np.einsum("ti,ti->t", side, front)
    side = unit(side + np.maximum(0.02 - forward, 0)[:, None] * front)
    knee = hip + along[:, None] * line + height[:, None] * side  # type: ignore[index]  # arrays
    return knee, hip + distance[:, None] * line
