"""A timeline, generated before the motion: what the legs and arms do, when, how often yet to come.

"Kicks three times" is one number for a whole motion, and a network that sees noise frame by frame
has to make it out of many frames far apart. In a timeline each frame says what is going on and how
many times are still to come, so counting becomes a matter of neighbours: every kick takes one away.
A small network generates the timeline from the text, and the motion is generated for both
(`performers/planned_mofusion.py`). Nobody has to give a timeline, but one can.

Columns of a frame:
    0:18   one for each verb, 1 while it is performed; of "sit", while the figure is on the seat
    18:20  the sides of legs and arms: 1 left, -1 right, 0 neither or both
    20:22  the times still to come of what legs and arms do, or will do next, this time included
    22:24  how far this time is: from 0 up to 1 in its middle, and down again
Gain: docs/RESULTS_ALL.md (`words-budget.no-timeline.*`).
Ours; MoFusion generates the motion alone.
Notebook: 16, 17
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy
import torch
from jaxtyping import Bool, Float
from torch import Tensor

from ..motion.cleanup import runs
from ..motion.root_frame import FPS

LEGS = (
    "walk", "run", "back", "aside", "turn", "stand", "squat", "jump", "kick", "sit", "rise", "bow"
)  # fmt: skip
ARMS = ("wave", "raise", "hold", "punch", "clap", "point")
WITH_TIMES = ("squat", "jump", "kick", "rise", "bow", *ARMS)  # the rest goes on until the next act
SIDES = {"left": 1.0, "right": -1.0}
WORDS = {value: word for word, value in SIDES.items()}
VERBS = LEGS + ARMS
SIDE, TO_COME, MIDDLE = (len(VERBS) + 2 * k for k in range(3))  # of the legs; the arms come next
D = MIDDLE + 2  # 24
SMOOTHED, SHORTEST = 5, 6  # frames
SPREAD = 0.4  # the standard deviation that all columns are given, so that rare verbs weigh no more


@dataclass(frozen=True)
class Timed:
    """What is done, from when to when, in seconds."""

    verb: str
    side: str
    count: int
    first: float
    last: float


def timeline(acts: Sequence[Timed], frames: int) -> Float[np.ndarray, "{frames} 24"]:
    """The columns of a motion whose acts are known, at 20 frames/s.

    Raises ValueError for a verb that there is not.
    """
    made, at = np.zeros((frames, D)), np.arange(frames) / FPS
    before = [0.0, 0.0]  # the end of the last counted act of legs and arms
    for one in with_seats(sorted(acts, key=lambda one: one.first), frames / FPS):
        if one.verb not in VERBS:
            raise ValueError(f"no verb is called {one.verb!r}; there are {', '.join(VERBS)}")
        part = int(one.verb in ARMS)
        during = (at >= one.first) & (at < one.last)
        made[during, VERBS.index(one.verb)] = 1.0
        made[during, SIDE + part] = SIDES.get(one.side, 0.0)
        if one.verb in WITH_TIMES:
            done = (at - one.first) / max(one.last - one.first, 1 / FPS)
            to_come = one.count * (1 - done.clip(0, 1))
            now = at >= before[part]
            made[now, TO_COME + part] = np.ceil(to_come[now] - 1e-6)
            made[during, MIDDLE + part] = np.sin(np.pi * to_come[during]) ** 2
            before[part] = one.last
    return made


def with_seats(acts: Sequence[Timed], seconds: float) -> Iterator[Timed]:
    """The acts in their order, in which "sit" lasts until the figure gets up, or to the end.

    A figure that gets up first sits from the beginning.
    """
    seats = [one for one in acts if one.verb in ("sit", "rise")]
    if seats and seats[0].verb == "rise" and seats[0].first > 0:
        yield Timed("sit", "", 1, 0.0, seats[0].first)
    for one in acts:
        ends = (rise.first for rise in seats if rise.verb == "rise" and rise.first > one.first)
        yield replace(one, last=next(ends, seconds)) if one.verb == "sit" else one


def acts_of(made: Float[np.ndarray, "T 24"]) -> list[Timed]:
    """The acts of a timeline, in the order of their beginnings; it need not be a clean one.

    An act lasts while its verb's column is above one half, its side stays, and the times to come do
    not rise. What lasts under SHORTEST frames is no act.
    """
    acts = []
    smooth = scipy.ndimage.median_filter(made, (SMOOTHED, 1), mode="nearest")
    for column, verb in enumerate(VERBS):
        part = int(verb in ARMS)
        side = np.round(smooth[:, SIDE + part]).astype(int)
        to_come = np.round(smooth[:, TO_COME + part]).astype(int)
        if verb not in WITH_TIMES:
            to_come[:] = 1
        breaks = (np.diff(side, prepend=side[:1]) != 0) | (np.diff(to_come, prepend=99) > 0)
        for first, last in runs(smooth[:, column] > 0.5):
            cuts = [first, *(first + 1 + np.flatnonzero(breaks[first + 1 : last])), last]
            for begin, end in zip(cuts, cuts[1:], strict=False):
                if end - begin >= SHORTEST:
                    whose = WORDS.get(float(np.median(side[begin:end])), "")
                    count = max(1, int(to_come[begin : begin + 3].max()))
                    acts.append(Timed(verb, whose, count, begin / FPS, end / FPS))
    return sorted(acts, key=lambda one: one.first)


def tidied(made: Float[Tensor, "*B T 24"]) -> Float[Tensor, "*B T 24"]:
    """Timelines as they would be written for their acts: whole numbers, sharp edges."""
    rows = made.double().cpu().numpy().reshape(-1, *made.shape[-2:])
    clean = np.stack([timeline(acts_of(row), len(row)) for row in rows])
    return torch.from_numpy(clean).to(made).reshape(made.shape)


def mirrored(columns: Float[Tensor, "*B T F"]) -> Float[Tensor, "*B T F"]:
    """The timeline of the mirrored motion: left and right exchanged. None (F = 0) stays none."""
    sign = columns.new_ones(D)
    sign[SIDE:TO_COME] = -1
    return columns * sign[: columns.shape[-1]]


def of_the_legs() -> Bool[Tensor, "24"]:
    """True for the columns of the legs; the others are those of the arms."""
    legs = torch.zeros(D, dtype=torch.bool)
    legs[: len(LEGS)] = True
    legs[[SIDE, TO_COME, MIDDLE]] = True
    return legs
