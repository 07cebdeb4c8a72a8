"""Acts on the spot: squat, jump, kick, sit down, get up, bow; and how a figure waits in between.

They are written on the sheet that the dances use, whose counts are seconds here.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from motiondiff_edu.motion.root_frame import FPS

from ..dancing.moves import Manner
from ..dancing.performance import ARMS, performed
from ..dancing.script import ARM, REST, Script
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
SEATED = {"surge": -0.24, "lean": 6.0}
ON_THE_THIGHS = (12.0, 10.0, 26.0, 58.0)
SEAT = (0.38, 0.41)  # metres that the pelvis is lower on a chair
STAY = "stay"  # no verb: what the legs of a seated figure do, while nothing is said of them
HANDS = {  # poses in which people wait, and how often
    "hanging": (ARMS_DOWN["l_swing"], ARMS_DOWN["l_out"], ARMS_DOWN["l_twist"], 18.0),
    "on the hips": (-24.0, 46.0, 42.0, 96.0),
    "clasped": (2.0, 6.0, 58.0, 44.0),
}
OFTEN = {"hanging": 0.7, "on the hips": 0.15, "clasped": 0.15}
IDLE = 1.2  # seconds: who waits longer shifts the weight, and looks around
LEG, HIP = 0.83, 0.88  # metres: of a straight leg, and the height of its socket


@dataclass(frozen=True)
class Timed:
    """An act of the legs from `first`, in seconds of its block, each time lasting `period`.

    `carried`: metres that the way before it carries a jump ahead.
    """

    act: Act
    first: float
    period: float
    carried: float = 0.0

    @property
    def last(self) -> float:
        return self.first + self.act.count * self.period


def squat(p: Sheet, at: float, one: Timed) -> None:
    """Down with the arms ahead, and up again."""
    period = one.period
    depth = float(p.rng.uniform(0.28, 0.36))
    low, high = at + 0.46 * period, at + 0.95 * period
    p.key("drop", (at + 0.04, 0.015), (low, depth), (high, 0.015))
    p.key("surge", (at + 0.04, 0.0), (low, -0.05), (high, 0.0))
    p.key("lean", (at + 0.04, 3.0), (low, 30.0), (high, 3.0))
    p.key("nod", (at + 0.04, 0.0), (low, -16.0), (high, 0.0))
    _arms_at_rest(p, at + 0.04)
    p.arms(low, BALANCE)
    _arms_at_rest(p, high)


def jump(p: Sheet, at: float, one: Timed) -> None:
    """Crouch with the arms back, both feet off the floor, and soft knees after it."""
    period = one.period
    flight = float(p.rng.uniform(0.40, 0.48))
    height = float(p.rng.uniform(0.14, 0.20))
    land = at + CROUCH * period + flight
    off = land - flight
    ahead = 0.32 if one.act.direction == "forward" else one.carried
    places = [p.at(p.foot(foot)) for foot in (L, R)]
    p.key("drop", (at + 0.02, 0.015), (off - 0.1, 0.20))
    p.key("lean", (at + 0.02, 3.0), (off - 0.1, 24.0), (off + 0.12, 0.0), (land + 0.1, 14.0))
    _arms_at_rest(p, at + 0.02)
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
    _arms_at_rest(p, max(at + 0.97 * period, land + 0.3))


def kick(p: Sheet, at: float, one: Timed) -> None:
    """One foot swings ahead and up, with the arms in guard."""
    period = one.period
    foot = L if one.act.side == "left" else R
    side = 1.0 if foot == L else -1.0
    height = float(p.rng.uniform(0.42, 0.75))
    far = 0.9 * float(np.sqrt(LEG**2 - (HIP - height) ** 2))  # of the foot, the leg nearly straight
    top = at + 0.5 * period
    half = _swing(period)
    again = at > one.first
    p.key("weight", (at, -0.5 * side if again else 0.0))
    p.kick(foot, top, -0.05 * side, far, height, 24.0, half=half)
    p.key("surge", (at, 0.0), (top, -0.05), (at + 0.95 * period, 0.0))
    p.key("weight", (top + half, -0.93 * side), (at + period, -0.4 * side))
    p.key("lean", (at, 3.0), (top, -9.0), (at + 0.95 * period, 3.0))
    p.key("hip_tilt", (at, 0.0), (top, -12.0), (at + 0.95 * period, 0.0))
    p.key("drop", (top - half, 0.03), (top, 0.025), (at + 0.95 * period, 0.015))
    if again:
        p.arms(at, GUARD)
    else:
        _arms_at_rest(p, at)
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


def sit(p: Sheet, at: float, one: Timed) -> None:
    """Down to a chair's height, and upright there."""
    down = at + 0.72 * one.period
    p.key("drop", (at + 0.04, 0.015), (down, float(p.rng.uniform(*SEAT))))
    p.key("surge", (at + 0.04, 0.0), (down, SEATED["surge"]))
    p.key("lean", (at + 0.04, 3.0), (at + 0.44 * one.period, 32.0))
    p.key("lean", (at + one.period, SEATED["lean"]))
    _arms_at_rest(p, at + 0.04)
    p.arms(down, ON_THE_THIGHS)


def rise(p: Sheet, at: float, one: Timed) -> None:
    """From the chair to the feet, the trunk first ahead."""
    up = at + 0.92 * one.period
    for name, rest in (("drop", 0.015), ("surge", 0.0)):
        p.keys[name] = [(at + 0.08 * one.period, p.script.keys[name][-1][1])]
        p.key(name, (up, rest))
    p.key("lean", (at, 8.0), (at + 0.32 * one.period, 36.0), (up, 3.0))
    p.arms(at + 0.08 * one.period, ON_THE_THIGHS)
    _arms_at_rest(p, up)


def bow(p: Sheet, at: float, one: Timed) -> None:
    """The trunk bends forward from the hips, and comes up again."""
    period = one.period
    low = at + 0.42 * period
    hold = at + 0.52 * period
    up = at + 0.95 * period
    bend = float(p.rng.uniform(38.0, 52.0))
    for name, rest, value in (("lean", 3.0, bend), ("hip_tilt", 0.0, 22.0), ("nod", 0.0, 14.0)):
        p.key(name, (at + 0.04, rest), (low, value), (hold, value), (up, rest))
    _arms_at_rest(p, at + 0.04)
    p.arms(low, (26.0, 8.0, 14.0, 12.0))
    p.arms(hold, (26.0, 8.0, 14.0, 12.0))
    _arms_at_rest(p, up)


def _arms_at_rest(p: Sheet, at: float) -> None:
    """Both arms as this person waits."""
    p.arms(at, *(tuple(p.rest[f"{side}_{name}"] for name in ARM) for side in "lr"))


def stay(p: Sheet, at: float, one: Timed) -> None:
    """Nothing: the figure stays as it is."""


WRITERS: dict[str, Callable[[Sheet, float, Timed], None]] = {
    "squat": squat,
    "jump": jump,
    "kick": kick,
    "sit": sit,
    "rise": rise,
    "bow": bow,
    STAY: stay,
}


def acted(
    timed: list[Timed], standing: Standing, seconds: float, seed: int, seated: bool = False
) -> tuple[Piece, Standing]:
    """The acts, one after the other, from where the feet stand; and where they stand afterwards.

    The block lasts `seconds`. Before, between and after the acts the figure waits as it is: it
    stands, or sits on the chair where it sat down, or from the beginning if it is `seated`.
    """
    rng = np.random.default_rng([seed, 7])
    rest = REST | MANNER.rest | hands_of(np.random.default_rng([seed, 12]))
    script = Script()
    script.home = standing.root
    script.toes = list(standing.toes)
    calm = dict(rest)
    if seated:
        calm |= SEATED | {"drop": float(rng.uniform(*SEAT))} | _arms(ON_THE_THIGHS)
    for name, value in calm.items():
        script.keys[name].append((-2.0, value))
    script.keys["heading"].append((-2.0, script.home[2]))
    waits = -2.0
    for one in timed:
        script.enter(idle(_sheet(script, one.last, rest, rng), waits, one.first, calm))
        sheet = _sheet(script, one.last, rest, rng)
        for k in range(one.act.count):
            WRITERS[one.act.verb](sheet, one.first + k * one.period, one)
        if one.act.verb == "sit":
            calm |= {name: sheet.keys[name][-1][1] for name in ("drop", *SEATED)}
            calm |= _arms(ON_THE_THIGHS)
        elif one.act.verb != STAY:
            calm = dict(rest)
            sheet.key("weight", (one.last, 0.0))
        for name, value in calm.items():
            if name in sheet.keys and name != "weight":
                late = 0.5 if name in ARMS else 0.05
                sheet.keys[name].append((one.last + late, value))
        script.enter(sheet.keys)
        waits = one.last
    script.enter(idle(_sheet(script, seconds, rest, rng), waits, seconds + 0.5, calm))
    t = np.arange(round(seconds * FPS)) / FPS
    felt = (np.array([-10.0, seconds + 10.0]),) * 2
    positions, contacts = performed(
        script, t, felt, MANNER, seed, np.random.default_rng([seed, 8]), standing.toes
    )
    return Piece(positions, contacts), Standing((script.toes[L], script.toes[R]))


def _sheet(script: Script, last: float, rest: dict[str, float], rng: np.random.Generator) -> Sheet:
    """A sheet whose counts are seconds of the block."""
    return Sheet(script, Counts(0.0, int(np.ceil(last)), 1.0, 4), False, 1.0, 1.0, rest, rng)


def _arms(pose: tuple[float, ...]) -> dict[str, float]:
    """The channels of both arms in a pose."""
    return {
        f"{side}_{name}": value for side in "lr" for name, value in zip(ARM, pose, strict=False)
    }


def hands_of(rng: np.random.Generator) -> dict[str, float]:
    """The channels of a person's arms while they wait: one hand or both in one of HANDS."""
    kind = str(rng.choice(list(OFTEN), p=list(OFTEN.values())))
    both = _arms(HANDS[kind])
    if kind == "on the hips" and rng.random() < 0.4:  # one of them alone
        other = "lr"[int(rng.integers(2))]
        both |= {name: x for name, x in _arms(HANDS["hanging"]).items() if name[0] == other}
    return both


def idle(
    p: Sheet, first: float, last: float, calm: dict[str, float]
) -> dict[str, list[tuple[float, float]]]:
    """The keys of somebody who waits: the weight goes from foot to foot, and the eyes wander."""
    first = max(first, 0.0)
    if last - first < IDLE:
        return {}
    times = [first + 0.3]
    while times[-1] < last - 0.9:
        times.append(times[-1] + float(p.rng.uniform(0.9, 2.2)))
    side, keys = float(p.rng.choice([-1.0, 1.0])), {"look": [(first, 0.0)]}
    stands = calm["drop"] < SEAT[0] / 2
    if stands:
        keys["weight"] = [(first, 0.0)]
    for at in times[1:-1]:
        keys["look"].append((at, side * float(p.rng.uniform(4.0, 26.0))))
        if stands:
            keys["weight"].append((at, -side * float(p.rng.uniform(0.25, 0.7))))
        side = -side
    return {name: [*found, (last - 0.2, 0.0)] for name, found in keys.items()}
