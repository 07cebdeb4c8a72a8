"""The schedule that leaps over low noise."""

import pytest

from motiondiff_edu.beyond.schedules import leap_schedule
from motiondiff_edu.ddpm import linear_schedule


def noise_over_signal(schedule):
    return ((1 - schedule.alpha_bar) / schedule.alpha_bar).sqrt()


def test_the_leap_schedule_makes_in_one_step_what_the_linear_one_makes_in_thirty():
    schedule, linear = leap_schedule(), linear_schedule(100)
    noise = noise_over_signal(schedule)
    assert not ((noise > 0) & (noise < 0.76)).any()
    assert ((noise_over_signal(linear) > 0) & (noise_over_signal(linear) < 0.76)).sum() == 30
    assert schedule.S == 100 and schedule.signal_left < 0.1
    assert noise[1] == pytest.approx((0.37 / 0.63) ** 0.5) and noise[0] == 0
    assert (noise[1:].diff() > 0).all() and schedule.beta[2] == pytest.approx(0.03)
