"""Checks of notebook 00: your own control, and the join of past and future control."""

import numpy as np

from ._report import check, expect, expect_close


@check
def right_turn(mine):
    """mine() -> (100, 3): the control of five seconds with one turn to the right."""
    got = mine()
    expect(got is not None, "your answer returns nothing; is a `return` missing?")
    got = np.asarray(got, dtype=float)
    expect(
        got.shape == (100, 3),
        f"five seconds at 20 frames/s are 100 rows of 3 numbers, not {got.shape}",
    )
    expect_close(
        got[:40], np.tile([1.2, 0.0, 0.0], (40, 1)), "the first two seconds (rows 0 to 39)"
    )
    quarter = np.pi / 4  # 90 degrees in two seconds
    mistakes = {
        "it turns left: counter-clockwise is positive, seen from above": np.tile(
            [0.8, 0.0, quarter], (40, 1)
        ),
        "these are degrees; the control is in radians": np.tile([0.8, 0.0, -45.0], (40, 1)),
        "this turns by 90 degrees in one second; the turn should take two": np.tile(
            [0.8, 0.0, -2 * quarter], (40, 1)
        ),
        ("90 is the whole turn in degrees; the control is in radians, and per second"): np.tile(
            [0.8, 0.0, -90.0], (40, 1)
        ),
        "this is the turn of one frame; the control is per second": np.tile(
            [0.8, 0.0, -quarter / 20], (40, 1)
        ),
        "the second column is a step to the side; the turn is in the third column": np.tile(
            [0.8, -quarter, 0.0], (40, 1)
        ),
        "it turns on the spot; it should keep walking at 0.8 m/s": np.tile(
            [0.0, 0.0, -quarter], (40, 1)
        ),
    }
    turning = np.tile([0.8, 0.0, -quarter], (40, 1))
    expect_close(got[40:80], turning, "seconds three and four (rows 40 to 79)", mistakes, rtol=1e-3)
    expect_close(got[80:], np.zeros((20, 3)), "the last second (rows 80 to 99), which is at rest")
    return "Three columns, 20 rows a second: that is the walker's whole control."


@check
def splice_control(mine):
    """Check mine(past, new, T_h).

    Wanted are the last T_h rows of the past, with a last row that leads into the first new frame.
    """
    past = np.arange(18.0).reshape(6, 3)
    new = 100 + np.arange(12.0).reshape(4, 3)
    before = past.copy()
    got = mine(past, new, 5)
    expect(np.array_equal(past, before), "the recording's control was changed; work on a copy")
    wanted = np.concatenate([past[1:5], new[:1], new])
    mistakes = {
        (
            "the last row of the past still repeats the row before it; "
            "it should lead into the first new frame"
        ): np.concatenate([past[1:], new]),
        "one row is missing: the first row of `new` must stand twice": np.concatenate(
            [past[1:5], new]
        ),
        "these are the first rows of the past; the walker sees the last ones": np.concatenate(
            [past[:4], new[:1], new]
        ),
        "the whole past is in; the walker needs T_h rows of it": np.concatenate(
            [past[:5], new[:1], new]
        ),
        "past and future are swapped": np.concatenate([new, past[1:5], new[:1]]),
    }
    expect_close(got, wanted, "5 rows of a past and 4 new ones", mistakes)
    return (
        "control[t] leads from frame t to t + 1. "
        "Most off-by-one errors with motion come from forgetting this."
    )
