"""Checks of notebook 09.

The batch of Algorithm 1 with its dropped past, what a linear fit sees of it, and the rate.
"""

import copy

import numpy as np
import torch

from ._compare import compare
from ._drawn import schedule, tensors
from ._report import check, expect
from .zoo.nb09 import MISTAKES

ALPHA_BAR = torch.tensor(
    [1.0, 0.64, 0.36, 0.0784], dtype=torch.float64
)  # a, b: (1, 0), (.8, .6), (.6, .8), (.28, .96)


def _batches(rng: np.random.Generator):
    """Four samples of which two are noised; others."""
    past, future = tensors(rng, 2, 4, 3, 2)
    s = torch.tensor([2, 1, 3, 2])
    u = torch.tensor([0.1, 0.7, 0.25, 0.9])
    yield past, future, s, ALPHA_BAR, 0.3, u, tensors(rng, 2, 4, 3, 2)
    for rate in (0.6, 0.15):
        u = torch.tensor([0.8, *rng.permutation([0.05, 0.5, 0.95, 0.1])])
        s = torch.from_numpy(rng.permutation(6)[:5] + 1)
        past, future, first, second = tensors(rng, 4, 5, 2, 3)
        yield past, future, s, schedule(rng, 6), rate, u, torch.stack([first, second])


def sample_by_sample(past, future, s, alpha_bar, rate: float, u, noise) -> tuple:
    """Algorithm 1 with equation 12, one sample after the other."""
    seen, x_s = past.clone(), torch.empty_like(future)
    for i, step in enumerate(s.tolist()):
        share = float(alpha_bar[step])
        x_s[i] = share**0.5 * future[i] + (1 - share) ** 0.5 * noise[0, i]
        if float(u[i]) < rate:
            seen[i] = share**0.5 * past[i] + (1 - share) ** 0.5 * noise[1, i]
    return seen, x_s


@check
def batch_with_dropout(mine):
    """mine(past, future, s, alpha_bar, rate, u, noise) -> past as it is seen, noised future."""
    _whole_pasts(mine)
    parts = ("the past as the network sees it", "the noised future")
    compare(mine, sample_by_sample, _batches, parts, MISTAKES["batch_with_dropout"])
    return (
        "Each sample decides for itself, its whole past is noised, and the noise is its own: "
        "a mistake in any of these three raises no error."
    )


def _whole_pasts(mine) -> None:
    """Whether some frames of a past are noised and others not."""
    given = next(_batches(np.random.default_rng(0)))
    got = mine(*copy.deepcopy(given))
    seen = got[0] if isinstance(got, tuple | list) and len(got) == 2 else None
    if isinstance(seen, torch.Tensor) and seen.shape == given[0].shape:
        touched = (seen != given[0]).all(-1)
        expect(
            (touched.any(1) == touched.all(1)).all(),
            "some frames of a past were noised and others not; "
            "one u decides for the whole past of a sample",
        )


def _fits(rng: np.random.Generator):
    """A past of 2 entries and a control of 1 at a rate of 1/2; others."""
    xx = torch.tensor([[2.0, 0.5, 1.0], [0.5, 3.0, -1.0], [1.0, -1.0, 4.0]], dtype=torch.float64)
    yield xx, 2, 0.5, ALPHA_BAR[1:3]  # roots 0.8 and 0.6
    for past, n, rate in ((3, 5, 0.25), (2, 6, 0.1)):
        x = tensors(rng, n, 8)
        yield x @ x.T, past, rate, schedule(rng, 4)[1:]


def expected(xx, past: int, rate: float, alpha_bar) -> torch.Tensor:
    """Entry by entry: the mean over clean and noised, and over the steps."""
    out = torch.empty_like(xx)
    for i in range(len(xx)):
        for j in range(len(xx)):
            noised = []
            for share in alpha_bar.tolist():
                factor = (share**0.5 if i < past else 1.0) * (share**0.5 if j < past else 1.0)
                noise = 1 - share if i == j and i < past else 0.0
                noised.append(factor * xx[i, j] + noise)
            out[i, j] = (1 - rate) * xx[i, j] + rate * sum(noised) / len(noised)
    return out


@check
def dropped_products(mine):
    """mine(xx, past, rate, alpha_bar)."""
    compare(
        mine, expected, _fits, "the products of half-dropped pasts", MISTAKES["dropped_products"]
    )
    return "For least squares, the noise is no more than a diagonal: a ridge."


def _times(rng: np.random.Generator):
    """Before and after each change; at the start, at the end; without a start; others."""
    for done in (0.0, 0.39, 0.4, 0.41, 0.59, 0.61, 0.79, 0.81, 0.999, 1.0):
        yield done, (0.1, 0.2, 0.4), 0.4
    for done in (0.0, 0.3, 0.7):
        yield done, (0.1, 0.3), 0.0
    for done in rng.uniform(0.3, 1.0, size=8):
        yield float(done), (0.05, 0.1, 0.15, 0.2, 0.25), 0.5


def counted(done: float, rates, start: float) -> float:
    """The last rate whose part of the time has begun."""
    part, rate = (1 - start) / len(rates), 0.0
    for k, one in enumerate(rates):
        if done >= start + k * part - 1e-12:
            rate = one
    return rate


@check
def rate_schedule(mine):
    """mine(done, rates, start): 0 until `start`, then the rates one after the other."""
    compare(mine, counted, _times, "the rate", MISTAKES["rate_schedule"])
    return (
        "With the paper's rates, .05 to .25, and start = .5, "
        "half of the training has no noised pasts."
    )
