"""A sheet on which a move is written, in its own counts and beginning with the left foot.

The sheet mirrors the move, scales it, slows or quickens it, and enters it in the script of the
whole dance. It sees to the weight: before a foot lifts, the other one bears. Angles in degrees,
lengths in metres.
"""

from dataclasses import dataclass, replace
from math import cos, hypot, radians, sin

import numpy as np

from ..walking.footsteps import TOE_AHEAD
from .script import ARM, LENGTHS, STANCE, TURNS_SIGN, Script, Step
from .stage import Way

UNSCALED = ("weight", "look")
ARRIVED = 0.74  # the weight (0 both feet, 1 one alone) on a foot at the count it lands on
TOES_AHEAD = 0.4  # counts: a foot lands as the body will face by then, so that it need not twist
SHIFT = 0.12  # counts between the landing of one foot and the lift of the next
TOUCHED = -0.5  # the weight after a foot only touched: it is over the other one
FLIGHT = 0.26  # beats that a step lasts, at least
LATELY = 0.55  # beats: so long ago a foot landed that has no time for another step
NEAREST, WIDEST = 0.13, 0.56  # metres between the toes when a step lands


@dataclass(frozen=True)
class Counts:
    """`n` counts, the first at beat `start`, `rate` beats apart; `metre` beats to a bar."""

    start: float
    n: int
    rate: float
    metre: int


@dataclass(frozen=True)
class Flight:
    """How a foot goes through the air: metres up, counts on the way, degrees the toe points down.

    `scaled`: a long stride of the dancer's carries it farther. `after`: it waits until the other
    foot has landed. `instead`: where there is no time for it, the flight before goes there.
    """

    height: float
    swing: float
    kick: float = 0.0
    scaled: bool = True
    after: bool = False
    instead: bool = False


class Sheet:
    """The page of one move.

    `size` scales how far it goes, `stride` the steps; `mirrored` swaps left and right; `rng` is for
    its own choices.
    """

    def __init__(
        self,
        script: Script,
        counts: Counts,
        mirrored: bool,
        size: float,
        stride: float,
        rest: dict[str, float],
        rng: np.random.Generator,
    ):
        self.script = script
        self.start = counts.start
        self.n = counts.n
        self.rate = counts.rate
        self.metre = counts.metre
        self.sign = -1 if mirrored else 1
        self.size = size
        self.stride = stride
        self.rest = rest
        self.rng = rng
        self.keys: dict[str, list[tuple[float, float]]] = {}
        self.way = Way()  # over the stage, while the move goes on

    def key(self, name: str, *pairs: tuple[float, float]) -> None:
        """Key values of a channel: (count, value) ..."""
        if self.sign < 0 and name[:2] in ("l_", "r_"):
            name = {"l": "r", "r": "l"}[name[0]] + name[1:]
        turned = self.sign if name in TURNS_SIGN else 1
        rest = self.rest[name]
        scale = 1.0 if name in UNSCALED else self.size**0.5 if name[1] == "_" else self.size
        for count, value in pairs:
            uneven = 1.0 if name == "weight" else 1 + 0.09 * self.rng.standard_normal()
            entry = rest + scale * uneven * (turned * value - rest)
            entry += self.way.sunk(count) if name == "drop" else 0.0
            self.keys.setdefault(name, []).append((self.start + count * self.rate, entry))

    def arms(self, count: float, left, right=None) -> None:
        """Both arms at a count: (swing, out, twist, elbow[, wrist, shrug]) each.

        The right as the left if not given.
        """
        for side, pose in (("l", left), ("r", left if right is None else right)):
            pose = (*pose, *(8.0, 0.0)[len(pose) - 4 :])
            for name, value in zip(ARM, pose, strict=True):
                self.key(f"{side}_{name}", (count, value))

    def home(self, count: float) -> tuple[float, float, float]:
        """Where the move's own floor is at a count, on its way over the stage: x, z, heading."""
        x, z, heading = self.script.home
        dx, dz = self.way.travelled(count)
        return x + dx, z + dz, heading + self.way.turned(count)

    def place(self, x: float, z: float, yaw: float, count: float) -> tuple[float, float, float]:
        """From the move's own floor (left, ahead, degrees to the left) at a count to the world's.

        x, z, yaw.
        """
        hx, hz, heading = self.home(count)
        x = self.sign * x
        s, c = sin(heading), cos(heading)
        return hx + x * c + z * s, hz - x * s + z * c, heading + self.sign * radians(yaw)

    def step(
        self,
        foot: int,
        count: float,
        x: float,
        z: float,
        turn: float | None = None,
        height: float = 0.06,
        weight: bool = True,
        swing: float = 0.80,
    ) -> None:
        """Put a foot (0 left, 1 right) down at a count, its ankle at (x left, z ahead) of home.

        The weight goes to the other foot before it lifts, and over to it after it has landed unless
        `weight` is False.
        """
        side = 1 if foot == 0 else -1
        flight = Flight(height, swing, after=weight, instead=True)
        lift = self._put(foot, count, x, z, turn, flight)
        if lift is None:
            return
        real = self.foot(foot)
        if self.script.bore[0] == real:
            self._free()
        self.key("weight", ((lift - self.start) / self.rate, -0.93 * side))
        if weight:  # the rest of it follows before the other foot lifts
            self.key("weight", (count + 0.06 / self.rate, ARRIVED * side))
            self.script.bore = (real, self.keys["weight"][-1][0])

    def _free(self) -> None:
        """The foot that bears is to step again.

        So the other foot takes the weight if it landed since; if it did not, the last step was a
        touch, without the weight.
        """
        real, at = self.script.bore
        landed = self.script.down[1 - real]
        if landed > at:
            keys = self.keys.setdefault("weight", [])
            keys.append((landed + 0.1, -ARRIVED if real == 0 else ARRIVED))
            return
        touch = TOUCHED if real == 0 else -TOUCHED
        for keys in (self.keys.get("weight", []), self.script.keys["weight"]):
            keys[:] = [(beat, touch if beat == at else value) for beat, value in keys]

    def jump(
        self,
        count: float,
        left: tuple[float, float],
        right: tuple[float, float],
        height: float = 0.09,
        turns: tuple[float, float] = (9.0, -9.0),
        swing: float = 0.6,
    ) -> None:
        """Both feet leave the floor together and come down at a count, at (x, z) each."""
        count -= 0.07  # the knees give after it
        lifts = [
            self._put(foot, count, *at, turns[foot], Flight(height, swing, 22.0))
            for foot, at in ((0, left), (1, right))
        ]
        self.both(count - 0.8 * swing)
        self.both(count + 0.07)
        for lift in lifts:
            if lift is not None:
                self.key(
                    "drop",
                    (count - 0.5 * swing, 0.02 - 0.9 * height),
                    (count - swing - 0.05, 0.075),
                )

    def hop(
        self,
        foot: int,
        count: float,
        height: float = 0.05,
        turn: float | None = None,
        swing: float = 0.42,
    ) -> None:
        """The standing foot leaves the floor where it is and comes down again at a count."""
        x, z = self.at(self.foot(foot), count)
        flight = Flight(height, swing, 20.0, scaled=False)
        if self._put(foot, count, x, z, turn, flight) is not None:
            self.key("drop", (count - 0.5 * swing, 0.015 - 0.6 * height))
            self.key(
                "weight",
                (count - swing, 0.93 if foot == 0 else -0.93),
                (count, 0.93 if foot == 0 else -0.93),
            )

    def at(self, real: int, count: float = 0.0) -> tuple[float, float]:
        """Where a foot of the dancer's has its ankle, on the move's own floor at a count."""
        x, z, yaw = self.script.toes[real]
        hx, hz, heading = self.home(count)
        dx = x - TOE_AHEAD * sin(yaw) - hx
        dz = z - TOE_AHEAD * cos(yaw) - hz
        s, c = sin(heading), cos(heading)
        return self.sign * (dx * c - dz * s), dx * s + dz * c

    def _put(self, foot, count, x, z, turn, flight: Flight) -> float | None:
        """Write down one step.

        The beat at which it lifts, or None where there is no time for it.
        """
        side, real = (1 if foot == 0 else -1), self.foot(foot)
        if flight.scaled:
            x = side * STANCE + self.stride * (x - side * STANCE)
            z = self.stride * z
        px, pz, yaw = self.place(x, z, side * 7.0 if turn is None else turn, count)
        yaw += self.way.turned(count + TOES_AHEAD) - self.way.turned(count)
        land = self.start + (count - 0.04) * self.rate
        lift = max(land - max(flight.swing * self.rate, 0.3), self.script.landed[real] + 0.25)
        if flight.after:
            lift = max(lift, self.script.down[1 - real] + SHIFT * self.rate)
        toe = self._spread(real, px + TOE_AHEAD * sin(yaw), pz + TOE_AHEAD * cos(yaw)) + (yaw,)
        if land - lift < FLIGHT:
            return self._instead(real, toe, land) if flight.instead else None
        out = self._round_the_other(real, toe)
        height = flight.height * (0.6 + 0.4 * self.size)
        self.script.steps[real].append(Step(lift, land, *toe, height, out, flight.kick))
        self.script.toes[real], self.script.landed[real] = toe, land
        self.script.down[real] = land
        return lift

    def _instead(self, foot: int, toe, land: float) -> float | None:
        """There is no time for a step, so the last one of this foot goes there, if it was just now.

        The beat at which that one lifted; None if there was none, and the foot stays.
        """
        steps = self.script.steps[foot]
        if not steps or steps[-1].pivot or land - steps[-1].land > LATELY:
            return None
        steps[-1] = replace(steps[-1], x=toe[0], z=toe[1], yaw=toe[2])
        self.script.toes[foot] = toe
        return steps[-1].lift

    def _spread(self, foot: int, x: float, z: float) -> tuple[float, float]:
        """A toe place brought to where the legs reach: NEAREST to WIDEST from the other toe."""
        ox, oz, _ = self.script.toes[1 - foot]
        gap = hypot(x - ox, z - oz)
        scale = min(max(gap, NEAREST), WIDEST) / max(gap, 1e-6)
        return ox + scale * (x - ox), oz + scale * (z - oz)

    def kick(
        self,
        foot: int,
        count: float,
        x: float,
        z: float,
        height: float,
        toe: float = 25.0,
        half: float = 0.48,
    ) -> None:
        """Swing a foot out, up to `height` at a count, and set it down again.

        It goes to (x left, z ahead) of where it stands.

        `toe` is how far it points down (degrees; negative: the heel first); `half` the counts from
        the floor to there.
        """
        real, at = self.foot(foot), self.start + count * self.rate
        half = max(half * self.rate, 0.28)
        lift = max(at - half, self.script.landed[real] + 0.25)
        if at - lift < 0.2:
            return
        facing = self.home(count)[2]
        s, c = sin(facing), cos(facing)
        x = self.sign * x
        out = self.size * (x * c + z * s), self.size * (z * c - x * s)
        self.script.steps[real].append(
            Step(lift, at + (at - lift), *self.script.toes[real], height * self.size, out, toe)
        )
        self.script.landed[real] = at + (at - lift)
        self.key("weight", ((lift - self.start) / self.rate, -0.93 * (1 if foot == 0 else -1)))

    def _round_the_other(self, foot: int, toe) -> tuple[float, float]:
        """How far the path must bulge to pass the other foot.

        The swinging foot passes it at 0.15 m or more.
        """
        ax, az, _ = self.script.toes[foot]
        bx, bz, _ = toe
        ox, oz, _ = self.script.toes[1 - foot]
        length = hypot(bx - ax, bz - az)
        u = min(
            max(((ox - ax) * (bx - ax) + (oz - az) * (bz - az)) / max(length, 1e-6) ** 2, 0.0), 1.0
        )
        dx, dz = ax + u * (bx - ax) - ox, az + u * (bz - az) - oz
        gap = hypot(dx, dz)
        if not 0.1 < u < 0.9 or gap > 0.15:
            return 0.0, 0.0
        bulge = (0.15 - gap) / max(sin(np.pi * u) ** 2, 0.3) / max(gap, 1e-6)
        return bulge * dx, bulge * dz

    def pivot(self, foot: int, count: float, turn: float, during: float = 0.6) -> None:
        """Turn a planted foot about its toe to `turn` degrees (left) from home by a count."""
        real, land = self.foot(foot), self.start + count * self.rate
        lift = max(land - during * self.rate, self.script.landed[real] + 0.02)
        if land - lift < 0.15:
            return
        x, z, _ = self.script.toes[real]
        yaw = self.home(count)[2] + self.sign * radians(turn)
        self.script.steps[real].append(Step(lift, land, x, z, yaw, 0.0, pivot=True))
        self.script.toes[real], self.script.landed[real] = (x, z, yaw), land

    def inward(self) -> int:
        """1 if the middle of the stage lies ahead of home, -1 if it lies behind."""
        x, z, heading = self.script.home
        return 1 if x * sin(heading) + z * cos(heading) <= 0 else -1

    def foot(self, foot: int) -> int:
        """Which foot of the dancer's a move's left (0) or right (1) one is."""
        return foot if self.sign > 0 else 1 - foot

    def both(self, count: float) -> None:
        """The weight on both feet."""
        self.key("weight", (count, 0.0))

    def go(
        self, count: float, x: float = 0.0, z: float = 0.0, turn: float = 0.0, during: float = 1.0
    ) -> None:
        """Home moves (left, ahead) and turns (degrees to the left) by a count.

        What follows is seen from there.
        """
        heading = self.script.home[2]
        end = self.start + count * self.rate
        began = self.start + (count - during) * self.rate
        px, pz, _ = self.place(self.stride * x, self.stride * z, 0.0, count)
        dx, dz = self.way.travelled(count)
        after = heading + self.sign * radians(turn)
        if turn:
            keys = self.keys.setdefault("heading", [])
            base = self.script.turned  # the turn of the stage's plan is a curve of its own
            began = max(began, self.script.heading_at + 0.07)
            keys += [(began, heading - base), (end, after - base)]
            self.script.heading_at = end
        self.script.home = (px - dx, pz - dz, after)

    def close(self) -> None:
        """Enter the move; a channel that it did not use goes back to rest."""
        last = self.start + (self.n - 1) * self.rate
        for name, rest in self.rest.items():
            if name not in self.keys and name != "weight":
                wander = (
                    0.03
                    * self.rng.standard_normal(2)
                    * (abs(rest) + (0.1 if name in LENGTHS else 30))
                )
                first = self.start + 0.5 * self.rng.random()
                self.keys[name] = [
                    (first, rest + wander[0]),
                    (max(last, first + 0.5), rest + wander[1]),
                ]
        self.script.enter(self.keys)
        self._follow_the_way()

    def _follow_the_way(self) -> None:
        """Home, and the floor of the moves that follow, are where the way of this one leads."""
        script = self.script
        script.floor += [
            (self.start + count * self.rate, script.turned + turn)
            for count, turn in zip(self.way.counts, self.way.turn, strict=True)
            if self.start + count * self.rate > script.floor[-1][0] + 1e-6
        ]
        script.home = self.home(self.n)
        script.turned += self.way.turned(self.n)
