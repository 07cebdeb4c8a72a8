"""Wrong answers to the exercises of notebook 00."""

import numpy as np


def _control(turn=(0.8, 0.0, -np.pi / 4), rows=100):
    control = np.zeros((rows, 3))
    control[:40, 0] = 1.2
    control[40:80] = turn
    return control


def _splice(past, new):
    return np.concatenate([past, new])


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


ZOO = {
    "right_turn": {
        "to the left": lambda: _control((0.8, 0.0, np.pi / 4)),
        "in degrees": lambda: _control((0.8, 0.0, -45.0)),
        "twice as fast": lambda: _control((0.8, 0.0, -np.pi / 2)),
        "per frame": lambda: _control((0.8, 0.0, -np.pi / 80)),
        "a sidestep": lambda: _control((0.8, -np.pi / 4, 0.0)),
        "five seconds at 25 frames": lambda: _control(rows=125),
        "returns nothing": lambda: None,
    },
    "splice_control": {
        "last row left as it is": lambda past, new, T_h: _splice(past[-T_h:], new),
        "changed in place": in_place,
        "a row missing": row_missing,
        "the first rows of the past": first_rows,
        "the whole past": lambda past, new, T_h: _splice(past, new),
    },
}
