"""House: the jack through the chest, quick light feet, loose knees."""

from ..sheet import Sheet
from .grooves import (
    bounce,
    brush,
    clap,
    counter,
    overhead,
    pick,
    pump,
    punch,
    reach,
    swing,
    tread,
    windmill,
)
from .turns import three_step

L, R = 0, 1


def jack(p: Sheet) -> None:
    """The torso rocks: chest forward and down on the count, back and up after it.

    Heels pump in turn.
    """
    tread(p, 0.17, 0.05, 0.07)
    for k in range(p.n):
        p.key("drop", (k, 0.085), (k + 0.5, 0.012))
        p.key("lean", (k, 19), (k + 0.5, -7))
        p.key("hip_tilt", (k, -7), (k + 0.5, 8))
        p.key("chest", (k, -9), (k + 0.5, 12))
        p.key("nod", (k, 12), (k + 0.5, -8))
        p.key("l_heel" if k % 2 else "r_heel", (k, 26))
        p.key("r_heel" if k % 2 else "l_heel", (k, 2))
        p.key("side", (k, 6 if k % 2 else -6))
        p.key("twist", (k, 12 if k % 2 else -12))
    pick(p, pump, punch, overhead, windmill)


def shuffle(p: Sheet) -> None:
    """Scooting sideways.

    One foot turns in and out under the weight, the other taps out and in after each count.
    """
    for k in range(p.n):
        out = k % 2 == 0
        p.step(R, k, -0.09, 0.0, turn=-30 if out else 26, height=0.025, swing=0.45)
        p.step(
            L,
            k + 0.5,
            0.30 if out else 0.10,
            0.05,
            turn=26 if out else -18,
            height=0.13,
            weight=False,
            swing=0.4,
        )
        p.key("weight", (k + 0.55, 0.5))
        p.key("l_knee", (k + 0.3, 26 if out else -10))
        p.key("hip_yaw", (k, 16 if out else -14))
        p.key("twist", (k, -18 if out else 16))
        p.go(k + 0.6, x=0.11)
    bounce(p, 0.08, 0.01, heels=14)
    pick(p, swing, pump, brush)


def side_step(p: Sheet) -> None:
    """Side, together, side, together; low, with the shoulders answering."""
    for k in range(p.n):
        if k % 4 in (0, 2):
            foot = L if k % 4 == 0 else R
            p.step(foot, k, 0.31 if foot == L else -0.31, 0.02)
        else:
            foot, other = (R, 0.10) if k % 4 == 1 else (L, -0.10)
            p.step(foot, k, other, -0.06, weight=False, height=0.09)
    for k in range(p.n):
        s = 1 if k % 4 in (0, 1) else -1
        p.key("side", (k, -7 * s if k % 2 == 0 else 6 * s))
        p.key("hip_roll", (k, 5 * s))
        p.key("lean", (k, 14 if k % 2 == 0 else 5))
    bounce(p, 0.095, 0.01, heels=12)
    counter(p, 14)
    pick(p, swing, clap, reach, windmill)


def loose_legs(p: Sheet) -> None:
    """The knee swings in and the foot flicks across, then out, foot by foot."""
    for k in range(p.n):
        foot = L if k % 2 == 0 else R
        s = 1 if foot == L else -1
        p.kick(foot, k, -0.20 * s, 0.20, 0.12, toe=24, half=0.4)
        p.step(foot, k + 0.9, 0.12 * s, 0.02, height=0.05, swing=0.42)
        mine, its = ("l_knee", "r_knee") if foot == L else ("r_knee", "l_knee")
        p.key(mine, (k, -16), (k + 0.5, 28))
        p.key(its, (k, 14))
        p.key("hip_yaw", (k, -15 * s))
        p.key("twist", (k, 20 * s))
        p.key("side", (k, 6 * s))
    bounce(p, 0.095, 0.005, heels=16)
    pick(p, swing, pump, punch)


def cross_step(p: Sheet) -> None:
    """Side, across in front, back to the side, touch."""
    for k in range(p.n):
        phase, way = k % 4, 1 if k % 8 < 4 else -1
        lead, trail = (L, R) if way == 1 else (R, L)
        if phase == 0:
            p.step(lead, k, 0.32 * way, 0.0)
        elif phase == 1:
            p.step(trail, k, 0.42 * way, 0.19, turn=18 * way)
        elif phase == 2:
            p.step(lead, k, 0.56 * way, -0.02)
        else:
            p.step(trail, k, 0.34 * way, -0.02, weight=False, height=0.1)
        if phase == 3 and k + 1 < p.n:
            p.go(k + 1, x=0.44 * way)
        p.key("hip_yaw", (k, (0, -24, 8, 0)[phase] * way))
        p.key("twist", (k, (6, 22, -8, 0)[phase] * way))
        p.key("lean", (k, (8, 12, 6, 4)[phase]))
    bounce(p, 0.09, 0.0, heels=16)
    pick(p, swing, overhead, reach, brush)


def stomp(p: Sheet) -> None:
    """Knee high between the counts, foot down hard on them; the arms drive it."""
    for k in range(p.n):
        foot = L if k % 2 == 0 else R
        s = 1 if foot == L else -1
        p.step(
            foot, k, 0.15 * s, 0.05 if k % 4 < 2 else -0.04, turn=14 * s, height=0.24, swing=0.88
        )
        p.key("lean", (k, 16), (k + 0.5, 2))
        p.key("drop", (k, 0.10), (k + 0.5, 0.01))
        p.key("twist", (k, 16 * s))
        p.key("nod", (k, 10), (k + 0.5, -4))
        p.key("hip_roll", (k, -4 * s))
    pick(p, punch, pump)


def skip(p: Sheet) -> None:
    """Hopping on one foot while the other knee comes up, two counts a side.

    The step, and the hop on it.
    """
    for k in range(p.n):
        s = 1 if k % 4 < 2 else -1
        foot, other = (L, R) if s > 0 else (R, L)
        if k % 2 == 0:
            p.step(foot, k, 0.16 * s, 0.05, height=0.08)
        else:
            p.hop(foot, k, 0.06)
            p.kick(other, k - 0.04, 0.03 * s, 0.22, 0.30, toe=34, half=0.5)
        p.key("drop", (k, 0.085))
        p.key("lean", (k, 13 if k % 2 == 0 else 3))
        p.key("twist", (k, 15 * s))
        p.key("hip_yaw", (k, -8 * s))
        p.key("side", (k, -5 * s if k % 2 == 0 else 4 * s))
    pick(p, pump, punch, clap)


def farmer(p: Sheet) -> None:
    """Behind, side, front on halves of the count, and a rest: the pas de bourree of the clubs."""
    for k in range(0, p.n, 2):
        lead, trail, s = (L, R, 1) if k % 4 == 0 else (R, L, -1)
        p.step(trail, k, 0.02 * s, -0.17, turn=-20 * s, swing=0.6)
        if k + 1 < p.n:
            p.step(lead, k + 0.55, 0.24 * s, -0.06, height=0.04, swing=0.45)
            p.step(trail, k + 1, 0.02 * s, 0.16, turn=10 * s, height=0.05, swing=0.45)
            p.step(lead, k + 1.6, 0.12 * s, 0.0, height=0.04, swing=0.45)
        p.key("hip_yaw", (k, 20 * s), (k + 1, -16 * s))
        p.key("twist", (k, -22 * s), (k + 1, 18 * s))
        p.key("lean", (k, 12), (k + 1, 8))
    bounce(p, 0.085, 0.01, heels=12)
    pick(p, swing, clap)


def sway_low(p: Sheet) -> None:
    """For breaks: small steps from side to side; head and shoulders keep the count."""
    tread(p, 0.18, 0.02, 0.04)
    for k in range(p.n):
        s = 1 if k % 2 == 0 else -1
        p.key("side", (k, -7 * s))
        p.key("twist", (k, 11 * s))
    bounce(p, 0.07, 0.01, heels=10)
    pick(p, swing, overhead)


def turn_step(p: Sheet) -> None:
    """Once round on three light steps to one side; then jacking steps, and once round again."""
    k = 0
    while k < p.n:
        if k % 8 == 0 and k + 3 < p.n:
            three_step(p, k, (40, 12, 40, 88), (26, 50, 0, 50))
            p.key("drop", (k, 0.10), (k + 1, 0.03), (k + 2, 0.03), (k + 3, 0.10))
            p.key("lean", (k, 12), (k + 1, 3), (k + 2, 3), (k + 3, 14))
            k += 4
            continue
        foot, s = (L, 1) if k % 2 == 0 else (R, -1)
        p.step(foot, k, 0.18 * s, 0.06 if k % 4 < 2 else -0.06, height=0.09)
        p.key("drop", (k, 0.09), (k + 0.5, 0.01))
        p.key("lean", (k, 18), (k + 0.5, -4))
        p.key("twist", (k, 16 * s))
        p.arms(k, (10, 40, 10, 80) if s > 0 else (48, 20, 24, 96))
        k += 1


def loft(p: Sheet) -> None:
    """Down into a low lunge with a hand to the floor, under and up on the other side."""
    for k in range(p.n):
        phase, s = k % 4, 1 if k % 8 < 4 else -1
        lead, trail = (L, R) if s > 0 else (R, L)
        if phase == 0:
            p.step(lead, k, 0.34 * s, 0.12, turn=30 * s)
        elif phase == 1:
            p.step(trail, k, 0.06 * s, 0.02, height=0.04)
        elif phase == 2:
            p.step(lead, k, 0.26 * s, -0.16, turn=-10 * s)
        else:
            p.step(trail, k, -0.06 * s, 0.02, height=0.12)
        p.key("drop", (k, (0.17, 0.20, 0.12, 0.02)[phase]))
        p.key("lean", (k, (26, 34, 18, -2)[phase]))
        p.key("side", (k, (-12, -4, 12, 4)[phase] * s))
        p.key("twist", (k, (20, -10, -24, 6)[phase] * s))
        p.key("look", (k, (20, 0, -24, 0)[phase] * s))
        low, wide = (38, 18, 10, 14), (10, 84, 0, 26)
        high = (120, 30, 0, 30)
        pair = ((low, wide), (low, low), (wide, low), (high, wide))[phase]
        p.arms(k, *(pair if s > 0 else pair[::-1]))


MOVES = (jack, shuffle, side_step, loose_legs, cross_step, stomp, skip, farmer, turn_step, loft)
CALM = (sway_low, jack)
