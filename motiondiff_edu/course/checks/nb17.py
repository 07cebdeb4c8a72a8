"""Checks of notebook 17: R-Precision, the start of an edit, and two texts for two parts."""

import math

import numpy as np
import torch

from ._compare import compare
from ._drawn import tensors
from ._report import check
from .zoo.nb17 import MISTAKES


def _tables(rng: np.random.Generator):
    """Ranks 0, 1, 2, 1 and 4; motions that are all the same; others, with ties."""
    distances = np.array(
        [
            [0.2, 0.9, 0.8, 0.7, 0.6],
            [0.1, 0.5, 0.9, 0.8, 0.7],
            [0.6, 0.3, 0.4, 0.2, 0.9],
            [0.9, 0.8, 0.7, 0.6, 0.1],
            [0.1, 0.2, 0.3, 0.4, 0.9],
        ]
    )
    for k in (1, 2, 3):
        yield distances, k
    yield np.ones((4, 4)), 1
    for k in (1, 2, 4):
        yield rng.integers(0, 5, size=(7, 7)) / 4.0, k


def by_shuffling(distances: np.ndarray, k: int) -> float:
    """Text by text: sorted, with equal motions in all orders alike."""
    shares = []
    for i, row in enumerate(distances.tolist()):
        places = [place for place, one in enumerate(sorted(row)) if one == row[i]]
        shares.append(sum(place < k for place in places) / len(places))
    return sum(shares) / len(shares)


@check
def r_precision(mine):
    """mine(distances, k): the share of texts (rows) whose own motion is among the k nearest."""
    compare(mine, by_shuffling, _tables, "R-Precision", MISTAKES["r_precision"])
    return "Among 32 motions, chance gives k/32: print it beside the score."


def _motions(rng: np.random.Generator):
    """A share of 36 %, of 1 %, and any."""
    for alpha_bar in (0.36, 0.01, float(rng.uniform(0.2, 0.9))):
        yield tensors(rng, 2, 3), alpha_bar, tensors(rng, 2, 3)


def noised(x0, alpha_bar: float, noise) -> torch.Tensor:
    """Signal and noise as the sides of a right-angled triangle."""
    angle = math.acos(math.sqrt(alpha_bar))
    return math.cos(angle) * x0 + math.sin(angle) * noise


@check
def edit_start(mine):
    """mine(x0, alpha_bar, noise): where an edit begins."""
    compare(mine, noised, _motions, "x_s", MISTAKES["edit_start"])
    return "It is q_sample: an edit begins where a training example of step s is."


def _guesses(rng: np.random.Generator):
    """Round numbers, then others."""
    lower = torch.tensor([True, False, False, True])
    yield torch.full((2, 3, 4), 1.0), torch.full((2, 3, 4), 5.0), lower
    lower = torch.from_numpy(rng.permutation([True, True, False, False, False]))
    yield tensors(rng, 2, 3, 5), tensors(rng, 2, 3, 5), lower


def column_by_column(eps_lower, eps_upper, lower) -> torch.Tensor:
    """Each column from its own text."""
    columns = [(eps_lower if low else eps_upper)[..., i] for i, low in enumerate(lower.tolist())]
    return torch.stack(columns, -1)


@check
def composed(mine):
    """mine(eps_lower, eps_upper, lower): one eps_hat of two texts, by columns."""
    what = "eps_hat of two texts"
    compare(mine, column_by_column, _guesses, what, MISTAKES["composed"])
    return "Both texts see the whole x_s, so that each part knows of the other."
