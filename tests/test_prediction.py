"""Every prediction target says the same thing, and tells it exactly."""

import pytest
import torch

from motiondiff_edu import prediction as P
from motiondiff_edu.ddpm import linear_schedule, q_sample


@pytest.fixture(params=["one step for all", "a step for each"])
def case(request):
    schedule = linear_schedule()
    generator = torch.Generator().manual_seed(3)
    x0, eps = (torch.randn(2, 5, 7, generator=generator, dtype=torch.float64) for _ in range(2))
    s = 41 if request.param.startswith("one") else torch.tensor([1, 100])
    return x0, eps, s, schedule, q_sample(x0, s, schedule, eps)


@pytest.mark.parametrize("target", P.TARGETS)
def test_every_target_gives_back_x0_and_eps(case, target):
    x0, eps, s, schedule, x_s = case
    output = P.target_of(x0, eps, s, schedule, target)
    torch.testing.assert_close(P.to_x0(output, x_s, s, schedule, target), x0)
    torch.testing.assert_close(P.to_eps(output, x_s, s, schedule, target), eps)


def test_targets_differ(case):
    x0, eps, s, schedule, _ = case
    made = [P.target_of(x0, eps, s, schedule, target) for target in P.TARGETS]
    assert (made[0] - made[1]).abs().max() > 0.1 and (made[2] + made[1]).abs().max() > 1e-3


def test_v_keeps_the_length_of_the_pair(case):
    x0, eps, s, schedule, x_s = case
    v = P.v_from_x0_eps(x0, s, eps, schedule)
    torch.testing.assert_close(x_s**2 + v**2, x0**2 + eps**2)


def test_mofusion_eq_5_with_its_index():
    """x0 = x_s / sqrt(alpha_bar_s) - sqrt(1 / alpha_bar_s - 1) eps, written as the paper has it."""
    schedule, s = linear_schedule(), 70
    x_s = torch.randn(2, 5, 7).double()
    eps = torch.randn(2, 5, 7).double()
    alpha_bar = schedule.alpha_bar[s]
    as_written = x_s / alpha_bar**0.5 - (1 / alpha_bar - 1) ** 0.5 * eps
    torch.testing.assert_close(P.x0_from_eps(x_s, s, eps, schedule), as_written)


def test_denoiser_of_turns_any_network_into_eps(case):
    x0, eps, s, schedule, x_s = case
    s = s if isinstance(s, torch.Tensor) else torch.full((2,), s)
    for target in P.TARGETS:

        def network(x, s, target=target):
            return P.target_of(x0, eps, s, schedule, target)

        torch.testing.assert_close(P.denoiser_of(network, schedule, target)(x_s, s), eps)


def test_unknown_target_is_named(case):
    x0, eps, s, schedule, x_s = case
    for call in (
        lambda: P.to_eps(eps, x_s, s, schedule, "noise"),
        lambda: P.to_x0(eps, x_s, s, schedule, "epsilon"),
        lambda: P.target_of(x0, eps, s, schedule, "x_0"),
        lambda: P.denoiser_of(None, schedule, "score"),
    ):
        with pytest.raises(ValueError, match="eps, x0, v"):
            call()
