"""The two samplers: equal to published runs, and honest about what few steps lose."""

import pytest
import torch

from data_synth.mixtures import crossed_bars, gaussian, three_hills
from motiondiff_edu.ddpm import ddim_steps, linear_schedule, sample_steps, timesteps
from motiondiff_edu.exact import dataset_denoiser, exact_denoiser
from motiondiff_edu.prediction import to_eps

START = (torch.arange(768).reshape(3, 8, 8, 4) / 768).permute(3, 0, 1, 2)


def dummy(x, s):
    return x * ((s - 1) / s).float().reshape(-1, 1, 1, 1)


def last_of(steps):
    *_, last = steps
    return last.x_s


class FarGenerator(torch.Generator):
    """Stands for the generator of another device.

    It uses the one device that is everywhere and not the CPU.
    """

    device = torch.device("meta")


@pytest.mark.parametrize("sample", [sample_steps, ddim_steps])
def test_samples_stay_on_the_device_of_the_noise(sample):
    schedule, start = linear_schedule(11, 1e-3, 0.7), torch.empty(3, 2, device="meta")
    for denoise in (
        exact_denoiser(crossed_bars(), schedule),
        dataset_denoiser(torch.randn(4, 2), schedule),
    ):
        steps = list(sample(denoise, start, schedule, generator=FarGenerator()))
        assert {(step.x_s.device.type, tuple(step.x_s.shape)) for step in steps} == {
            ("meta", (3, 2))
        }


def test_the_last_step_draws_nothing():
    schedule, noise = linear_schedule(), torch.zeros(100, 2, 3)
    noise[0] = 1e6
    assert (
        last_of(sample_steps(lambda x, s: 0 * x, torch.ones(2, 3), schedule, noise=noise))
        .abs()
        .max()
        < 100
    )


@pytest.mark.parametrize(
    "target, beta_1, total",
    [("eps", 1e-4, 172.0067), ("v", 1e-4, 52.5302), ("eps", 0.01, 149.8295)],
)
def test_ddim_sum_equals_the_published_run(target, beta_1, total):
    schedule = linear_schedule(1000, beta_1, 0.02)

    def denoise(x, s):
        return to_eps(dummy(x, s), x, s, schedule, target)

    x = last_of(ddim_steps(denoise, START, schedule, list(range(901, 0, -100)), clip=1.0))
    assert x.abs().sum().item() == pytest.approx(total, abs=0.1)


@pytest.mark.parametrize(
    "t, before, published", [(420, 400, 0.14771), (980, 960, 0.32460), (487, 486, 0.00979)]
)
def test_ddim_noise_equals_published_variances(t, before, published):
    """With a silent model and eta = 1, one leap from zero leaves exactly sigma times the noise."""
    schedule = linear_schedule(1000, 1e-4, 0.02)
    noise = torch.ones(1000, 1, 1)
    leap = list(
        ddim_steps(
            lambda x, s: 0 * x, torch.zeros(1, 1), schedule, [t + 1, before + 1], 1.0, noise=noise
        )
    )
    assert leap[1].x_s.item() ** 2 == pytest.approx(published, abs=2e-5)


def test_ddim_with_eta_1_and_all_steps_is_ddpm_with_the_posterior_variance():
    schedule = linear_schedule(30, 1e-3, 0.3)
    noise = torch.randn(30, 4, 1, dtype=torch.float64)
    denoise = exact_denoiser(three_hills(), schedule)
    start = torch.randn(4, 1, dtype=torch.float64)
    ddim = last_of(ddim_steps(denoise, start, schedule, 30, 1.0, noise=noise))
    torch.testing.assert_close(
        ddim, last_of(sample_steps(denoise, start, schedule, noise=noise, variance="posterior"))
    )


def test_ddim_without_eta_is_a_map_of_its_start():
    schedule = linear_schedule()
    denoise = exact_denoiser(three_hills(), schedule)
    start = torch.randn(4, 1)
    assert torch.equal(
        last_of(ddim_steps(denoise, start, schedule)), last_of(ddim_steps(denoise, start, schedule))
    )


@pytest.mark.parametrize("steps, lost", [(10, 0.22), (100, 0.293)])
def test_ddim_under_disperses_as_its_own_algebra_says(steps, lost):
    """A Gaussian of std .30: each leap multiplies x by (a a' var + b b') / (a^2 var + b^2).

    Ten of them leave .22.
    """
    schedule, std = linear_schedule(), 0.3
    predicted, visited = 1.0, timesteps(100, steps) + [0]
    for now, then in zip(visited[:-1], visited[1:], strict=True):
        (a, b), (a2, b2) = (
            ((ab := schedule.alpha_bar[s].item()) ** 0.5, (1 - ab) ** 0.5) for s in (now, then)
        )
        predicted *= (a * a2 * std**2 + b * b2) / (a * a * std**2 + b * b)
    start = torch.randn(40_000, 1, generator=torch.Generator().manual_seed(11))
    denoise = exact_denoiser(gaussian(0.0, std), schedule)
    ddim = last_of(ddim_steps(denoise, start, schedule, steps))
    ddpm = last_of(
        sample_steps(denoise, start, schedule, generator=torch.Generator().manual_seed(12))
    )
    assert predicted == pytest.approx(lost, abs=0.005)
    assert ddim.std().item() == pytest.approx(predicted, abs=0.005)
    assert ddpm.std().item() == pytest.approx(std, abs=0.015)


def test_timesteps_start_at_the_top_and_do_not_repeat():
    assert timesteps(100, 4) == [100, 75, 50, 25]
    assert timesteps(100, 100) == list(range(100, 0, -1))
    assert timesteps(100, 7) == [100, 86, 72, 58, 43, 29, 15]  # sevenths, rounded up
    for steps in (1, 3, 7, 60):
        chosen = timesteps(100, steps)
        assert (
            chosen[0] == 100
            and len(set(chosen)) == steps
            and chosen[-1] >= 1
            and chosen == sorted(chosen)[::-1]
        )
    with pytest.raises(ValueError, match="between 1 and 100"):
        timesteps(100, 101)
