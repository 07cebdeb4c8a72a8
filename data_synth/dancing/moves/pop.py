"""Pop: clean steps to the front, whole-body hits and long arms."""

from ..sheet import Sheet
from .grooves import (  # fmt: skip
    ASIDE,
    CACTUS,
    CROSSED,
    DOWN,
    GUARD,
    HIGH_V,
    HIP,
    NAPE,
    UP,
    WING,
    bounce,
    clap,
    conduct,
    lift,
    onhips,
    overhead,
    pick,
    punch,
    reach,
    roll,
    slide,
    sweep,
    swing,
    tread,
    windmill,
)
from .turns import half_round

L, R = 0, 1


def grapevine(p: Sheet) -> None:
    """Side, behind, side, touch; and back the other way."""
    for k in range(p.n):
        phase, way = k % 4, 1 if k % 8 < 4 else -1
        lead, trail = (L, R) if way == 1 else (R, L)
        if phase == 0:
            p.step(lead, k, 0.34 * way, 0.0)
        elif phase == 1:
            p.step(trail, k, 0.40 * way, -0.20, turn=-16 * way)
        elif phase == 2:
            p.step(lead, k, 0.62 * way, 0.0)
        else:
            p.step(trail, k, 0.42 * way, 0.02, weight=False, height=0.09)
            if k + 1 < p.n:
                p.go(k + 1, x=0.52 * way)
        p.key("hip_yaw", (k, (4, 18, -4, 0)[phase] * way))
        p.key("twist", (k, (-4, -20, 6, 12)[phase] * way))
    bounce(p, 0.08, 0.005, heels=14)
    pick(p, swing, clap, lift, sweep, reach)


def box_step(p: Sheet) -> None:
    """Across in front, back, side, together: a square on the floor."""
    for k in range(p.n):
        phase = k % 4
        if phase == 0:
            p.step(R, k, 0.06, 0.24, turn=10)
        elif phase == 1:
            p.step(L, k, 0.16, -0.16)
        elif phase == 2:
            p.step(R, k, -0.22, -0.12)
        else:
            p.step(L, k, 0.13, 0.06)
        p.key("hip_yaw", (k, (12, 0, -12, 0)[phase]))
        p.key("twist", (k, (-16, 8, 14, -8)[phase]))
        p.key("lean", (k, (9, -2, 6, 2)[phase]))
    bounce(p, 0.08, 0.01, heels=12)
    pick(p, swing, roll, punch, conduct, windmill)


POSES = (  # left arm, right arm, weight, side, twist, lean, drop, look
    (HIGH_V, HIP, 0.8, -8, 10, 0, 0.05, 20),
    (HIP, HIGH_V, -0.8, 8, -10, 0, 0.05, -20),
    (ASIDE, ASIDE, 0.0, 0, 0, 2, 0.09, 0),
    (CROSSED, CROSSED, 0.0, 0, 0, 14, 0.11, 0),
    (UP, UP, 0.3, 0, 0, -5, 0.01, 0),
    (WING, ASIDE, -0.8, 7, -18, 6, 0.09, -35),
    (ASIDE, WING, 0.8, -7, 18, 6, 0.09, 35),
    (CACTUS, CACTUS, 0.0, 0, 8, -2, 0.06, 0),
    (NAPE, HIP, 0.7, -10, -12, 2, 0.05, -15),
    (HIP, NAPE, -0.7, 10, 12, 2, 0.05, 15),
    (GUARD, UP, -0.6, 6, -8, 0, 0.05, 10),
)


def pose_hits(p: Sheet) -> None:
    """A pose on every other count or on two in a row, hit and held, one of a dozen.

    The foot of the side that it goes to steps into it.
    """
    beats, k = [], 0
    while k < p.n:
        beats.append(k)
        k += int(p.rng.choice([1, 2], p=[0.6, 0.4]))
    chosen = p.rng.choice(len(POSES), len(beats), replace=len(beats) > len(POSES))
    for k, which in zip(beats, chosen, strict=True):
        left, right, weight, side, twist, lean, drop, look = POSES[which]
        p.arms(k, left, right)
        foot = L if weight > 0 or (weight == 0 and k % 2 == 0) else R
        s = 1 if foot == L else -1
        p.step(foot, k, 0.26 * s, 0.06, turn=18 * s, height=0.10, weight=weight != 0)
        p.step(1 - foot, k + 0.55, -0.14 * s, -0.04, height=0.05, weight=False, swing=0.5)
        if weight == 0:
            p.both(k + 0.3)
        for name, value in (
            ("side", side),
            ("twist", twist),
            ("lean", lean),
            ("drop", drop),
            ("look", look),
        ):
            p.key(name, (k, value))
        p.key("hip_roll", (k, 6 * weight))


def body_roll(p: Sheet) -> None:
    """A wave down the spine over two counts: head and chest forward first, then the hips."""
    slide(p, 0.30)
    for k in range(0, p.n, 2):
        p.key("nod", (k, -12), (k + 1, 14))
        p.key("chest", (k, 20), (k + 1, -14))
        p.key("lean", (k, 10), (k + 1, -8))
        p.key("surge", (k, -0.05), (k + 1, 0.07))
        p.key("hip_tilt", (k, 10), (k + 1, -10))
        p.key("drop", (k, 0.03), (k + 1, 0.11))
        p.key("twist", (k, 10 if k % 4 == 0 else -10), (k + 1, 0))
        p.arms(k, (52, 30, 10, 44, -10), (52, 30, 10, 44, -10))
        p.arms(k + 1, (-16, 26, 20, 52, 20), (6, 34, 30, 74, 20))
    for k in range(p.n):
        p.key("l_heel", (k, 18 if k % 2 else 0))


def spin(p: Sheet) -> None:
    """Prepare, turn once round to the left on two steps, arms drawn in, and come out of it."""
    k = 0
    while k + 3 < p.n:
        p.step(L, k, 0.26, 0.04, turn=40)
        p.key("twist", (k, -14), (k + 1, 8), (k + 2, 4), (k + 3, 0))
        p.arms(k, (44, 12, 46, 82), (36, 26, 30, 76))
        p.go(k + 1, x=0.16, turn=180, during=0.9)
        p.pivot(L, k + 0.9, 30, during=0.8)
        p.step(R, k + 1, -0.14, 0.02, turn=0, height=0.05, swing=0.75)
        p.arms(k + 1, (50, 6, 56, 98), (50, 6, 56, 98))
        p.go(k + 2, turn=180, during=0.9)
        p.pivot(R, k + 1.95, -20, during=0.75)
        p.step(L, k + 2, 0.13, 0.0, swing=0.75)
        p.arms(k + 2, (44, 10, 50, 88), (44, 10, 50, 88))
        p.step(R, k + 3, -0.16, 0.0, weight=False)
        p.arms(k + 3, *((ASIDE, HIP) if k % 8 < 4 else (CACTUS, CACTUS)))
        p.key("drop", (k, 0.09), (k + 1, 0.03), (k + 2, 0.02), (k + 3, 0.07))
        p.key("lean", (k, 8), (k + 1, 2), (k + 2, 2), (k + 3, 4))
        k += 4
        if k + 3 < p.n:
            for j in range(min(4, p.n - k)):
                foot = (L, R)[j % 2]
                p.step(foot, k + j, (0.22, -0.22)[j % 2], 0.0 if j < 2 else 0.08)
                p.arms(k + j, *((ASIDE, GUARD) if j % 2 else (GUARD, ASIDE)))
                p.key("drop", (k + j, 0.07), (k + j + 0.5, 0.02))
            k += 4
    for j in range(k, p.n):
        p.step((L, R)[(j - k) % 2], j, (0.2, -0.2)[(j - k) % 2], 0.0)
        p.arms(j, DOWN, GUARD)


def arm_sweeps(p: Sheet) -> None:
    """Long arms from side to side and overhead, the weight and the chest going with them."""
    slide(p, 0.36)
    path = ((ASIDE, CROSSED), (UP, UP), (CROSSED, ASIDE), (DOWN, DOWN))
    for k in range(p.n):
        s = (1, 0, -1, 0)[k % 4]
        p.arms(k, *path[k % 4])
        p.key("side", (k, -9 * s))
        p.key("twist", (k, 20 * s))
        p.key("look", (k, 24 * s))
        p.key("hip_roll", (k, 6 * s))
        p.key("drop", (k, (0.09, 0.01, 0.09, 0.12)[k % 4]))
        p.key("lean", (k, (4, -5, 4, 17)[k % 4]))


def v_step(p: Sheet) -> None:
    """Out, out to the front, in, in to the back, with the arms opening and closing."""
    for k in range(p.n):
        phase = k % 4
        x, z = ((0.30, 0.24), (-0.30, 0.24), (0.09, -0.04), (-0.09, -0.04))[phase]
        p.step((L, R)[phase % 2], k, x, z, turn=(18, -18, 6, -6)[phase])
        p.key("twist", (k, (12, -12, 8, -8)[phase]))
        p.key("drop", (k, (0.06, 0.10, 0.06, 0.03)[phase]), (k + 0.5, 0.02))
        p.key("lean", (k, (8, 4, 2, 2)[phase]))
    hips(p)
    pick(p, lift, overhead, clap, onhips)


def hips(p: Sheet) -> None:
    """The hip on the stepping side gives."""
    for k in range(p.n):
        s = 1 if k % 2 == 0 else -1
        p.key("hip_roll", (k, 5 * s))
        p.key("side", (k, -5 * s))


def kick_front(p: Sheet) -> None:
    """Step and kick across, from side to side."""
    for k in range(p.n):
        s = 1 if k % 4 < 2 else -1
        lead, trail = (L, R) if s > 0 else (R, L)
        if k % 2 == 0:
            p.step(lead, k, 0.20 * s, 0.0)
        else:
            p.kick(trail, k, 0.16 * s, 0.34, 0.28, toe=30)
            p.hop(lead, k, 0.035)
        p.key("twist", (k, 6 * s if k % 2 == 0 else -18 * s))
        p.key("hip_yaw", (k, 0 if k % 2 == 0 else 14 * s))
        p.key("lean", (k, 8 if k % 2 == 0 else -4))
    bounce(p, 0.08, 0.005, heels=14)
    pick(p, swing, sweep, punch)


def jumping(p: Sheet) -> None:
    """Jump out and in, the arms opening wide with the legs: a jack with a turn of the chest."""
    for k in range(p.n):
        out = k % 2 == 0
        p.jump(k, (0.24, 0.0) if out else (0.1, 0.03), (-0.24, 0.0) if out else (-0.1, 0.03))
        p.key("drop", (k, 0.10 if out else 0.07))
        p.key("lean", (k, 8 if out else 3))
        p.key("twist", (k, (10, 0, -10, 0)[k % 4]))
        if k % 8 < 4:
            p.arms(k, (8, 84, 0, 24) if out else (8, 24, 14, 40))
        else:
            p.arms(k, *(((10, 128, 0, 30), HIP) if out else ((20, 40, 10, 70), HIP)))


def side_sway(p: Sheet) -> None:
    """For breaks: swaying from foot to foot, arms soft."""
    tread(p, 0.20, 0.03, 0.05)
    for k in range(p.n):
        s = 1 if k % 2 == 0 else -1
        p.key("hip_roll", (k, 6 * s))
        p.key("side", (k, -7 * s))
        p.key("look", (k, 10 * s))
    bounce(p, 0.065, 0.012, heels=10)
    pick(p, onhips, conduct, overhead)


def strut(p: Sheet) -> None:
    """Three steps ahead as on a catwalk, half round on both feet, and ahead again."""
    for k in range(0, p.n, 4):
        p.step(L, k, 0.06, 0.38, turn=4, height=0.07)
        p.go(k + 0.5, z=0.38)
        p.arms(k, BACK_LONG, AHEAD_LONG)
        if k + 3 < p.n:
            half_round(p, k + 1)
            p.arms(k + 1, AHEAD_LONG, BACK_LONG)
            p.arms(k + 2, ASIDE, HIP)
            p.step(R, k + 3, -0.06, 0.36, turn=-4, height=0.07)
            p.go(k + 3.5, z=0.36)
            p.arms(k + 3, AHEAD_LONG, BACK_LONG)
        for j, s in enumerate((1, -1, 1, -1)):
            p.key("hip_roll", (k + j, 8 * s))
            p.key("twist", (k + j, -12 * s))
            p.key("lean", (k + j, -3 if j == 2 else 4))
    bounce(p, 0.055, 0.0, heels=8)


AHEAD_LONG, BACK_LONG = (40, 14, 16, 34), (-32, 20, 8, 24)
MOVES = (
    grapevine,
    box_step,
    pose_hits,
    body_roll,
    spin,
    arm_sweeps,
    v_step,
    kick_front,
    jumping,
    strut,
)
CALM = (side_sway, body_roll, pose_hits)
