"""The published forms of the beat score.

A recorded dance on its known grid, and each fault where it shows.
"""

import numpy as np
import pytest
from moves import shake, stopping_at

from motiondiff_edu.metrics.dances import (
    aist_beats,
    aist_score,
    bailando_beats,
    bailando_score,
    kinematic_beats,
)
from motiondiff_edu.motion.formats.aist import read_keypoints

GRID = np.arange(0, 576, 36)  # 100 BPM at 60 frames/s: 16 beats in 9.6 s


def phases(clip):
    """Bailando's score of a recorded dance with the grid moved by each of its 36 frames."""
    found = bailando_beats(clip.positions)
    return [bailando_score(found, np.arange(phase, 576, 36)) for phase in range(36)]


def recorded(folder, name):
    clip = read_keypoints(folder / "aist" / "keypoints3d" / name)
    assert len(clip.positions) == 576
    return clip


def test_a_breaker_is_on_the_true_grid_more_than_on_any(real_data):
    every = phases(recorded(real_data, "gBR_sBM_cAll_d06_mBR2_ch06.pkl"))
    assert every[0] == pytest.approx(0.393, abs=5e-4) and np.mean(every) == pytest.approx(
        0.300, abs=5e-4
    )
    assert np.argmax(every) == 24 and max(every) == pytest.approx(0.430, abs=5e-4)


def test_on_another_clip_the_true_grid_scores_below_the_average_so_one_clip_says_little(real_data):
    every = phases(recorded(real_data, "gBR_sBM_cAll_d04_mBR2_ch08.pkl"))
    assert every[0] == pytest.approx(0.066, abs=5e-4) and np.mean(every) == pytest.approx(
        0.091, abs=5e-4
    )


def test_one_is_late_by_half_a_frame_and_the_other_early():
    stops = 23.5 + 36 * np.arange(15)  # frames of 60 a second
    dance = stopping_at(stops / 60, 9.6, 60)
    np.testing.assert_array_equal(aist_beats(dance) - stops, 0.5)
    np.testing.assert_array_equal(
        (bailando_beats(dance) - stops)[1:-1], -0.5
    )  # smoothing moves the first and last
    np.testing.assert_allclose((60 * kinematic_beats(dance, 60) - stops)[1:-1], 0.0, atol=0.05)


def test_a_stop_on_a_frame_may_be_missed():
    """The steps before and after it are then equally long, and neither is less than the other:
    rounding decides."""
    dance = stopping_at((24 + 36 * np.arange(15)) / 60, 9.6, 60)
    assert len(bailando_beats(dance)) < 15 == len(kinematic_beats(dance, 60))


def test_averages_by_hand():
    kinematic, music = np.array([10, 23, 50]), np.array([10, 20])
    assert aist_score(kinematic, music) == pytest.approx((1 + np.exp(-0.5) + np.exp(-50.0)) / 3)
    assert bailando_score(kinematic, music) == pytest.approx((1 + np.exp(-0.5)) / 2)


def test_who_shakes_wins_over_the_music_and_has_chance_over_the_dance():
    music = np.arange(12.0, 1200.0, 60 / 113 * 60)
    over_music = [
        bailando_score(bailando_beats(shake(6.0, 20.0, 60, phase=p)), music)
        for p in np.arange(7) * 0.9
    ]
    over_dance = [
        aist_score(aist_beats(shake(6.0, 20.0, 60, phase=p)), music) for p in np.arange(7) * 0.9
    ]
    chance = 3 * np.sqrt(2 * np.pi) * 113 / 3600
    assert np.mean(over_music) == pytest.approx(0.94, abs=0.02)
    assert np.mean(over_dance) == pytest.approx(chance, abs=0.05) and chance == pytest.approx(
        0.236, abs=1e-3
    )


def test_at_twenty_frames_a_second_chance_alone_scores_three_times_as_much():
    rng, period = np.random.default_rng(5), 0.5
    stops = rng.uniform(0, 2000.0, 40_000)  # frames
    at_60, at_20 = (aist_score(stops, np.arange(-9.0, 2009.0, period * fps)) for fps in (60, 20))
    assert at_60 == pytest.approx(0.251, abs=0.01) and at_20 == pytest.approx(0.68, abs=0.01)


def test_nothing_on_one_side():
    none = np.array([], dtype=int)
    assert aist_score(none, GRID) == 0.0
    for kinematic, music in ((none, GRID), (GRID, none)):
        with pytest.raises(ValueError, match="has no beats"):
            bailando_score(kinematic, music)
