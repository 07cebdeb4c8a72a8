"""Dropout of the past in least squares.

The closed forms equal what is drawn, and the ridge they are said to be.
"""

import numpy as np
import pytest
import torch

from motiondiff_edu.baselines import linear_dropout as ld
from motiondiff_edu.baselines import linear_gaussian
from motiondiff_edu.ddpm import linear_schedule
from motiondiff_edu.diffusion_dropout import diffusion_dropout, frame_dropout, zero_past
from motiondiff_edu.motion.clip import Clip
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.performers.windows import Windows

T_H = 2
D = 63
SCHEDULE = linear_schedule(100)


@pytest.fixture(scope="module")
def windows() -> Windows:
    """A world of 63 coordinates that all go on from the past and from the control.

    They are alike enough to be redundant.
    """
    rng = np.random.default_rng(0)
    control, x = rng.normal(size=(900, 3)), np.zeros((900, D))
    for t in range(1, 899):
        common = 0.7 * x[t].mean() - 0.2 * x[t - 1].mean() + 0.5 * control[t, 0]
        x[t + 1] = common + 0.3 * x[t] + 0.2 * rng.normal(size=D)
    unit = (Scaler(torch.zeros(D), torch.ones(D)), Scaler(torch.zeros(3), torch.ones(3)))
    return Windows.of([Clip(x.reshape(-1, 21, 3), control)], T_H, 1, unit)


@pytest.fixture(scope="module")
def clean(windows) -> ld.Products:
    return ld.products(windows)


def by_steps(past, generator):
    s = torch.randint(1, 101, (len(past),), generator=generator)
    return diffusion_dropout(past, s, SCHEDULE, 0.4, generator)


def one_step(past, generator):
    return diffusion_dropout(past, torch.full((len(past),), 30), SCHEDULE, 1.0, generator)


KINDS = {
    "diffusion": (by_steps, ld.noise_moments(0.4, SCHEDULE.alpha_bar[1:])),
    "one step": (one_step, ld.noise_moments(1.0, SCHEDULE.alpha_bar[30:31])),
    "zeroing": (lambda past, g: zero_past(past, 0.3, g), ld.zero_moments(0.3)),
    "frames": (lambda past, g: frame_dropout(past, 0.3, g), ld.frames_zeroed(0.3, T_H, D)),
    "entries": (
        lambda past, g: past * (torch.rand(past.shape, generator=g) >= 0.3) / 0.7,
        ld.entries_rescaled(0.3, T_H * D),
    ),
}


@pytest.mark.parametrize("kind", KINDS)
def test_the_closed_form_is_what_drawn_pasts_tend_to(windows, clean, kind):
    drop, moments = KINDS[kind]
    drawn = ld.products(windows, drop, 60, torch.Generator().manual_seed(1))
    wanted = ld.expected_products(clean, moments)
    assert (wanted.xx - drawn.xx).abs().max() < 0.06 < 0.15 < (clean.xx - drawn.xx).abs().max()
    assert (wanted.xy - drawn.xy).abs().max() < 0.04
    control = slice(T_H * D, None)  # and the constant: as they were
    torch.testing.assert_close(drawn.xx[control, control], clean.xx[control, control])


def test_one_step_of_noise_is_plain_ridge_by_noise_over_signal(clean):
    alpha_bar, P = 0.36, T_H * D
    found = ld.fit(
        ld.expected_products(clean, ld.noise_moments(1.0, torch.tensor([alpha_bar]))),
        clean,
        ridge=0.0,
    ).weight.double()
    penalty = torch.zeros(len(clean.xx), dtype=torch.float64)
    penalty[:P] = 0.64 / 0.36
    ridge = torch.linalg.solve(clean.xx + torch.diag(penalty), clean.xy)
    ridge[:P] /= 0.6
    torch.testing.assert_close(found, ridge, rtol=1e-4, atol=1e-5)


def test_zeroing_shrinks_a_past_without_control_evenly(windows, clean):
    P = clean.past
    alone = ld.Products(
        clean.xx[:P, :P], clean.xy[:P], clean.yy, windows
    )  # no control, no constant
    least, dropped = (
        torch.linalg.solve(p.xx, p.xy)
        for p in (alone, ld.expected_products(alone, ld.zero_moments(0.3)))
    )
    torch.testing.assert_close(
        least, dropped
    )  # keep / share = 1: nothing is left that could take over


def test_without_dropout_it_is_ordinary_least_squares(windows, clean):
    again = ld.fit(clean, ridge=1e-3)
    wanted = linear_gaussian.fit(windows, ridge=1e-3)
    torch.testing.assert_close(again.weight, wanted.weight, rtol=1e-4, atol=1e-5)
    torch.testing.assert_close(again.noise_factor, wanted.noise_factor, rtol=1e-3, atol=1e-4)


def test_weight_moves_from_the_past_to_the_control(clean):
    rates = (0.0, 0.2, 1.0)
    walkers = [
        ld.fit(ld.expected_products(clean, ld.noise_moments(rate, SCHEDULE.alpha_bar[1:])), clean)
        for rate in rates
    ]
    past, control = zip(*(ld.contributions(walker, clean) for walker in walkers), strict=True)
    assert control[0] < control[1] < control[2] and past[2] < past[0]


def test_contributions_are_the_spread_of_either_part(windows, clean):
    walker, (X, _) = ld.fit(clean), linear_gaussian.design(windows)
    parts = (
        X[:, :126] @ walker.weight[:126].double(),
        X[:, 126:-1] @ walker.weight[126:-1].double(),
    )
    wanted = [part.std(0, correction=0).square().mean().sqrt().item() for part in parts]
    assert ld.contributions(walker, clean) == pytest.approx(wanted, rel=1e-6)


def test_windows_of_several_futures_are_refused(windows):
    with pytest.raises(ValueError, match="make the windows with T_p=1, not 3"):
        ld.products(
            Windows(
                windows.poses,
                windows.control,
                windows.starts[:-3],
                T_H,
                3,
                *[windows.pose_scaler] * 2,
            )
        )


@pytest.mark.parametrize("rate", [-1.0, 1.5])
@pytest.mark.parametrize(
    "moments",
    [
        lambda rate: ld.noise_moments(rate, SCHEDULE.alpha_bar[1:]),
        ld.zero_moments,
        lambda rate: ld.frames_zeroed(rate, T_H, D),
        lambda rate: ld.entries_rescaled(rate, T_H * D),
    ],
)
def test_a_rate_that_is_no_probability_is_refused(moments, rate):
    with pytest.raises(ValueError, match=f"a rate must be between 0 and 1, not {rate:g}"):
        moments(rate)


def test_entries_that_are_all_dropped_cannot_keep_their_mean():
    with pytest.raises(ValueError, match="use a rate below 1"):
        ld.entries_rescaled(1.0, T_H * D)
