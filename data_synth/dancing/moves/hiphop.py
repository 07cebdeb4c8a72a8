"""Hip-hop: heavy on the count, knees deep, shoulders and arms in waves and hits."""

import numpy as np

from ..sheet import Sheet
from .grooves import (
    BACK,
    DOWN,
    GUARD,
    bounce,
    brush,
    clap,
    counter,
    overhead,
    pick,
    pump,
    punch,
    reach,
    roll,
    slide,
    swing,
    tread,
    windmill,
)
from .turns import half_round

L, R = 0, 1


def bouncing(p: Sheet) -> None:
    """Two knees, deep on the count; the shoulders rock and one arm drops at a time."""
    tread(p, 0.19, 0.05, 0.10)
    for k in range(p.n):
        s = 1 if k % 2 == 0 else -1
        p.key("drop", (k, 0.13), (k + 0.5, 0.045))
        p.key("lean", (k, 18), (k + 0.5, 6))
        p.key("side", (k, -10 * s))
        p.key("twist", (k, 20 * s))
        p.key("nod", (k, 12), (k + 0.5, -4))
        p.key("l_knee", (k, 14), (k + 0.5, 2))
        p.key("r_knee", (k, 14), (k + 0.5, 2))
        hit, rest = (52, 34, 22, 44, 20, -4), (-4, 40, 10, 104, 0, 10)
        p.arms(k, *((hit, rest) if s > 0 else (rest, hit)))


def rock(p: Sheet) -> None:
    """The weight falls from foot to foot, chest over it, the free heel up."""
    tread(p, 0.23, 0.07, 0.10)
    for k in range(p.n):
        s = 1 if k % 2 == 0 else -1
        p.key("side", (k, -12 * s))
        p.key("twist", (k, 15 * s))
        p.key("hip_roll", (k, 5 * s))
        p.key("cock", (k, -8 * s))
        p.key("l_heel", (k, 0 if s > 0 else 30))
        p.key("r_heel", (k, 30 if s > 0 else 0))
        p.key("l_knee", (k, 4 if s > 0 else -10))
        p.key("r_knee", (k, -10 if s > 0 else 4))
    bounce(p, 0.11, 0.015)
    pick(p, swing, roll, pump, windmill)


def running_man(p: Sheet) -> None:
    """A knee comes up between the counts, lands ahead, and both feet slide together.

    Running on the spot.
    """
    for k in range(p.n):
        foot, other = (L, R) if k % 2 == 0 else (R, L)
        s = 1 if foot == L else -1
        p.step(foot, k, 0.10 * s, 0.13, height=0.19, swing=0.66)
        p.step(other, k + 0.04, -0.10 * s, -0.15, height=0.012, swing=0.66, weight=False)
        p.key("twist", (k, 14 * s))
        p.key("drop", (k, 0.09), (k + 0.5, 0.025))
        p.key("lean", (k, 13), (k + 0.5, 5))
        p.key("nod", (k, 8), (k + 0.5, -2))
    pick(p, pump, punch)


def two_step(p: Sheet) -> None:
    """Step out, touch beside, on the diagonal, leaning back into it."""
    for k in range(p.n):
        s = 1 if k % 4 < 2 else -1
        lead, trail = (L, R) if s > 0 else (R, L)
        if k % 2 == 0:
            p.step(lead, k, 0.32 * s, 0.15, turn=24 * s)
        else:
            p.step(trail, k, 0.12 * s, 0.05, weight=False, height=0.08)
        p.key("hip_yaw", (k, 12 * s))
        p.key("lean", (k, 12 if k % 2 == 0 else -3))
        p.key("side", (k, 9 * s if k % 2 == 0 else -6 * s))
    bounce(p, 0.11, 0.02, heels=12)
    counter(p, 13)
    pick(p, swing, clap, reach, brush)


def arm_wave(p: Sheet) -> None:
    """A wave runs from one hand over the shoulders to the other and back; the body rides it."""
    slide(p)
    for k in range(p.n):
        # crest at: left hand, left elbow, chest, right elbow ... forth in four counts and back in
        # four
        at = k % 4 if k % 8 < 4 else 3 - k % 4
        hand = (14, 78, -36, 62, -26, 2)
        elbow = (4, 100, 22, 30, 34, 18)
        quiet = (2, 73, 12, 17, 14, 0)
        p.arms(k, *((hand, quiet), (elbow, quiet), (quiet, elbow), (quiet, hand))[at])
        s = 1.5 - at
        p.key("side", (k, 8 * s))
        p.key("look", (k, 18 * s))
        p.key("twist", (k, 5 * s))
        p.key("hip_roll", (k, -5 * s))
        p.key("chest", (k, 12 if at in (1, 2) else -3))
        p.key("drop", (k, 0.10), (k + 0.5, 0.03))


def party_machine(p: Sheet) -> None:
    """On the spot, a knee crosses up and steps down wide.

    The arms pump like pistons and the chest turns.
    """
    for k in range(p.n):
        foot = L if k % 2 == 0 else R
        s = 1 if foot == L else -1
        p.step(foot, k, 0.21 * s, 0.06, turn=20 * s, height=0.22, swing=0.88)
        p.key("twist", (k, 24 * s), (k + 0.5, 0))
        p.key("hip_yaw", (k, -10 * s))
        p.key("drop", (k, 0.12), (k + 0.5, 0.01))
        p.key("lean", (k, 15), (k + 0.5, -4))
        up, down = (96, 26, 14, 92), (10, 30, 20, 74)
        p.arms(k, *((down, up) if s > 0 else (up, down)))
        p.key("nod", (k, 9), (k + 0.5, -3))


def cabbage_patch(p: Sheet) -> None:
    """Fists stir a wide circle before the chest, the hips stir against them."""
    tread(p, 0.20, 0.06, 0.07)
    circle = ((74, 14, 26, 36), (44, 48, 4, 62), (6, 26, 18, 112), (44, 2, 46, 84))
    for k in range(p.n):
        p.arms(k, circle[k % 4], circle[(4 - k % 4) % 4])
        s = (0.9, 0.0, -0.9, 0.0)[k % 4]
        p.key("surge", (k, (0.0, -0.08, 0.0, 0.08)[k % 4]))
        p.key("lean", (k, (10, 18, 10, -5)[k % 4]))
        p.key("side", (k, 10 * s))
        p.key("twist", (k, (24, 0, -24, 0)[k % 4]))
    bounce(p, 0.10, 0.02, heels=12)


def kick_step(p: Sheet) -> None:
    """Kick ahead, step back under, and two steps in place: kick-ball-change."""
    for k in range(p.n):
        s = 1 if k % 4 < 2 else -1
        foot, other = (L, R) if s > 0 else (R, L)
        if k % 2 == 0:
            p.kick(foot, k, 0.02, 0.36, 0.22, toe=16)
            p.key("lean", (k, -6))
            p.arms(k, *((BACK, GUARD) if s > 0 else (GUARD, BACK)))
        else:
            p.step(foot, k, 0.14 * s, -0.05)
            p.step(other, k + 0.55, -0.14 * s, 0.05, height=0.04, swing=0.42)
            p.key("lean", (k, 13))
            p.arms(k, *((GUARD, DOWN) if s > 0 else (DOWN, GUARD)))
        p.key("twist", (k, -16 * s if k % 2 == 0 else 10 * s))
    bounce(p, 0.10, 0.015, heels=14)


def criss_cross(p: Sheet) -> None:
    """Jump apart, jump crossed, apart again, and together.

    The arms cross and open with the legs.
    """
    for k in range(p.n):
        phase = k % 4
        z = 0.10 if k % 8 < 4 else -0.10
        left, right = (
            ((0.25, 0.0), (-0.25, 0.0)),
            ((-0.06, z), (0.06, -z)),
            ((0.25, 0.0), (-0.25, 0.0)),
            ((0.1, 0.0), (-0.1, 0.0)),
        )[phase]
        p.jump(k, left, right, turns=(16, -16) if phase % 2 == 0 else (4, -4))
        p.key("drop", (k, 0.11 if phase % 2 == 0 else 0.07))
        p.key("lean", (k, 14 if phase % 2 == 0 else 5))
        p.key("twist", (k, (8, -14, -8, 14)[phase]))
        p.key("nod", (k, 8), (k + 0.5, -3))
        p.arms(k, (30, 52, 0, 60) if phase % 2 == 0 else (46, 6, 52, 86))


def freeze(p: Sheet) -> None:
    """For breaks: into a stance, held, with the head and one shoulder alone on the count."""
    for k in range(0, p.n, 2):
        s = 1 if k % 4 == 0 else -1
        p.step(L if s > 0 else R, k, 0.26 * s, 0.10, turn=26 * s, height=0.10)
        p.step(R if s > 0 else L, k + 1, -0.10 * s, -0.06, height=0.05, weight=False)
        p.key("drop", (k, 0.12), (k + 1, 0.05))
    p.key("hip_yaw", (1, -10), (p.n - 1, -8))
    for k in range(p.n):
        hit = 1 if k % 2 else 0
        p.key("nod", (k, 14 * hit))
        p.key("twist", (k, 8 + 16 * hit))
        p.key("side", (k, -9 + 9 * hit))
        p.key("sway", (k, 0.02 - 0.04 * hit))
        p.arms(k, (36 + 12 * hit, 12, 54, 96, 10, 12 * hit), (-10, 30, 30, 40 + 24 * hit, 10, 0))


def nod_groove(p: Sheet) -> None:
    """For breaks: head, shoulders and a small bounce."""
    tread(p, 0.18, 0.03, 0.06)
    bounce(p, 0.085, 0.02, heels=8)
    counter(p, 14)
    pick(p, swing, overhead)


def turn_out(p: Sheet) -> None:
    """Two heavy steps, half round on the balls of the feet, and a step out of it."""
    for k in range(0, p.n, 4):
        p.step(L, k, 0.14, 0.22, turn=16, height=0.12)
        p.arms(k, BACK, GUARD)
        if k + 3 < p.n:
            half_round(p, k + 1)
            p.arms(k + 1, (30, 40, 10, 84), (30, 40, 10, 84))
            p.arms(k + 2, (40, 10, 44, 90), (40, 10, 44, 90))
            p.step(R, k + 3, -0.22, 0.06, turn=-20, height=0.12)
            p.arms(k + 3, GUARD, (80, 10, 6, 24))
        p.key("lean", (k, 16), (k + 1, 10), (k + 2, 2), (k + 3, 16))
        p.key("twist", (k, -16), (k + 1, 14), (k + 3, -18))
    bounce(p, 0.12, 0.02)


def get_low(p: Sheet) -> None:
    """Wide and down to the floor with both hands at the knees, a shuffle there, and up."""
    for k in range(p.n):
        phase, s = k % 4, 1 if k % 8 < 4 else -1
        lead, trail = (L, R) if s > 0 else (R, L)
        x = (0.30, -0.24, 0.22, -0.12)[phase] * s
        p.step((lead, trail)[phase % 2], k, x, (0.04, 0.0, -0.06, 0.0)[phase], turn=22 * np.sign(x))
        p.key("drop", (k, (0.15, 0.23, 0.20, 0.02)[phase]))
        p.key("lean", (k, (20, 36, 28, -5)[phase]))
        p.key("nod", (k, (6, -14, -10, -6)[phase]))
        p.key("twist", (k, (14, -10, 18, -8)[phase] * s))
        p.key("side", (k, (-8, 6, -8, 4)[phase] * s))
        down, out = (44, 16, 6, 16), (16, 70, 10, 70)
        up = (146, 26, 0, 30)
        pair = ((out, down), (down, down), (down, out), (up, out))[phase]
        p.arms(k, *(pair if s > 0 else pair[::-1]))


MOVES = (
    bouncing,
    rock,
    running_man,
    two_step,
    arm_wave,
    party_machine,
    cabbage_patch,
    kick_step,
    criss_cross,
    turn_out,
    get_low,
)
CALM = (freeze, nod_groove, arm_wave)
