"""Checks of notebook 10: there and back."""

import numpy as np
import torch

from ._compare import compare
from ._drawn import tensors
from ._report import check, expect
from .zoo.nb10 import MISTAKES

T_H = 3


class Walker:
    """A toy `walk_on` whose pose is two numbers, (B, 3, 2).

    Column 0 of the control changes the first number, column 2 the second; a little of all past
    poses is in each new one. It refuses a past or a control that is too short, and a third call.
    """

    def __init__(self, of_past: torch.Tensor):
        self.of_past = of_past
        self.calls = 0

    def __call__(self, past: torch.Tensor, control: torch.Tensor) -> torch.Tensor:
        self.calls += 1
        call = f"call {self.calls} of walk_on"
        B, rows = len(past), control.shape[1]
        expect(
            past.shape[1:] == (T_H, 2),
            f"{call} got a past {tuple(past.shape)}; it needs all T_h = {T_H} frames, "
            f"({B}, {T_H}, 2)",
        )
        expect(
            rows == 2 * T_H,
            f"{call} got {rows} rows of control; it needs all {2 * T_H}: {T_H} for the past, "
            f"{T_H} for the new frames",
        )
        expect(self.calls < 3, f"{call}: one round takes two calls, there and back")
        steps = control[:, T_H - 1 : 2 * T_H - 1][..., [0, 2]]
        return past[:, -1:] + steps.cumsum(1) + self.of_past @ past


def turned_round(control: torch.Tensor) -> torch.Tensor:
    """Row t leads from frame T - 1 - t back to T - 2 - t; the last one repeats."""
    T = control.shape[1]
    return torch.stack([-control[:, max(T - 2 - t, 0)] for t in range(T)], 1)


def _controls(rng: np.random.Generator):
    """Two walks by hand; others."""
    one = torch.tensor([[1.0, 0.5, 4], [2, 0.25, 8], [3, 0.125, 16], [7, 0.75, 32]])
    yield (torch.stack([one, -10 * one]),)
    yield (tensors(rng, 3, 6, 3),)


@check
def time_reversal(mine):
    """mine(control (B, T, 3)): the control of the same walk played backwards."""
    what = "the control of walks, played backwards"
    compare(mine, turned_round, _controls, what, MISTAKES["time_reversal"])
    return "Backwards in time, all three velocities change their sign, and all rows move by one."


def _pasts(rng: np.random.Generator):
    """Round numbers with a walker that only adds the control; then others with holes anywhere."""
    nan = float("nan")
    past = torch.tensor(
        [[[1.0, nan], [nan, nan], [4.0, 5.0]], [[2.0, 7.0], [nan, 6.0], [5.0, nan]]]
    )
    control = torch.tensor(
        [[1.0, 0.4, 2], [2, 0.3, 0.5], [4, 0.2, 1], [3, 0.1, 0.25], [1, 0.6, 8], [16, 0.5, 32]]
    ).expand(2, -1, -1)
    yield Walker(torch.zeros(T_H, T_H)), past, ~past.isnan(), torch.tensor([8.0, 9.0]), control
    for _ in range(2):
        past = tensors(rng, 3, T_H, 2)
        known = torch.from_numpy(rng.random((3, T_H, 2)) < 0.5)
        past[~known] = nan
        walker = Walker(0.2 * tensors(rng, T_H, T_H))
        yield walker, past, known, tensors(rng, 2), tensors(rng, 3, 2 * T_H, 3)


def one_round(walk_on, past, known, mean, control) -> torch.Tensor:
    """Frame by frame: fill, walk on, turn round, walk back, turn round, keep what was given."""
    filled = past.clone()
    for place in (~known).nonzero().tolist():
        filled[tuple(place)] = mean[place[-1]]
    ahead = torch.stack(walk_on(filled, control).unbind(1)[::-1], 1)
    back = torch.stack(walk_on(ahead, turned_round(control)).unbind(1)[::-1], 1)
    result = past.clone()
    for place in (~known).nonzero().tolist():
        result[tuple(place)] = back[tuple(place)]
    return result


@check
def there_and_back(mine):
    """mine(walk_on, past, known, mean, control): one round; past has NaN in its holes."""
    compare(mine, one_round, _pasts, "the past after one round", MISTAKES["there_and_back"])
    return (
        "In the first case one number is still its mean: the toy walker of this check knows "
        "nothing of bodies, and has nothing better for it."
    )


def _changes(rng: np.random.Generator):
    """Holes that move by 3, 4 and 0, and by 1 and 7; a sample without holes; others."""
    before = torch.zeros(2, 4, 3)
    known = torch.ones(2, 4, 3, dtype=torch.bool)
    known[0, 1] = False
    known[1, 2:, 0] = False
    after = before + 100.0
    after[0, 1] = torch.tensor([3.0, 4.0, 0.0])
    after[1, 2:, 0] = torch.tensor([1.0, 7.0])
    yield before, after, known
    known = torch.from_numpy(rng.random((3, 5, 2)) < 0.6)
    known[1] = True
    known[2] = True
    known[2, 3, 1] = False  # a single hole
    yield tensors(rng, 3, 5, 2), tensors(rng, 3, 5, 2), known


def hole_by_hole(before, after, known) -> list[float]:
    """Hole by hole, in plain Python."""
    changes = []
    for b, a, k in zip(before, after, known, strict=True):
        squares = [float((a[tuple(p)] - b[tuple(p)]) ** 2) for p in (~k).nonzero().tolist()]
        changes.append((sum(squares) / len(squares)) ** 0.5 if squares else 0.0)
    return changes


@check
def moved_by(mine):
    """mine(before, after, known): how far the holes moved, RMS, one number for each sample."""
    compare(mine, hole_by_hole, _changes, "the change of each sample", MISTAKES["moved_by"])
    return "Each sample has its own change, but the loop runs until all of them are small."
