"""Turns that several genres share: once round on three steps, and half round on both feet."""

from ..sheet import Sheet

L, R = 0, 1
Pose = tuple[float, ...]


def three_step(p: Sheet, k: int, drawn: Pose, opened: Pose) -> None:
    """Four counts: once round to the left on three steps that travel to the left, and a touch.

    `drawn` are the arms while it turns, `opened` at both ends.
    """
    p.step(L, k, 0.30, 0.03, turn=50)
    p.key("twist", (k, -16), (k + 1, 10), (k + 2, 6), (k + 3, 0))
    p.arms(k, opened)
    p.go(k + 1.05, x=0.26, turn=180, during=1.2)
    p.pivot(L, k + 0.9, 20, during=0.8)
    p.step(R, k + 1, -0.28, 0.02, turn=0, height=0.05, swing=0.75)
    p.arms(k + 0.6, drawn)
    p.go(k + 2.3, x=-0.24, turn=180, during=1.2)
    p.pivot(R, k + 1.95, -20, during=0.75)
    p.step(L, k + 2, 0.22, 0.0, swing=0.75)
    p.arms(k + 2.2, drawn)
    p.step(R, k + 3, -0.02, 0.05, weight=False)
    p.arms(k + 3, opened)
    p.go(k + 4, x=0.12)


def half_round(p: Sheet, k: int) -> None:
    """Two counts: the right foot ahead, and half round to the left on the balls of both feet."""
    p.step(R, k, 0.02, 0.30, turn=10)
    p.go(k + 0.95, z=0.16, turn=180, during=1.35)
    p.pivot(L, k + 0.95, 8, during=0.8)
    p.pivot(R, k + 0.95, -8, during=0.8)
    p.key("weight", (k + 1, 0.6))
    p.key("hip_yaw", (k, -12), (k + 1, 8))
    p.key("side", (k, 5), (k + 1, -5))
