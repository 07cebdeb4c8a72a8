"""Masked sampling.

What is given comes back, what is not follows the true conditional once it is resampled.
"""

import pytest
import torch
from seeds import seeded
from two_numbers import correlated, given_first

from data_synth.mixtures import crossed_bars
from motiondiff_edu.beyond.guidance import with_guess
from motiondiff_edu.ddpm import cosine_schedule, ddim_steps, timesteps
from motiondiff_edu.exact import conditional, exact_denoiser, log_density, sample_mixture
from motiondiff_edu.inbetweening import inpaint_steps, resampling_steps

SCHEDULE = cosine_schedule(100)


def last(loop):
    *_, end = loop
    return end.x_s


def test_the_conditional_is_the_joint_density_over_the_marginal_one():
    truth = crossed_bars()
    value = torch.tensor([-0.9, 9.0])
    known = torch.tensor([True, False])
    grid = torch.linspace(-4, 4, 8001, dtype=torch.float64)[:, None]
    joint = log_density(truth, torch.cat([torch.full_like(grid, -0.9), grid], 1)).exp()
    wanted = joint / (joint.sum() * (grid[1] - grid[0]))
    ours = log_density(conditional(truth, value, known), grid).exp()
    torch.testing.assert_close(ours, wanted, atol=1e-6, rtol=1e-5)


def test_the_conditional_of_one_gaussian_is_the_textbook_s():
    found = conditional(correlated(0.9), torch.tensor([1.3, 0.0]), torch.tensor([True, False]))
    assert found.mean().item() == pytest.approx(-0.2 + 0.9 * (1.3 - 0.3))
    assert found.covariance().item() == pytest.approx(1 - 0.9**2)
    for known in (torch.tensor([True, True]), torch.tensor([False, False])):
        with pytest.raises(ValueError, match="one entry must be known"):
            conditional(correlated(), torch.zeros(2), known)


def test_masking_with_the_exact_denoiser_misses_the_conditional_until_it_resamples():
    truth, n = correlated(0.9), 4000
    given, known = given_first(1.8, n)
    wanted = conditional(truth, given[0].nan_to_num(), known[0])
    off = {}
    for resample in (1, 10):
        start = torch.randn(n, 2, generator=seeded(1))
        loop = inpaint_steps(
            exact_denoiser(truth, SCHEDULE),
            start,
            SCHEDULE,
            given,
            known,
            steps=resampling_steps(timesteps(100, 50), resample),
            generator=seeded(2),
        )
        x = last(loop)
        assert torch.equal(x[:, 0], given[:, 0])
        off[resample] = abs(x[:, 1].mean().item() - wanted.mean().item())
        if resample == 10:
            assert x[:, 1].var().item() == pytest.approx(wanted.covariance().item(), rel=0.25)
    assert off[1] > 0.1 and off[10] < 0.4 * off[1], off


def test_nothing_known_is_plain_sampling_and_all_known_is_the_input():
    truth = crossed_bars()
    start = torch.randn(50, 2, generator=seeded(3))
    denoise = exact_denoiser(truth, SCHEDULE)
    nothing = torch.zeros(50, 2, dtype=torch.bool)
    for eta in (0.0, 1.0):
        thrice = {
            "steps": resampling_steps(timesteps(100, 50), 3),
            "eta": eta,
            "generator": seeded(4),
        }
        ours = last(inpaint_steps(denoise, start, SCHEDULE, start, nothing, **thrice))
        plain = last(ddim_steps(denoise, start, SCHEDULE, 50, eta, generator=seeded(4)))
        torch.testing.assert_close(ours, plain, atol=1e-5, rtol=1e-5)
    given = sample_mixture(truth, 50, seeded(5)).float()
    assert torch.equal(
        last(inpaint_steps(denoise, start, SCHEDULE, given, ~nothing, generator=seeded(6))), given
    )


def test_the_known_part_is_a_snapshot_noised_for_the_step():
    given, known = given_first(2.0, 3000)
    denoise = exact_denoiser(correlated(), SCHEDULE)
    start = torch.randn(3000, 2, generator=seeded(7))
    for step in inpaint_steps(
        denoise, start, SCHEDULE, given, known, steps=10, generator=seeded(8)
    ):
        alpha_bar = SCHEDULE.alpha_bar[step.s].item()
        assert step.x_s[:, 0].mean().item() == pytest.approx(2 * alpha_bar**0.5, abs=0.08)
        assert step.x_s[:, 0].std().item() == pytest.approx((1 - alpha_bar) ** 0.5, abs=0.05)


def test_resampling_goes_there_back_and_there():
    assert resampling_steps([30, 20, 10], 2) == [30, 20, 30, 20, 10, 20, 10]
    assert resampling_steps([9, 4], 3) == [9, 4, 9, 4, 9, 4]
    assert resampling_steps([9, 4], 1) == [9, 4]
    with pytest.raises(ValueError, match="R must be at least 1"):
        resampling_steps([9, 4], 0)


def test_a_way_back_adds_the_noise_of_the_forward_process():
    """Whose guess is always 3: at step 60, after a way back, x_s has the mean and spread of 60."""
    n, nothing = 6000, torch.zeros(6000, 2)
    known = torch.tensor([True, False]).expand(n, 2)
    denoise = with_guess(lambda x, s: x, SCHEDULE, lambda x0: torch.full_like(x0, 3.0))
    visited = resampling_steps([60, 10], 2)
    loop = inpaint_steps(
        denoise, nothing, SCHEDULE, nothing, known, steps=visited, generator=seeded(8)
    )
    steps = list(loop)
    assert [step.s for step in steps] == [60, 60, 10, 0]
    free, alpha_bar = steps[1].x_s[:, 1], SCHEDULE.alpha_bar[60].item()
    assert free.mean().item() == pytest.approx(3 * alpha_bar**0.5, abs=0.05)
    assert free.std().item() == pytest.approx((1 - alpha_bar) ** 0.5, abs=0.03)


@pytest.mark.parametrize("steps", [[], [101], [20, 0], 0, 101])
def test_steps_that_are_not_there(steps):
    start = torch.zeros(1, 2)
    with pytest.raises(ValueError, match="between 1 and 100"):
        next(inpaint_steps(lambda x, s: x, start, SCHEDULE, start, start > 0, steps=steps))


def test_a_step_that_follows_itself_is_refused():
    start = torch.zeros(1, 2)
    with pytest.raises(ValueError, match=r"fall or rise, not stay; these are \[20, 20\]"):
        next(inpaint_steps(lambda x, s: x, start, SCHEDULE, start, start > 0, steps=[20, 20]))
