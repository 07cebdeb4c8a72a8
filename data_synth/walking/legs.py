"""Legs that follow footprints.

The feet roll over heel and toe, the pelvis rides above, knees bend to fit.

Everything here is per frame, in the root frame (x left, y up, z ahead), metres and radians.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from motiondiff_edu.motion.kinematics import rot_x, rot_y, rot_z
from motiondiff_edu.motion.root_frame import forward_left
from motiondiff_edu.motion.skeleton import OFFSETS

from .footsteps import TOE_AHEAD, Steps
from .gait_curves import HEIGHT, ROLL, foot_pitch, periodic, swing_lift
from .styles import Style

ANKLE = 0.075  # height of the Foot joint over the floor, foot flat
HEEL_BEHIND = 0.04  # of the ankle
THIGH, SHANK = 0.41, 0.425
LEVEL = 0.53  # metres, of a long step
REACH = 0.9935 * (THIGH + SHANK)


@dataclass(frozen=True)
class Feet:
    """Ankle and toe joints, left then right, and the direction of each foot."""

    ankle: Float[np.ndarray, "T 2 3"]
    toe: Float[np.ndarray, "T 2 3"]
    yaw: Float[np.ndarray, "T 2"]


def softplus(x: Float[np.ndarray, "*T"], width: float) -> Float[np.ndarray, "*T"]:
    """max(x, 0), rounded over about `width`."""
    return width * np.logaddexp(0.0, x / width)


def heel_rise(behind: Float[np.ndarray, "*T"]) -> Float[np.ndarray, "*T"]:
    """Degrees that the heel must rise when the toe is this far behind the hip (metres)."""
    return 190 * softplus(behind - 0.18, 0.02)


def place_feet(
    steps: Steps,
    root_xz: Float[np.ndarray, "T 2"],
    heading: Float[np.ndarray, "T"],
    forward: Float[np.ndarray, "T"],
    run: Float[np.ndarray, "T"],
    style: Style,
) -> Feet:
    """Roll each foot about its heel or its toe, and lift it in between.

    About the heel after landing, about the toe before leaving.
    """
    to_forward, to_left = (v[:, None] for v in forward_left(heading))
    offset = steps.ground - root_xz[:, None]
    x, z = (offset * to_left).sum(-1), (offset * to_forward).sum(-1)
    x = x + _clear(steps, x)
    yaw = steps.yaw - heading[:, None]
    pitch, pivot, lift = _roll(steps, x, z, yaw, forward[:, None], run[:, None], style)
    back = TOE_AHEAD - (TOE_AHEAD + HEEL_BEHIND) * pivot  # of the pivot, seen from the ankle
    sin, cos = np.sin(pitch), np.cos(pitch)
    ahead_ankle = back - back * cos + ANKLE * sin
    up_ankle = back * sin + ANKLE * cos + lift
    rest = TOE_AHEAD - back
    ahead_toe, up_toe = back + rest * cos, lift - rest * sin
    s, c = np.sin(yaw), np.cos(yaw)
    ankle = np.stack([x + ahead_ankle * s, up_ankle, z + ahead_ankle * c], -1)
    toe = np.stack([x + ahead_toe * s, up_toe, z + ahead_toe * c], -1)
    return Feet(ankle, toe, yaw)


def _behind(x: np.ndarray, z: np.ndarray, yaw: np.ndarray) -> np.ndarray:
    """How far the toe is behind its hip, also aside where it is behind (metres)."""
    aside = x + TOE_AHEAD * np.sin(yaw) - np.array([0.085, -0.085])
    back = np.maximum(-(z + TOE_AHEAD * np.cos(yaw)), 0)
    return np.sqrt(back**2 + aside**2 * np.clip(back / 0.2, 0, 1))


def _clear(steps: Steps, x: np.ndarray) -> np.ndarray:
    """How far a swinging foot moves outward, to pass the other one.

    In metres, left positive.
    """
    short = softplus(0.095 - (x[:, 0] - x[:, 1]), 0.012)[:, None]
    return short * np.sin(np.pi * np.clip(steps.progress - 1, 0, 1)) ** 2 * np.array([1.0, -1.0])


def _roll(
    steps: Steps,
    x: Float[np.ndarray, "T 2"],
    z: Float[np.ndarray, "T 2"],
    yaw: Float[np.ndarray, "T 2"],
    forward: Float[np.ndarray, "T 1"],
    run: Float[np.ndarray, "T 1"],
    style: Style,
) -> tuple[Float[np.ndarray, "T 2"], Float[np.ndarray, "T 2"], Float[np.ndarray, "T 2"]]:
    """Pitch (radians, heel up), pivot (0 toe, 1 heel) and height of the pivot, for both feet."""
    progress = steps.progress
    curve = foot_pitch(progress, run)
    heel_off = np.clip(forward / 1.1, 0, 1.0) ** 0.7 * steps.amount[:, None]
    degrees = np.where(curve > 0, curve * heel_off, curve * steps.toe_up)
    late = np.clip((progress - 0.4) / 0.2, 0, 1) * np.clip((1.45 - progress) / 0.4, 0, 1)
    forced = heel_rise(_behind(x, z, yaw)) * late
    up = np.maximum(degrees, 0)
    degrees = degrees + softplus(forced - up, 1.5) - softplus(-up, 1.5)
    u = np.clip(progress - 1, 0, 1)
    pivot = np.where(progress > 1, u * u * (3 - 2 * u), (progress < 0.35) * 1.0)
    walk = 0.104 + 0.03 * np.clip(forward - 1.2, -0.5, 0.8)
    size = np.clip(0.30 + 0.75 * steps.stride, 0, 1.1) * style.lift
    lift = swing_lift(u, run) * (progress > 1) * size * (walk + (0.44 - walk) * run)
    return np.radians(degrees), pivot, lift


def pelvis_height(
    clock: Float[np.ndarray, "T"],
    amount: Float[np.ndarray, "T"],
    run: Float[np.ndarray, "T"],
    speed: Float[np.ndarray, "T"],
    style: Style,
) -> Float[np.ndarray, "T"]:
    """Height of the Hips joint before the reach of the legs limits it.

    It is highest at mid-stance, and lower at higher speed.
    """
    swing = np.clip(0.055 * speed - 0.031, 0.012, 0.06) * style.bounce
    walk = 0.957 - (0.02 + 0.008 * (speed - 1.2) + 0.02 * softplus(speed - 1.35, 0.1)) * amount
    wave = periodic(HEIGHT, 2 * clock) * amount
    bounce = 0.066 * np.cos(4 * np.pi * (clock - 0.40)) * amount
    return walk + wave * swing * (1 - run) + (bounce + 0.024) * run - style.crouch * (1 - 0.7 * run)


def pelvis_rotation(
    yaw: Float[np.ndarray, "T"], roll: Float[np.ndarray, "T"], pitch: Float[np.ndarray, "T"]
) -> Float[np.ndarray, "T 3 3"]:
    """Rotation of the pelvis: yaw counter-clockwise, roll left side up, pitch forward (radians)."""
    return rot_y(yaw) @ rot_z(roll) @ rot_x(pitch)


def own_roll(
    clock: Float[np.ndarray, "T"], amount: Float[np.ndarray, "T"]
) -> Float[np.ndarray, "T"]:
    """Roll of the pelvis in radians, left side up: half the difference of both sides' curves."""
    return np.radians(periodic(ROLL, clock) - periodic(ROLL, clock + 0.5)) / 2 * amount


def hips_within_reach(
    hips: Float[np.ndarray, "T 3"],
    rotation: Float[np.ndarray, "T 3 3"],
    feet: Feet,
    level: float | Float[np.ndarray, "T 2"] = LEVEL,
) -> Float[np.ndarray, "T 3"]:
    """Lower the pelvis smoothly where a leg would not reach the ground.

    A foot that is more than `level` metres beside its hip also pulls the pelvis along.
    """
    hips = hips.copy()
    sockets = [rotation @ OFFSETS[joint] for joint in (1, 5)]
    levels = np.broadcast_to(level, (len(hips), 2))
    for side, socket in enumerate(sockets):
        gap = (feet.ankle[:, side] - hips - socket)[:, [0, 2]]
        beside = np.linalg.norm(gap, axis=-1, keepdims=True)
        beyond = beside - levels[:, side, None]
        hips[:, [0, 2]] += softplus(beyond, 0.015) * gap / beside
    for side, socket in enumerate(sockets):
        gap = feet.ankle[:, side] - hips - socket
        highest = (
            feet.ankle[:, side, 1]
            + np.sqrt(np.maximum(REACH**2 - gap[:, 0] ** 2 - gap[:, 2] ** 2, 0.2))
            - socket[:, 1]
        )
        hips[:, 1] -= softplus(hips[:, 1] - highest, 0.008)
    return hips


def not_folded(
    hips: Float[np.ndarray, "T 3"], rotation: Float[np.ndarray, "T 3 3"], feet: Feet
) -> Feet:
    """Lower a swinging foot that comes too near its hip.

    Otherwise the knee would bend by more than about 135 degrees.
    """
    sockets = np.stack([hips + rotation @ OFFSETS[j] for j in (1, 5)], 1)
    near = softplus(0.34 - np.linalg.norm(feet.ankle - sockets, axis=-1), 0.012)
    down = np.stack([0 * near, near, 0 * near], -1)
    return Feet(feet.ankle - down, feet.toe - down, feet.yaw)


def bend_knee(
    hip: Float[np.ndarray, "T 3"], ankle: Float[np.ndarray, "T 3"], toward: Float[np.ndarray, "T 3"]
) -> Float[np.ndarray, "T 3"]:
    """The knee of a two-bone leg from hip to ankle, on the side of `toward`.

    The ankle must be within reach.
    """
    gap = ankle - hip
    distance = np.linalg.norm(gap, axis=-1, keepdims=True)
    along = gap / distance
    a = (distance**2 + THIGH**2 - SHANK**2) / (2 * distance)
    out = toward - (toward * along).sum(-1, keepdims=True) * along
    out /= np.linalg.norm(out, axis=-1, keepdims=True)
    return hip + a * along + np.sqrt(np.maximum(THIGH**2 - a * a, 0)) * out
