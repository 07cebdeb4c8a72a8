"""Wrong answers to the exercises of notebook 08."""

from dataclasses import dataclass

import numpy as np


def _heights(toes):
    return np.maximum(toes[1:, :, 1], toes[:-1, :, 1])


def _speeds(toes):
    return _speeds_along(toes, [0, 2])


def _speeds_along(toes, axes):
    return np.linalg.norm(np.diff(toes[:, :, axes], axis=0), axis=-1)


@dataclass(frozen=True)
class _Fault:
    """Where a measure of skating goes wrong; as it stands it is right."""

    height: object = _heights  # of each toe in each step
    speed: object = _speeds  # of each toe in each step, in metres a frame
    lower: object = None  # which toe, from heights and speeds
    fps: float | None = None
    below: float | None = None
    or_equal: bool = False


def _skate(toes, fps, below, fault):
    height, speed = fault.height(toes), fault.speed(toes)
    lower = height.argmin(1) if fault.lower is None else fault.lower(height, speed)
    rows, below = np.arange(len(height)), fault.below or below
    planted = height[rows, lower] < below
    return (fault.fps or fps) * speed[rows, lower][planted].mean()


def _wrong(fault):
    return lambda toes, fps=20, below=0.03: _skate(toes, fps, below, fault)


def per_frame(toes, fps=20, below=0.03):
    """Gives metres per frame, a twentieth of the speed: every foot seems to stand still."""
    return _skate(toes, 1.0, below, _Fault())


def frame_time_inverted(toes, fps=20, below=0.03):
    """Multiplies by the time of a frame instead of dividing by it."""
    return _skate(toes, 1 / fps, below, _Fault())


def in_the_air(toes, fps=20, below=0.03):
    """A swinging toe is fast, and should be; here it counts as sliding."""
    return _skate(toes, fps, np.inf, _Fault())


def nothing_is_a_score(toes, fps=20, below=0.03):
    """Frames without a planted toe count as perfect, so a figure that flies wins."""
    height, speed = _heights(toes), _speeds(toes)
    lower = speed[np.arange(len(height)), height.argmin(1)]
    return fps * np.where(height.min(1) < below, lower, 0).mean()


def both_toes(toes, fps=20, below=0.03):
    """While one toe stands, the other swings: its speed is counted as sliding."""
    return fps * _speeds(toes)[_heights(toes).min(1) < below].mean()


def each_planted_toe(toes, fps=20, below=0.03):
    """Where both toes are low, both count: such frames weigh twice."""
    return fps * _speeds(toes)[_heights(toes) < below].mean()


def planted_in_the_air(toes, fps=20, below=0.03):
    """The comparison is the wrong way round."""
    height, speed = _heights(toes), _speeds(toes)
    lower = speed[np.arange(len(height)), height.argmin(1)]
    return fps * lower[height.min(1) >= below].mean()


def summed(toes, fps=20, below=0.03):
    """Adds up where the mean is asked for."""
    height, speed = _heights(toes), _speeds(toes)
    lower = speed[np.arange(len(height)), height.argmin(1)]
    return fps * lower[height.min(1) < below].sum()


def median(toes, fps=20, below=0.03):
    """A median does not see a single slip."""
    height, speed = _heights(toes), _speeds(toes)
    lower = speed[np.arange(len(height)), height.argmin(1)]
    return fps * np.median(lower[height.min(1) < below])


def _merge(runs, gap, from_first=False, slack=0):
    merged = []
    for first, after in runs:
        if merged and first - merged[-1][0 if from_first else 1] <= gap + slack:
            merged[-1] = (merged[-1][0], after)
        else:
            merged.append((first, after))
    return merged


def pairs_once(runs, gap):
    """Joins two runs and skips both: a third short run of the same step stays alone."""
    merged, k = [], 0
    while k < len(runs):
        join = k + 1 < len(runs) and runs[k + 1][0] - runs[k][1] <= gap
        merged.append((runs[k][0], runs[k + join][1]))
        k += 1 + join
    return merged


def start_moved(runs, gap):
    """The joined run begins where its last part does."""
    merged = []
    for first, after in runs:
        if merged and first - merged[-1][1] <= gap:
            merged[-1] = (first, after)
        else:
            merged.append((first, after))
    return merged


def end_kept(runs, gap):
    """The joined run ends where its first part does: nothing is joined, some runs are lost."""
    merged = []
    for first, after in runs:
        if not merged or first - merged[-1][1] > gap:
            merged.append((first, after))
    return merged


def neighbours_only(runs, gap):
    """Compares with the run before as it was given, and forgets what it was joined to."""
    merged = list(runs[:1])
    for before, now in zip(runs, runs[1:], strict=False):
        if now[0] - before[1] <= gap:
            merged[-1] = (before[0], now[1])
        else:
            merged.append(now)
    return merged


def in_place(runs, gap):
    """The steps are right, but the caller's list is changed."""
    runs[:] = _merge(runs, gap)
    return runs


MISTAKES = {
    "toe_slide": {
        "a speed is per second: multiply by fps": (per_frame, frame_time_inverted),
        "you used 20 for fps; it is an argument, and not always 20": _wrong(_Fault(fps=20)),
        "you used 0.03 for `below`; it is an argument, and not always 0.03": _wrong(
            _Fault(below=0.03)
        ),
        "steps without a planted toe count as sliding of zero; leave them out": nothing_is_a_score,
        "both toes are counted; count only the lower one": both_toes,
        "each toe under `below` is counted; where both are, count only the lower one": (
            each_planted_toe
        ),
        "sliding is horizontal, along x and z; y is the height": (
            _wrong(_Fault(speed=lambda toes: _speeds_along(toes, [0, 1]))),
            _wrong(_Fault(speed=lambda toes: _speeds_along(toes, [1, 2]))),
        ),
        "the height of a step is that of its higher end, not the mean of both": _wrong(
            _Fault(height=lambda toes: (toes[1:, :, 1] + toes[:-1, :, 1]) / 2)
        ),
        "the height of a step is that of its higher end, not of its lower one": _wrong(
            _Fault(height=lambda toes: np.minimum(toes[1:, :, 1], toes[:-1, :, 1]))
        ),
        "the height is taken at the first end of the step only": _wrong(
            _Fault(height=lambda toes: toes[:-1, :, 1])
        ),
        "the height is taken at the second end of the step only": _wrong(
            _Fault(height=lambda toes: toes[1:, :, 1])
        ),
        "this is the higher toe; take the lower one": _wrong(
            _Fault(lower=lambda h, v: h.argmax(1))
        ),
        "steps in the air are counted, too; is a toe under `below`?": in_the_air,
        "these are the steps in the air; a planted toe is *under* `below`": planted_in_the_air,
        "this is the slower toe; speed is what we measure, so choose by height": _wrong(
            _Fault(lower=lambda h, v: v.argmin(1))
        ),
        "this is always the left toe; take the lower one": _wrong(
            _Fault(lower=lambda h, v: np.zeros(len(h), int))
        ),
        "upward movement is no sliding: use only x and z": _wrong(
            _Fault(speed=lambda toes: np.linalg.norm(np.diff(toes, axis=0), axis=-1))
        ),
        "sliding to the side counts, too: the length of (x, z)": (
            _wrong(_Fault(speed=lambda toes: np.abs(np.diff(toes[:, :, 2], axis=0)))),
            _wrong(_Fault(speed=lambda toes: np.abs(np.diff(toes[:, :, 0], axis=0)))),
        ),
        "that is |x| + |z|; the length of (x, z) is a root of squares": _wrong(
            _Fault(speed=lambda toes: np.abs(np.diff(toes[:, :, [0, 2]], axis=0)).sum(-1))
        ),
        "the speeds are squared; take their root": _wrong(
            _Fault(speed=lambda toes: _speeds(toes) ** 2)
        ),
        "take the mean, not the sum": summed,
        "take the mean, not the median": median,
    },
    "merge_steps": {
        "a gap of exactly `gap` frames is closed as well": (
            lambda runs, gap: _merge(runs, gap, slack=-1)
        ),
        "a gap of `gap` + 1 frames stays open": lambda runs, gap: _merge(runs, gap, slack=1),
        "three short runs in a row must become one step; yours made two": pairs_once,
        "a step is missing at the end": lambda runs, gap: _merge(runs, gap)[:-1],
        "short runs are joined, not dropped": lambda runs, gap: [
            (first, after) for first, after in runs if after - first > gap
        ],
        "the gap begins at the end of the run before, not at its first frame": (
            lambda runs, gap: _merge(runs, gap, from_first=True)
        ),
        "a joined step begins with its first run": (start_moved, neighbours_only),
        "a joined step ends with its last run": end_kept,
        "nothing is joined": lambda runs, gap: list(runs),
        "everything is joined, also over wide gaps": lambda runs, gap: (
            [(runs[0][0], runs[-1][1])] if runs else []
        ),
    },
}
OTHERS = {"merge_steps": {"changes its input": in_place}}
