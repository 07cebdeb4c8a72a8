"""Classifier-free guidance, exactly: on a mixture whose conditional is one of its two humps."""

import pytest
import torch

from motiondiff_edu.beyond.classifier_free import guided_by_condition, while_between
from motiondiff_edu.ddpm import cosine_schedule, ddim_steps, final
from motiondiff_edu.exact import exact_denoiser, mixture

SCHEDULE = cosine_schedule(100)
MEANS, STD = (-1.0, 1.0), 0.6
BOTH = mixture(torch.ones(2) / 2, torch.tensor(MEANS)[:, None], torch.full((2, 1, 1), STD**2))
RIGHT = mixture(torch.ones(1), torch.tensor(MEANS[1:])[:, None], torch.full((1, 1, 1), STD**2))


def denoisers():
    return exact_denoiser(RIGHT, SCHEDULE), exact_denoiser(BOTH, SCHEDULE)


def test_one_is_the_conditional_itself_and_nought_the_unconditional():
    conditional, unconditional = denoisers()
    assert guided_by_condition(conditional, unconditional, 1) is conditional
    x, s = torch.linspace(-2, 2, 9)[:, None], torch.full((9,), 30)
    torch.testing.assert_close(
        guided_by_condition(conditional, unconditional, 0)(x, s), unconditional(x, s)
    )
    wanted = 3 * conditional(x, s) - 2 * unconditional(x, s)
    torch.testing.assert_close(guided_by_condition(conditional, unconditional, 3)(x, s), wanted)


def sampled(w: float) -> torch.Tensor:
    start = torch.randn(4000, 1, generator=torch.Generator().manual_seed(1))
    loop = ddim_steps(guided_by_condition(*denoisers(), w), start, SCHEDULE, steps=100)
    return final(loop).x_s


def test_more_guidance_leads_away_from_the_other_hump_and_narrows_the_samples():
    """The conditional is N(1, 0.6); with w > 1 the samples are no sample of it any more."""
    found = {w: sampled(w) for w in (1.0, 2.5, 5.0)}
    assert found[1.0].mean().item() == pytest.approx(1.0, abs=0.05)
    assert found[1.0].std().item() == pytest.approx(STD, abs=0.05)
    means, stds = ([x(found[w]).item() for w in found] for x in (torch.mean, torch.std))
    assert means[0] < means[1] < means[2] and stds[0] > stds[1] > stds[2]
    wrong = [(one < 0).float().mean().item() for one in found.values()]  # nearer the other hump
    assert wrong[0] > 0.03 and wrong[1] < 0.5 * wrong[0]


def test_each_sample_is_guided_between_two_amounts_of_noise():
    conditional, unconditional = denoisers()
    guided = guided_by_condition(conditional, unconditional, 3)
    x, s = torch.linspace(-2, 2, 100)[:, None], torch.arange(1, 101)
    most, least = SCHEDULE.alpha_bar[[40, 80]].tolist()
    mixed = while_between(guided, conditional, SCHEDULE, least, most)
    found, inside = mixed(x, s), (40 <= s) & (s <= 80)
    torch.testing.assert_close(found[inside], guided(x, s)[inside])
    torch.testing.assert_close(found[~inside], conditional(x, s)[~inside])
    # one step for all, as samplers have it
    for step, alone in ((90, conditional), (60, guided), (10, conditional)):
        torch.testing.assert_close(mixed(x, s * 0 + step), alone(x, s * 0 + step))


def test_what_is_not_asked_for_is_not_evaluated():
    def refused(*_):
        raise AssertionError("not needed here")

    x, conditional = torch.zeros(3, 1), denoisers()[0]
    while_between(refused, conditional, SCHEDULE, 0.1, 0.5)(x, torch.full((3,), 1))
    while_between(refused, conditional, SCHEDULE, 0.1, 0.5)(x, torch.full((3,), 100))
    while_between(conditional, refused, SCHEDULE, 0.1, 0.5)(x, torch.full((3,), 60))
