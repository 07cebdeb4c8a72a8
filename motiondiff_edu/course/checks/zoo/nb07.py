"""Wrong answers to the exercises of notebook 07."""

from dataclasses import dataclass

import torch


def one_row_late(control, T_h):
    """Holds the first row of the future: the walker knows a frame it cannot know yet."""
    held = control.clone()
    held[T_h:] = control[T_h]
    return held


def in_place(control, T_h):
    """Right numbers, but the caller's control loses its future."""
    control[T_h:] = control[T_h - 1]
    return control


def one_row_kept_too_many(control, T_h):
    """One row of the future is left as it was: a glimpse of a single frame."""
    held = control.clone()
    held[T_h + 1 :] = control[T_h - 1]
    return held


def zeroed(control, T_h):
    """Tells the walker to stop at once, in every window anew."""
    held = control.clone()
    held[T_h:] = 0
    return held


def everything_held(control, T_h):
    """Overwrites the past with its last row, too, so that a curve becomes a straight line."""
    return control[T_h - 1 : T_h].repeat(len(control), 1)


@dataclass(frozen=True)
class _Fault:
    """Where a rollout goes wrong; as it stands it is right."""

    shift: int = 0  # frames that the control is late
    keep: int = 1  # poses kept of a window
    hold: bool = True  # the control over the future
    feed: bool = True  # the new pose back into the past
    drop: bool = True  # the oldest pose of the past


def _roll(sample, past, control, frames, T_p, fault):
    T_h, new = past.shape[1], []
    while sum(w.shape[1] for w in new) < frames:
        t = sum(w.shape[1] for w in new) + fault.shift
        rows = control[:, t : t + T_h]
        ahead = control[:, t + T_h : t + T_h + T_p]
        ahead = rows[:, -1:].repeat(1, T_p, 1) if fault.hold else ahead
        window = sample(past, torch.cat([rows, ahead], dim=1))[:, : fault.keep]
        new.append(window)
        if fault.feed:
            past = torch.cat([past[:, fault.keep if fault.drop else 0 :], window], dim=1)
    return torch.cat(new, dim=1)[:, :frames]


def look_ahead(sample, past, control, frames, T_p):
    """Gives the control that is to come where the last known row should be held."""
    longer = torch.cat([control, control[:, -1:].repeat(1, T_p, 1)], 1)
    return _roll(sample, past, longer, frames, T_p, _Fault(hold=False))


def control_one_late(sample, past, control, frames, T_p):
    """Control and poses are a frame apart: the figure obeys too early."""
    longer = torch.cat([control, control[:, -1:]], 1)
    return _roll(sample, past, longer, frames, T_p, _Fault(shift=1))


def keeps_the_whole_window(sample, past, control, frames, T_p):
    """Takes all poses of a window and so hears of the control once in T_p frames only."""
    return _roll(sample, past, control, frames, T_p, _Fault(keep=T_p))


def never_feeds_back(sample, past, control, frames, T_p):
    """Every window starts from the same past: the figure never gets going."""
    return _roll(sample, past, control, frames, T_p, _Fault(feed=False))


def keeps_the_oldest(sample, past, control, frames, T_p):
    """The past grows by a pose each time, and is no longer what the network was trained on."""
    return _roll(sample, past, control, frames, T_p, _Fault(drop=False))


def feeds_the_last_of_the_window(sample, past, control, frames, T_p):
    """Keeps the pose furthest in the future, and so leaves out T_p - 1 frames each time."""
    T_h, new = past.shape[1], []
    for t in range(frames):
        rows = control[:, t : t + T_h]
        window = sample(past, torch.cat([rows, rows[:, -1:].repeat(1, T_p, 1)], dim=1))
        new.append(window[:, -1])
        past = torch.cat([past[:, 1:], window[:, -1:]], dim=1)
    return torch.stack(new, dim=1)


ZOO = {
    "hold_control": {
        "one row late": one_row_late,
        "changed in place": in_place,
        "one row kept too many": one_row_kept_too_many,
        "zero instead of held": zeroed,
        "the past held, too": everything_held,
    },
    "rollout_by_hand": {
        "look-ahead": look_ahead,
        "control one row late": control_one_late,
        "the whole window kept": keeps_the_whole_window,
        "its own poses never fed back": never_feeds_back,
        "the oldest pose kept": keeps_the_oldest,
        "the last pose of the window": feeds_the_last_of_the_window,
    },
}
