"""Wrong answers to the exercises of notebook 07."""

from dataclasses import dataclass

import torch


def _held(row, first=lambda T_h: T_h):
    """Holds another row, or begins at another one."""

    def answer(control, T_h):
        held = control.clone()
        held[first(T_h) :] = control[row(T_h)]
        return held

    return answer


def in_place(control, T_h):
    """Right numbers, but the caller's control loses its future."""
    control[T_h:] = control[T_h - 1].clone()
    return control


def zeroed(control, T_h):
    """Tells the walker to stop at once, in every window anew."""
    held = control.clone()
    held[T_h:] = 0
    return held


def everything_held(control, T_h):
    """Overwrites the past with its last row, too, so that a curve becomes a straight line."""
    return control[T_h - 1 : T_h].repeat(len(control), 1)


def past_held(control, T_h):
    """Writes over the known rows."""
    held = control.clone()
    held[:T_h] = control[T_h - 1]
    return held


def shifted(control, T_h):
    """Takes the row before for each future row, instead of one row for all."""
    held = control.clone()
    held[T_h:] = control[T_h - 1 : -1]
    return held


def mean_held(control, T_h):
    """A mean of the past is late in every curve."""
    held = control.clone()
    held[T_h:] = control[:T_h].mean(0)
    return held


@dataclass(frozen=True)
class _Fault:
    """Where a rollout goes wrong; as it stands it is right."""

    shift: int = 0  # frames that the control is late
    keep: int = 1  # poses kept of a window
    hold: bool = True  # the control over the future
    held: int = -1  # which row beside the past is held
    feed: bool = True  # the new pose back into the past
    move: bool = True  # the control with time
    zero: bool = False  # the future's control is zero


def _roll(sample, past, control, frames, T_p, fault):
    T_h, new = past.shape[1], []
    while sum(w.shape[1] for w in new) < frames:
        t = sum(w.shape[1] for w in new) * fault.move + fault.shift
        rows = control[:, t : t + T_h]
        ahead = control[:, t + T_h : t + T_h + T_p]
        ahead = rows[:, [fault.held]].repeat(1, T_p, 1) if fault.hold else ahead
        window = sample(past, torch.cat([rows, ahead * (not fault.zero)], dim=1))[:, : fault.keep]
        new.append(window)
        if fault.feed:
            past = torch.cat([past[:, fault.keep :], window], dim=1)
    return torch.cat(new, dim=1)[:, :frames]


def _longer(control, by):
    return torch.cat([control, control[:, -1:].repeat(1, by, 1)], 1)


def look_ahead(sample, past, control, frames, T_p):
    """Gives the control that is to come where the last known row should be held."""
    return _roll(sample, past, _longer(control, T_p), frames, T_p, _Fault(hold=False))


def _wrong(fault):
    return lambda sample, past, control, frames, T_p: _roll(
        sample, past, _longer(control, 1), frames, T_p, fault
    )


def keeps_the_whole_window(sample, past, control, frames, T_p):
    """Takes all poses of a window and so hears of the control once in T_p frames only."""
    return _roll(sample, past, _longer(control, T_p), frames, T_p, _Fault(keep=T_p))


def keeps_the_oldest(sample, past, control, frames, T_p):
    """The past grows by a pose each time, and is no longer what the network was trained on."""
    T_h, new = past.shape[1], []
    for t in range(frames):
        rows = control[:, t : t + T_h]
        window = sample(past, torch.cat([rows, rows[:, -1:].repeat(1, T_p, 1)], 1))
        new, past = [*new, window[:, 0]], torch.cat([past, window[:, :1]], 1)
    return torch.stack(new, 1)


def feeds_the_last_of_the_window(sample, past, control, frames, T_p):
    """Keeps the pose furthest in the future, and so leaves out T_p - 1 frames each time."""
    T_h, new = past.shape[1], []
    for t in range(frames):
        rows = control[:, t : t + T_h]
        window = sample(past, torch.cat([rows, rows[:, -1:].repeat(1, T_p, 1)], dim=1))
        new.append(window[:, -1])
        past = torch.cat([past[:, 1:], window[:, -1:]], dim=1)
    return torch.stack(new, dim=1)


def held_row_late(sample, past, control, frames, T_p):
    """The rows beside the past are right, the row that is held comes one too late."""
    T_h = past.shape[1]
    new = []
    control = _longer(control, 1)
    for t in range(frames):
        rows = control[:, t : t + T_h]
        ahead = control[:, t + T_h : t + T_h + 1].repeat(1, T_p, 1)
        window = sample(past, torch.cat([rows, ahead], dim=1))
        new, past = [*new, window[:, 0]], torch.cat([past[:, 1:], window[:, :1]], 1)
    return torch.stack(new, dim=1)


def past_in_place(sample, past, control, frames, T_p):
    """Right poses, but the past that was given is overwritten."""
    T_h, new = past.shape[1], []
    for t in range(frames):
        rows = control[:, t : t + T_h]
        window = sample(past, torch.cat([rows, rows[:, -1:].repeat(1, T_p, 1)], 1))
        new.append(window[:, 0])
        past[:] = torch.cat([past[:, 1:], window[:, :1]], 1)
    return torch.stack(new, 1)


MISTAKES = {
    "hold_control": {
        "one row too late: row T_h is a step that is not known yet": _held(lambda T_h: T_h),
        "one row too early: the step into the first predicted frame is known, it is row T_h - 1": (
            _held(lambda T_h: T_h - 2)
        ),
        "one row too early: the past ends with row T_h - 1, which stays as it is": _held(
            lambda T_h: T_h - 2, lambda T_h: T_h - 1
        ),
        "the past was overwritten, and the future stayed": past_held,
        "each row is that of the frame before: hold one row over the future": shifted,
        "hold the last known row, not the mean of the past": mean_held,
        "row T_h is a future row, too": _held(lambda T_h: T_h - 1, lambda T_h: T_h + 1),
        "the control is unchanged: hold one row over the future": lambda control, T_h: (
            control.clone()
        ),
        "the future is not zero, it repeats the last known step": zeroed,
        "the past must stay as it was; only the future is unknown": everything_held,
        "the last row of the whole control is held; the walker does not know it yet": _held(
            lambda T_h: -1
        ),
        "the first row is held; hold the last one that is known": _held(lambda T_h: 0),
    },
    "rollout_by_hand": {
        "this is look-ahead: the future control is not known yet; hold the last row": look_ahead,
        "the row that is held is one too late: which step leads into the first new frame?": (
            held_row_late
        ),
        "the row that is held is one too early": _wrong(_Fault(held=-2)),
        "the rows beside the past are one frame too late": _wrong(_Fault(shift=1)),
        "the unknown future is not zero": _wrong(_Fault(zero=True)),
        "keep only the first pose of each window": keeps_the_whole_window,
        "every window has the first past: append the pose that was kept": _wrong(
            _Fault(feed=False)
        ),
        "the pose that is kept is the last of the window; keep the first": (
            feeds_the_last_of_the_window
        ),
        "the control never moves on: window t begins at row t": _wrong(_Fault(move=False)),
    },
}
OTHERS = {
    "hold_control": {"changed in place": in_place},
    "rollout_by_hand": {"the oldest pose kept": keeps_the_oldest, "past in place": past_in_place},
}
