"""Acts of the arms: wave, raise, hold, punch, clap and point, over whatever the legs do.

An arm's pose is (swing ahead, out to the side, twist inward, elbow, wrist) in degrees, seen from
the shoulders. The acts lay a curve of poses over the arms of a motion that exists already.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.ndimage import gaussian_filter1d

from motiondiff_edu.motion.directions import frame_of
from motiondiff_edu.motion.kinematics import rot_x, rot_y, rot_z
from motiondiff_edu.motion.root_frame import FPS

from ..dancing.curves import least_jerk
from ..walking.upper_body import DOWN, FOREARM, UPPER_ARM
from .acts import Act
from .join import mixed_bone

HAND = 0.09
FADE = 0.35  # seconds in which an arm leaves what it did before, and comes back to it
RISE = 0.55  # seconds in which a hand goes up beside the head, and down again
SHOULDERS = {"left": 13, "right": 17}
Pose = tuple[float, float, float, float, float]
Keys = list[tuple[float, Pose]]

READY: Pose = (18, 12, 20, 104, 6)
PUNCHED: Pose = (84, 4, 10, 8, 0)
OPEN: Pose = (34, 44, 4, 62, 8)
TOGETHER: Pose = (46, 4, 44, 86, 4)
WAVING: Pose = (14, 82, -84, 84, 0)
UP: Pose = (164, 10, 0, 12, 0)
HANGING: Pose = (4, 10, 14, 20, 8)


@dataclass(frozen=True)
class TimedArms:
    """An act of the arms from `first` to `last`, in seconds of the clip."""

    act: Act
    first: float
    period: float
    last: float


def wave(one: TimedArms, side: str, rng: np.random.Generator) -> Keys:
    """The hand beside the head, swinging out and in, about one and a half times a second."""
    each = 0.5 * one.period / 3.0
    keys = [(one.first, HANGING), (one.first + RISE, WAVING)]
    sign = 1.0
    while keys[-1][0] + each < one.last - RISE:
        swing = sign * rng.uniform(20.0, 28.0)
        pose = tuple(np.add(WAVING, (0.0, 0.0, swing, 0.5 * swing, 0.0)))
        keys.append((keys[-1][0] + each, pose))
        sign = -sign
    return [*keys, (keys[-1][0] + RISE, HANGING)]


def raise_arm(one: TimedArms, side: str, rng: np.random.Generator) -> Keys:
    """The straight arm goes up ahead and overhead, and down again, each time."""
    keys = [(one.first, HANGING)]
    top = tuple(np.add(UP, (rng.uniform(-14, 6), 0, 0, 0, 0)))
    for k in range(one.act.count):
        at = one.first + k * one.period
        keys += [(at + 0.44 * one.period, top), (at + 0.56 * one.period, top)]
        keys.append((at + one.period, HANGING))
    return keys


def hold(one: TimedArms, side: str, rng: np.random.Generator) -> Keys:
    """The straight arm goes up and stays there."""
    top = tuple(np.add(UP, (rng.uniform(-14, 6), rng.uniform(-4, 14), 0, rng.uniform(-4, 10), 0)))
    return [(one.first, HANGING), (one.first + RISE, top), (one.last - RISE, top),
            (one.last, HANGING)]  # fmt: skip


def punch(one: TimedArms, side: str, rng: np.random.Generator) -> Keys:
    """From the guard straight ahead and back, each time."""
    keys = [(one.first, READY)]
    for k in range(one.act.count):
        at = one.first + k * one.period
        hit = tuple(np.add(PUNCHED, (rng.uniform(-8, 8), 0, 0, 0, 0)))
        keys += [(at + 0.48 * one.period, hit), (at + 0.95 * one.period, READY)]
    return keys


def clap(one: TimedArms, side: str, rng: np.random.Generator) -> Keys:
    """Both hands apart and together, each time."""
    keys = [(one.first, OPEN)]
    for k in range(one.act.count):
        at = one.first + k * one.period
        keys += [(at + 0.52 * one.period, TOGETHER), (at + 0.98 * one.period, OPEN)]
    return keys


def point(one: TimedArms, side: str, rng: np.random.Generator) -> Keys:
    """The straight arm shows ahead or to its side, and stays there."""
    pose = (82, 6, 0, 6, -4) if one.act.direction == "forward" else (4, 84, 0, 6, -4)
    pose = tuple(np.add(pose, (rng.uniform(-6, 6), rng.uniform(-4, 4), 0, 0, 0)))
    return [(one.first + FADE, pose), (one.last - FADE, pose)]


WRITERS: dict[str, Callable[[TimedArms, str, np.random.Generator], Keys]] = {
    "wave": wave,
    "raise": raise_arm,
    "hold": hold,
    "punch": punch,
    "clap": clap,
    "point": point,
}


def sides_of(act: Act) -> tuple[str, ...]:
    """The arms that an act needs."""
    return (act.side,) if act.side in SHOULDERS else ("left", "right")


def laid_over(
    positions: Float[np.ndarray, "T 21 3"], timed: list[TimedArms], seed: int
) -> Float[np.ndarray, "T 21 3"]:
    """The motion with these acts of the arms."""
    out = positions.copy()
    t = np.arange(len(positions)) / FPS
    for k, one in enumerate(timed):
        for side in sides_of(one.act):
            # both arms draw the same numbers, so that hands meet
            rng = np.random.default_rng([seed, 9, k])
            pose = _curve(t, WRITERS[one.act.verb](one, side, rng))
            _set_arm(out, side, pose, _presence(t, one))
    return out


def _curve(t: Float[np.ndarray, "T"], keys: Keys) -> Float[np.ndarray, "T 5"]:
    """Least-jerk movements from key to key; constant before and after."""
    at = np.array([key[0] for key in keys])
    value = np.array([key[1] for key in keys], float)
    if len(at) == 1:
        return np.repeat(value, len(t), 0)
    i = np.clip(np.searchsorted(at, t, side="right") - 1, 0, len(at) - 2)
    share = least_jerk((t - at[i]) / np.maximum(at[i + 1] - at[i], 1e-6))
    return value[i] + share[:, None] * (value[i + 1] - value[i])


def _presence(t: Float[np.ndarray, "T"], one: TimedArms) -> Float[np.ndarray, "T"]:
    """How much of an act there is: up before its first key, and down after its last."""
    rise = least_jerk((t - one.first + 0.5 * FADE) / FADE)
    return rise * least_jerk((one.last + 0.5 * FADE - t) / FADE)


def _set_arm(joints: np.ndarray, side: str, pose, share: Float[np.ndarray, "T"]) -> None:
    """Mix one arm's bones with the pose, by their directions."""
    first = SHOULDERS[side]
    sign = 1.0 if side == "left" else -1.0
    swing, out, twist, elbow, wrist = np.radians(pose).T
    upper = _shoulders(joints) @ rot_x(-swing) @ rot_z(sign * out) @ rot_y(-sign * twist)
    fore = upper @ rot_x(-elbow)
    bones = ((upper, UPPER_ARM), (fore, FOREARM), (fore @ rot_x(-wrist), HAND))
    old = np.diff(joints[:, first : first + 4], axis=1)
    for k, (turn, length) in enumerate(bones):
        bone = mixed_bone(old[:, k], length * (turn @ DOWN), share[:, None], length)
        joints[:, first + k + 1] = joints[:, first + k] + bone


def _shoulders(joints: Float[np.ndarray, "T 21 3"]) -> Float[np.ndarray, "T 3 3"]:
    """The rotation of the shoulders: left, up along the chest, ahead."""
    left = joints[:, SHOULDERS["left"]] - joints[:, SHOULDERS["right"]]
    left = gaussian_filter1d(left, 0.04 * FPS, axis=0, mode="nearest")
    return frame_of(left, joints[:, 11] - joints[:, 10])
