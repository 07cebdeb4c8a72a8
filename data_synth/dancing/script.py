"""The script of a dance: key poses by channel, and footsteps, in beats of the song.

Angles are in degrees, lengths in metres. A move does not write here, but on its own `Sheet`
(sheet.py).
"""

from dataclasses import dataclass, field

from ..walking.footsteps import TOE_AHEAD

ARM = (
    "swing",
    "out",
    "twist",
    "elbow",
    "wrist",
    "shrug",
)  # ahead, aside, inward, bend, bend, shoulder up
REST = {
    # weight: 1 on the left foot, -1 on the right; drop: down
    "weight": 0.0,
    "sway": 0.0,
    "surge": 0.0,
    "drop": 0.02,
    "hip_yaw": 0.0,
    "hip_roll": 0.0,
    "hip_tilt": 0.0,  # to the left, left side up, forward
    # chest: forward, left side up, to the left, pushed out
    "lean": 3.0,
    "side": 0.0,
    "twist": 0.0,
    "chest": 0.0,
    "nod": 0.0,
    "look": 0.0,
    "cock": 0.0,  # of the head: down, to the left, left side up
    **{
        f"{side}_{name}": v
        for side in "lr"
        for name, v in zip(ARM, (6.0, 12.0, 18.0, 28.0, 8.0, 0.0), strict=True)
    },
    # heel raised; knee turned outward
    **{f"{side}_{name}": 0.0 for side in "lr" for name in ("heel", "knee")},
}
# channels that change their sign when left and right are swapped
TURNS_SIGN = ("weight", "sway", "hip_yaw", "hip_roll", "side", "twist", "look", "cock")
LENGTHS = ("weight", "sway", "surge", "drop")  # channels that are no angles
STANCE = 0.10  # of an ankle from the middle, standing


Toe = tuple[float, float, float]  # x, z (metres) and direction (radians) of a planted toe
START: tuple[Toe, Toe] = ((STANCE, TOE_AHEAD, 0.12), (-STANCE, TOE_AHEAD, -0.12))


@dataclass(frozen=True)
class Step:
    """One foot from `lift` to `land` (beats), to a toe place (x, z) and direction.

    In the air it passes `height`.
    """

    lift: float
    land: float
    x: float
    z: float
    yaw: float  # radians
    height: float
    out: tuple[float, float] = (0.0, 0.0)  # metres by which the path bulges half-way
    kick: float = 0.0  # degrees: toe down (+) or up (-) half-way
    pivot: bool = False  # the toe stays on the floor, only the direction changes


@dataclass
class Script:
    """The whole dance while it is being written."""

    keys: dict[str, list[tuple[float, float]]] = field(
        default_factory=lambda: {name: [] for name in (*REST, "heading")}
    )
    steps: tuple[list[Step], list[Step]] = field(default_factory=lambda: ([], []))
    home: tuple[float, float, float] = (0.0, 0.0, 0.0)  # x, z, heading (radians)
    toes: list[Toe] = field(default_factory=lambda: list(START))
    landed: list = field(default_factory=lambda: [-9.0, -9.0])
    down: list = field(
        default_factory=lambda: [-9.0, -9.0]
    )  # as landed, of steps alone: no pivots, no kicks
    bore: tuple[int, float] = (-1, -9.0)  # the foot that took the weight last, and when (beat)
    heading_at: float = -9.0
    floor: list[tuple[float, float]] = field(default_factory=lambda: [(-2.0, 0.0)])
    turned: float = 0.0  # radians by which the ways of the moves so far turned; see stage.py

    def enter(self, keys: dict[str, list[tuple[float, float]]]) -> None:
        """Add the keys of a move; later keys of older moves are removed."""
        for name, fresh in keys.items():
            fresh = sorted(fresh, key=lambda k: k[0])
            kept = [k for k in self.keys[name] if k[0] < fresh[0][0] - 0.12]
            for beat, value in fresh:
                if kept and beat - kept[-1][0] < 0.06:
                    kept[-1] = (kept[-1][0], value)
                else:
                    kept.append((beat, value))
            self.keys[name] = kept
