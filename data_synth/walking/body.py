"""One walk, put together: control and noise in, poses of 21 joints in the root frame out."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from motiondiff_edu.motion.skeleton import OFFSETS, J

from ..noise import drift, follow, uniform
from . import legs, upper_body
from .behaviours import behaviours
from .drive import drive
from .footsteps import Place, plan, planted
from .gait_curves import Gait, running
from .styles import Style

GRAVITY = 9.81


@dataclass(frozen=True, eq=False)
class Pelvis:
    """Where the pelvis is in the root frame (metres), how it is turned, and its yaw (radians)."""

    place: Float[np.ndarray, "T 3"]
    rotation: Float[np.ndarray, "T 3 3"]
    yaw: Float[np.ndarray, "T"]


def body(
    control: Float[np.ndarray, "T 3"],
    root_xz: Float[np.ndarray, "T 2"],
    heading: Float[np.ndarray, "T"],
    rows: Float[np.ndarray, "rows 40"],
    style: Style,
    phase: float,
    fps: float,
    places: list[Place] | None = None,
) -> tuple[Float[np.ndarray, "T 21 3"], Bool[np.ndarray, "T 2"]]:
    """Poses and contacts of a walk.

    `rows` is the noise of noise.white, `phase` where the clock starts; `places` as in `plan`.
    """
    forward, left, yaw = follow(np.concatenate([control[:1], control[:-1]]), 0.07, fps).T
    run = follow(running(forward), 0.09, fps)
    speed = np.hypot(np.where(forward < 0, -forward, forward), left)
    inward = 0.78 * np.arctan(forward * yaw / GRAVITY)
    lean_shift = -1.58 * (1 - 0.25 * run) * np.tan(inward)
    driven = drive(control, root_xz, heading, rows, style, lean_shift, run, fps)
    steps = plan(driven, style, phase, fps, places)
    feet = legs.place_feet(steps, root_xz, heading, forward, run, style)
    noise = drift(rows[:, 8:28], 0.5, fps)
    ahead = (
        0.25 + 0.75 * np.tanh(np.abs(forward) / 0.7) ** 2
    )  # sideways and on the spot nothing swings much
    gait = Gait(steps.clock, steps.amount, ahead, run, speed)
    pelvis_yaw, rotation = _pelvis_turn(gait, yaw, noise, style)
    hips = _hips(gait, forward, lean_shift, rows, noise, style, fps)
    hips = legs.hips_within_reach(hips, rotation, feet)
    feet = legs.not_folded(hips, rotation, feet)
    pelvis = Pelvis(hips, rotation, pelvis_yaw)
    joints = np.zeros((len(control), J, 3))
    joints[:, 0] = hips
    _set_legs(joints, pelvis, feet)
    _set_upper(joints, pelvis, gait, inward, rows, noise, style, fps)
    return joints, planted(steps, feet.toe[..., 1])


def _pelvis_turn(gait: Gait, yaw, noise, style):
    turn = 2 * np.pi * gait.clock
    angle = (
        -np.radians(9.3 * style.pelvis_yaw)
        * np.cos(turn - 2 * np.pi * 0.03)
        * gait.amount
        * gait.ahead
        * (1 + 0.1 * gait.run)
    )
    angle = angle + 0.05 * yaw + np.radians(0.7) * noise[:, 0]
    roll = (
        legs.own_roll(gait.clock, gait.amount) * (1 + 0.9 * gait.run)
        + np.radians(0.35) * noise[:, 1]
    )
    return angle, legs.pelvis_rotation(angle, roll, np.zeros_like(roll))


def _hips(gait: Gait, forward, lean_shift, rows, noise, style, fps):
    """Pelvis about the root: sway to the standing foot, ripple ahead, height."""
    turn = 2 * np.pi * gait.clock
    amount, run = gait.amount, gait.run
    early = 0.4 * (
        follow(lean_shift, 0.2, fps) - lean_shift
    )  # the pelvis leans in before the feet have come out
    idle = drift(rows[:, 28:30], 0.9, fps) * (1 - amount)[:, None]
    sway = (
        0.024 * style.sway * np.cos(turn - 2 * np.pi * 0.30) * amount * (1 - 0.6 * run)
        + 0.003 * noise[:, 2]
    )
    ripple = (
        0.0135
        * np.clip(forward, -1, 2.5)
        * np.sin(2 * turn - 4 * np.pi * 0.03)
        * amount
        * (1 - 0.5 * run)
    )
    height = (
        legs.pelvis_height(gait.clock, amount, run, gait.speed, style)
        + 0.0022 * noise[:, 3]
        - 0.14 * np.abs(lean_shift)
    )
    return np.stack(
        [
            sway + early + 0.018 * idle[:, 0],
            height,
            ripple + 0.004 * noise[:, 4] + 0.010 * idle[:, 1],
        ],
        -1,
    )


def _set_legs(joints, pelvis: Pelvis, feet) -> None:
    for side, first in enumerate((1, 5)):
        socket = pelvis.place + pelvis.rotation @ OFFSETS[first]
        facing = 0.5 * pelvis.yaw + 0.5 * feet.yaw[:, side]
        toward = np.stack([np.sin(facing), np.zeros_like(facing), np.cos(facing)], -1)
        joints[:, first], joints[:, first + 2] = socket, feet.ankle[:, side]
        joints[:, first + 1] = legs.bend_knee(socket, feet.ankle[:, side], toward)
        joints[:, first + 3] = feet.toe[:, side]


def _set_upper(joints, pelvis: Pelvis, gait: Gait, inward, rows, noise, style, fps) -> None:
    doing = behaviours(uniform(rows[:, 30:34]), style.behaviours, gait.run < 0.5, fps)
    wave = np.sin(2 * np.pi * np.arange(len(rows)) * 1.4 / fps)[-len(joints) :]
    pose = upper_body.trunk(gait, inward, doing, noise[:, 5:9], style)
    column, shoulders = upper_body.spine(pelvis.place, pelvis.rotation, pose, pelvis.yaw)
    joints[:, 9:13] = np.stack(column, 1)
    swing = drift(rows[:, 34], 2.0, fps)[:, None]
    arm_noise = np.concatenate([noise[:, 9:13], swing], -1)
    arms = upper_body.both_arms(column[2], shoulders, gait, doing, arm_noise, wave, style)
    joints[:, 13:21] = np.stack(arms, 1)
