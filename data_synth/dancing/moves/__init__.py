"""The vocabularies: the moves and the manner of each genre, one file each."""

from dataclasses import dataclass

from ...walking.legs import LEVEL
from ..stage import StagePlan
from ..steps import Roll
from . import hiphop, house, latin, pop, waltz


@dataclass(frozen=True)
class Manner:
    """The manner of a genre.

    It has the stillness at the keys, the flow through them, the arms' spring, and the rest posture.
    """

    moves: tuple
    calm: tuple  # for breaks
    hold: float  # share of the time between two keys that is still
    flow: float  # 0 stops at each key, 1 passes through
    spring: float  # Hz: how tightly the arms follow
    lead: float  # seconds by which the dancer starts early, so that the stillness is on the beat
    rest: dict[str, float]
    variety: float = 1.0  # factor on the differences of posture between persons
    level: float = LEVEL  # metres: a foot farther beside its hip pulls the pelvis along
    roll: Roll = Roll()
    stage: StagePlan = StagePlan(0.0, (0.0,), 0.0)  # on the spot, facing one way


_BENT = {
    f"{side}_{name}": value
    for side in "lr"
    for name, value in (("elbow", 62.0), ("swing", 16.0), ("out", 20.0))
}
_ROUND = {
    f"{side}_{name}": value
    for side in "lr"
    for name, value in (("elbow", 40.0), ("swing", 22.0), ("out", 34.0))
}

# quick feet of clubs are on their balls; in hip-hop and latin dances they press into the floor, in
# a waltz they roll slowly (seconds and degrees were set by looking at pictures)
_LIGHT = Roll(early=0.24, off=22.0, land=20.0, settle=0.20, pivot=16.0, steepest=50.0)
_PRESSED = Roll(early=0.24, off=27.0, land=25.0, settle=0.20, pivot=16.0, steepest=50.0)
_SLOW = Roll(early=0.34, off=24.0, land=20.0, settle=0.28, pivot=16.0, steepest=50.0)

MANNERS: dict[str, Manner] = {
    "house": Manner(
        house.MOVES,
        house.CALM,
        0.10,
        0.15,
        4.0,
        0.012,
        {"drop": 0.04, "lean": 7.0, **_BENT},
        roll=_LIGHT,
        stage=StagePlan(0.15, (45.0, 90.0, 90.0, 135.0), 0.06),
    ),
    "hiphop": Manner(
        hiphop.MOVES,
        hiphop.CALM,
        0.14,
        0.10,
        4.5,
        0.012,
        {"drop": 0.05, "lean": 7.0},
        roll=_PRESSED,
        stage=StagePlan(0.18, (45.0, 90.0, 90.0, 135.0), 0.07),
    ),
    "pop": Manner(
        pop.MOVES,
        pop.CALM,
        0.18,
        0.08,
        5.0,
        0.03,
        {"drop": 0.025, "lean": 2.0},
        roll=_LIGHT,
        stage=StagePlan(0.14, (0.0, 45.0, 90.0, 90.0), 0.05),
    ),
    "latin": Manner(
        latin.MOVES,
        latin.CALM,
        0.10,
        0.20,
        4.0,
        0.03,
        {"drop": 0.03, "lean": 2.0, **_BENT},
        roll=_PRESSED,
        stage=StagePlan(0.15, (45.0, 90.0, 90.0, 135.0), 0.05),
    ),
    "waltz": Manner(
        waltz.MOVES,
        waltz.CALM,
        0.10,
        0.18,
        3.2,
        0.045,
        {"drop": 0.02, "lean": 0.0, **_ROUND},
        roll=_SLOW,
        stage=StagePlan(0.06, (30.0, 45.0, 60.0), 0.0, stays=0.75),
    ),
}
