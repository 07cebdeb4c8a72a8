"""Wrong answers to the exercises of notebook 00."""

from typing import Any

import numpy as np


def turning(turn=(0.8, 0.0, -np.pi / 4), rows=100, first=1.2):
    """A control in which only the numbers of the turn are given; as it stands it is right."""
    control = np.zeros((rows, 3))
    control[:40, 0] = first
    control[40:80] = turn
    return control


def in_place(past_control, new, T_h):
    """Right numbers, but the caller's control of the past is overwritten with them."""
    past_control[-1] = new[0]
    return np.concatenate([past_control[-T_h:], new])


def row_missing(past_control, new, T_h):
    """The row that leads into the first new frame is missing, so all others come a frame early."""
    return np.concatenate([past_control[-T_h:-1], new])


def first_rows(past_control, new, T_h):
    """Keeps the beginning of the past; a continuation needs its end."""
    past = past_control[:T_h].copy()
    past[-1] = new[0]
    return np.concatenate([past, new])


def last_new_row(past_control, new, T_h):
    """The past leads to where the new control ends."""
    return np.concatenate([past_control[-T_h:-1], new[-1:], new])


def whole_past(past_control, new, T_h):
    """All of the past, with the right last row."""
    return np.concatenate([past_control[:-1], new[:1], new])


MISTAKES: dict[str, dict[str, Any]] = {
    "splice_control": {
        "the last row of the past still repeats the row before it; it should lead into the first "
        "new frame": lambda past, new, T_h: np.concatenate([past[-T_h:], new]),
        "one row is missing: the first row of `new` must stand twice": row_missing,
        "these are the first rows of the past; the walker sees the last ones": (
            first_rows,
            lambda past, new, T_h: np.concatenate([past[:T_h], new]),
        ),
        "the whole past is in; the walker needs T_h rows of it": (
            whole_past,
            lambda past, new, T_h: np.concatenate([past, new]),
        ),
        "past and future are swapped": lambda past, new, T_h: np.concatenate(
            [new, past[-T_h:-1], new[:1]]
        ),
        "the last row of the past should be the first row of `new`, not its last one": last_new_row,
        "the new rows are missing: append them": lambda past, new, T_h: np.concatenate(
            [past[-T_h:-1], new[:1]]
        ),
    }
}
OTHERS = {
    "right_turn": {
        "to the left": lambda: turning((0.8, 0.0, np.pi / 4)),
        "half a second late": lambda: (
            np.roll(turning(), 10, axis=0) + [[1.2, 0, 0]] * (np.arange(100)[:, None] < 10)
        ),
        "half a second early": lambda: np.roll(turning(), -10, axis=0),
        "in degrees": lambda: turning((0.8, 0.0, -45.0)),
        "the whole turn in degrees": lambda: turning((0.8, 0.0, -90.0)),
        "twice as fast": lambda: turning((0.8, 0.0, -np.pi / 2)),
        "per frame": lambda: turning((0.8, 0.0, -np.pi / 80)),
        "a sidestep": lambda: turning((0.8, -np.pi / 4, 0.0)),
        "on the spot": lambda: turning((0.0, 0.0, -np.pi / 4)),
        "too slow at first": lambda: turning(first=1.0),
        "five seconds at 25 frames": lambda: turning(rows=125),
        "returns nothing": lambda: None,
    },
    "splice_control": {"changed in place": in_place},
}
