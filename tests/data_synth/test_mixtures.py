"""The named mixtures are what their docstrings say."""

import pytest
import torch

from data_synth import mixtures as M
from motiondiff_edu.exact import log_density


@pytest.mark.parametrize("make", [M.gaussian, M.two_hills, M.three_hills])
def test_lines_integrate_to_one(make):
    grid = torch.linspace(-9, 9, 18_001, dtype=torch.float64)[:, None]
    assert log_density(make(), grid).exp().sum().item() * 0.001 == pytest.approx(1, abs=1e-6)


@pytest.mark.parametrize("make", [M.ring, M.crossed_bars])
def test_planes_integrate_to_one(make):
    axis = torch.linspace(-6, 6, 601, dtype=torch.float64)
    grid = torch.cartesian_prod(axis, axis)
    assert log_density(make(), grid).exp().sum().item() * 0.02**2 == pytest.approx(1, abs=1e-5)


@pytest.mark.parametrize("make", [M.gaussian, M.two_hills, M.three_hills, M.ring, M.crossed_bars])
def test_samples_have_the_stated_moments_and_weights(make):
    truth, n = make(), 30_000
    x = M.sample_mixture(truth, n, torch.Generator().manual_seed(7))
    torch.testing.assert_close(x.mean(0), truth.mean(), atol=0.04, rtol=0)
    torch.testing.assert_close(
        x.T.cov().reshape(truth.covariance().shape), truth.covariance(), atol=0.06, rtol=0
    )
    share = torch.bincount(M.nearest_part(truth, x), minlength=len(truth.weights)) / n
    torch.testing.assert_close(share.double(), truth.weights, atol=0.02, rtol=0)


def test_two_hills_moments_by_hand():
    truth = M.two_hills(left=0.3, std=0.3)
    assert truth.mean().item() == pytest.approx(0.4)
    assert truth.covariance().item() == pytest.approx(0.09 + 1 - 0.16)


def test_same_seed_same_points():
    draw = [M.sample_mixture(M.ring(), 11, torch.Generator().manual_seed(8)) for _ in range(2)]
    assert torch.equal(*draw)
