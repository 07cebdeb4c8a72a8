"""The variational bound, term by term, in nats: where the loss of eq. 10 comes from.

    -log p(x0) <= prior_kl + sum of step_kl for s = S..2 + reconstruction_nll
Every term has one value for each sample of the batch.
Source: MoDiff eq. 4-10.  Notebook: 04
"""

import math

import torch
from jaxtyping import Float
from torch import Tensor

from .ddpm import Denoiser, Schedule, Table, X, at, draw, p_mean, q_posterior, q_sample


def dropped_weight(schedule: Schedule) -> Table:
    """The weight of ||eps - eps_hat||^2 that eq. 10 leaves out.

    It is 1 / (2 beta_s) * beta_s^2 / (alpha_s (1 - alpha_bar_s)).

    Source: MoDiff eq. 8-10. Notebook: 04.
    """
    return (schedule.beta / (2 * schedule.alpha * (1 - schedule.alpha_bar))).nan_to_num(0)


def gaussian_kl(mean_1: X, variance_1: Tensor, mean_2: X, variance_2: Tensor) -> Float[Tensor, "B"]:
    """KL(N(mean_1, variance_1 I) || N(mean_2, variance_2 I)).

    It is summed over all entries of a sample.
    Notebook: 02.
    """
    each = (
        (variance_2 / variance_1).log() + (variance_1 + (mean_1 - mean_2).square()) / variance_2 - 1
    )
    return each.flatten(1).sum(1) / 2


def prior_kl(x0: X, schedule: Schedule) -> Float[Tensor, "B"]:
    """KL(q(x_S | x0) || N(0, I)), which has no parameters to learn. Source: MoDiff eq. 5."""
    alpha_bar, one = at(schedule.alpha_bar, schedule.S, x0), torch.ones((), dtype=x0.dtype)
    return gaussian_kl(alpha_bar.sqrt() * x0, 1 - alpha_bar, torch.zeros_like(x0), one)


def step_kl(x0: X, x_s: X, s: int, eps_hat: X, schedule: Schedule) -> Float[Tensor, "B"]:
    """KL(q(x_{s-1} | x_s, x0) || p(x_{s-1} | x_s)), s >= 2.

    It is ||difference of the means||^2 / (2 beta_s) + a constant.

    Source: MoDiff eq. 5, 8.
    """
    mean, variance = q_posterior(x0, x_s, s, schedule)
    return gaussian_kl(
        mean, variance, p_mean(x_s, s, eps_hat, schedule), at(schedule.beta, s, x_s, first=2)
    )


def reconstruction_nll(x0: X, x_1: X, eps_hat: X, schedule: Schedule) -> Float[Tensor, "B"]:
    """-log p(x0 | x_1), with variance beta_1. Source: MoDiff eq. 5."""
    variance = at(schedule.beta, 1, x_1)
    each = (x0 - p_mean(x_1, 1, eps_hat, schedule)).square() / variance + (
        2 * math.pi * variance
    ).log()
    return each.flatten(1).sum(1) / 2


@torch.no_grad()
def bound_terms(
    denoise: Denoiser, x0: X, schedule: Schedule, generator: torch.Generator | None = None
) -> Float[Tensor, "S_plus_1 B"]:
    """Estimate every term of the negative bound with one draw each.

    Their sum over s is at least -log p(x0) on average.

    Row 0 is the prior's term, row 1 -log p(x0 | x_1), rows 2..S the KL of step s. Source: MoDiff
    eq. 4-5. Notebook: 04.
    """
    terms = [prior_kl(x0, schedule)]
    for s in range(1, schedule.S + 1):
        x_s = q_sample(x0, s, schedule, draw(x0, generator))
        eps_hat = denoise(x_s, torch.full((len(x0),), s, device=x0.device))
        terms += [
            reconstruction_nll(x0, x_s, eps_hat, schedule)
            if s == 1
            else step_kl(x0, x_s, s, eps_hat, schedule)
        ]
    return torch.stack(terms)
