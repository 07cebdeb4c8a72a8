"""The diffusion core against numbers that are not ours, and against itself taken step by step."""

import re
import warnings
from pathlib import Path

import numpy as np
import pytest
import torch

from motiondiff_edu.beyond.schedules import leap_schedule, shifted
from motiondiff_edu.ddpm import (
    at,
    cosine_schedule,
    ddim_sigma,
    ddim_step,
    ddim_steps,
    draw,
    final,
    linear_schedule,
    make_schedule,
    p_mean,
    p_sample,
    posterior_variance,
    q_posterior,
    q_sample,
    q_step,
    rescaled_ddpm_schedule,
    sample_steps,
    schedule_card,
    simple_loss,
)
from motiondiff_edu.exact import exact_denoiser, mixture, sample_mixture
from motiondiff_edu.prediction import to_eps
from motiondiff_edu.recipes.mover import MOVER

S_REF = 1000


@pytest.fixture(scope="module")
def reference():
    """The schedule, the start and the dummy model of the published reference run.

    They are those of diffusers' scheduler tests.
    """
    start = (torch.arange(768).reshape(3, 8, 8, 4) / 768).permute(3, 0, 1, 2)
    return (
        linear_schedule(S_REF, 1e-4, 0.02),
        start,
        lambda x, s: x * ((s - 1) / s).float().reshape(-1, 1, 1, 1),
    )


def run(reference, target="eps", **kwargs):
    schedule, start, model = reference
    generator = torch.Generator().manual_seed(0)
    steps = sample_steps(
        lambda x, s: to_eps(model(x, s), x, s, schedule, target),
        start,
        schedule,
        generator=generator,
        variance="posterior",
        clip=1.0,
        **kwargs,
    )
    return {step.s: step.x_s for step in steps}


@pytest.mark.parametrize("target, total", [("eps", 258.9606), ("v", 202.0296)])
def test_ddpm_sum_equals_the_published_run(reference, target, total):
    assert run(reference, target)[0].abs().sum().item() == pytest.approx(total, abs=0.1)


def test_two_steps_from_lightly_noised_data_equal_the_published_run(reference):
    schedule, start, model = reference
    noise = (torch.arange(768).flip(-1).reshape(3, 8, 8, 4) / 768).permute(3, 0, 1, 2)
    x = q_sample(start, 2, schedule, noise)
    generator = torch.Generator().manual_seed(0)
    for s in (2, 1):
        a = schedule.alpha_bar[s].sqrt().float()
        b = (1 - schedule.alpha_bar[s]).sqrt().float()
        x0_hat = ((x - b * model(x, torch.full((4,), s))) / a).clamp(-1, 1)
        mean, variance = q_posterior(x0_hat, x, s, schedule)
        x = mean + variance.sqrt() * draw(x, generator)
    assert x.abs().sum().item() == pytest.approx(387.9466, abs=0.1)


def test_trajectory_equals_the_stored_one_frame_by_frame(reference, real_data):
    stored = np.load(
        real_data / "oracle/diffusers_ddpm_trajectory_eps_linear_fixed_small_seed0.npz"
    )
    ours = run(reference)
    np.testing.assert_allclose(
        reference[0].alpha_bar[1:], stored["alphas_cumprod"], rtol=1e-4, atol=1e-7
    )
    for t in (
        999,
        900,
        500,
        100,
        10,
        1,
        0,
    ):  # the stored x_t is what step t leaves behind, ours is labelled with it
        np.testing.assert_allclose(ours[t].numpy(), stored[f"x{t}"], atol=2e-3, err_msg=f"t = {t}")


def test_cosine_schedule_equals_published_values():
    schedule = cosine_schedule(1000)
    index = torch.tensor([0, 10, 100, 250, 500, 750, 900, 999]) + 1
    published = [0.999959, 0.999279, 0.971576, 0.845888, 0.492285, 0.143179, 0.0236161, 2.42873e-9]
    np.testing.assert_allclose(schedule.alpha_bar[index], published, rtol=2e-5)
    np.testing.assert_allclose(
        schedule.beta[[1, 501, 999, 1000]], [4.128e-5, 0.00315569, 0.7499994, 0.999], rtol=2e-4
    )


def test_shifting_a_schedule_multiplies_its_signal_to_noise_ratio():
    plain = cosine_schedule(1000)
    less = shifted(cosine_schedule(1000), 0.02)
    ratios = [s.alpha_bar[1:] / (1 - s.alpha_bar[1:]) for s in (plain, less)]
    torch.testing.assert_close(ratios[1], 0.02 * ratios[0], rtol=1e-9, atol=0)
    assert less.alpha_bar[0] == 1 and "x 0.02" in less.name and less.signal_left < plain.signal_left
    assert shifted(plain, 1.0) is plain
    torch.testing.assert_close(shifted(less, 50.0).alpha_bar, plain.alpha_bar, rtol=1e-9, atol=0)
    with pytest.raises(ValueError, match="above 0"):
        shifted(plain, 0.0)


def test_posterior_variances_equal_published_values(reference):
    variance = posterior_variance(reference[0])[torch.tensor([0, 487, 999]) + 1]
    np.testing.assert_allclose(variance, [0, 0.00979, 0.02], atol=5e-6)


@pytest.mark.parametrize("make", [linear_schedule, rescaled_ddpm_schedule, cosine_schedule])
@pytest.mark.parametrize("S", [21, 50, 400])
def test_schedule_contract(make, S):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        schedule = make(S)
    assert schedule.S == S and len(schedule.alpha_bar) == S + 1
    assert schedule.beta[0] == 0 and schedule.alpha_bar[0] == 1
    assert ((schedule.beta[1:] > 0) & (schedule.beta[1:] < 1)).all()
    assert (schedule.alpha_bar.diff() < 0).all()


@pytest.mark.parametrize("beta", [[0.1, 0.0], [0.1, 1.0], [0.1, float("nan")], []])
def test_impossible_schedules_are_refused(beta):
    with pytest.raises(ValueError, match="between 0 and 1"):
        make_schedule(torch.tensor(beta))


def test_too_few_steps_are_refused_with_the_remedy():
    with pytest.raises(ValueError, match="more steps"):
        rescaled_ddpm_schedule(10)


@pytest.mark.parametrize(
    "make, percent",
    [
        (linear_schedule, "7.5 %"),
        (lambda: cosine_schedule(100), "0.049 %"),
        (rescaled_ddpm_schedule, "0.45 %"),
    ],
)
def test_schedule_card_tells_the_signal_left(make, percent):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert f" {percent} of the signal" in schedule_card(make())


@pytest.mark.parametrize("beta_S, left", [(0.05, "28 %"), (0.02, "60 %")])
def test_schedule_that_leaves_signal_warns_in_words(beta_S, left):
    with pytest.warns(UserWarning, match=f"{left} of the signal.*pure noise"):
        linear_schedule(100, 1e-4, beta_S)


def test_iterated_single_steps_match_the_closed_form():
    schedule = linear_schedule(30, 1e-3, 0.3)
    generator = torch.Generator().manual_seed(1)
    x0 = torch.tensor([0.7, -1.2]).expand(40_000, 2)
    x = x0
    for s in range(1, 23):
        x = q_step(x, s, schedule, draw(x, generator))
    at_once = q_sample(x0, 22, schedule, torch.zeros_like(x0))
    torch.testing.assert_close(x.mean(0), at_once[0], atol=0.02, rtol=0)
    torch.testing.assert_close(
        x.var(0), (1 - schedule.alpha_bar[22]).float().expand(2), atol=0.02, rtol=0
    )


def test_q_sample_takes_a_step_for_each_sample():
    schedule = linear_schedule()
    x0 = torch.randn(2, 5, 7)
    noise = torch.randn(2, 5, 7)
    both = q_sample(x0, torch.tensor([3, 90]), schedule, noise)
    for i, s in enumerate((3, 90)):
        torch.testing.assert_close(
            both[i : i + 1], q_sample(x0[i : i + 1], s, schedule, noise[i : i + 1])
        )


@pytest.mark.parametrize(
    "wrong",
    [
        lambda x, plan: ddim_step(x, x, -1, plan),
        lambda x, plan: ddim_step(x, x, 101, plan),
        lambda x, plan: ddim_sigma(5, 9, plan, 1.0),
        lambda x, plan: ddim_sigma(0, 0, plan, 1.0),
        lambda x, plan: at(plan.alpha_bar, -1, x),
        lambda x, plan: at(plan.alpha_bar, torch.tensor([3, 101]), x),
    ],
)
def test_a_step_that_is_none_is_refused(wrong):
    with pytest.raises(IndexError, match="steps must be"):
        wrong(torch.zeros(2, 3), linear_schedule(100))


def test_posterior_is_bayes_rule_on_a_grid():
    """q(x_{s-1} | x_s, x0) from eq. 7 against the product of two densities, normalised by a sum."""
    schedule = linear_schedule(20, 0.01, 0.4)
    s = 9
    x0 = 0.8
    x_s = -0.3
    grid = torch.linspace(-6, 6, 20_001, dtype=torch.float64)
    log_p = -((grid - schedule.alpha_bar[s - 1].sqrt() * x0) ** 2) / (
        2 * (1 - schedule.alpha_bar[s - 1])
    ) - (x_s - schedule.alpha[s].sqrt() * grid) ** 2 / (2 * schedule.beta[s])
    weight = log_p.softmax(0)
    mean = (weight * grid).sum()
    ours, variance = q_posterior(
        torch.tensor([[x0]]).double(), torch.tensor([[x_s]]).double(), s, schedule
    )
    assert ours.item() == pytest.approx(mean.item(), abs=1e-6)
    assert variance.item() == pytest.approx((weight * (grid - mean) ** 2).sum().item(), abs=1e-6)
    assert variance.shape == ()  # one number for one step, one for each sample of a batch
    both = q_posterior(torch.zeros(2, 5, 3), torch.ones(2, 5, 3), torch.tensor([9, 4]), schedule)
    assert both[1].shape == (2, 1, 1) and both[1][0].item() == pytest.approx(variance.item())


def test_p_mean_with_the_true_noise_is_the_posterior_mean():
    schedule = linear_schedule()
    x0 = torch.randn(4, 3, 2).double()
    eps = torch.randn(4, 3, 2).double()
    s = 37
    x_s = q_sample(x0, s, schedule, eps)
    torch.testing.assert_close(p_mean(x_s, s, eps, schedule), q_posterior(x0, x_s, s, schedule)[0])


@pytest.mark.parametrize("variance", ["beta", "posterior"])
def test_one_reverse_step_by_hand(variance):
    """x_1 from x_2 in plain numbers: beta is 0.1, then 0.4, so alpha_bar_2 = 0.9 * 0.6 = 0.54."""
    schedule = make_schedule(torch.tensor([0.1, 0.4, 0.75, 0.95], dtype=torch.float64))
    x_2 = [0.7, -1.2]
    eps_hat = [0.3, 0.5]
    z = [-0.8, 1.5]
    sigma = {"beta": 0.4**0.5, "posterior": (0.4 * 0.1 / 0.46) ** 0.5}[variance]
    x_1 = [
        (x - 0.4 / 0.46**0.5 * e) / 0.6**0.5 + sigma * n
        for x, e, n in zip(x_2, eps_hat, z, strict=True)
    ]
    tensors = [torch.tensor([values], dtype=torch.float64) for values in (x_2, eps_hat, z)]
    ours = p_sample(tensors[0], 2, tensors[1], schedule, tensors[2], variance)
    assert ours[0].tolist() == pytest.approx(x_1, rel=1e-12)


def test_one_leap_by_hand():
    """From s = 3 to 1: alpha_bar_1 = 0.9, and alpha_bar_3 = 0.9 * 0.6 * 0.25 = 0.135."""
    schedule = make_schedule(torch.tensor([0.1, 0.4, 0.75, 0.95], dtype=torch.float64))
    sigma = 0.5 * (0.1 / 0.865 * (1 - 0.135 / 0.9)) ** 0.5
    assert ddim_sigma(3, 1, schedule, 0.5) == pytest.approx(sigma, rel=1e-12)
    guesses = ([0.7, -1.2], [0.3, 0.5], [-0.8, 1.5])
    x0_hat, eps_hat, z = (torch.tensor([values], dtype=torch.float64) for values in guesses)
    x_1 = [
        0.9**0.5 * x0 + (0.1 - sigma**2) ** 0.5 * eps + sigma * n
        for x0, eps, n in zip(*guesses, strict=True)
    ]
    ours = ddim_step(x0_hat, eps_hat, 1, schedule, sigma, z)
    assert ours[0].tolist() == pytest.approx(x_1, rel=1e-12)


@pytest.mark.parametrize("eta", [0.0, 0.7, 1.0])
def test_a_leap_with_the_true_guesses_keeps_the_noise_of_its_step(eta):
    """The variance around sqrt(alpha_bar) x0 is 1 - alpha_bar, however much of it is new."""
    schedule, n = linear_schedule(), 40_000
    random = torch.Generator().manual_seed(4)
    eps, z = torch.randn(2, n, 1, generator=random)
    made = ddim_step(torch.zeros(n, 1), eps, 30, schedule, ddim_sigma(60, 30, schedule, eta), z)
    assert made.var().item() == pytest.approx(1 - schedule.alpha_bar[30].item(), rel=0.03)


def test_a_leap_that_draws_noise_wants_it():
    x = torch.zeros(2, 3)
    with pytest.raises(ValueError, match="sigma = 0.5 draws noise: pass it"):
        ddim_step(x, x, 5, linear_schedule(), 0.5)


def test_leaping_with_all_steps_and_all_noise_is_ddpm_with_the_posterior():
    schedule = linear_schedule(9, 0.05, 0.7)
    truth = exact_denoiser(mixture(torch.ones(1), torch.zeros(1, 3), torch.eye(3)[None]), schedule)
    start, noise = torch.randn(4, 3).double(), torch.randn(9, 4, 3).double()
    leaps = list(ddim_steps(truth, start, schedule, 9, 1.0, noise=noise))
    steps = list(sample_steps(truth, start, schedule, noise=noise, variance="posterior"))
    assert [one.s for one in leaps] == [one.s for one in steps] == list(range(9, -1, -1))
    for leap, step in zip(leaps, steps, strict=True):
        torch.testing.assert_close(leap.x_s, step.x_s)


@pytest.mark.parametrize("variance", ["beta", "posterior"])
def test_last_step_adds_no_noise(variance):
    schedule = linear_schedule()
    x = torch.randn(2, 5, 7)
    eps = torch.randn(2, 5, 7)
    loud = torch.full_like(x, 1e6)
    torch.testing.assert_close(
        p_sample(x, 1, eps, schedule, loud, variance), p_mean(x, 1, eps, schedule)
    )
    assert (p_sample(x, 2, eps, schedule, loud, variance) - p_mean(x, 2, eps, schedule)).min() > 1e3


def test_sampling_yields_every_step_and_repeats_with_its_seed():
    schedule = linear_schedule(13, 1e-3, 0.6)
    denoise = exact_denoiser(
        mixture(torch.ones(1), torch.zeros(1, 3), torch.eye(3)[None]), schedule
    )

    def walk():
        generator = torch.Generator().manual_seed(5)
        x_S = torch.randn(4, 3, generator=generator)
        return list(sample_steps(denoise, x_S, schedule, generator=generator))

    first, second = walk(), walk()
    assert [step.s for step in first] == list(range(13, -1, -1))
    for a, b in zip(first, second, strict=True):
        assert torch.equal(a.x_s, b.x_s)
    assert torch.equal(first[-1].x_s, first[-1].x0_hat)
    torch.testing.assert_close(
        first[-1].x_s, first[-2].x0_hat
    )  # without noise, the last mean is the last guess of x0


def test_clip_bounds_the_guess():
    schedule = linear_schedule()
    steps = list(
        sample_steps(lambda x, s: torch.zeros_like(x), 5 * torch.ones(2, 3), schedule, clip=0.5)
    )
    assert max(step.x0_hat.abs().max() for step in steps) <= 0.5 + 1e-4


def test_exact_denoiser_samples_have_the_mixtures_mean_variance_and_weights():
    truth = mixture(
        torch.tensor([0.3, 0.7]),
        torch.tensor([[-1.0, 0.5], [1.0, -0.2]]),
        torch.tensor([[[0.04, 0.02], [0.02, 0.05]], [[0.09, 0.0], [0.0, 0.02]]]),
    )
    schedule = cosine_schedule(200)
    generator = torch.Generator().manual_seed(2)
    x_S = torch.randn(8000, 2, generator=generator)
    *_, last = sample_steps(exact_denoiser(truth, schedule), x_S, schedule, generator=generator)
    x = last.x_s.double()
    torch.testing.assert_close(x.mean(0), truth.mean(), atol=0.04, rtol=0)
    torch.testing.assert_close(x.T.cov(), truth.covariance(), atol=0.05, rtol=0)
    assert (x[:, 0] < 0).double().mean().item() == pytest.approx(0.3, abs=0.025)
    drawn = sample_mixture(truth, 8000, generator)
    torch.testing.assert_close(drawn.T.cov(), truth.covariance(), atol=0.05, rtol=0)


def test_simple_loss_is_the_mean_square_and_zero_for_the_true_noise():
    schedule = linear_schedule()
    x0 = torch.randn(2, 5, 7)
    noise = torch.randn(2, 5, 7)
    s = torch.tensor([4, 60])
    assert simple_loss(lambda x, s: noise, x0, s, schedule, noise) == 0
    zero = simple_loss(lambda x, s: torch.zeros_like(x), x0, s, schedule, noise)
    assert zero.item() == pytest.approx((noise**2).mean().item(), rel=1e-6)


@pytest.mark.parametrize("left, warns", [(0.099, False), (0.101, True)])
def test_a_tenth_of_the_signal_is_the_limit(left, warns):
    beta = torch.full((50,), 1 - left ** (2 / 50), dtype=torch.float64)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        make_schedule(beta, "constant")
    assert bool(caught) == warns


def schedule_table() -> list[tuple[str, str]]:
    """(call, what is left) of each row of the table in NOTATION.md."""
    text = (Path(__file__).parents[1] / "docs" / "NOTATION.md").read_text(encoding="utf-8")
    rows = re.findall(
        r"^\| `(\w+_schedule\(.*?\))`.*?\| \d+ \| ([\d.]+ %)(?: \(warns\))? \|$", text, re.MULTILINE
    )
    assert len(rows) == 7
    return rows


@pytest.mark.filterwarnings("ignore:.*of the signal")
@pytest.mark.parametrize("call, left", schedule_table())
def test_the_table_in_the_docs_is_what_the_schedules_leave(call, left):
    made = {
        "linear": linear_schedule,
        "rescaled_ddpm": rescaled_ddpm_schedule,
        "cosine": cosine_schedule,
    }
    name, arguments = call[:-1].split("_schedule(")
    numbers = [float(x) if "e" in x or "." in x else int(x) for x in arguments.split(", ")]
    schedule = (made | {"leap": leap_schedule})[name](*numbers)
    assert f" {left} of the signal" in schedule_card(schedule)


def test_the_movers_row_of_the_table():
    text = (Path(__file__).parents[1] / "docs" / "NOTATION.md").read_text(encoding="utf-8")
    ((snr, left),) = re.findall(
        r"^\| `shifted\(cosine_schedule\(1000\), (.*?)\)`.*?\| 1000 \| (.*?) \|$",
        text,
        re.MULTILINE,
    )
    assert float(snr) == MOVER.snr and f" {left} of" in schedule_card(
        shifted(cosine_schedule(1000), MOVER.snr)
    )


def test_final_keeps_only_the_last_record():
    """Earlier records are freed while the loop runs, so that a long one needs little memory."""

    class Noted:
        alive = 0

        def __init__(self):
            type(self).alive += 1
            assert self.alive <= 3

        def __del__(self):
            type(self).alive -= 1

    made = []

    def loop():
        for k in range(50):
            made.append(k)
            yield Noted()

    assert isinstance(final(loop()), Noted) and len(made) == 50
