"""Diffusion dropout.

Eq. 12's mean and variance, its rate, who is hit, and the schedule of rates.
"""

import pytest
import torch
from seeds import seeded

from motiondiff_edu.ddpm import linear_schedule
from motiondiff_edu.diffusion_dropout import (
    P_D,
    Dropout,
    diffusion_dropout,
    dropout_rate,
    frame_dropout,
    zero_past,
)

SCHEDULE = linear_schedule(100)


def test_rate_zero_is_the_identity_and_rate_one_is_equation_12():
    past, s = torch.full((4000, 5, 3), 2.0), torch.full((4000,), 40)
    assert torch.equal(diffusion_dropout(past, s, SCHEDULE, 0.0, seeded()), past)
    out = diffusion_dropout(past, s, SCHEDULE, 1.0, seeded())
    alpha_bar = SCHEDULE.alpha_bar[40].item()
    assert out.mean().item() == pytest.approx(2 * alpha_bar**0.5, abs=0.02)
    assert out.var().item() == pytest.approx(1 - alpha_bar, rel=0.02)
    each = out.flatten(1)
    assert abs(torch.corrcoef(each.T)[0, 1].item()) < 0.06  # entries are noised on their own


def test_whole_samples_are_hit_and_by_the_rate():
    past = torch.ones(5000, 4, 3)
    s = torch.randint(1, 101, (5000,), generator=seeded(1))
    touched = (diffusion_dropout(past, s, SCHEDULE, 0.2, seeded(2)) != past).flatten(1)
    assert torch.equal(touched.any(1), touched.all(1))
    assert touched.any(1).float().mean().item() == pytest.approx(0.2, abs=0.02)


@pytest.mark.parametrize("shared", [True, False])
def test_a_noised_past_has_the_target_s_step_or_one_of_its_own(shared):
    past = torch.zeros(3000, 40, 5)
    s = torch.where(torch.arange(3000) % 2 == 0, 5, 95)
    out = diffusion_dropout(past, s, SCHEDULE, 1.0, seeded(3), shared=shared)
    spread = out.flatten(1).std(1)
    few, many = spread[::2].mean().item(), spread[1::2].mean().item()
    if shared:
        assert few == pytest.approx((1 - SCHEDULE.alpha_bar[5].item()) ** 0.5, rel=0.02)
        assert many == pytest.approx((1 - SCHEDULE.alpha_bar[95].item()) ** 0.5, rel=0.02)
    else:
        assert few == pytest.approx(many, abs=0.04)


def test_steps_of_its_own_are_drawn_evenly_from_all():
    """The variance of each noised past tells its step; in order, they are the schedule's."""
    past = torch.zeros(4000, 40, 50)
    out = diffusion_dropout(
        past, torch.ones(4000, dtype=torch.int64), SCHEDULE, 1.0, seeded(6), shared=False
    )
    found = out.flatten(1).var(1)
    quantiles = torch.tensor([0.02, 0.25, 0.5, 0.75, 0.98])
    wanted = (1 - SCHEDULE.alpha_bar[1:]).float()
    torch.testing.assert_close(
        found.quantile(quantiles), wanted.quantile(quantiles), atol=0.01, rtol=0.08
    )
    assert found.max() > 0.95 * wanted[-1]


def test_a_dropout_that_nobody_tells_the_time_refuses_to_be_none_at_all():
    dropout, past = Dropout(SCHEDULE, dropout_rate(), steps=8), torch.zeros(2, 3, 4)
    with pytest.raises(RuntimeError, match=r"train_steps\(..., before=dropout.now\)"):
        dropout(past, torch.tensor([1, 2]), seeded())
    dropout.now(0)
    assert torch.equal(dropout(past, torch.tensor([1, 2]), seeded()), past)


@pytest.mark.parametrize("shared", [True, False])
def test_a_training_s_dropout_goes_by_what_is_done_and_by_its_own_choice_of_steps(shared):
    dropout = Dropout(SCHEDULE, lambda done: float(done >= 0.5), steps=8, shared=shared)
    past, s = torch.zeros(400, 40, 50), torch.full((400,), 10)
    touched = []
    for step in range(8):
        dropout.now(step)
        out = dropout(past, s, seeded(step))
        touched.append((out != past).flatten(1).any(1).float().mean().item())
    assert touched == [0.0] * 4 + [1.0] * 4
    spread = (
        out.flatten(1).var(1).std().item()
    )  # of noise levels, not of noise: one level for all, or many
    assert spread < 0.01 if shared else spread > 0.1


def test_rivals_set_frames_or_whole_pasts_to_zero():
    past = torch.ones(3000, 10, 4)
    frames = frame_dropout(past, 0.3, seeded(4)) == 0
    assert torch.equal(frames.any(-1), frames.all(-1))
    assert frames.float().mean().item() == pytest.approx(0.3, abs=0.02)
    assert 0 < frames[:, :, 0].float().mean(1).std().item()  # some frames of a past, not all
    whole = (zero_past(past, 0.3, seeded(5)) == 0).flatten(1)
    assert torch.equal(whole.any(1), whole.all(1)) and whole.float().mean().item() == pytest.approx(
        0.3, abs=0.03
    )


def test_the_paper_s_schedule_of_a_thousand_epochs():
    rate = dropout_rate()
    found = [rate(epoch / 1000) for epoch in range(1000)]
    assert found[:500] == [0.0] * 500
    for k, wanted in enumerate(P_D[1:]):
        assert found[500 + 100 * k : 600 + 100 * k] == [wanted] * 100
    assert rate(1.0) == 0.25


def test_other_schedules():
    high = dropout_rate((0.25,), start=0.0)
    assert high(0.0) == high(1.0) == 0.25
    assert (
        dropout_rate((0.1, 0.2), start=0.2)(0.19) == 0.0
        and dropout_rate((0.1, 0.2), start=0.2)(0.21) == 0.1
    )


def test_wrong_inputs():
    past, s = torch.zeros(2, 3, 4), torch.tensor([1, 2])
    for call in (
        lambda: diffusion_dropout(past, s, SCHEDULE, 1.5),
        lambda: frame_dropout(past, -0.1),
        lambda: zero_past(past, 2.0),
        lambda: dropout_rate((0.1, 1.2)),
        lambda: dropout_rate(()),
        lambda: dropout_rate(start=-1.0),
    ):
        with pytest.raises(ValueError, match="between 0 and 1"):
            call()


@pytest.mark.parametrize(
    "past, s, told",
    [
        ((7, 63), [5] * 7, r"past is \(7, 63\) .* a past \(B, T_h, D\)"),
        ((7, 2, 3, 21), [5] * 7, r"past is \(7, 2, 3, 21\) .* a past \(B, T_h, D\)"),
        ((2, 3, 4), [5], r"past is \(2, 3, 4\) and s \[5\]: .* each of its samples"),
        ((2, 3, 4), [5, -3], r"s \[5, -3\]: .* a step from 0 to 100"),
        ((2, 3, 4), [5, 101], r"s \[5, 101\]: .* a step from 0 to 100"),
    ],
)
@pytest.mark.parametrize("shared", [True, False])
def test_a_past_or_a_step_that_does_not_fit_is_named(past, s, told, shared):
    unchecked = getattr(
        diffusion_dropout, "__wrapped__", diffusion_dropout
    )  # as in a notebook: no shape is checked
    with pytest.raises(ValueError, match=told):
        unchecked(torch.zeros(past), torch.tensor(s), SCHEDULE, 1.0, seeded(), shared=shared)
