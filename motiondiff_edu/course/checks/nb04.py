"""Checks of notebook 04: where the loss comes from."""

import numpy as np
import torch
from torch.distributions import Normal, kl_divergence

from ._compare import compare
from ._drawn import betas_of, schedule, tensors
from ._report import check
from .zoo.nb04 import MISTAKES


def _clean(rng: np.random.Generator):
    """A ramp at alpha_bar = .36, then others."""
    x0 = torch.linspace(-2, 1.5, 30, dtype=torch.float64).reshape(2, 5, 3)
    yield x0, torch.tensor(0.36).double()
    yield tensors(rng, 4, 2, 6), torch.tensor(rng.uniform(0.01, 0.8))


def divergence(x0, alpha_bar) -> torch.Tensor:
    """torch's own KL divergence, entry by entry."""
    last = Normal(alpha_bar.sqrt() * x0, (1 - alpha_bar).sqrt().expand(x0.shape))
    return kl_divergence(last, Normal(0.0, 1.0)).flatten(1).sum(1)


@check
def prior_term(mine):
    """mine(x0, alpha_bar) against torch's own KL divergence."""
    compare(mine, divergence, _clean, "the prior's term", MISTAKES["prior_term"])
    return "This term has no eps_hat in it: training cannot change it, only the schedule can."


def _tables(rng: np.random.Generator):
    """Betas of a tenth to a half, then others."""
    beta = torch.tensor([0.0, 0.1, 0.2, 0.4, 0.5], dtype=torch.float64)
    yield beta, torch.tensor([1.0, 0.9, 0.72, 0.432, 0.216], dtype=torch.float64)
    table = schedule(rng, 7)
    yield betas_of(table), table


def moved_means(beta, alpha_bar) -> torch.Tensor:
    """A unit error of x0 moves the posterior's mean (DDPM, equation 7); squared, over 2 beta."""
    moved = alpha_bar[:-1].sqrt() * beta[1:] / (1 - alpha_bar[1:])
    return moved.square() / (2 * beta[1:])


@check
def x0_weight(mine):
    """mine(beta, alpha_bar) -> u_1 ... u_S."""
    compare(mine, moved_means, _tables, "u_1 ... u_S", MISTAKES["x0_weight"])
    u = moved_means(*next(_tables(np.random.default_rng(0))))
    return (
        f"With betas of .1, .2, .4 and .5, u_1 is {float(u[0] / u[-1]):.0f} times u_4: "
        "for errors of x0, the bound weights the last step most."
    )


def _ratios(rng: np.random.Generator):
    """Paths of known probability; others; numbers whose exp is zero in the computer."""
    ratio = torch.tensor([[0.1, 0.6], [0.6, 0.6], [0.2, 0.3]], dtype=torch.float64)
    yield (ratio.log(),)
    yield (2 * tensors(rng, 5, 3) - 4,)
    yield (ratio.log() - torch.tensor([2000.0, 10.0], dtype=torch.float64),)


def by_numpy(log_ratio) -> np.ndarray:
    """numpy's logarithm of a sum of exponentials, path by path."""
    return np.logaddexp.reduce(log_ratio.numpy(), axis=0) - np.log(len(log_ratio))


@check
def tighter_bound(mine):
    """mine(log_ratio (K, B)) -> (B,)."""
    compare(mine, by_numpy, _ratios, "log of the mean ratio", MISTAKES["tighter_bound"], rtol=1e-7)
    return "With K = 1 it is the bound; as K grows, it approaches log p(x0)."
