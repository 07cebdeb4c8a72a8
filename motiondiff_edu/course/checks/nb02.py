"""Checks of notebook 02: noise."""

import numpy as np
import torch

from ._compare import compare
from ._drawn import schedule, tensors
from ._report import check
from .zoo.nb02 import MISTAKES


def _batches(rng: np.random.Generator):
    """A batch whose square roots are round numbers, then others; each sample has its own step."""
    x0 = torch.arange(30.0).reshape(2, 5, 3) / 10 - 1
    noise = torch.linspace(2, -1, 30).reshape(2, 5, 3)
    yield x0, torch.tensor([2, 1]), torch.tensor([1.0, 0.64, 0.36]), noise
    for B, T, D in ((3, 4, 2), (4, 2, 5)):
        s = torch.from_numpy(rng.permutation(5)[:B] + 1)
        yield tensors(rng, B, T, D), s, schedule(rng, 5), tensors(rng, B, T, D)


def noised(x0, s, alpha_bar, noise) -> torch.Tensor:
    """Sample by sample: equation 2."""
    shares = [float(alpha_bar[int(step)]) for step in s]
    return torch.stack([a**0.5 * x0[i] + (1 - a) ** 0.5 * noise[i] for i, a in enumerate(shares)])


@check
def q_sample(mine):
    """mine(x0, s, alpha_bar, noise): at alpha_bar = .36 and .64, then anywhere."""
    compare(mine, noised, _batches, "x_s", MISTAKES["q_sample"])
    return (
        "At alpha_bar = 0.36, 60 % of the amplitude is left, and 80 % of the noise's is added: "
        "as variances, 0.36 + 0.64 = 1."
    )


def _steps(rng: np.random.Generator):
    """Numbers first, then arrays."""
    table = torch.tensor([1.0, 0.9, 0.7, 0.4], dtype=torch.float64)
    yield 0.8, -0.6, 3, table
    yield tensors(rng, 2, 5, 3), tensors(rng, 2, 5, 3), 2, table
    yield tensors(rng, 4), tensors(rng, 4), 4, schedule(rng, 6)


def closed_form(x0, x_s, s: int, alpha_bar) -> tuple:
    """Equations 6 and 7 of DDPM (Ho and others, 2020)."""
    now, before = alpha_bar[s], alpha_bar[s - 1]
    beta = 1 - now / before
    mean = before**0.5 * beta / (1 - now) * x0 + (1 - beta) ** 0.5 * (1 - before) / (1 - now) * x_s
    return mean, (1 - before) / (1 - now) * beta


@check
def posterior(mine):
    """mine(x0, x_s, s, alpha_bar) -> mean and variance of x_{s-1}."""
    parts = ("the mean of x_{s-1}", "the variance of x_{s-1}")
    compare(mine, closed_form, _steps, parts, MISTAKES["posterior"])
    return (
        "Knowing x0 narrows x_{s-1}: at alpha_bar = .4 after .7, from +- 0.87, which x_s alone "
        "gives, to +- 0.46."
    )


def _schedules(rng: np.random.Generator):
    """Round numbers, then others."""
    yield 10, 0.1
    yield 100, 0.05
    yield int(rng.integers(5, 50)), float(rng.uniform(0.05, 0.5))


def halved(S: int, left: float) -> float:
    """Beta by halving an interval, with the steps taken one after the other."""
    low, high = 0.0, 1.0
    for _ in range(60):
        beta, amplitude = (low + high) / 2, 1.0
        for _ in range(S):
            amplitude *= (1 - beta) ** 0.5
        low, high = (beta, high) if amplitude > left else (low, beta)
    return (low + high) / 2


@check
def constant_beta(mine):
    """mine(S, left) -> beta: S steps of it must leave that share of the amplitude."""
    compare(mine, halved, _schedules, "beta", MISTAKES["constant_beta"])
    return "Ten times as many steps need about a tenth of the beta, because noise adds up."
