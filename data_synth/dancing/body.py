"""From the channels of a dance to the 21 joints.

The pelvis is over the feet, the spine bends in three places; arms and legs follow.

All is per frame and vectorised, in the world frame and metres. The channels are those of
script.REST, in degrees and metres.
"""

import numpy as np
from jaxtyping import Float
from scipy.ndimage import gaussian_filter1d

from motiondiff_edu.motion.kinematics import rot_x, rot_y, rot_z
from motiondiff_edu.motion.root_frame import FPS, forward_left
from motiondiff_edu.motion.skeleton import OFFSETS, J

from ..walking import legs
from ..walking.upper_body import DOWN, FOREARM, UPPER_ARM
from .script import ARM, LENGTHS
from .steps import Track

STAND = 0.957  # height of the Hips joint over flat feet before `drop`
# metres that the hips move away per unit of sine of the trunk's lean, so that the weight stays
UPPER_SHARE = 0.17
CARRIED = 0.1  # s: how a change of weight is spread over time
KICKED, KICK = 0.12, 0.66  # metres: a toe so high over the floor is so far beside its hip at most
KNEE_TURNS = np.radians(50)  # of a knee against the pelvis, at most: about what a hip joint allows


def dancer(
    channels: dict[str, Float[np.ndarray, "T"]],
    tracks: tuple[Track, Track],
    heading: Float[np.ndarray, "T"],
    level: float = legs.LEVEL,
) -> Float[np.ndarray, "T 21 3"]:
    """The joints of a figure with its feet at `tracks` and its body as in the channels.

    `level` as in `legs.hips_within_reach`.
    """
    c = {name: value if name in LENGTHS else np.radians(value) for name, value in channels.items()}
    yaw = heading + c["hip_yaw"]
    pelvis = legs.pelvis_rotation(yaw, c["hip_roll"], c["hip_tilt"])
    feet = legs.Feet(
        *(np.stack(v, 1) for v in zip(*((k.ankle(), k.toe, k.yaw) for k in tracks), strict=True))
    )
    hips = legs.hips_within_reach(_hips(c, tracks, heading), pelvis, feet, _level(feet, level))
    feet = legs.not_folded(hips, pelvis, feet)
    joints = np.zeros((len(heading), J, 3))
    joints[:, 0] = hips
    for side, first in enumerate((1, 5)):
        knee_out = (1, -1)[side] * c["lr"[side] + "_knee"]
        joints[:, first] = hips + pelvis @ OFFSETS[first]
        joints[:, first + 2] = feet.ankle[:, side]
        joints[:, first + 3] = feet.toe[:, side]
        turned = 0.5 * (feet.yaw[:, side] - yaw) + knee_out
        facing = yaw + np.clip(turned, -KNEE_TURNS, KNEE_TURNS)
        joints[:, first + 1] = legs.bend_knee(
            joints[:, first],
            feet.ankle[:, side],
            _knee_side(joints[:, first], feet.ankle[:, side], facing),
        )
    shoulders = _spine(joints, hips, yaw, c)
    for side, joint in enumerate((13, 17)):
        _arm(joints, shoulders, joint, {name: c[f"{'lr'[side]}_{name}"] for name in ARM})
    return joints


def _level(feet: legs.Feet, level: float) -> Float[np.ndarray, "T 2"]:
    """How far beside its hip each foot may be: farther when it is kicked up."""
    return level + (KICK - level) * np.clip(feet.toe[..., 1] / KICKED, 0, 1)


def _hips(c, tracks, heading) -> Float[np.ndarray, "T 3"]:
    """The pelvis over the supporting foot, moved by sway and surge.

    It also moves away from where the trunk leans.
    """
    left, right = (k.ground for k in tracks)
    over = right + (0.5 + 0.47 * c["weight"])[:, None] * (left - right)
    # a body is not thrown as fast as its weight is meant to change
    over = gaussian_filter1d(over, CARRIED * FPS, axis=0, mode="nearest")
    ahead, aside = forward_left(heading)
    surge = c["surge"] + 0.03 - UPPER_SHARE * (np.sin(c["lean"]) + 0.5 * np.sin(c["hip_tilt"]))
    sway = c["sway"] + UPPER_SHARE * np.sin(c["side"])
    x, z = (over + surge[:, None] * ahead + sway[:, None] * aside).T
    return np.stack([x, STAND - c["drop"], z], -1)


def _knee_side(hip, ankle, facing) -> Float[np.ndarray, "T 3"]:
    """The direction of the knee.

    It is ahead for a hanging leg, up for a leg kicked forward, down for one kicked back.
    """
    left = np.stack([np.cos(facing), np.zeros_like(facing), -np.sin(facing)], -1)
    return np.cross(ankle - hip, left)


def _spine(joints, hips, yaw, c) -> Float[np.ndarray, "T 3 3"]:
    """Set Spine, Spine1, Neck1 and Head; returns the rotation that carries the shoulders."""
    low = (
        rot_y(yaw)
        @ rot_z(0.5 * c["hip_roll"] + 0.3 * c["side"])
        @ rot_x(0.5 * c["hip_tilt"] + 0.4 * c["lean"])
    )
    middle = (
        rot_y(yaw + 0.5 * c["twist"])
        @ rot_z(0.7 * c["side"])
        @ rot_x(0.8 * c["lean"] + 0.2 * c["hip_tilt"] + c["chest"])
    )
    top = (
        rot_y(yaw + 0.9 * c["twist"])
        @ rot_z(c["side"])
        @ rot_x(1.15 * c["lean"] - 0.9 * c["chest"])
    )
    joints[:, 9] = hips + low @ OFFSETS[9]
    joints[:, 10] = joints[:, 9] + middle @ OFFSETS[10]
    joints[:, 11] = joints[:, 10] + top @ OFFSETS[11]
    steady = (
        0.45 * c["twist"] - 0.5 * c["hip_yaw"] + c["look"]
    )  # the head stays nearer to the heading of the dance
    head = (
        rot_y(yaw + steady)
        @ rot_z(0.3 * c["side"] + c["cock"])
        @ rot_x(0.45 * c["lean"] + c["nod"] - 0.3 * c["chest"])
    )
    joints[:, 12] = joints[:, 11] + head @ OFFSETS[12]
    return rot_y(yaw + c["twist"]) @ rot_z(c["side"]) @ rot_x(0.7 * c["lean"] - 0.6 * c["chest"])


def _arm(joints, shoulders, joint: int, a) -> None:
    """Set Arm, ForeArm, Hand and HandIndex1 from the angles of one arm."""
    side = 1.0 if joint == 13 else -1.0
    shoulder = joints[:, 11] + (shoulders @ rot_z(side * a["shrug"])) @ OFFSETS[joint]
    upper = shoulders @ rot_x(-a["swing"]) @ rot_z(side * a["out"]) @ rot_y(-side * a["twist"])
    bend = np.radians(4) + legs.softplus(a["elbow"] - np.radians(4), 0.06)
    bend = np.radians(148) - legs.softplus(np.radians(148) - bend, 0.06)
    fore = upper @ rot_x(-bend)
    hand = fore @ rot_x(-a["wrist"])
    joints[:, joint] = shoulder
    joints[:, joint + 1] = shoulder + upper @ (UPPER_ARM * DOWN)
    joints[:, joint + 2] = joints[:, joint + 1] + fore @ (FOREARM * DOWN)
    joints[:, joint + 3] = joints[:, joint + 2] + hand @ (0.09 * DOWN)
