"""The feet of a dance at every frame.

Toes stay while they are planted, and swing, lift and roll between.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float
from scipy.interpolate import PchipInterpolator

from ..walking.footsteps import TOE_AHEAD
from ..walking.legs import ANKLE
from .curves import least_jerk
from .script import Step


@dataclass(frozen=True)
class Roll:
    """How a foot rolls over its ball, before it leaves the floor and after it lands.

    The heel begins to rise `early` seconds before the foot lifts, and is `off` degrees up then; it
    lands `land` degrees up and is down `settle` seconds later. `pivot`: degrees up in a pivot.
    `steepest`: whatever the move asks for, it stays below so many; with 57 the ankle is above the
    ball.
    """

    early: float = 0.12
    off: float = 0.0
    land: float = 7.0
    settle: float = 0.1
    pivot: float = 7.0
    steepest: float = np.inf


@dataclass(frozen=True)
class Track:
    """One foot over time.

    It has the toe joint, direction and pitch (radians, heel up), whether it is planted, and where
    it carries weight.
    """

    toe: Float[np.ndarray, "T 3"]
    yaw: Float[np.ndarray, "T"]
    pitch: Float[np.ndarray, "T"]
    planted: Bool[np.ndarray, "T"]
    ground: Float[np.ndarray, "T 2"]  # of the flat ankle (x, z), without the detours of a swing

    def ankle(self) -> Float[np.ndarray, "T 3"]:
        """The Foot joint: it is behind the toe, and rises with the pitch of the foot."""
        sin, cos = np.sin(self.pitch), np.cos(self.pitch)
        back = TOE_AHEAD * cos - ANKLE * sin
        up = ANKLE * cos + TOE_AHEAD * sin
        return self.toe + np.stack([-back * np.sin(self.yaw), up, -back * np.cos(self.yaw)], -1)


def track(
    steps: list[Step],
    start: tuple[float, float, float],
    times: Float[np.ndarray, "S 2"],
    t: Float[np.ndarray, "T"],
    heel: Float[np.ndarray, "T"],
    roll: Roll = Roll(),
) -> Track:
    """A foot that stands at `start` (toe x, toe z, yaw) and takes `steps`.

    They last from times[:, 0] to times[:, 1] (seconds).

    `heel` (degrees) is how far a move raises it while it stands; `roll` how it leaves and lands.
    """
    x = np.full(len(t), start[0])
    y = np.zeros(len(t))
    z = np.full(len(t), start[1])
    yaw = np.full(len(t), start[2])
    planted, detour = np.ones(len(t), bool), np.zeros((len(t), 2))
    pitch: list[tuple[float, float]] = [(t[0] - 1.0, 0.0)]
    for step, (lift, land) in zip(steps, times, strict=True):
        first, last = np.searchsorted(t, (lift, land))
        u = (t[first:last] - lift) / (land - lift)
        share = least_jerk(u)
        for path, goal in ((x, step.x), (z, step.z), (yaw, step.yaw)):
            path[first:last] += share * (goal - path[first:last])
            path[last:] = goal
        far = np.hypot(step.x - start[0], step.z - start[1])
        start = (step.x, step.z, step.yaw)
        pitch += _pitch(step, far, lift, land, roll)
        if not step.pivot:
            planted[first:last] = False
            y[first:last] = step.height * 64 * (u * (1 - u)) ** 3
            detour[first:last] = (np.sin(np.pi * u) ** 2)[:, None] * step.out
    ground = np.stack([x - TOE_AHEAD * np.sin(yaw), z - TOE_AHEAD * np.cos(yaw)], -1)
    toe = np.stack([x + detour[:, 0], y, z + detour[:, 1]], -1)
    degrees = _rolled(pitch, t) + np.where(planted, 1.0, 0.6) * heel
    return Track(toe, yaw, np.radians(_softly_below(degrees, roll.steepest)), planted, ground)


def _softly_below(degrees: Float[np.ndarray, "T"], most: float) -> Float[np.ndarray, "T"]:
    """The pitches, which grow less and less over the last quarter below `most`."""
    if not np.isfinite(most):
        return degrees
    room = most / 4
    over = np.maximum(degrees - (most - room), 0.0)
    return np.minimum(degrees, most - room) + room * np.tanh(over / room)


def _pitch(
    step: Step, far: float, lift: float, land: float, roll: Roll
) -> list[tuple[float, float]]:
    """Degrees, heel up, at moments around one step.

    The heel leaves first, and the ball of the foot lands first.
    """
    if step.pivot:
        return [(lift, 0.0), ((lift + land) / 2, roll.pivot), (land, 0.0)]
    took = land - lift
    off = min(10 + 50 * far + 60 * step.height, 38)
    middle = step.kick if step.kick else 10 + 40 * step.height
    return [
        (lift - roll.early, 0.0),
        *([(lift, roll.off)] if roll.off else []),
        (lift + 0.12 * took, max(off, roll.off)),
        (lift + 0.5 * took, middle),
        (land, roll.land),
        (land + roll.settle, 0.0),
    ]


def _rolled(keys: list[tuple[float, float]], t: Float[np.ndarray, "T"]) -> Float[np.ndarray, "T"]:
    """A smooth curve through the keys.

    Keys that are out of order are left out.
    """
    kept = keys[:1]
    for key in keys[1:]:
        while key[0] - kept[-1][0] < 0.02 and len(kept) > 1 and kept[-1][1] == 0.0:
            kept.pop()
        if key[0] - kept[-1][0] >= 0.02:
            kept.append(key)
    kept.append((max(t[-1], kept[-1][0]) + 1.0, 0.0))
    at, value = np.array(kept).T
    return PchipInterpolator(at, value)(t)
