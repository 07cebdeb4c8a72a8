"""Checks of notebook 03: taking noise away."""

import numpy as np
import torch
from torch.distributions import Normal

from ._compare import compare
from ._drawn import betas_of, schedule, tensors
from ._report import check
from .zoo.nb03 import MISTAKES


def _noisy_samples(rng: np.random.Generator):
    """A few by hand; others; one far from all candidates, with little noise."""
    x_s = torch.tensor([[0.3, -0.2, 0.5], [-0.8, 0.1, 0.9]], dtype=torch.float64)
    data = torch.tensor(
        [[-1, 0, 0.4], [1, 0.5, -1], [0.2, -0.6, 1], [0, 1, 1.2]], dtype=torch.float64
    )
    yield x_s, torch.tensor([0.36, 0.81], dtype=torch.float64), data
    yield tensors(rng, 3, 5), torch.tensor([0.9, 0.3, 0.6]).double(), tensors(rng, 7, 5)
    yield 40 + tensors(rng, 2, 3), torch.tensor([0.999, 0.99]).double(), data


def by_bayes(x_s, alpha_bar, data) -> torch.Tensor:
    """Candidate by candidate: how likely is x_s, if this one was noised?"""
    guesses = []
    for x, a in zip(x_s, alpha_bar, strict=True):
        log = torch.stack(
            [Normal(a.sqrt() * row, (1 - a).sqrt()).log_prob(x).sum() for row in data]
        )
        share = (log - log.logsumexp(0)).exp()
        guesses.append(sum(w * row for w, row in zip(share, data, strict=True)))
    return torch.stack(guesses)


@check
def best_guess(mine):
    """mine(x_s, alpha_bar, data) against Bayes' rule with torch's Gaussian."""
    compare(mine, by_bayes, _noisy_samples, "E[x0 | x_s]", MISTAKES["best_guess"])
    return "The best guess is no row of the data: it is a mean, and a mean need not be a sample."


def _noisy_steps(rng: np.random.Generator):
    """At s = 2 the square roots of the first table are round; s = 1 is the last step."""
    beta = torch.tensor([0.0, 0.4375, 0.36])
    alpha_bar = torch.tensor([1.0, 0.5625, 0.36])
    x = torch.tensor([[1.0, -2.0, 0.5]])
    eps = torch.tensor([[0.4, 1.0, -1.0]])
    z = torch.tensor([[10.0, -10.0, 5.0]])
    yield x, 2, eps, beta, alpha_bar, z
    yield x, 1, eps, beta, alpha_bar, z
    table = schedule(rng, 5)
    betas = betas_of(table)
    for s in (4, 2, 1):
        shape = (2, 5, 3)
        yield tensors(rng, *shape), s, tensors(rng, *shape), betas, table, tensors(rng, *shape)


def stepped(x_s, s: int, eps_hat, beta, alpha_bar, z) -> torch.Tensor:
    """Through x0_hat and the posterior's mean (DDPM, equation 7), then noise."""
    a, b = alpha_bar[s] ** 0.5, (1 - alpha_bar[s]) ** 0.5
    before = alpha_bar[s - 1]
    x0_hat = (x_s - b * eps_hat) / a
    mean = (before**0.5 * beta[s] * x0_hat + (1 - beta[s]) ** 0.5 * (1 - before) * x_s) / (
        1 - alpha_bar[s]
    )
    return mean if s == 1 else torch.addcmul(mean, beta[s].sqrt(), z)


@check
def step_back(mine):
    """mine(x_s, s, eps_hat, beta, alpha_bar, z)."""
    compare(mine, stepped, _noisy_steps, "x_{s-1}", MISTAKES["step_back"])
    return "At s = 1 the step lands on x0_hat itself."


def _leaps(rng: np.random.Generator):
    """Round roots without and with fresh noise; to the very end; others."""
    x = torch.tensor([[1.0, -2.0, 0.5]])
    eps = torch.tensor([[0.4, 1.0, -1.0]])
    z = torch.tensor([[2.0, -1.0, 3.0]])
    yield x, eps, 0.36, 0.64, 0.0, z
    yield x, eps, 0.36, 0.64, 0.5, z
    yield x, eps, 0.36, 1.0, 0.0, z
    for eta in (0.3, 1.0):
        now = float(rng.uniform(0.1, 0.4))
        then = float(rng.uniform(0.5, 0.8))
        yield tensors(rng, 2, 3), tensors(rng, 2, 3), now, then, eta, tensors(rng, 2, 3)


def leapt(x, eps_hat, now: float, then: float, eta: float, z) -> torch.Tensor:
    """Equation 12 of DDIM (Song and others, 2021), in numpy, with angles for the shares."""
    here, there = np.arccos(now**0.5), np.arccos(min(1.0, then**0.5))
    sigma = eta * np.sin(there) / np.sin(here) * max(0.0, 1 - now / then) ** 0.5
    x0_hat = (x.numpy() - np.sin(here) * eps_hat.numpy()) / np.cos(here)
    kept = max(0.0, np.sin(there) ** 2 - sigma**2) ** 0.5
    return torch.from_numpy(np.cos(there) * x0_hat + kept * eps_hat.numpy() + sigma * z.numpy())


@check
def leap(mine):
    """mine(x_s, eps_hat, alpha_bar_s, alpha_bar_r, eta, z): one DDIM step."""
    compare(mine, leapt, _leaps, "x_r", MISTAKES["leap"])
    return "A leap to the very end gives x0_hat: one-step DDIM shows an average."
