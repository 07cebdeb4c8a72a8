"""Standardisation: column by column, invertible, and safe for a column that never moves."""

import pytest
import torch

from motiondiff_edu.motion.scaler import Scaler


@pytest.fixture
def data():
    generator = torch.Generator().manual_seed(2)
    return 3 + torch.randn(4, 11, 5, generator=generator) * torch.tensor(
        [0.01, 1.0, 2.0, 30.0, 5.0]
    )


def test_columns_get_zero_mean_and_unit_spread(data):
    out = Scaler.fit(data).transform(data)
    assert out.shape == data.shape
    torch.testing.assert_close(out.mean((0, 1)), torch.zeros(5), atol=1e-4, rtol=0)
    torch.testing.assert_close(
        out.flatten(0, 1).std(0, correction=0), torch.ones(5), atol=1e-4, rtol=0
    )


def test_there_and_back(data):
    scaler = Scaler.fit(data)
    torch.testing.assert_close(scaler.inverse(scaler.transform(data)), data, atol=1e-4, rtol=1e-5)
    torch.testing.assert_close(
        scaler.transform(scaler.mean), torch.zeros(5)
    )  # missing = zero = the average


def test_fit_by_hand():
    scaler = Scaler.fit(torch.tensor([[1.0, 10.0], [3.0, 30.0], [5.0, 50.0]]))
    torch.testing.assert_close(scaler.mean, torch.tensor([3.0, 30.0]))
    torch.testing.assert_close(scaler.std, torch.tensor([(8 / 3) ** 0.5, 10 * (8 / 3) ** 0.5]))


@pytest.mark.parametrize("rounding", [0.0, 1e-8])
def test_a_column_that_never_moves_stays_in_its_own_unit(data, rounding):
    """Walks without a step to the side, then the first one at 0.6 m/s: 0.6, and not thousands."""
    seen = data.double()
    seen[..., 2] = rounding * seen[..., 2]
    scaler = Scaler.fit(seen.float())
    torch.testing.assert_close(scaler.std[2], torch.tensor(1.0))
    assert scaler.transform(seen.float())[..., 2].abs().max() < 1e-6
    aside = scaler.mean + torch.tensor([0.0, 0.0, 0.6, 0.0, 0.0])
    torch.testing.assert_close(scaler.transform(aside), torch.tensor([0.0, 0.0, 0.6, 0.0, 0.0]))
    torch.testing.assert_close(scaler.inverse(scaler.transform(aside)), aside)


def test_a_constant_far_from_zero_becomes_zero():
    constant = torch.full((6, 2), 0.97)
    scaler = Scaler.fit(constant)
    torch.testing.assert_close(scaler.transform(constant), torch.zeros(6, 2))
    torch.testing.assert_close(scaler.transform(constant + 0.5), torch.full((6, 2), 0.5))


@pytest.mark.parametrize("bad", [float("nan"), float("inf")])
def test_what_is_not_finite_is_named(data, bad):
    data[1, 3, 2] = bad  # row 1 * 11 + 3
    with pytest.raises(ValueError, match="row 14"):
        Scaler.fit(data)
