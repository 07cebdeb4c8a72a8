"""Checks of notebook 15.

The snapshot, the loop of masked sampling, and the way back to more noise.
"""

import math

import numpy as np
import torch

from ._compare import compare
from ._drawn import tensors
from ._report import check
from .zoo.nb15 import MISTAKES


def _masks(rng: np.random.Generator):
    """A few entries known; others; NaN where nothing is given."""
    known = torch.zeros(2, 5, 3, dtype=torch.bool)
    known[0, :2], known[1, 3, 1:] = True, True
    for alpha_bar in (0.36, 0.9):
        x_s, given, noise = tensors(rng, 3, 2, 5, 3)
        yield x_s, given, known, alpha_bar, noise
    x_s, given, noise = tensors(rng, 3, 3, 4, 2)
    known = torch.from_numpy(rng.random((3, 4, 2)) < 0.4)
    given[~known] = math.nan
    yield x_s, given, known, float(rng.uniform(0.1, 0.8)), noise


def entry_by_entry(x_s, given, known, alpha_bar: float, noise) -> torch.Tensor:
    """One known entry after the other."""
    seen = x_s.clone()
    a = math.sqrt(alpha_bar)
    b = math.sqrt(1 - alpha_bar)
    for place in map(tuple, known.nonzero().tolist()):
        seen[place] = a * given[place] + b * noise[place]
    return seen


@check
def snapshot(mine):
    """mine(x_s, given, known, alpha_bar, noise)."""
    compare(mine, entry_by_entry, _masks, "x_s with the given entries", MISTAKES["snapshot"])
    return "The network sees the given entries with as much noise as all others."


class _Toy:
    """A leap and a snapshot: each entry depends on all entries, on the step and on the next.

    A snapshot also depends on how many were drawn before.
    """

    def __init__(self, given: torch.Tensor):
        self.given = given
        self.drawn = 0

    def snapshot(self, s: int) -> torch.Tensor:
        self.drawn += 1
        return self.given.nan_to_num(0.7) / (1 + s) + 0.01 * s + 0.1 * self.drawn

    def leap(self, x: torch.Tensor, s: int, after: int) -> torch.Tensor:
        return 0.7 * x + 0.2 * x.mean() + 0.03 * s + 0.011 * after


def _loops(rng: np.random.Generator):
    """Four steps; others, from any step; NaN where nothing is given."""
    for visited, shape, holes in (([9, 6, 4, 1], (2, 5), False), ([20, 7, 2], (3, 4), True)):
        x, given = tensors(rng, 2, *shape)
        known = torch.from_numpy(rng.random(shape) < 0.4)
        if holes:
            given[~known] = math.nan
        toy = _Toy(given)
        yield toy.leap, toy.snapshot, x, visited, given, known


def step_by_step(leap, snapshot, x, visited: list, given, known) -> torch.Tensor:
    """Known entries by assignment, before each leap and at the end."""
    steps = [*visited, 0]
    for i in range(len(visited)):
        x = x.clone()
        x[known] = snapshot(steps[i])[known]
        x = leap(x, steps[i], steps[i + 1])
    x[known] = given[known]
    return x


@check
def masked(mine):
    """mine(leap, snapshot, x, visited, given, known)."""
    compare(mine, step_by_step, _loops, "the end of masked sampling", MISTAKES["masked"])
    return "One snapshot for each step, each with its own noise."


def _ways(rng: np.random.Generator):
    """Far and near; others."""
    for now, then in ((0.9, 0.4), (0.5, 0.45)):
        yield tensors(rng, 3, 5), now, then, tensors(rng, 3, 5)
    now = float(rng.uniform(0.4, 0.9))
    yield tensors(rng, 2, 4), now, now * float(rng.uniform(0.2, 0.8)), tensors(rng, 2, 4)


def by_logarithms(x, now: float, then: float, noise) -> torch.Tensor:
    """The signal shrinks by exp of half the difference of the logs; the variance stays 1."""
    signal = math.exp((math.log(then) - math.log(now)) / 2)
    return signal * x + math.sqrt(1 - signal**2) * noise


@check
def way_back(mine):
    """mine(x, now, then, noise): the shares of signal and noise in the result."""
    compare(mine, by_logarithms, _ways, "x, back at `then`", MISTAKES["way_back"])
    return "This is one step of notebook 02's forward process, even if it replaces several."
