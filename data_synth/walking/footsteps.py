"""When and where the feet go.

The control drives a gait clock. A footprint never moves after it is made.

It is causal: frame t depends on the root path and the noise up to t, so a held control decides
everything. A swinging foot aims at the middle of its next stance, for the present velocity; the
aim is fixed before it lands.
"""

from dataclasses import dataclass
from math import cos, exp, hypot, sin
from typing import no_type_check

import numpy as np
from jaxtyping import Bool, Float

from .drive import LEFT_FOOT, RIGHT_FOOT, Drive, home
from .gait_curves import swing_progress
from .styles import Style

TOE_AHEAD = 0.115  # of the ankle, foot flat (metres)
Place = tuple[float, float, float]  # x, z (metres) and direction (radians) of a flat foot's ankle
ACTIVE = 0.09  # m/s below which a figure stands, if its feet are in place


@dataclass(frozen=True)
class Steps:
    """The gait clock and both feet (index 0 left, 1 right) at every frame."""

    clock: Float[np.ndarray, "T"]  # cycles; the left heel strikes at whole numbers
    amount: Float[np.ndarray, "T"]  # 0 standing, 1 walking at the full rate
    ground: Float[np.ndarray, "T 2 2"]  # where the flat foot's ankle is, (x, z) in the world
    yaw: Float[np.ndarray, "T 2"]  # heading of the foot, radians
    progress: Float[np.ndarray, "T 2"]  # 0..1 through stance, 1..2 through swing
    stride: Float[np.ndarray, "T 2"]  # length of the present swing, metres (0 in stance)
    toe_up: Float[np.ndarray, "T 2"]  # how much the toe is raised at heel strike, 0..1


@no_type_check  # a dozen calls a frame: checking their numbers would take most of the time
class _Feet:
    """State of the loop: both feet and the clock."""

    def __init__(self, d: Drive, style: Style, phase: float, places: list[Place] | None = None):
        self.d = d
        self.style = style
        self.clock = phase
        self.rate = d.steps_per_second[0] / 2
        self.offset = [0.0, 0.5 + style.asymmetry]
        self.amount = [1.0, 1.0]
        if d.need[0] < ACTIVE:  # standing: both feet down, in the middle of double support
            self.clock = (0.0 if phase < 0.5 else 0.5) + 0.09
            self.rate = 0.0
            self.amount = [0.0, 0.0]
        self.toe_up = [0.0, 0.0]
        places = places or [home(d, 0, foot, style, 0.0, 0.0) for foot in (0, 1)]
        self.place = list(places)
        self.start = list(places)
        self.aim = list(places)
        self.swing, self.off_phase = [False, False], [0.65, 0.65]
        self.error = [(0.0, 0.0), (0.0, 0.0)]  # ahead and aside, of the present swing

    def phase(self, foot: int) -> float:
        return (self.clock + self.offset[foot]) % 1.0

    def displaced(self, t: int) -> bool:
        for foot in (0, 1):
            x, z, yaw = home(self.d, t, foot, self.style, 0.0, 0.0)
            px, pz, pyaw = self.place[foot]
            if (px - x) ** 2 + (pz - z) ** 2 > 0.10**2 or abs(pyaw - yaw) > 0.35:
                return True
        return False

    def tick(self, t: int, dt: float) -> None:
        d = self.d
        full = d.steps_per_second[t] / 2
        wanted = full * (1 + self.overstretched(t))
        trailing = max(self.phase(0), self.phase(1))
        if not any(self.swing) and d.stance[t] > 0.5:
            standing = d.need[t] < ACTIVE and not self.displaced(t)
            if standing:
                stop_at = 0.5 + 0.55 * (d.stance[t] - 0.5)
                wanted = min(full, max(0.0, 9.0 * (stop_at - trailing)))
            elif self.rate < 0.02 and self.amount[1] < 0.02:
                self.first_foot(t)
        old = self.rate
        self.rate += (wanted - old) * (1 - exp(-dt / 0.07))
        self.clock += dt * (old + self.rate) / 2
        k = 1 - exp(-dt / 0.12)
        self.amount[0] += k * (min(1.0, self.rate / full) - self.amount[0])
        self.amount[1] += k * (self.amount[0] - self.amount[1])

    def overstretched(self, t: int) -> float:
        """How much faster the step must be because a planted foot is far from the root, 0..1."""
        far = 0.0
        for foot in (0, 1):
            if not self.swing[foot] and self.phase(foot) > 0.25:
                far = max(
                    far, hypot(self.place[foot][0] - self.d.x[t], self.place[foot][1] - self.d.z[t])
                )
        return min(max((far - 0.50) / 0.15, 0.0), 1.2)

    def first_foot(self, t: int) -> None:
        """Choose the first foot from standing: it may be either.

        For sideways steps and turns it is usually the near one.
        """
        d = self.d
        lift_next = LEFT_FOOT if self.phase(0) > self.phase(1) else RIGHT_FOOT
        pull = 1.5 * d.noise[t][0] + 6 * d.left[t] + 1.5 * d.yaw[t]  # positive: the left foot
        if (pull > 0) != (lift_next == LEFT_FOOT):
            self.clock += 0.5

    def move(self, t: int, foot: int, dt: float) -> tuple[float, float]:
        """Advance one foot; returns (progress, stride)."""
        d, p = self.d, self.phase(foot)
        if self.swing[foot] and p < 0.25:
            self.swing[foot], self.place[foot] = False, self.aim[foot]
        if not self.swing[foot] and d.stance[t] <= p:
            self.swing[foot] = True
            self.off_phase[foot] = min(p, d.stance[t])
            self.start[foot] = self.place[foot]
            self.aim[foot] = self.target(t, foot, p)
            self.error[foot] = (0.009 * d.noise[t][1], 0.009 * d.noise[t][2])
        if not self.swing[foot]:
            self.pivot(t, foot, p / d.stance[t], dt)
            return min(p / d.stance[t], 1.0), 0.0
        u = (p - self.off_phase[foot]) / (1 - self.off_phase[foot])
        return 1.0 + u, self.fly(t, foot, p, u, dt)

    def target(self, t: int, foot: int, p: float) -> tuple[float, float, float]:
        rate = max(self.rate, 0.6 * self.d.steps_per_second[t] / 2)
        middle = self.d.stance[t]
        return home(
            self.d,
            t,
            foot,
            self.style,
            (1 - p + 0.48 * middle) / rate,
            (1 - p + (0.37 - 0.07 * self.d.run[t]) * middle) / rate,
        )

    def fly(self, t: int, foot: int, p: float, u: float, dt: float) -> float:
        ax, az, ayaw = self.target(t, foot, p)
        ex, ez = self.error[foot]
        s, c = sin(ayaw), cos(ayaw)
        ez += self.uncrossed(t, foot, ax, az, s, c)
        ax, az = ax + ex * s + ez * c, az + ex * c - ez * s
        keep = min(max((u - 0.52) / 0.36, 0.0), 1.0)
        gain = 1 - keep * keep * (3 - 2 * keep)
        self.aim[foot] = _between(self.aim[foot], (ax, az, ayaw), gain)
        share = swing_progress(min(u, 1.0), self.d.run[t])
        here = _between(self.start[foot], self.aim[foot], share)
        self.place[foot] = here
        want = min(max(self.d.forward[t] / 1.1, 0.0), 1.15)
        self.toe_up[foot] += (want - self.toe_up[foot]) * (1 - exp(-dt / 0.1))
        return float(
            hypot(self.aim[foot][0] - self.start[foot][0], self.aim[foot][1] - self.start[foot][1])
        )

    def uncrossed(self, t: int, foot: int, x: float, z: float, s: float, c: float) -> float:
        """How far the aim must move aside (left positive) so that slow feet do not cross."""
        side = 1.0 if foot == LEFT_FOOT else -1.0
        ox, oz, _ = self.place[1 - foot]
        apart = side * ((x - ox) * c - (z - oz) * s)
        return side * max(0.0, 0.10 - apart) * (1 - min(abs(self.d.forward[t]) / 0.5, 1.0))

    def pivot(self, t: int, foot: int, r: float, dt: float) -> None:
        """Turn the foot about its planted toe, late in the stance of a turning figure."""
        ease = min(max((r - 0.55) / 0.3, 0.0), 1.0)
        turn = 0.5 * self.d.yaw[t] * dt * ease * self.amount[1]
        x, z, yaw = self.place[foot]
        x += TOE_AHEAD * (sin(yaw) - sin(yaw + turn))
        z += TOE_AHEAD * (cos(yaw) - cos(yaw + turn))
        self.place[foot] = (x, z, yaw + turn)


def _between(a: Place, b: Place, share: float) -> Place:
    """A share of the way from one place to another."""
    x, z, yaw = (one + share * (other - one) for one, other in zip(a, b, strict=True))
    return x, z, yaw


def plan(
    d: Drive, style: Style, phase: float, fps: float, places: list[Place] | None = None
) -> Steps:
    """Run the clock and the feet over all frames.

    `places`: where the feet stand at first; else where they belong.
    """
    feet, n = _Feet(d, style, phase, places), len(d.x)
    rows = []
    for t in range(n):
        if t:
            feet.tick(t, 1 / fps)
        moves = [feet.move(t, foot, 1 / fps) for foot in (0, 1)]
        rows.append(
            (
                feet.clock,
                feet.amount[1],
                *feet.place[0],
                *feet.place[1],
                *moves[0],
                *moves[1],
                *feet.toe_up,
            )
        )
    a = np.array(rows)
    places = a[:, 2:8].reshape(n, 2, 3)
    return Steps(
        a[:, 0], a[:, 1], places[..., :2], places[..., 2], a[:, 8:12:2], a[:, 9:12:2], a[:, 12:14]
    )


def planted(steps: Steps, toe_height: Float[np.ndarray, "T 2"]) -> Bool[np.ndarray, "T 2"]:
    """A foot is planted while it is in stance with its toe on the floor."""
    return (steps.progress < 1.0) & (toe_height < 2e-4)
