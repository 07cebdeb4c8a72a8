"""Walking styles: the numbers that stay constant through a clip, for a few characters.

A style shows in trunk lean, elbows, arm swing, width of the track and turning of the chest; the
timing of steps varies much less. Angles in degrees, lengths in metres, factors relative to the
neutral walk at the same speed.
"""

from dataclasses import dataclass, fields, replace

import numpy as np


@dataclass(frozen=True, kw_only=True)
class Style:
    """Constants of one walker; the defaults are the neutral walk."""

    name: str = "neutral"
    cadence: float = 1.0  # factor on steps per minute
    stance: float = 0.0  # added to the stance fraction
    asymmetry: float = 0.0  # share of a cycle by which the right foot is late
    width: float = 0.075  # distance between the two lines of footprints
    toe_out: float = 6.0
    crouch: float = 0.0  # metres the pelvis is lower
    bounce: float = 1.0  # vertical pelvis movement, factor
    sway: float = 1.0  # lateral pelvis movement, factor
    lift: float = 1.0  # height of the swinging foot, factor
    pelvis_yaw: float = 1.0
    chest_yaw: float = 1.0
    lean: float = 0.0  # trunk, forward
    head: float = 0.0  # extra, forward
    arms: float = 1.0  # arm swing, factor
    arms_right: float = 1.0  # the right arm's swing over the left's
    elbow: float = 0.0  # added to the elbows
    abduct: float = 8.0  # upper arms away from the body
    behaviours: float = 6.0  # behaviours per minute: looking about, waving, hands on hips


STYLES: dict[str, Style] = {
    s.name: s
    for s in (
        Style(),
        Style(
            name="old",
            cadence=1.08,
            stance=0.02,
            width=0.15,
            toe_out=14.0,
            crouch=0.035,
            bounce=0.7,
            sway=0.9,
            lift=0.75,
            pelvis_yaw=0.7,
            chest_yaw=1.2,
            lean=20.0,
            head=8.0,
            arms=0.65,
            elbow=24.0,
            abduct=10.0,
        ),
        Style(
            name="strut",
            cadence=0.98,
            width=0.13,
            toe_out=9.0,
            sway=1.4,
            lift=1.1,
            pelvis_yaw=1.25,
            chest_yaw=2.2,
            lean=-6.0,
            head=-3.0,
            arms=1.1,
            elbow=10.0,
            abduct=17.0,
        ),
        Style(
            name="crouch",
            cadence=0.92,
            stance=0.01,
            width=0.2,
            toe_out=12.0,
            crouch=0.1,
            bounce=0.9,
            sway=1.2,
            lift=1.1,
            pelvis_yaw=1.5,
            chest_yaw=1.8,
            lean=24.0,
            head=-14.0,
            arms=0.5,
            elbow=55.0,
            abduct=20.0,
        ),
        Style(
            name="brisk",
            cadence=1.07,
            stance=-0.01,
            width=0.06,
            toe_out=4.0,
            bounce=1.1,
            sway=0.85,
            pelvis_yaw=1.1,
            chest_yaw=0.9,
            lean=3.0,
            arms=1.35,
            elbow=32.0,
            abduct=9.0,
        ),
        Style(
            name="tired",
            cadence=0.93,
            stance=0.02,
            width=0.1,
            toe_out=8.0,
            crouch=0.015,
            bounce=0.8,
            sway=1.2,
            lift=0.8,
            pelvis_yaw=0.8,
            chest_yaw=0.8,
            lean=9.0,
            head=14.0,
            arms=0.55,
            elbow=-4.0,
            abduct=5.0,
        ),
    )
}
SHARES = {"neutral": 0.45, "old": 0.1, "strut": 0.12, "crouch": 0.08, "brisk": 0.13, "tired": 0.12}

# how much persons of one style differ: sd of each number (for factors, of the logarithm)
STD = {
    "cadence": 0.025,
    "stance": 0.008,
    "asymmetry": 0.006,
    "width": 0.018,
    "toe_out": 2.5,
    "crouch": 0.006,
}
STD |= {
    "bounce": 0.08,
    "sway": 0.1,
    "lift": 0.06,
    "pelvis_yaw": 0.12,
    "chest_yaw": 0.2,
    "lean": 1.5,
    "head": 2.0,
}
STD |= {"arms": 0.14, "arms_right": 0.08, "elbow": 3.5, "abduct": 2.0}
FACTORS = ("cadence", "bounce", "sway", "lift", "pelvis_yaw", "chest_yaw", "arms", "arms_right")


def draw_style(name: str | None, rng: np.random.Generator) -> str:
    """The given name, or one drawn by SHARES.

    Raises ValueError for a name that is not in STYLES.
    """
    if name is None:
        return str(rng.choice(list(SHARES), p=list(SHARES.values())))
    if name not in STYLES:
        raise ValueError(f"no style is called {name!r}; there are {', '.join(STYLES)}")
    return name


def person(style: Style, rng: np.random.Generator) -> Style:
    """One walker of this style: each constant differs at random, by at most two of its STD."""
    new = {}
    for f in fields(style):
        if f.name in STD:
            shift = STD[f.name] * float(np.clip(rng.standard_normal(), -2, 2))
            old = getattr(style, f.name)
            new[f.name] = old * float(np.exp(shift)) if f.name in FACTORS else old + shift
    side = 1.0 if rng.random() < 0.5 else -1.0  # no person is exactly symmetric
    new["asymmetry"] += 0.006 * side
    new["width"] = max(new["width"], 0.02)
    return replace(style, **new)
