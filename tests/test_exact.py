"""The exact denoiser, against integrals on a grid and against a data set counted by hand."""

import pytest
import torch

from data_synth.mixtures import crossed_bars, gaussian, three_hills, two_hills
from motiondiff_edu.ddpm import cosine_schedule, linear_schedule, q_sample, sample_steps
from motiondiff_edu.exact import (
    conditional,
    dataset_denoiser,
    exact_denoiser,
    log_density,
    mixture,
    noised_mixture,
    posterior_mean,
    sample_mixture,
)
from motiondiff_edu.prediction import x0_from_eps

SCHEDULE = linear_schedule()
GRID = torch.linspace(-8, 8, 16_001, dtype=torch.float64)[:, None]


def normal(x, mean, variance):
    return torch.exp(-((x - mean) ** 2) / (2 * variance)) / (2 * torch.pi * variance) ** 0.5


@pytest.mark.parametrize("s", [1, 20, 60, 100])
def test_density_of_x_s_is_the_blurred_density_of_x0(s):
    """log q(x_s) against the integral of q(x_s | x0) q(x0), on a grid."""
    truth = three_hills()
    x_s = torch.tensor([[-1.1], [0.0], [0.6], [2.0]], dtype=torch.float64)
    a, rest = SCHEDULE.alpha_bar[s] ** 0.5, 1 - SCHEDULE.alpha_bar[s]
    p0 = log_density(truth, GRID).exp()
    integral = (normal(x_s, a * GRID[:, 0], rest) * p0).sum(1) * (GRID[1, 0] - GRID[0, 0])
    torch.testing.assert_close(
        log_density(noised_mixture(truth, s, SCHEDULE), x_s), integral.log(), atol=1e-5, rtol=1e-5
    )


@pytest.mark.parametrize("s", [2, 20, 60, 100])
def test_posterior_mean_is_the_integral_of_x0(s):
    truth = three_hills()
    x_s = torch.tensor([[-1.1], [0.0], [0.6], [2.0]], dtype=torch.float64)
    a, rest = SCHEDULE.alpha_bar[s] ** 0.5, 1 - SCHEDULE.alpha_bar[s]
    weight = normal(x_s, a * GRID[:, 0], rest) * log_density(truth, GRID).exp()
    expected = (weight * GRID[:, 0]).sum(1) / weight.sum(1)
    ours = posterior_mean(truth, x_s, torch.full((4,), s), SCHEDULE)
    torch.testing.assert_close(ours[:, 0], expected, atol=1e-5, rtol=1e-5)


def test_density_with_covariances_is_torchs():
    truth = crossed_bars()
    x = torch.randn(5, 2, dtype=torch.float64)
    covariances = torch.einsum("kia,ka,kja->kij", truth.axes, truth.variances, truth.axes)
    normal = torch.distributions.MultivariateNormal
    parts = [normal(m, c).log_prob(x) for m, c in zip(truth.means, covariances, strict=True)]
    expected = (torch.stack(parts, 1) + truth.weights.log()).logsumexp(1)
    torch.testing.assert_close(log_density(truth, x), expected)


def test_denoiser_is_the_score_of_the_noised_density():
    """eps_hat = -sqrt(1 - alpha_bar) d log q(x_s) / d x_s, by automatic differentiation."""
    truth, s = crossed_bars(), 45
    x = torch.randn(6, 2, dtype=torch.float64, requires_grad=True)
    log_density(noised_mixture(truth, s, SCHEDULE), x).sum().backward()
    eps_hat = exact_denoiser(truth, SCHEDULE)(x.detach(), torch.full((6,), s))
    torch.testing.assert_close(eps_hat, -((1 - SCHEDULE.alpha_bar[s]) ** 0.5) * x.grad)


def test_denoiser_beats_every_other_guess():
    """Its mean square error is below that of the same guess scaled or shifted."""
    truth = two_hills()
    s = 40
    generator = torch.Generator().manual_seed(4)
    x0 = sample_mixture(truth, 40_000, generator)
    eps = torch.randn(x0.shape, generator=generator, dtype=torch.float64)
    guess = exact_denoiser(truth, SCHEDULE)(
        q_sample(x0, s, SCHEDULE, eps), torch.full((len(x0),), s)
    )
    best = (guess - eps).square().mean()
    assert (
        best < (0.95 * guess - eps).square().mean() and best < (guess + 0.05 - eps).square().mean()
    )
    assert best < 1


def test_denoiser_keeps_shape_and_dtype_and_mixed_steps():
    schedule = linear_schedule()
    truth = mixture(torch.ones(2), torch.randn(2, 15), torch.eye(15).expand(2, 15, 15))
    denoise, x = exact_denoiser(truth, schedule), torch.randn(4, 5, 3)
    both = denoise(x, torch.tensor([1, 9, 60, 100]))
    assert both.shape == x.shape and both.dtype == torch.float32
    torch.testing.assert_close(both[2:3], denoise(x[2:3], torch.tensor([60])))


def test_dataset_denoiser_counts_by_hand():
    """Two samples, +1 and -1: x0_hat = tanh(a x / (1 - a^2))."""
    data, s = torch.tensor([[1.0], [-1.0]]), 50
    x = torch.tensor([[-0.4], [0.1], [1.3]], dtype=torch.float64)
    eps_hat = dataset_denoiser(data, SCHEDULE)(x, torch.full((3,), s))
    a = SCHEDULE.alpha_bar[s] ** 0.5
    torch.testing.assert_close(x0_from_eps(x, s, eps_hat, SCHEDULE), torch.tanh(a * x / (1 - a**2)))


def test_dataset_denoiser_gives_back_its_data():
    generator = torch.Generator().manual_seed(6)
    schedule = cosine_schedule(60)
    data = torch.randn(7, 5, 3, generator=generator)
    x_S = torch.randn(40, 5, 3, generator=generator)
    *_, last = sample_steps(dataset_denoiser(data, schedule), x_S, schedule, generator=generator)
    distance = torch.cdist(last.x_s.flatten(1).double(), data.flatten(1).double()).min(1)
    assert distance.values.max() < 1e-3 and len(distance.indices.unique()) > 3


def test_dataset_denoiser_equals_a_mixture_without_width():
    data = torch.randn(7, 3, dtype=torch.float64)
    points = mixture(torch.ones(7), data, torch.zeros(7, 3, 3))
    x = torch.randn(4, 3, dtype=torch.float64)
    s = torch.tensor([1, 20, 60, 100])
    torch.testing.assert_close(
        dataset_denoiser(data, SCHEDULE)(x, s), exact_denoiser(points, SCHEDULE)(x, s)
    )


def test_a_standard_gaussian_stays_itself():
    for s in (1, 50, 100):
        torch.testing.assert_close(
            noised_mixture(gaussian(), s, SCHEDULE).variances, torch.ones(1, 1, dtype=torch.float64)
        )


def test_what_is_no_mixture_is_refused():
    with pytest.raises(ValueError, match="part 1 of the mixture has weight 0"):
        mixture(torch.tensor([1.0, 0.0]), torch.zeros(2, 3), torch.eye(3).expand(2, 3, 3))
    with pytest.raises(ValueError, match="part 0 of the mixture has a variance of -1"):
        mixture(torch.ones(1), torch.zeros(1, 3), -torch.eye(3)[None])
    with pytest.raises(ValueError, match="has weight nan"):
        mixture(torch.tensor([torch.nan]), torch.zeros(1, 2), torch.eye(2)[None])
    with pytest.raises(ValueError, match="part 0 of the mixture is not symmetric"):
        mixture(torch.ones(1), torch.zeros(1, 2), torch.tensor([[[1.0, 5.0], [0.0, 1.0]]]))


def test_a_part_without_width_has_no_density():
    flat = mixture(torch.ones(2), torch.zeros(2, 2), torch.stack([torch.eye(2), torch.zeros(2, 2)]))
    x, told = torch.zeros(3, 2), "part 1 of the mixture has no width"
    with pytest.raises(ValueError, match=told):
        log_density(flat, x)
    with pytest.raises(ValueError, match=told):
        conditional(flat, torch.zeros(2), torch.tensor([True, False]))
    with pytest.raises(ValueError, match=told):
        posterior_mean(flat, x, torch.tensor([5, 0, 5]), SCHEDULE)
    assert posterior_mean(flat, x, torch.tensor([5, 1, 5]), SCHEDULE).isfinite().all()
