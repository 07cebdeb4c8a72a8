"""Latin: small steps under a quiet chest, and hips that go out over each foot.

The arms are held and lead.
"""

from ..sheet import Sheet
from .grooves import HIGH_V, HIP, bounce, conduct, lift, onhips, pick, reach, soft, sweep, tread
from .turns import half_round, three_step

L, R = 0, 1


def settle(p: Sheet, counts: list[tuple[float, int]], size: float = 1.0) -> None:
    """The hip goes out over the foot with the new weight: (count, 1 left or -1 right)
    ..."""
    for k, s in counts:
        p.key("hip_roll", (k, 12 * size * s))
        p.key("sway", (k, 0.055 * size * s))
        p.key("hip_yaw", (k, -15 * size * s))
        p.key("side", (k, -8 * size * s))
        p.key("twist", (k, 16 * size * s))


def frame(p: Sheet) -> None:
    """Arms held before the body, forearms going round with the steps."""
    for k in range(p.n):
        front, back = (
            ((72, 30, 20, 48, 4), (-12, 36, 26, 98, 8))
            if k % 8 < 4
            else ((40, 84, 6, 40, -4), (4, 40, 30, 96, 8))
        )
        p.arms(k, *((back, front) if k % 2 == 0 else (front, back)))


def arms(p: Sheet) -> None:
    """One of the arm patterns that go with steps."""
    pick(p, frame, frame, soft, conduct, sweep, lift, reach)


def basic(p: Sheet) -> None:
    """Mambo: left ahead, right in place, left back home, hold.

    Then right back, left in place, right home, hold.
    """
    for k in range(p.n):
        half, s = k % 4, 1 if k % 8 < 4 else -1
        foot, other = (L, R) if s > 0 else (R, L)
        if half == 0:
            p.step(foot, k, 0.09 * s, 0.30 * s, height=0.05)
        elif half == 1:
            p.step(other, k, -0.09 * s, 0.02 * s, height=0.035)
        elif half == 2:
            p.step(foot, k, 0.10 * s, 0.0, height=0.04)
        else:
            p.kick(other, k, -0.03 * s, 0.05, 0.05, toe=28)
        p.key("lean", (k, (6, 3, 3, 2)[half] if s > 0 else (-3, 2, 3, 3)[half]))
    settle(p, [(k, (1, -1, 1, 1)[k % 4] * (1 if k % 8 < 4 else -1)) for k in range(p.n)])
    bounce(p, 0.075, 0.01, heels=9)
    arms(p)


def side_basic(p: Sheet) -> None:
    """Side, back in place, together, tap; and the other way."""
    for k in range(p.n):
        half, s = k % 4, 1 if k % 8 < 4 else -1
        foot, other = (L, R) if s > 0 else (R, L)
        if half == 0:
            p.step(foot, k, 0.36 * s, 0.0, height=0.05)
        elif half == 1:
            p.step(other, k, -0.07 * s, 0.0, height=0.035)
        elif half == 2:
            p.step(foot, k, 0.09 * s, 0.0, height=0.04)
        else:
            p.step(other, k, -0.16 * s, 0.06, weight=False, height=0.04)
    settle(p, [(k, (1, -1, 1, 1)[k % 4] * (1 if k % 8 < 4 else -1)) for k in range(p.n)])
    bounce(p, 0.075, 0.01, heels=9)
    arms(p)


def cumbia(p: Sheet) -> None:
    """Back on the diagonal behind the other foot, in place, side, together.

    The body opens to each side.
    """
    for k in range(p.n):
        half, s = k % 4, 1 if k % 8 < 4 else -1
        foot, other = (L, R) if s > 0 else (R, L)
        if half == 0:
            p.step(foot, k, -0.05 * s, -0.28, turn=34 * s, height=0.04)
        elif half == 1:
            p.step(other, k, -0.12 * s, 0.02, height=0.05)
        elif half == 2:
            p.step(foot, k, 0.18 * s, 0.02, height=0.05)
        else:
            p.step(other, k, -0.06 * s, 0.0, weight=False, height=0.06)
        p.key("hip_yaw", (k, (32, 8, -6, 0)[half] * s))
        p.key("twist", (k, (-6, -10, 6, 0)[half] * s))
        p.key("hip_roll", (k, (9, -9, 9, 7)[half] * s))
        p.key("side", (k, (-5, 5, -5, -3)[half] * s))
        p.key("look", (k, (14, 4, 0, 0)[half] * s))
        p.key("lean", (k, (-2, 4, 4, 3)[half]))
    bounce(p, 0.08, 0.01, heels=9)
    arms(p)


def suzie_q(p: Sheet) -> None:
    """Cross in front with a twist of the feet, open to the side, cross again.

    Travelling sideways.
    """
    for k in range(p.n):
        across, way = k % 2 == 0, 1 if k % 8 < 4 else -1
        lead, trail = (R, L) if way > 0 else (L, R)
        if across:
            p.step(lead, k, 0.16 * way, 0.13, turn=30 * way, height=0.04)
            p.pivot(trail, k, 22 * way, during=0.4)
        else:
            p.pivot(lead, k, -24 * way, during=0.6)
            p.step(trail, k, 0.36 * way, -0.02, turn=-14 * way, height=0.04)
            p.go(k, x=0.26 * way)
        p.key("hip_yaw", (k, (26 if across else -24) * way))
        p.key("twist", (k, (-28 if across else 26) * way))
        p.key("hip_roll", (k, (-7 if across else 7) * way))
        p.key("lean", (k, 6 if across else 2))
    bounce(p, 0.08, 0.01, heels=9)
    pick(p, frame, onhips, soft)


def figure_eight(p: Sheet) -> None:
    """Small steps under the hips, which draw a lying eight, one loop a side, over two counts."""
    tread(p, 0.12, 0.05, 0.04)
    for k in range(p.n):
        s = 1 if (k // 2) % 2 == 0 else -1
        first = k % 2 == 0
        p.key("sway", (k, (0.05 if first else 0.075) * s))
        p.key("surge", (k, 0.07 if first else -0.06))
        p.key("hip_roll", (k, (6 if first else 14) * s))
        p.key("hip_yaw", (k, (-20 if first else 16) * s))
        p.key("twist", (k, (17 if first else -13) * s))
        p.key("side", (k, (-4 if first else -8) * s))
        p.key("l_knee", (k, -8 if s < 0 else 4))
        p.key("r_knee", (k, -8 if s > 0 else 4))
        p.key("drop", (k, 0.09 if first else 0.03))
    pick(p, lift, onhips, conduct, sweep)


def cucaracha(p: Sheet) -> None:
    """Press out to the side, hip over it, recover, close, hold: the weight goes only partly."""
    for k in range(p.n):
        half, s = k % 4, 1 if k % 8 < 4 else -1
        foot = L if s > 0 else R
        if half == 0:
            p.step(foot, k, 0.32 * s, 0.02, turn=12 * s, height=0.05)
        elif half == 1:
            p.step(L + R - foot, k, -0.12 * s, 0.04, height=0.05)
        elif half == 2:
            p.step(foot, k, 0.09 * s, 0.0, height=0.05)
        else:
            p.step(L + R - foot, k, -0.14 * s, 0.05, height=0.06, weight=False)
        p.key("hip_roll", (k, (13, -10, 9, 11)[half] * s))
        p.key("sway", (k, (0.05, -0.03, 0.03, 0.04)[half] * s))
        p.key("hip_yaw", (k, (-16, 10, -10, 6)[half] * s))
        p.key("twist", (k, (16, -12, 10, -6)[half] * s))
        p.key("side", (k, (-7, 6, -5, -6)[half] * s))
    bounce(p, 0.075, 0.01, heels=9)
    arms(p)


def turn(p: Sheet) -> None:
    """Spot turn: ahead and half round, half round, close; one hand overhead.

    A basic follows as a rest.
    """
    k = 0
    while k + 2 < p.n:
        p.step(L, k, 0.02, 0.22, turn=20)
        p.go(k + 1, z=0.12, turn=180, during=0.85)
        p.pivot(L, k + 0.95, 10, during=0.7)
        p.step(R, k + 1, -0.08, 0.12, swing=0.7)
        p.go(k + 2, z=0.10, turn=180, during=0.85)
        p.pivot(R, k + 1.95, -10, during=0.7)
        p.step(L, k + 2, 0.10, 0.0, swing=0.7)
        p.key("drop", (k, 0.05), (k + 1, 0.02), (k + 2, 0.04))
        p.key("hip_roll", (k, 7), (k + 1, -6), (k + 2, 8))
        p.key("twist", (k, 16), (k + 1, 10), (k + 2, -8))
        p.key("side", (k, -3), (k + 1, 3), (k + 2, -5))
        p.arms(k, (60, 20, 30, 70), (20, 50, 10, 60))
        p.arms(k + 1, (148, 14, 0, 52), (34, 8, 58, 96))
        p.arms(k + 2, (120, 40, 0, 40), HIP)
        k += 3
        rest = [(R, -0.2, -0.12), (L, 0.12, 0.02), (R, -0.11, 0.0), (L, 0.18, 0.1), (R, -0.1, 0.0)]
        for j in range(min(5, p.n - k)):
            foot, x, z = rest[j]
            p.step(foot, k + j, x, z, height=0.04)
            s = 1 if foot == L else -1
            p.key("hip_roll", (k + j + 0.1, 9 * s))
            p.key("twist", (k + j, 9 * s))
            p.key("side", (k + j, -4 * s))
            p.key("drop", (k + j, 0.05), (k + j + 0.5, 0.025))
            p.arms(k + j, (46, 20, 26, 82), (8, 40, 10, 60)) if j % 2 else p.arms(
                k + j, (8, 40, 10, 60), (46, 20, 26, 82)
            )
        k += 5


def shimmy(p: Sheet) -> None:
    """For breaks: the shoulders quiver in halves of the count over slow hips."""
    tread(p, 0.13, 0.04, 0.05)
    for k in range(p.n):
        s = 1 if k % 2 == 0 else -1
        p.key("twist", (k, 12), (k + 0.5, -10))
        p.key("hip_roll", (k, 7 * s))
        p.key("lean", (k, 6 if k % 4 < 2 else -3))
        p.key("drop", (k, 0.065), (k + 0.5, 0.03))
        p.arms(k, (14, 50, 6, 50, 0, 5), (14, 50, 6, 50, 0, -4))
        p.arms(k + 0.5, (14, 52, 6, 50, 0, -4), (14, 52, 6, 50, 0, 5))


def hold_out(p: Sheet) -> None:
    """For breaks: a line, one arm high, the hip alone on the count."""
    for k in range(0, p.n, 2):
        p.step(L, k, 0.24, 0.05, turn=20, height=0.06)
        p.step(R, k + 1, -0.08, -0.02 if k % 4 == 0 else 0.05, height=0.05)
    for k in range(p.n):
        s = 1 if k % 2 else -1
        p.key("hip_roll", (k, -4 + 10 * s))
        p.key("sway", (k, -0.02 + 0.04 * s))
        p.key("side", (k, 4 - 6 * s))
        p.key("twist", (k, 6 * s))
        p.arms(k, (HIGH_V[0], HIGH_V[1] - 8 * s, *HIGH_V[2:]), (HIP[0] + 5 * s, *HIP[1:]))


def walk_through(p: Sheet) -> None:
    """Ahead on three walking steps with half a turn, and a hip; then the same way back."""
    for k in range(0, p.n, 4):
        p.step(L, k, 0.07, 0.32, turn=10, height=0.05)
        p.go(k + 0.5, z=0.30)
        if k + 3 < p.n:
            half_round(p, k + 1)
            p.step(R, k + 3, -0.10, 0.06, height=0.05)
            p.arms(k, (46, 24, 24, 80), (-10, 40, 20, 60))
            p.arms(k + 1, (50, 14, 36, 90), (60, 12, 40, 84))
            p.arms(k + 2, HIP, (110, 20, 10, 60))
            p.arms(k + 3, HIP, (30, 84, -6, 22))
        for j, s in enumerate((1, -1, 1, -1)):
            p.key("hip_roll", (k + j, 11 * s))
            p.key("twist", (k + j, 14 * s))
            p.key("side", (k + j, -7 * s))
    bounce(p, 0.07, 0.01, heels=9)


def travelling_turn(p: Sheet) -> None:
    """Once round on three steps to the side, one arm high; then a side step with the hips."""
    for k in range(0, p.n, 4):
        if k % 8 == 0 and k + 3 < p.n:
            three_step(p, k, (60, 12, 40, 92), (26, 56, 0, 44))
            p.key("hip_roll", (k, 8), (k + 1, -7), (k + 2, 8), (k + 3, -6))
            p.key("drop", (k, 0.07), (k + 1, 0.02), (k + 2, 0.03), (k + 3, 0.07))
            continue
        for j in range(min(4, p.n - k)):
            foot, s = (L, 1) if j % 2 == 0 else (R, -1)
            p.step(foot, k + j, (-0.04, -0.30, -0.10, -0.26)[j], 0.04 * s, height=0.06)
            p.key("hip_roll", (k + j, 12 * s))
            p.key("side", (k + j, -8 * s))
            p.key("twist", (k + j, 15 * s))
            p.key("drop", (k + j, 0.07), (k + j + 0.5, 0.01))
            p.arms(k + j, *((HIP, (60, 70, 0, 30)) if j % 2 else ((130, 40, 0, 30), HIP)))


MOVES = (
    basic,
    side_basic,
    cumbia,
    suzie_q,
    figure_eight,
    cucaracha,
    turn,
    walk_through,
    travelling_turn,
)
CALM = (figure_eight, shimmy, hold_out)
