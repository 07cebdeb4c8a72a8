"""Trunk, head and arms over a moving pelvis.

The chest trails it, the arms swing with the opposite leg.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from motiondiff_edu.motion.kinematics import rot_x, rot_y, rot_z
from motiondiff_edu.motion.skeleton import OFFSETS

from .behaviours import Behaviours, pose_arm, swing_factor
from .gait_curves import ELBOW, HAND, Gait, periodic
from .styles import Style

UPPER_ARM, FOREARM = 0.28, 0.25
DOWN = np.array([0.0, -1.0, 0.0])


@dataclass(frozen=True)
class Trunk:
    """Angles in radians per frame.

    Chest yaw (counter-clockwise), forward lean, roll (left side up), head.
    """

    yaw: Float[np.ndarray, "T"]
    lean: Float[np.ndarray, "T"]
    roll: Float[np.ndarray, "T"]
    head_pitch: Float[np.ndarray, "T"]
    head_yaw: Float[np.ndarray, "T"]


def trunk(
    gait: Gait,
    inward: Float[np.ndarray, "T"],
    doing: Behaviours,
    noise: Float[np.ndarray, "T 4"],
    style: Style,
) -> Trunk:
    """Chest and head angles; `inward` is the lean into a turn (radians, left positive)."""
    turn = 2 * np.pi * gait.clock
    amount, run = gait.amount, gait.run
    chest = (
        -4.6
        * style.chest_yaw
        * (1 + 0.9 * run)
        * np.cos(turn - np.radians(11 + 105 + 35 * run))
        * amount
        * gait.ahead
    )
    nod = 1.45 * np.cos(2 * turn - 4 * np.pi * 0.10) * amount
    look = doing.head[:, 0] - doing.head[:, 1]
    lean = style.lean + 1.0 + 1.4 * np.clip(gait.speed, 0, 2) + 5.5 * run + nod + 1.0 * noise[:, 0]
    roll = -1.0 * np.cos(turn - 2 * np.pi * 0.2) * amount + 0.5 * noise[:, 1]
    head = (
        0.45 * (style.lean - 3) * -0.6
        + style.head
        + 18 * doing.head[:, 2]
        + 0.2 * nod
        + 1.2 * noise[:, 2]
    )
    yaw = chest + 13 * look + 1.0 * noise[:, 3]
    angles = np.radians([yaw, lean, roll, head, 45 * look])
    return Trunk(angles[0], angles[1], angles[2] - 0.45 * inward, angles[3], angles[4])


def spine(
    hips: Float[np.ndarray, "T 3"],
    pelvis: Float[np.ndarray, "T 3 3"],
    pose: Trunk,
    pelvis_yaw: Float[np.ndarray, "T"],
):
    """Positions of Spine, Spine1, Neck1 and Head, and the rotation that carries the shoulders."""
    low = pelvis @ rot_x(0.5 * pose.lean) @ rot_z(0.5 * pose.roll)
    mid = rot_y(0.5 * pose.yaw + 0.5 * pelvis_yaw) @ rot_z(pose.roll) @ rot_x(1.0 * pose.lean)
    chest = rot_y(pose.yaw) @ rot_z(pose.roll) @ rot_x(1.25 * pose.lean)
    head = (
        rot_y(pose.yaw + pose.head_yaw)
        @ rot_x(pose.lean + pose.head_pitch)
        @ rot_z(0.4 * pose.roll)
    )
    p9 = hips + low @ OFFSETS[9]
    p10 = p9 + mid @ OFFSETS[10]
    p11 = p10 + chest @ OFFSETS[11]
    shoulders = rot_y(pose.yaw) @ rot_z(pose.roll) @ rot_x(0.6 * pose.lean)
    return (p9, p10, p11, p11 + head @ OFFSETS[12]), shoulders


def free_arm(gait: Gait, side: int, swing, noise: Float[np.ndarray, "T 2"], style: Style):
    """(swing, abduction, twist, elbow) of an arm that just swings.

    The hand's angle follows the measured curve.
    """
    amount, run = gait.amount * gait.ahead, gait.run
    p = gait.clock if side == 0 else gait.clock + 0.5
    size = (
        (27 + 17 * np.clip(gait.speed, 0, 1.8))
        / 50
        * style.arms
        * swing
        * (style.arms_right if side else 1.0)
    )
    wave = (periodic(HAND, p) - HAND[0][0]) * amount * size
    bend = (periodic(ELBOW, p) - ELBOW[0][0]) * amount * np.minimum(size, 1.25)
    elbow = 15 + 10 * amount * np.minimum(size, 1.3) + bend + style.elbow + 3.5 * noise[:, 0]
    elbow = elbow + (98 + 0.5 * bend + 0.3 * style.elbow - elbow) * run
    elbow = 4 + np.logaddexp(0, (elbow - 4) / 4) * 4
    hand = (
        4 + 5 * amount + wave * (1 + 0.05 * run) + 0.32 * style.elbow + 22 * run + 2.2 * noise[:, 1]
    )
    bent = np.radians(elbow)
    upper = hand - np.degrees(
        np.arctan2(FOREARM * np.sin(bent), UPPER_ARM + FOREARM * np.cos(bent))
    )
    abduct = style.abduct + 4 * run + 0.8 * noise[:, 0]
    return np.stack([upper, abduct, 14 + 14 * run + 0 * upper, elbow], -1)


def arm(
    neck: Float[np.ndarray, "T 3"],
    shoulders: Float[np.ndarray, "T 3 3"],
    joint: int,
    pose: Float[np.ndarray, "T 4"],
):
    """Shoulder, elbow, hand and finger positions of one arm.

    It starts at `joint` (13 left, 17 right).
    """
    side = 1.0 if joint == 13 else -1.0
    swing, abduct, twist, elbow = np.radians(pose).T
    shoulder = neck + shoulders @ OFFSETS[joint]
    upper = shoulders @ rot_x(-swing) @ rot_z(side * abduct) @ rot_y(-side * twist)
    fore = upper @ rot_x(-elbow)
    hand = fore @ rot_x(np.full_like(elbow, -0.15))
    p1 = shoulder + upper @ (UPPER_ARM * DOWN)
    p2 = p1 + fore @ (FOREARM * DOWN)
    return shoulder, p1, p2, p2 + hand @ (0.09 * DOWN)


def both_arms(neck, shoulders, gait: Gait, doing: Behaviours, noise, wave, style: Style) -> list:
    """The eight joints of both arms, left first.

    `noise` (T, 5): a pair per arm, and the swing they share.
    """
    joints = []
    for side, joint in enumerate((13, 17)):
        swing = swing_factor(doing) * np.exp(0.16 * noise[:, 4])
        free = free_arm(gait, side, swing, noise[:, 2 * side : 2 * side + 2], style)
        joints += arm(neck, shoulders, joint, pose_arm(free, side, doing, wave))
    return joints
