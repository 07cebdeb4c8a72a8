"""Checks of notebook 07.

The control held over the future, and the rollout that repeats Algorithm 2.
"""

import numpy as np
import torch

from ._compare import compare
from ._drawn import tensors
from ._report import check, expect
from .zoo.nb07 import MISTAKES


def _controls(rng: np.random.Generator):
    """7 rows of which 4 are past; others."""
    yield torch.arange(21.0).reshape(7, 3), 4
    yield tensors(rng, 9, 3), 3
    yield tensors(rng, 6, 3), 5


def held(control, T_h: int) -> torch.Tensor:
    """Row by row."""
    return torch.stack([control[min(t, T_h - 1)] for t in range(len(control))])


@check
def hold_control(mine):
    """mine(control, T_h): the row that leads out of the last past frame, repeated to the end."""
    compare(mine, held, _controls, "the held control", MISTAKES["hold_control"])
    return "The walker knows one step ahead: the step that it is about to take."


class _Sampler:
    """A toy walker of Algorithm 2: each new pose depends on all that it is shown.

    It refuses a past or a control of another length, and a call too many.
    """

    def __init__(self, rng: np.random.Generator, shape: tuple[int, ...], frames: int):
        self.B, self.T_h, self.T_p, self.D, self.C = shape
        self.of_past = tensors(rng, self.T_p, self.T_h) / self.T_h
        self.of_control = tensors(rng, self.T_p, self.T_h + self.T_p)
        self.mix = tensors(rng, self.C, self.D)
        self.left = frames

    def __call__(self, past, control):
        seen, wanted = tuple(past.shape), (self.B, self.T_h, self.D)
        expect(
            seen == wanted, f"the sampler got a past {seen}; it needs the last T_h poses, {wanted}"
        )
        seen, wanted = tuple(control.shape), (self.B, self.T_h + self.T_p, self.C)
        expect(
            seen == wanted,
            f"the sampler got a control {seen}; it needs T_h rows beside the past and T_p for the "
            f"new poses, {wanted}",
        )
        self.left -= 1
        expect(
            self.left >= 0,
            "the sampler is called more often than there are frames; each call gives one of them",
        )
        return torch.tanh(self.of_past @ past + self.of_control @ control @ self.mix)


def _rollouts(rng: np.random.Generator):
    """Two walkers of other sizes; the control has a row for each past and each new frame."""
    for B, T_h, T_p, D, C, frames in ((2, 4, 3, 6, 2, 5), (3, 5, 2, 4, 3, 7)):
        sample = _Sampler(rng, (B, T_h, T_p, D, C), frames)
        yield sample, tensors(rng, B, T_h, D), tensors(rng, B, T_h + frames, C), frames, T_p


def rolled(sample, past, control, frames: int, T_p: int) -> torch.Tensor:
    """All poses in one list; each window looks at its last T_h."""
    poses, T_h = list(past.unbind(1)), past.shape[1]
    rows = list(control.unbind(1))
    for t in range(frames):
        shown = torch.stack(poses[-T_h:], 1)
        steps = torch.stack([*rows[t : t + T_h], *[rows[t + T_h - 1]] * T_p], 1)
        poses.append(sample(shown, steps)[:, 0])
    return torch.stack(poses[T_h:], 1)


@check
def rollout_by_hand(mine):
    """Check mine(sample, past, control, frames, T_p)."""
    compare(mine, rolled, _rollouts, "the poses of the rollout", MISTAKES["rollout_by_hand"])
    return "After ten frames the network sees only its own poses, so its errors can add up."
