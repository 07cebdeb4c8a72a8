"""Waltz, with three steps a bar: down on the first, rising through the others.

Long arms, and the figure turns as it goes.

A bar may have any number of beats: the first step drives, the last one closes.
"""

from ..sheet import Sheet

L, R = 0, 1
HOLD = (52, 46, 14, 66, 0)  # the left arm of a couple's hold
EMBRACE = (48, 38, 40, 80, 4)
OPEN = (22, 78, -6, 22, -8)
HIGH = (112, 44, -4, 26, -6)
CURVED = (58, 22, 34, 54, 10)
SOFT = (10, 28, 12, 30, 6)


def bars(p: Sheet) -> list[tuple[int, int, int]]:
    """(first count, counts, 1 or -1 in turn) of every bar."""
    return [
        (k, min(p.metre, p.n - k), 1 if (k // p.metre) % 2 == 0 else -1)
        for k in range(0, p.n, p.metre)
    ]


def rise(p: Sheet, size: float = 1.0) -> None:
    """Down on the first count, up on the others, heels off the floor, down again for the next."""
    for k, m, _ in bars(p):
        p.key("drop", (k, 0.02 + 0.075 * size))
        for j in range(1, m):
            p.key("drop", (k + j, 0.02 - 0.04 * size * j / max(m - 1, 1)))
            up = 24 * size * j / max(m - 1, 1)
            p.key("l_heel", (k + j, up))
            p.key("r_heel", (k + j, up))
        p.key("drop", (k + m - 0.45, 0.01))
        p.key("l_heel", (k, 2.0), (k + m - 0.35, 4.0))
        p.key("r_heel", (k, 2.0), (k + m - 0.35, 4.0))


def sway(p: Sheet, size: float = 7.0) -> None:
    """The body leans away from where the first step goes, and turns towards it."""
    for k, m, s in bars(p):
        p.key("side", (k, 0.3 * size * s), (k + 1, size * s), (k + m - 1, 0.7 * size * s))
        p.key("twist", (k, 10 * s), (k + m - 1, -4 * s))
        p.key("look", (k + 1, 8 * s))
        p.key("lean", (k, 5), (k + 1, -1), (k + m - 1, 1))


def couple(p: Sheet) -> None:
    """Arms held as if around a partner, moving a little with the bar."""
    for k, m, s in bars(p):
        p.arms(k, HOLD, EMBRACE)
        p.arms(k + 1, *[(a[0] + 14 * s, a[1] + 20, *a[2:]) for a in (HOLD, EMBRACE)])
        p.arms(k + m - 1, *[(a[0] - 6 * s, a[1] + 9, *a[2:]) for a in (HOLD, EMBRACE)])


def open_arms(p: Sheet) -> None:
    """Both arms open during one bar and curve in during the next, one a little after the other."""
    for k, m, s in bars(p):
        for name, pose, late in (
            ("l", OPEN if s > 0 else CURVED, 0.0),
            ("r", OPEN if s > 0 else CURVED, 0.12),
        ):
            for part, value in zip(("swing", "out", "twist", "elbow", "wrist"), pose, strict=True):
                p.key(f"{name}_{part}", (k + m - 1 - late, value))
        p.arms(k, (26, 34, 10, 44, 8, 0))


def high_arm(p: Sheet) -> None:
    """One arm rises to a curve overhead while the other opens low; they change with the bar."""
    for k, m, s in bars(p):
        p.arms(k, (34, 36, 14, 40, 8), (34, 36, 14, 40, 8))
        p.arms(k + 1, *((HIGH, SOFT) if s > 0 else (SOFT, HIGH)))
        if m > 2:
            p.arms(
                k + m - 1,
                *(
                    (HIGH[:1] + (62, *HIGH[2:]), OPEN)
                    if s > 0
                    else (OPEN, HIGH[:1] + (62, *HIGH[2:]))
                ),
            )


def arms(p: Sheet) -> None:
    """Draw one of the three arm patterns."""
    (couple, open_arms, high_arm)[int(p.rng.integers(3))](p)


def middle(m: int) -> range:
    """Counts of a bar between its first and its last."""
    return range(1, max(m - 1, 1))


def box(p: Sheet, turn: float = 0.0) -> None:
    """Ahead, side, close; back, side, close."""
    for k, m, s in bars(p):
        lead, other = (L, R) if s > 0 else (R, L)
        p.step(lead, k, 0.09 * s, 0.42 * s, height=0.04, swing=0.86)
        if m > 1:
            p.go(k + 1, z=0.40 * s, turn=turn, during=1.0)
            p.step(other, k + 1, -0.34 * s, 0.02, height=0.04, swing=0.86)
        for j in range(2, m):
            foot = (lead, other)[j % 2]
            x = -0.34 * s + (0.18 * s if foot == lead else 0.0)
            p.step(foot, k + j, x, 0.02, height=0.04, swing=0.86)
        p.go(k + m, x=-0.25 * s)
    rise(p)
    sway(p)
    arms(p)


def turning_box(p: Sheet) -> None:
    """The box, a quarter to the left in each bar."""
    box(p, 90.0 if p.rng.random() < 0.7 else 45.0)


def balance(p: Sheet) -> None:
    """One step, drawn out; the other foot is drawn up to it and waits on its toe: hesitation."""
    for k, m, s in bars(p):
        lead, other = (L, R) if s > 0 else (R, L)
        p.step(lead, k, 0.34 * s, 0.08, height=0.05, swing=0.86)
        p.step(other, k + max(m - 2, 1), 0.16 * s, 0.03, height=0.05, swing=0.86)
        if m > 2:
            p.step(lead, k + m - 1, 0.34 * s, 0.02, height=0.05, swing=0.86)
        p.key("hip_roll", (k, 4 * s), (k + m - 1, -2 * s))
        p.key("sway", (k, 0.02 * s), (k + m - 1, 0.05 * s))
    rise(p, 1.1)
    sway(p, 9)
    arms(p)


def twinkle(p: Sheet) -> None:
    """Across in front, side, close; and across the other way: a zigzag ahead."""
    for k, m, s in bars(p):
        lead, other = (L, R) if s > 0 else (R, L)
        p.step(lead, k, -0.16 * s, 0.28, turn=-24 * s, height=0.05, swing=0.86)
        if m > 1:
            p.step(other, k + 1, -0.32 * s, 0.30, turn=4 * s, height=0.04, swing=0.86)
        for j in range(2, m):
            foot = (lead, other)[j % 2]
            p.step(
                foot,
                k + j,
                -0.12 * s if foot == lead else -0.32 * s,
                0.26,
                turn=10 * s,
                height=0.04,
            )
        p.go(k + m, x=-0.22 * s, z=0.26 if k % (4 * p.metre) < 2 * p.metre else 0.05)
        p.key("hip_yaw", (k, -20 * s), (k + 1, 0), (k + m - 1, 14 * s))
    rise(p)
    sway(p)
    arms(p)


def progressive(p: Sheet) -> None:
    """Three long steps ahead a bar, then back again, passing feet; first to where there is room."""
    foot, inward = L, p.inward()
    for i, (k, m, _) in enumerate(bars(p)):
        way = inward if i % 4 < 2 else -inward
        for j in range(m):
            s = 1 if foot == L else -1
            p.step(
                foot, k + j, 0.09 * s, 0.42 * way if j == 0 else 0.34 * way, height=0.045, swing=0.7
            )
            p.go(k + j + 0.5, z=(0.42 if j == 0 else 0.34) * way)
            p.key("twist", (k + j, 9 * s))
            p.key("hip_yaw", (k + j, -6 * s))
            foot = 1 - foot
        p.key("lean", (k, 6 * way), (k + m - 1, 1))
    rise(p)
    arms(p)


def sway_arms(p: Sheet) -> None:
    """Side to side with long arms: a bar to the left, a bar to the right."""
    for k, m, s in bars(p):
        lead, other = (L, R) if s > 0 else (R, L)
        p.step(lead, k, 0.34 * s, 0.0, turn=20 * s, height=0.04, swing=0.86)
        p.step(other, k + 1, 0.06 * s, -0.08, height=0.05)
        if m > 2:
            p.step(lead, k + 2, 0.20 * s, 0.04, turn=10 * s, height=0.05)
        for j, (side, twist) in enumerate(((4, 8), (-10, 20), (-6, 14))):
            if j < m:
                p.key("side", (k + j, side * s))
                p.key("twist", (k + j, twist * s))
        far, near = (24, 104, -10, 16, -8), (64, 10, 40, 40, 6)
        p.arms(k, (28, 40, 10, 36), (28, 40, 10, 36))
        p.arms(k + 1, *((far, near) if s > 0 else (near, far)))
        if m > 2:
            p.arms(
                k + m - 1,
                *(
                    ((10, 84, 0, 22), (56, 16, 30, 40))
                    if s > 0
                    else ((56, 16, 30, 40), (10, 84, 0, 22))
                ),
            )
        p.key("look", (k + 1, 26 * s))
        p.key("nod", (k, 6), (k + 1, -6))
    rise(p, 0.9)


def spin_turn(p: Sheet) -> None:
    """Three steps and once round to the left in a bar; balance in the next."""
    for i, (k, m, _) in enumerate(bars(p)):
        if i % 2 == 0 and m >= 3:
            p.step(L, k, 0.10, 0.32, turn=20, height=0.04, swing=0.86)
            p.go(k + 1, z=0.30, turn=150, during=1.1)
            p.pivot(L, k + 1, 10, during=0.75)
            p.step(R, k + 1, -0.12, 0.06, height=0.04, swing=0.75)
            p.go(k + 2, turn=150, during=0.95)
            p.pivot(R, k + 2, -5, during=0.75)
            p.step(L, k + 2, 0.10, 0.0, height=0.04, swing=0.86)
            p.go(k + 3, turn=60, during=0.9)
            p.arms(k, (50, 60, 0, 36), (34, 52, 0, 40))
            p.arms(k + 1, (66, 16, 44, 62), (66, 16, 44, 62))
            p.arms(k + 2, (60, 12, 46, 62), (60, 12, 46, 62))
            p.key("twist", (k, -16), (k + 1, 14), (k + 2, 4))
            p.key("side", (k, 2), (k + 1, -7), (k + 2, 0))
        else:
            p.step(R, k, -0.34, 0.04, height=0.04, swing=0.86)
            p.step(L, k + max(m - 2, 1), -0.16, 0.02, weight=False, height=0.03, swing=0.86)
            p.go(k + m, x=-0.2)
            p.key("side", (k, -3), (k + 1, 8))
            p.key("twist", (k, -10), (k + m - 1, -16))
            p.arms(k, (30, 40, 10, 40), (30, 40, 10, 40))
            p.arms(k + m - 1, CURVED, OPEN)
    rise(p)


def whisk(p: Sheet) -> None:
    """Ahead, side, and hooked behind on the toe; then away again the other way."""
    for k, m, s in bars(p):
        lead, other = (L, R) if s > 0 else (R, L)
        p.step(lead, k, 0.10 * s, 0.24, height=0.04, swing=0.86)
        p.step(other, k + 1, -0.28 * s, 0.22, height=0.04, swing=0.86)
        if m > 2:
            p.step(lead, k + m - 1, -0.30 * s, 0.05, turn=-14 * s, height=0.05, swing=0.86)
        p.go(k + m, x=-0.2 * s, z=0.02)
        p.key("hip_yaw", (k, -6 * s), (k + m - 1, 16 * s))
    rise(p)
    sway(p)
    arms(p)


def breathe(p: Sheet) -> None:
    """For breaks: a step and a touch, rising and sinking with the bar, one arm opening."""
    for k, m, s in bars(p):
        lead, other = (L, R) if s > 0 else (R, L)
        p.step(lead, k, 0.24 * s, 0.06, turn=16 * s, height=0.04)
        p.step(other, k + max(m - 2, 1), 0.04 * s, 0.04, height=0.04, weight=False)
        p.key("drop", (k, 0.085), (k + 1, 0.02), (k + m - 1, 0.012))
        p.key("side", (k, 0), (k + m - 1, -6 * s))
        p.key("twist", (k, 0), (k + m - 1, 12 * s))
        p.key("look", (k, 0), (k + m - 1, 16 * s))
        p.arms(k, SOFT, SOFT)
        p.arms(k + m - 1, *((OPEN, SOFT) if s > 0 else (SOFT, OPEN)))


def natural_turn(p: Sheet) -> None:
    """Round the floor: half round to the left in each bar, ahead in one and back in the next."""
    for k, m, s in bars(p):
        lead, other = (L, R) if s > 0 else (R, L)
        p.step(lead, k, 0.09 * s, 0.36 * s, turn=24, height=0.05, swing=0.86)
        if m > 1:
            p.go(k + 1, z=0.34 * s, turn=100, during=1.0)
            p.pivot(lead, k + 1, 10, during=0.7)
            p.step(other, k + 1, -0.26 * s, 0.04, height=0.05, swing=0.86)
        if m > 2:
            p.go(k + 2, x=-0.12 * s, turn=80, during=0.95)
            p.pivot(other, k + 2, 5 if other == L else -5, during=0.6)
        for j in range(2, m):
            foot = (lead, other)[j % 2]
            p.step(foot, k + j, 0.10 if foot == L else -0.10, 0.02, height=0.05, swing=0.8)
    rise(p)
    sway(p, 8)
    pick_arms = (couple, open_arms)
    pick_arms[int(p.rng.integers(2))](p)


MOVES = (box, turning_box, balance, twinkle, progressive, sway_arms, spin_turn, whisk, natural_turn)
CALM = (breathe, balance)
