"""Checks of notebook 00: your own control, and the join of past and future control."""

import numpy as np

from ._compare import compare
from ._report import as_array, check, expect
from .zoo.nb00 import MISTAKES

COLUMNS = ("forward speed", "speed to the left", "yaw rate")
HAND = 10  # rows within which a hand changes a joystick, before or after the time asked for


@check
def right_turn(mine):
    """mine() -> (100, 3): two seconds ahead, a turn to the right, a second at rest.

    Each change comes at once, or as a hand makes it: within half a second, to either side.
    """
    got = as_array(mine())
    expect(
        got.shape == (100, 3),
        f"five seconds at 20 frames/s are 100 rows of 3 numbers, not {got.shape}",
    )
    expect(np.isfinite(got).all(), "the control contains NaN or infinity")
    _held(got[: 40 - HAND], (1.2, 0.0, 0.0), "the first two seconds (rows 0 to 39)")
    _held(got[80 + HAND :], (0.0, 0.0, 0.0), "the last second (rows 80 to 99), which is at rest")
    _turns_right(got)
    softer = _changes(got)
    return ("A softer version of what was asked, and right. " if softer else "") + (
        "Three columns, 20 rows a second: that is the walker's whole control."
    )


def _held(rows: np.ndarray, wanted: tuple[float, ...], what: str) -> None:
    """Whether all rows are the wanted speeds."""
    for column, speed in enumerate(wanted):
        worst = np.abs(rows[:, column] - speed).argmax()
        per_frame = speed and np.abs(rows[:, column] - speed / 20).max() < 1e-6
        expect(
            not per_frame,
            f"{what}: the {COLUMNS[column]} is that of one frame; the control is per second",
        )
        expect(
            abs(rows[worst, column] - speed) < 0.001,
            f"{what}: the {COLUMNS[column]} is {rows[worst, column]:.4g}, and should be {speed:g}",
        )


def _turns_right(got: np.ndarray) -> None:
    """The third and fourth second: ahead at 0.8 m/s, and by 90 degrees to the right in all."""
    forward, aside, yaw = got[40 + HAND : 80 - HAND].T
    what = "seconds three and four (rows 40 to 79)"
    whole = np.degrees(got[40 - HAND : 80 + HAND, 2].sum() / 20)
    expect(
        np.abs(aside).max() < 0.001,
        f"{what}: the second column is a step to the side; the turn is in the third column",
    )
    expect(
        np.abs(yaw).max() < 5,
        f"{what}: this turns by {np.abs(yaw).max():.3g} rad a second; "
        "the control is in radians, not in degrees, and per second",
    )
    expect(abs(whole - 90) > 2, "it turns left: counter-clockwise is positive, seen from above")
    expect(np.abs(yaw).max() > 1e-6, f"{what}: it does not turn")
    per_frame = abs(whole + 90 / 20) < 0.1
    expect(not per_frame, "this is the turn of one frame; the control is per second")
    expect(
        abs(whole + 90) < 2,
        f"it turns by {abs(whole):.3g} degrees to the {'left' if whole > 0 else 'right'} in all; "
        "it should be 90 to the right, in two seconds",
    )
    expect((yaw < 0.001).all(), f"{what}: some of it turns left")
    expect(
        np.abs(forward).max() > 0.001, f"{what}: it turns on the spot; it should walk at 0.8 m/s"
    )
    _held(got[40 + HAND : 80 - HAND, :2], (0.8, 0.0), what)


def _changes(got: np.ndarray) -> bool:
    """Whether the changes are soft. One that comes at once must come at its row."""
    soft = False
    for at, before, after in ((40, 1.2, 0.8), (80, 0.8, 0.0)):
        forward = got[at - HAND - 1 : at + HAND + 1, 0]
        low, high = min(before, after) - 0.001, max(before, after) + 0.001
        expect(
            ((forward > low) & (forward < high)).all() and np.abs(got[:, 1]).max() < 0.001,
            f"around row {at} the speed goes from {before} to {after} m/s, and nothing else",
        )
        jump = np.abs(np.diff(forward))
        if jump.max() > 0.9 * abs(after - before):
            row = at - HAND + int(jump.argmax())
            expect(
                row == at, f"the change to {after} m/s comes at row {row}, and should at row {at}"
            )
        else:
            soft = True
    return soft


def _splices(rng: np.random.Generator):
    """Pasts that are longer than needed, and one that is just as long."""
    yield np.arange(18.0).reshape(6, 3), 100 + np.arange(12.0).reshape(4, 3), 5
    yield rng.normal(size=(9, 3)), rng.normal(size=(5, 3)), 4
    yield rng.normal(size=(7, 3)), rng.normal(size=(3, 3)), 7


def spliced(past: np.ndarray, new: np.ndarray, T_h: int) -> np.ndarray:
    """Row by row: T_h - 1 rows of the past, then the first new row twice, then the others."""
    rows = [past[len(past) - T_h + t] for t in range(T_h - 1)]
    return np.array([*rows, new[0], *new])


@check
def splice_control(mine):
    """Check mine(past, new, T_h).

    Wanted are the last T_h rows of the past, with a last row that leads into the first new frame.
    """
    compare(mine, spliced, _splices, "the joined control", MISTAKES["splice_control"])
    return (
        "control[t] leads from frame t to t + 1. "
        "Most off-by-one errors with motion come from forgetting this."
    )
