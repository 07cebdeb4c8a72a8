"""motion.resample.

Sums of sines come back at the new frames, the ends stay, what the new rate cannot show is filtered
out, and what cannot be done is refused.
"""

import numpy as np
import pytest

from motiondiff_edu.motion.resample import resample

RNG = np.random.default_rng(1)
HZ = RNG.uniform(0.3, 4.0, (6, 3, 3))
PHASE, SIZE = RNG.uniform(0, 2 * np.pi, (2, 6, 3, 3))


def movement(times):
    """A sum of sines below 4 Hz, (T, 3, 3), known at every time."""
    return (0.1 * np.cos(2 * np.pi * HZ * times[:, None, None, None] + PHASE)).sum(1)


def test_movement_below_a_quarter_of_the_rate_comes_back():
    coarse = movement(np.arange(81) / 20)
    fine = movement(np.arange(241) / 60)
    new = resample(coarse, 20)
    assert new.shape == (241, 3, 3)
    inner = np.abs(new - fine)[12:-12].max()
    assert (
        inner < 0.012 < 0.1 * np.abs(fine).max()
    )  # metres; 0.6 m is the largest swing there can be
    nearest = fine[np.round(np.arange(241) / 3).astype(int).clip(0, 80) * 3]
    assert inner < 0.1 * np.abs(nearest - fine).max()  # a spline, not the nearest frame


def test_slow_movement_comes_back_closely():
    times = np.arange(81) / 20
    new = resample(np.sin(2 * np.pi * 1.5 * times), 20)
    np.testing.assert_allclose(new, np.sin(2 * np.pi * 1.5 * np.arange(241) / 60), atol=3e-3)


def test_the_old_frames_and_both_ends_stay_as_they_are():
    old = RNG.normal(size=(17, 4, 3))
    new = resample(old, 20)
    np.testing.assert_allclose(new[::3], old, atol=1e-12)
    assert np.array_equal(new[0], old[0]) and np.array_equal(new[-1], old[-1])


def test_a_rate_that_does_not_divide_ends_before_the_old_end():
    ramp = np.arange(26.0) / 25  # one second of a straight line, at 25 frames/s
    new = resample(ramp, 25)
    np.testing.assert_allclose(new, np.arange(61) / 60, atol=1e-12)
    assert len(resample(ramp[:-1], 25)) == 58  # 0.96 s: frames 0 .. 57, the last at 0.95 s


def test_the_same_rate_changes_nothing():
    old = RNG.normal(size=(7, 2, 3))
    assert np.array_equal(resample(old, 60), old)


def test_at_a_lower_rate_slow_movement_stays_and_fast_movement_goes():
    """From 120 to 20 frames/s: 3 Hz stays without delay; 17 Hz would come back as 3 Hz."""
    fine, coarse = np.arange(481) / 120, np.arange(81) / 20
    slow, fast = (np.sin(2 * np.pi * hz * fine) for hz in (3, 17))
    wanted = np.sin(2 * np.pi * 3 * coarse)
    new = resample(slow + fast, 120, 20)
    assert new.shape == wanted.shape
    assert np.abs(new - wanted)[10:-10].max() < 0.03
    assert np.abs(resample(fast, 120, 20))[10:-10].max() < 0.03 < np.abs(fast[::6]).max()


def test_a_lower_rate_ends_before_the_old_end():
    new = resample(np.arange(47.0) / 30, 30, 20)
    assert len(new) == 31
    np.testing.assert_allclose(new[3:-3], (np.arange(31) / 20)[3:-3], atol=2e-3)


@pytest.mark.parametrize(
    "positions, fps, told",
    [
        (np.zeros((9, 3)), 0, "positive"),
        (np.zeros((1, 3)), 20, "2 are needed"),
        (
            np.where(np.arange(9)[:, None] == 4, np.nan, np.zeros((9, 3))),
            20,
            "frame 4 is not finite",
        ),
    ],
)
def test_what_cannot_be_resampled_is_refused(positions, fps, told):
    with pytest.raises(ValueError, match=told):
        resample(positions, fps)


def test_at_the_same_rate_it_is_a_copy():
    given = np.random.default_rng(0).normal(size=(9, 3))
    same = resample(given, 20, 20)
    np.testing.assert_array_equal(same, given)
    assert not np.shares_memory(same, given)
