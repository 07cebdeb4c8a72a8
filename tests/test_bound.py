"""The variational bound, term by term, where the log-density is known exactly."""

import math

import pytest
import torch

from data_synth.mixtures import gaussian, three_hills, two_hills
from motiondiff_edu.bound import (
    bound_terms,
    dropped_weight,
    gaussian_kl,
    prior_kl,
    reconstruction_nll,
    step_kl,
)
from motiondiff_edu.ddpm import cosine_schedule, linear_schedule, p_mean, q_posterior, q_sample
from motiondiff_edu.exact import exact_denoiser, log_density, mixture, sample_mixture

N = 20_000


def gap(truth, schedule, denoise=None, seed=13):
    """Exact mean log-density minus the bound, in nats, with its standard error."""
    generator = torch.Generator().manual_seed(seed)
    x0 = sample_mixture(truth, N, generator)
    terms = bound_terms(denoise or exact_denoiser(truth, schedule), x0, schedule, generator)
    difference = log_density(truth, x0) + terms.sum(0)
    return difference.mean().item(), difference.std().item() / N**0.5


def test_gaussian_kl_is_torchs():
    m1 = torch.randn(2, 5, 7)
    m2 = torch.randn(2, 5, 7)
    v1 = torch.tensor(0.3)
    v2 = torch.tensor(0.8)
    normal = torch.distributions.Normal
    expected = torch.distributions.kl_divergence(normal(m1, v1.sqrt()), normal(m2, v2.sqrt())).sum(
        (1, 2)
    )
    torch.testing.assert_close(gaussian_kl(m1, v1, m2, v2), expected)


def test_reconstruction_term_is_torchs():
    schedule = linear_schedule()
    x0 = torch.randn(2, 5, 7)
    x_1 = torch.randn(2, 5, 7)
    eps = torch.randn(2, 5, 7)
    normal = torch.distributions.Normal(
        p_mean(x_1, 1, eps, schedule), schedule.beta[1].sqrt().float()
    )
    torch.testing.assert_close(
        reconstruction_nll(x0, x_1, eps, schedule), -normal.log_prob(x0).sum((1, 2))
    )


def test_prior_term_is_small_where_the_schedule_reaches_noise():
    x0 = torch.tensor([[1.0, -2.0]])
    assert prior_kl(x0, cosine_schedule(100)).item() < 1e-5
    schedule = linear_schedule()
    ab = schedule.alpha_bar[100].item()
    by_hand = (5 * ab + 2 * (1 - ab) - 2 - 2 * math.log(1 - ab)) / 2
    assert prior_kl(x0, schedule).item() == pytest.approx(by_hand, rel=1e-4)


@pytest.mark.parametrize("s", [2, 30, 100])
def test_eq_8_is_the_weighted_distance_of_means_plus_a_constant(s):
    """KL - ||mean_q - mean_p||^2 / (2 beta) is the same for every denoiser.

    Eq. 9 turns means into noises.
    """
    schedule = linear_schedule()
    generator = torch.Generator().manual_seed(14)
    x0 = torch.randn(2, 5, 7, generator=generator).double()
    eps = torch.randn(2, 5, 7, generator=generator).double()
    x_s, constants = q_sample(x0, s, schedule, eps), []
    for eps_hat in (0 * eps, eps + 0.3, torch.tanh(x_s)):
        means = q_posterior(x0, x_s, s, schedule)[0] - p_mean(x_s, s, eps_hat, schedule)
        weighted = dropped_weight(schedule)[s] * (eps - eps_hat).square().sum((1, 2))
        torch.testing.assert_close(weighted, means.square().sum((1, 2)) / (2 * schedule.beta[s]))
        constants.append(step_kl(x0, x_s, s, eps_hat, schedule) - weighted)
    torch.testing.assert_close(constants[0], constants[1])
    torch.testing.assert_close(constants[0], constants[2])
    assert (
        constants[0] > 0
    ).all()  # beta is not the posterior's variance: that costs a little, whatever is learnt


def test_dropped_weight_by_hand():
    schedule = linear_schedule()
    beta = schedule.beta[30].item()
    alpha_bar = schedule.alpha_bar[30].item()
    assert dropped_weight(schedule)[30].item() == pytest.approx(
        beta / (2 * (1 - beta) * (1 - alpha_bar))
    )
    assert dropped_weight(schedule)[0] == 0
    assert (
        dropped_weight(schedule)[1] > 10 * dropped_weight(schedule)[50]
    )  # eq. 10 levels what the bound does not


@pytest.mark.parametrize("truth", [two_hills(), three_hills()], ids=["two hills", "three hills"])
@pytest.mark.parametrize(
    "schedule", [linear_schedule(), cosine_schedule(50)], ids=["linear", "cosine"]
)
def test_bound_lies_below_the_exact_log_density(truth, schedule):
    value, error = gap(truth, schedule)
    assert value > -3 * error
    assert value < 0.25


def test_bound_is_tight_for_a_standard_gaussian():
    """q(x_{s-1} | x_s) is then a Gaussian of variance beta_s, exactly what p assumes.

    Only the prior's term is lost.
    """
    schedule = cosine_schedule(50)
    value, error = gap(gaussian(), schedule)
    assert abs(value) < 4 * error and error < 0.02


def test_gap_shrinks_with_more_steps():
    truth = two_hills(std=0.2)
    few = gap(truth, cosine_schedule(10))
    many = gap(truth, cosine_schedule(200))
    assert few[0] > many[0] + 5 * (few[1] + many[1])


def test_a_worse_denoiser_has_a_wider_gap():
    truth, schedule = two_hills(), linear_schedule()
    exact = exact_denoiser(truth, schedule)
    good, _ = gap(truth, schedule, exact)
    worse, error = gap(truth, schedule, lambda x, s: 0.8 * exact(x, s))
    assert worse > good + 0.05 + 5 * error


def test_terms_are_one_a_step_and_kls_are_positive():
    schedule = linear_schedule(17, 1e-3, 0.5)
    truth = mixture(torch.ones(1), torch.zeros(1, 3), torch.eye(3)[None])
    terms = bound_terms(
        exact_denoiser(truth, schedule),
        torch.randn(5, 3),
        schedule,
        torch.Generator().manual_seed(15),
    )
    assert terms.shape == (18, 5)
    assert (terms[0] >= 0).all() and (terms[2:] >= 0).all()


def test_bound_lies_below_the_models_own_density():
    """For three steps the model's own p(x0) can be summed on a grid.

    The bound is below its log at every x0.
    """
    truth, schedule = two_hills(std=0.4), linear_schedule(3, 0.5, 0.97)
    denoise = exact_denoiser(truth, schedule)
    grid = torch.linspace(-6, 6, 3001, dtype=torch.float64)[:, None]
    density = torch.exp(-(grid[:, 0] ** 2) / 2) / (2 * torch.pi) ** 0.5
    for s in (3, 2, 1):
        mean = p_mean(grid, s, denoise(grid, torch.full((3001,), s)), schedule)[:, 0]
        kernel = (
            torch.exp(-((grid - mean) ** 2) / (2 * schedule.beta[s]))
            / (2 * torch.pi * schedule.beta[s]) ** 0.5
        )
        density = kernel @ density * 0.004
    for at in (-1.0, 0.2, 1.1):
        x0 = torch.full((N, 1), at, dtype=torch.float64)
        terms = bound_terms(denoise, x0, schedule, torch.Generator().manual_seed(16)).sum(0)
        own = density[(grid[:, 0] - at).abs().argmin()].log().item()
        assert -terms.mean().item() < own + 3 * terms.std().item() / N**0.5
    assert density.sum().item() * 0.004 == pytest.approx(1, abs=1e-3)
