"""How the body moves in one cycle of walking or running, and how that depends on speed.

There are curves and relations, and no state.

Phase p = 0 is the heel strike of one's own foot, p = 1 the next one. `run` is 0 for walking, 1 for
running. HAND, ELBOW, ROLL and HEIGHT follow mean curves measured on eight public recordings of
straight walking; relations with speed follow straight lines through them. No recorded pose is here
(README.md, "Licence and sources"). The rest is set by hand.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.interpolate import PchipInterpolator

RUN_SPEED = 2.2  # m/s at which walking becomes running

Frames = Float[np.ndarray, "*#T"]


@dataclass(frozen=True, eq=False)
class Gait:
    """What the whole body follows, frame by frame."""

    clock: Float[np.ndarray, "T"]  # cycles; the left heel strikes at whole numbers
    amount: Float[np.ndarray, "T"]  # 0 standing, 1 walking at the full rate
    ahead: Float[np.ndarray, "T"]  # share of the swing: little sideways and on the spot
    run: Float[np.ndarray, "T"]  # 0 walking, 1 running
    speed: Float[np.ndarray, "T"]  # m/s


def running(speed: Frames) -> Frames:
    """Share of running at this forward speed (m/s): 0 below about 2.05, 1 above about 2.35."""
    return 0.5 + 0.5 * np.tanh((speed - RUN_SPEED) / 0.1)


def cadence(forward: Frames, left: Frames, yaw: Frames, run: Frames) -> Frames:
    """Steps per second: (74 + 27 v) / 60 walking straight, (137 + 4.5 v) / 60 running.

    Sideways, backward and turning steps are faster.
    """
    ahead = np.where(forward < 0, -1.5 * forward, forward)
    v = np.hypot(ahead, 2.2 * left)
    walk = 74 + 27 * v + 8 * np.maximum(v - 1.6, 0) + 17 * np.abs(yaw) * np.exp(-0.6 * v)
    return (walk + (137 + 4.5 * v - walk) * run) / 60


def stance_fraction(forward: Frames, run: Frames) -> Frames:
    """Share of the cycle until the toe leaves.

    It is 0.63 - 0.044 v in a walk, and below one half (flight) in a run.

    A contact detector finds some 0.05 more: it counts the toe as down until it is faster than the
    pelvis.
    """
    walk = 0.63 - 0.044 * np.abs(forward) - 0.03 * np.maximum(forward - 1.5, 0)
    running_one = np.clip(0.28 - 0.05 * (forward - 2.61), 0.24, 0.33)
    return walk + (running_one - walk) * run


def fourier(table: list, harmonics: int) -> tuple[np.ndarray, np.ndarray]:
    """Coefficients (cosines, sines) of a periodic curve given at equal steps of phase.

    The mean comes first.
    """
    c = np.fft.rfft(table) / len(table)
    c = c[: harmonics + 1] * np.where(np.arange(harmonics + 1) == 0, 1, 2)
    return c.real, -c.imag


def periodic(coefficients: tuple[np.ndarray, np.ndarray], p: Frames) -> Frames:
    """The curve with these Fourier coefficients at phase p (cycles)."""
    cos, sin = coefficients
    angle = 2 * np.pi * np.asarray(p)[..., None] * np.arange(len(cos))
    return np.cos(angle) @ cos + np.sin(angle) @ sin


# Foot pitch in degrees, heel up positive. Abscissa: 0..1 through stance, 1..2 through swing, then
# again from 0.
_WALK_PITCH = [
    (0, -15),
    (0.065, -6.5),
    (0.14, 0),
    (0.58, 0),
    (0.7, 2),
    (0.86, 13),
    (1.0, 47),
    (1.1, 57),
]
_WALK_PITCH += [(1.28, 40), (1.5, 14), (1.7, -8), (1.88, -17), (2, -15)]
_RUN_PITCH = [
    (0, -7),
    (0.1, -3),
    (0.2, 0),
    (0.45, 0),
    (0.6, 6),
    (0.8, 28),
    (1.0, 58),
    (1.15, 78),
    (1.4, 88),
    (1.65, 48),
]
_RUN_PITCH += [(1.85, 4), (2, -7)]


def _loop(knots: Sequence[tuple[float, float]]) -> PchipInterpolator:
    x, y = np.array(knots).T
    return PchipInterpolator(
        np.concatenate([x - 2, x[1:], x[1:] + 2]), np.concatenate([y, y[1:], y[1:]])
    )


_WALK, _RUN = _loop(_WALK_PITCH), _loop(_RUN_PITCH)


def foot_pitch(x: Frames, run: Frames) -> Frames:
    """Pitch of the foot (degrees, heel up positive) at x = 0..1 of stance, 1..2 of swing."""
    walk = _WALK(x)
    return walk + (_RUN(x) - walk) * run


def swing_progress(u: float, run: float) -> float:
    """Progress of a swinging foot, 0..1; its speed is 0 at both ends."""
    w = u ** (1 + 0.35 * run)
    return w * w * (3 - 2 * w) + (1.7 - 1.7 * run) * u**2 * (1 - u) ** 3


def swing_lift(u: Frames, run: Frames) -> Frames:
    """Height of the swinging foot's pivot, as a share of the maximum."""
    u = np.clip(u, 0, 1)
    walk = u**1.35 * (1 - u) ** 4.4 / 0.0439
    return walk + (u**1.3 * (1 - u) ** 1.7 / 0.1314 - walk) * run


# Measured means over the cycle, steps of 10 %: own hand, elbow and hip up (degrees), pelvis height
# (share of its range)
HAND = fourier([-14, -8, 5, 20, 33, 36, 26, 12, 0, -10], 2)
ELBOW = fourier([13.5, 14, 21, 32, 43, 47, 39, 24, 19, 16], 3)
ROLL = fourier([-1.5, 2, 3, 1.5, 2, 1.5, -2, -3, -1.5, -2], 3)
HEIGHT = fourier([-0.41, -0.46, 0.07, 0.5, 0.26], 2)  # over one step, half a cycle
