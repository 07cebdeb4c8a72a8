"""What the control means for the feet: rates and velocities per frame, and where a foot belongs.

It is causal: the velocity at frame t is control[t-1], which brought the root there.
"""

from dataclasses import dataclass
from math import cos, radians, sin

import numpy as np

from ..noise import drift, follow
from .gait_curves import cadence, stance_fraction
from .styles import Style

LEFT_FOOT, RIGHT_FOOT = 0, 1


@dataclass(frozen=True)
class Drive:
    """Inputs of the clock and the feet, per frame."""

    x: list
    z: list
    heading: list
    forward: list
    left: list
    yaw: list
    steps_per_second: list
    stance: list
    run: list
    need: list
    noise: list
    lean_shift: list


def drive(control, root_xz, heading, rows, style: Style, lean_shift, run, fps: float) -> Drive:
    """Rates and velocities per frame.

    Velocity at frame t is control[t-1], which brought the root there.
    """
    arrived = np.concatenate([control[:1], control[:-1]])
    smooth = follow(arrived, 0.06, fps)
    slow = drift(rows[:, 0], 3.0, fps)
    fast = drift(rows[:, 1], 0.3, fps)
    forward, left, yaw = smooth.T
    rate = cadence(forward, left, yaw, run) * style.cadence * np.exp(0.032 * slow + 0.012 * fast)
    # a changing velocity is extrapolated a little
    ahead = arrived + np.clip(1.2 * (arrived - smooth), -0.15, 0.15)
    need = np.sqrt(arrived[:, 0] ** 2 + arrived[:, 1] ** 2 + (0.25 * arrived[:, 2]) ** 2)
    columns = (
        *root_xz.T,
        heading,
        *ahead.T,
        rate,
        stance_fraction(smooth[:, 0], run) + style.stance,
    )
    columns += (run, need, rows[len(rows) - len(control) :, 2:6], lean_shift)
    return Drive(*(c.tolist() for c in columns))


def home(
    d: Drive, t: int, foot: int, style: Style, tau: float, ahead: float
) -> tuple[float, float, float]:
    """Where this foot belongs tau seconds after frame t if the velocity lasts: x, z, heading.

    `ahead`: the same for walking ahead (a foot passes under the hip before the middle of its
    stance).
    """
    side = 1.0 if foot == LEFT_FOOT else -1.0
    vf = d.forward[t]
    vl = d.left[t]
    w = d.yaw[t]
    middle, later = d.heading[t] + w * tau * 0.4, d.heading[t] + w * tau
    slow = 1 - 0.7 * min(abs(vf) / 0.8, 1.0)
    width = style.width * (1 - 0.5 * d.run[t]) + slow * (
        0.6 * min(abs(vl), 0.6) + 0.085 * min(abs(w), 2.0)
    )
    out = side * width / 2 + d.lean_shift[t]
    far, across = vf * (ahead if vf > 0 else tau), vl * tau
    sm = sin(middle)
    cm = cos(middle)
    sl = sin(later)
    cl = cos(later)
    x = d.x[t] + far * sm + across * cm + out * cl + 0.015 * sl
    z = d.z[t] + far * cm - across * sm - out * sl + 0.015 * cl
    return x, z, later + side * radians(style.toe_out)
