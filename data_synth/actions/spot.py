"""Acts on the spot: squat, jump, kick, sit down and get up, bow.

They are written on the sheet that the dances use, whose counts are seconds here.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from motiondiff_edu.motion.root_frame import FPS

from ..dancing.moves import Manner
from ..dancing.performance import ARMS, performed
from ..dancing.script import REST, Script
from ..dancing.sheet import Counts, Sheet
from .acts import Act
from .way import Piece, Standing

STILL = {"drop": 0.015, "lean": 3.0}
ARMS_DOWN = {
    f"{side}_{name}": value
    for side in "lr"
    for name, value in (("swing", 3.0), ("out", 9.0), ("twist", 14.0), ("elbow", 18.0))
}
MANNER = Manner(
    moves=(),
    calm=(),
    hold=0.0,
    flow=0.12,
    spring=3.0,
    lead=0.0,
    rest={**STILL, **ARMS_DOWN},
    variety=0.4,
    level=0.8,  # so that the leg of a kick is nearly straight
)
BALANCE = (62.0, 10.0, 10.0, 22.0)  # both arms ahead
GUARD = (30.0, 16.0, 24.0, 95.0)
BACK = (-35.0, 14.0, 10.0, 20.0)
L, R = 0, 1
CROUCH = 0.42  # of a jump's period
LEG, HIP = 0.83, 0.88  # metres: of a straight leg, and the height of its socket


@dataclass(frozen=True)
class Timed:
    """An act of the legs from `first`, in seconds of its block, each time lasting `period`."""

    act: Act
    first: float
    period: float

    @property
    def last(self) -> float:
        return self.first + self.act.count * self.period


def squat(p: Sheet, at: float, period: float, act: Act) -> None:
    """Down with the arms ahead, and up again."""
    depth = float(p.rng.uniform(0.28, 0.36))
    low, high = at + 0.46 * period, at + 0.95 * period
    p.key("drop", (at + 0.04, 0.015), (low, depth), (high, 0.015))
    p.key("surge", (at + 0.04, 0.0), (low, -0.05), (high, 0.0))
    p.key("lean", (at + 0.04, 3.0), (low, 30.0), (high, 3.0))
    p.key("nod", (at + 0.04, 0.0), (low, -16.0), (high, 0.0))
    p.arms(at + 0.04, _down(p))
    p.arms(low, BALANCE)
    p.arms(high, _down(p))


def jump(p: Sheet, at: float, period: float, act: Act) -> None:
    """Crouch with the arms back, both feet off the floor, and soft knees after it."""
    flight = float(p.rng.uniform(0.40, 0.48))
    height = float(p.rng.uniform(0.14, 0.20))
    land = at + CROUCH * period + flight
    off = land - flight
    ahead = 0.32 if act.direction == "forward" else 0.0
    places = [p.at(p.foot(foot)) for foot in (L, R)]
    p.key("drop", (at + 0.02, 0.015), (off - 0.1, 0.20))
    p.key("lean", (at + 0.02, 3.0), (off - 0.1, 24.0), (off + 0.12, 0.0), (land + 0.1, 14.0))
    p.arms(at + 0.02, _down(p))
    p.arms(off - 0.1, BACK)
    p.arms(off + 0.16, (105.0, 14.0, 8.0, 26.0))
    p.arms(land + 0.12, (35.0, 16.0, 12.0, 34.0))
    if ahead:
        p.go(land, z=ahead, during=flight)
        places = [(x, 0.0) for x, _ in places]
    left, right = places
    p.jump(land + 0.07, left, right, height=height, swing=flight)
    p.key("drop", (land + 0.16, 0.14), (max(at + 0.97 * period, land + 0.3), 0.015))
    p.key("lean", (max(at + 0.97 * period, land + 0.3), 3.0))
    p.arms(max(at + 0.97 * period, land + 0.3), _down(p))


def kick(p: Sheet, at: float, period: float, act: Act) -> None:
    """One foot swings ahead and up, with the arms in guard."""
    foot = L if act.side == "left" else R
    side = 1.0 if foot == L else -1.0
    height = float(p.rng.uniform(0.42, 0.75))
    far = 0.9 * float(np.sqrt(LEG**2 - (HIP - height) ** 2))  # of the foot, the leg nearly straight
    top = at + 0.5 * period
    half = _swing(period)
    p.key("weight", (at, 0.0 if at < 0.3 else -0.5 * side))
    p.kick(foot, top, -0.05 * side, far, height, 24.0, half=half)
    p.key("surge", (at, 0.0), (top, -0.05), (at + 0.95 * period, 0.0))
    p.key("weight", (top + half, -0.93 * side), (at + period, -0.4 * side))
    p.key("lean", (at, 3.0), (top, -9.0), (at + 0.95 * period, 3.0))
    p.key("hip_tilt", (at, 0.0), (top, -12.0), (at + 0.95 * period, 0.0))
    p.key("drop", (top - half, 0.03), (top, 0.025), (at + 0.95 * period, 0.015))
    p.arms(at, GUARD if at > 0.3 else _down(p))
    p.arms(top - 0.8 * half, GUARD)
    p.arms(top + half, GUARD)


def _swing(period: float) -> float:
    """Seconds from the floor to the top of a kick."""
    return float(np.clip(0.34 * period, 0.30, 0.5))


def on_the_floor(act: Act, period: float) -> float:
    """Seconds from the beginning of an act for which both feet stay where they stand."""
    if act.verb == "kick":
        return 0.5 * period - _swing(period)
    return CROUCH * period if act.verb == "jump" else act.count * period


def sit(p: Sheet, at: float, period: float, act: Act) -> None:
    """Down to a chair's height, upright there for a moment, and up again."""
    seat = float(p.rng.uniform(0.38, 0.41))
    down = at + 0.36 * period
    rise = at + 0.62 * period
    up = at + 0.97 * period
    for name, rest, value in (("drop", 0.015, seat), ("surge", 0.0, -0.24)):
        p.key(name, (at + 0.04, rest), (down, value))
        _hold(p, name, rise)
        p.key(name, (up, rest))
    p.key("lean", (at + 0.04, 3.0), (at + 0.22 * period, 32.0), (down + 0.1, 6.0))
    p.key("lean", (rise, 8.0), (rise + 0.14 * period, 36.0), (up, 3.0))
    p.arms(at + 0.04, _down(p))
    p.arms(down, (34.0, 12.0, 20.0, 46.0))
    p.arms(rise, (34.0, 12.0, 20.0, 46.0))
    p.arms(up, _down(p))


def bow(p: Sheet, at: float, period: float, act: Act) -> None:
    """The trunk bends forward from the hips, and comes up again."""
    low = at + 0.42 * period
    hold = at + 0.52 * period
    up = at + 0.95 * period
    bend = float(p.rng.uniform(38.0, 52.0))
    for name, rest, value in (("lean", 3.0, bend), ("hip_tilt", 0.0, 22.0), ("nod", 0.0, 14.0)):
        p.key(name, (at + 0.04, rest), (low, value), (hold, value), (up, rest))
    p.arms(at + 0.04, _down(p))
    p.arms(low, (26.0, 8.0, 14.0, 12.0))
    p.arms(hold, (26.0, 8.0, 14.0, 12.0))
    p.arms(up, _down(p))


def _hold(p: Sheet, name: str, until: float) -> None:
    """Keep the value of the last key of a channel until a time."""
    p.keys[name].append((until, p.keys[name][-1][1]))


def _down(p: Sheet) -> tuple[float, float, float, float]:
    swing, out, twist, elbow = (p.rest[f"l_{name}"] for name in ("swing", "out", "twist", "elbow"))
    return swing, out, twist, elbow


WRITERS: dict[str, Callable[[Sheet, float, float, Act], None]] = {
    "squat": squat,
    "jump": jump,
    "kick": kick,
    "sit": sit,
    "bow": bow,
}


def acted(
    timed: list[Timed], standing: Standing, seconds: float, seed: int
) -> tuple[Piece, Standing]:
    """The acts, one after the other, from where the feet stand; and where they stand afterwards.

    The block lasts `seconds`; after the last act the figure stands.
    """
    rest = REST | MANNER.rest
    script = Script()
    script.home = standing.root
    script.toes = list(standing.toes)
    for name, value in rest.items():
        script.keys[name].append((-2.0, value))
    script.keys["heading"].append((-2.0, script.home[2]))
    rng = np.random.default_rng([seed, 7])
    for one in timed:
        counts = Counts(0.0, int(np.ceil(one.last)), 1.0, 4)
        sheet = Sheet(script, counts, False, 1.0, 1.0, rest, rng)
        for k in range(one.act.count):
            WRITERS[one.act.verb](sheet, one.first + k * one.period, one.period, one.act)
        sheet.key("weight", (one.last, 0.0))
        for name, value in rest.items():
            if name in sheet.keys and name != "weight":
                sheet.key(name, (one.last + (0.5 if name in ARMS else 0.05), value))
        script.enter(sheet.keys)
    t = np.arange(round(seconds * FPS)) / FPS
    felt = (np.array([-10.0, seconds + 10.0]),) * 2
    positions, contacts = performed(
        script, t, felt, MANNER, seed, np.random.default_rng([seed, 8]), standing.toes
    )
    return Piece(positions, contacts), Standing((script.toes[L], script.toes[R]))
