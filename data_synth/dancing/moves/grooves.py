"""Parts that many moves share: how the body bounces on the count, and arm patterns."""

from collections.abc import Callable

from ..sheet import Sheet

Pose = tuple[float, ...]  # (swing, out, twist, elbow[, wrist[, shrug]]) in degrees, see script.ARM

DOWN: Pose = (4, 13, 18, 28)
LOW: Pose = (-8, 22, 10, 20)
GUARD: Pose = (28, 18, 22, 108)
BACK: Pose = (-38, 18, 12, 40)
AHEAD: Pose = (78, 8, 8, 24)
ASIDE: Pose = (2, 82, 8, 16, -4)
WING: Pose = (8, 72, 20, 100)
CACTUS: Pose = (6, 86, -78, 88)
UP: Pose = (158, 12, 0, 18)
HIGH_V: Pose = (10, 140, 0, 14)
CROSSED: Pose = (44, 4, 62, 92)
HIP: Pose = (-26, 44, 62, 88, -10)
CLAP: Pose = (48, 4, 46, 84)
NAPE: Pose = (40, 118, -60, 138)


def bounce(
    p: Sheet, low: float = 0.05, high: float = 0.012, each: float = 1.0, heels: float = 0.0
) -> None:
    """Down on every count, up in between: knees, and a little of the chest and head.

    The heels are `heels` degrees up when the body is high.
    """
    count = 0.0
    while count < p.n:
        p.key("drop", (count, low), (count + 0.5 * each, high))
        if heels:
            for name in ("l_heel", "r_heel"):
                p.key(name, (count, 1.0), (count + 0.5 * each, heels))
        p.key("chest", (count, 4.0), (count + 0.5 * each, -2.0))
        p.key("nod", (count, 7.0), (count + 0.5 * each, -1.0))
        count += each


def tread(
    p: Sheet, wide: float = 0.17, ahead: float = 0.04, height: float = 0.07, each: float = 1.0
) -> None:
    """A step in place on every count: the left foot on even ones, a little ahead and back in turn.

    Moves of the trunk and the arms stand on it; so a dancer's feet are seldom at rest.
    """
    for k in range(int(p.n / each)):
        s = 1 if k % 2 == 0 else -1
        z = ahead if k % 4 < 2 else -ahead
        p.step(0 if s > 0 else 1, k * each, wide * s, z, turn=14 * s, height=height)


def slide(p: Sheet, wide: float = 0.32) -> None:
    """Side, together, side, together: four counts to the right and four to the left."""
    for k in range(p.n):
        way = -1 if k % 8 < 4 else 1
        lead, trail = (0, 1) if way > 0 else (1, 0)
        foot = lead if k % 2 == 0 else trail
        x = (0.12, -0.1, wide, wide - 0.22)[k % 4] * way
        p.step(foot, k, x, 0.0 if k % 2 == 0 else 0.05, turn=16 * way if foot == lead else None)


def hips(p: Sheet, size: float = 7.0, sway: float = 0.03) -> None:
    """The hip goes to the standing side on every count: left on even ones; the chest answers."""
    for k in range(p.n):
        s = 1 if k % 2 == 0 else -1
        p.key("hip_roll", (k, size * s))
        p.key("sway", (k, sway * s))
        p.key("hip_yaw", (k, -0.8 * size * s))
        p.key("side", (k, -0.5 * size * s))


def counter(p: Sheet, size: float = 12.0) -> None:
    """The chest turns against the stepping leg: right shoulder ahead on even counts."""
    for k in range(p.n):
        s = 1 if k % 2 == 0 else -1
        p.key("twist", (k, size * s))
        p.key("hip_yaw", (k, -0.4 * size * s))


def swing(p: Sheet) -> None:
    """Arms swing with the opposite foot, elbows bent at the front."""
    for k in range(p.n):
        front, back = (42, 12, 26, 72), (-30, 16, 12, 34)
        p.arms(k, *((back, front) if k % 2 == 0 else (front, back)))


def pump(p: Sheet) -> None:
    """Bent arms, one up and one down on each count."""
    for k in range(p.n):
        up, down = (62, 20, 20, 112), (6, 26, 18, 84)
        p.arms(k, *((down, up) if k % 2 == 0 else (up, down)))


def clap(p: Sheet) -> None:
    """Open on even counts, together on odd ones."""
    for k in range(p.n):
        p.arms(k, (24, 46, 0, 66) if k % 2 == 0 else CLAP)


def lift(p: Sheet) -> None:
    """Both arms rise aside for two counts and come down for two."""
    levels = ((2, 24, 10, 22), (4, 84, 0, 18), HIGH_V, (4, 78, 12, 30))
    for k in range(p.n):
        p.arms(k, levels[k % 4])


def sweep(p: Sheet) -> None:
    """Both arms sweep to one side and to the other, one high and one across."""
    for k in range(p.n):
        across, out = (60, 8, 40, 52), (16, 92, -8, 22, -6)
        p.arms(k, *((out, across) if k % 2 == 0 else (across, out)))


def punch(p: Sheet) -> None:
    """One arm shoots ahead on each count, the other draws back."""
    for k in range(p.n):
        ahead, back = (80, 6, 6, 22, 0), (-26, 18, 20, 98)
        p.arms(k, *((back, ahead) if k % 2 == 0 else (ahead, back)))


def overhead(p: Sheet) -> None:
    """Hands up, waving to the left and to the right."""
    for k in range(p.n):
        near, far = (150, 8, 10, 42), (130, 42, -8, 24)
        p.arms(k, *((far, near) if k % 2 == 0 else (near, far)))


def roll(p: Sheet) -> None:
    """Forearms circle round each other before the chest."""
    for k in range(p.n):
        for half in (0.0, 0.5):
            high, low = (46, 10, 52, 92), (22, 10, 52, 84)
            p.arms(k + half, *((high, low) if half == 0.0 else (low, high)))


def onhips(p: Sheet) -> None:
    """Hands on the hips, elbows moving a little."""
    for k in range(p.n):
        wag = 7 if k % 2 == 0 else -7
        p.arms(k, (HIP[0] + wag, *HIP[1:]), (HIP[0] - wag, *HIP[1:]))


def conduct(p: Sheet) -> None:
    """One hand high, one on the hip, changing over every four counts."""
    for k in range(p.n):
        wave = 12 if k % 2 == 0 else -12
        high, low = (112 + wave, 34, 0, 36 - wave), HIP
        p.arms(k, *((high, low) if k % 8 < 4 else (low, high)))


def soft(p: Sheet) -> None:
    """Arms open and close before the body, slowly."""
    for k in range(p.n):
        opened = k % 4 in (1, 2)
        p.arms(k, (30, 66, -6, 30, -6) if opened else (44, 14, 36, 76, 14))


def windmill(p: Sheet) -> None:
    """Long arms go round at the sides, one after the other: up ahead and down behind."""
    circle = ((-34, 24, 10, 22), (14, 78, -8, 18), (150, 22, 0, 24), (82, 10, 14, 30))
    for k in range(p.n):
        p.arms(k, circle[k % 4], circle[(k + 2) % 4])


def reach(p: Sheet) -> None:
    """One hand reaches far to a side and the eyes go with it; the other is drawn to the ribs."""
    for k in range(p.n):
        s = 1 if k % 4 < 2 else -1
        far, near = (34, 96, -10, 12, -8), (-14, 30, 30, 112)
        gathered = (40, 30, 24, 92)
        pair = (far, near) if k % 2 == 0 else (gathered, gathered)
        p.arms(k, *(pair if s > 0 else pair[::-1]))
        p.key("look", (k, 22 * s if k % 2 == 0 else 0))


def brush(p: Sheet) -> None:
    """Both hands cross low before the body, and open high behind it."""
    for k in range(p.n):
        p.arms(k, (34, 2, 50, 34) if k % 2 == 0 else (-24, 62, -14, 40, -6, 6))


def pick(p: Sheet, *choices: Callable[[Sheet], None]) -> None:
    """Draw one of several arm patterns."""
    choices[int(p.rng.integers(len(choices)))](p)
