"""Past noise: one steady error and fresh ones, of all sizes over two decades."""

import pytest
import torch

from motiondiff_edu.beyond.past_noise import past_noise


def assert_even_on_a_log_scale(sizes: torch.Tensor, largest: float):
    """Over two decades, up to `largest`."""
    for quantile, level in ((0.1, 10**-1.8), (0.5, 0.1), (0.9, 10**-0.2)):
        assert sizes.quantile(quantile) == pytest.approx(level * largest, rel=0.25)


def test_past_noise_has_one_steady_error_of_any_size():
    """Where nothing changes from frame to frame, only the steady part is left: the same noise in
    all frames."""
    past = torch.zeros(4000, 6, 50)
    noise = past_noise(past, 0.3, torch.zeros(50), torch.Generator().manual_seed(0))
    assert torch.equal(noise, noise[:, :1].expand_as(noise))
    assert_even_on_a_log_scale(
        noise[:, 0].std(1), 0.3
    )  # one level for a window, in standard deviations
    assert abs(torch.corrcoef(noise[:, 0].T)[0, 1]) < 0.1  # and each column its own error


def test_past_noise_has_fresh_errors_as_large_as_columns_change():
    past, change = torch.zeros(4000, 6, 3), torch.tensor([0.5, 1.0, 2.0])
    noise = past_noise(past, 0.3, change, torch.Generator().manual_seed(0))
    fresh = noise - noise.mean(1, keepdim=True)
    assert fresh.std((0, 1)) == pytest.approx(change * fresh.std((0, 1))[1], rel=0.05)
    assert_even_on_a_log_scale(
        fresh[..., 1].std(1), 1.0
    )  # an amount of 0.3 is once the change of a frame
    assert (past_noise(past, 0.03, change, torch.Generator().manual_seed(0)) * 10).allclose(
        noise, atol=1e-6
    )


def test_each_past_has_two_levels_of_its_own():
    """How large the steady error is says nothing about the fresh ones."""
    past, change = torch.zeros(4000, 6, 50), torch.ones(50)
    noise = past_noise(past, 0.3, change, torch.Generator().manual_seed(0))
    steady = past_noise(past, 0.3, torch.zeros(50), torch.Generator().manual_seed(0))
    levels = torch.stack([steady[:, 0].std(1), (noise - steady).std((1, 2))]).log10()
    assert abs(torch.corrcoef(levels)[0, 1]) < 0.1 and (levels.std(1) > 0.4).all()
