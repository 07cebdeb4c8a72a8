"""Beats of a dance.

Stops at known times, the closed form of chance, and a shake that fools the music form alone.
"""

import warnings

import numpy as np
import pytest
from moves import shake, stopping_at, sway
from scipy.special import erf

from motiondiff_edu.metrics.dances import (
    NoBeatsWarning,
    beat_alignment,
    chance_level,
    f_measure,
    kinematic_beats,
    mean_speed,
    music_alignment,
    shifted_level,
)

BEATS = 0.3 + 0.5 * np.arange(39)  # 120 BPM, 20 s
UNEVEN = np.array([0.41, 0.93, 1.52, 2.2, 2.71, 3.37, 4.02])


def test_speed_is_the_mean_over_joints_in_metres_a_second():
    positions = np.zeros((3, 2, 3))
    positions[1:, 0] = [
        0.3,
        0.0,
        0.4,
    ]  # half a metre in one frame, then nothing; the other joint stands
    np.testing.assert_allclose(mean_speed(positions, 10), [2.5, 0.0])
    assert mean_speed(np.zeros((2, 5, 4, 3))).shape == (2, 4)


@pytest.mark.parametrize("fps", [20, 30, 60, 100])
def test_stops_are_found_when_they_happen_at_every_frame_rate(fps):
    found = kinematic_beats(stopping_at(UNEVEN, 4.5, fps), fps)
    fine = kinematic_beats(stopping_at(UNEVEN, 4.5, 240), 240)
    assert len(found) == len(UNEVEN)
    np.testing.assert_allclose(
        found, fine, atol=0.006
    )  # seconds, a frame lasting 0.05, 0.033, 0.017, 0.01
    np.testing.assert_allclose(
        found, UNEVEN, atol=0.032
    )  # a stop between unequal moves is moved by the smoothing


def test_steady_stops_have_no_bias_of_half_a_frame():
    found = kinematic_beats(stopping_at(BEATS, 20.0, 20), 20)
    assert len(found) == len(BEATS) and abs((found - BEATS).mean()) < 0.002


def test_a_figure_at_constant_speed_has_no_beat_and_so_has_one_that_stands():
    assert len(kinematic_beats(sway(5.0, 20), 20)) == 0
    assert len(kinematic_beats(np.zeros((50, 7, 3)), 20)) == 0


def test_a_recorded_dance_has_the_same_beats_at_twenty_and_sixty_frames(real_data):
    from motiondiff_edu.motion.formats.aist import read_keypoints

    clip = read_keypoints(
        real_data / "aist" / "keypoints3d" / "gBR_sBM_cAll_d06_mBR2_ch06.pkl"
    ).positions
    fine = kinematic_beats(clip, 60)
    coarse = kinematic_beats(clip[::3], 20)
    assert f_measure(coarse, fine, 0.025) == 1.0
    assert 2.2 < len(fine) / 9.6 < 2.6  # beats a second: measured by others, at 20 frames/s


def test_scores_by_hand():
    kinematic, music = np.array([1.0, 2.05, 2.5]), np.array([1.0, 2.0])
    # 0, 1 and 10 sigma away
    here = 1.0
    half = np.exp(-0.5)
    one = np.exp(-50.0)
    assert beat_alignment(kinematic, music) == pytest.approx((here + half + one) / 3)
    assert music_alignment(kinematic, music) == pytest.approx((here + half) / 2)
    assert beat_alignment(kinematic, music, sigma=0.1) == pytest.approx(
        (1 + np.exp(-1 / 8) + np.exp(-12.5)) / 3
    )


def test_dancing_on_the_beat_scores_and_off_it_does_not():
    on, off = (kinematic_beats(stopping_at(BEATS + late, 20.0, 20), 20) for late in (0.0, 0.25))
    assert beat_alignment(on, BEATS) > 0.95 and music_alignment(on, BEATS) > 0.95
    assert beat_alignment(off, BEATS) < 0.01


def test_chance_is_the_closed_form_for_a_steady_beat():
    for bpm, published in ((80, 0.167), (110, 0.230), (120, 0.251)):
        steady = np.arange(-5, 60 * bpm // 60 + 5) * 60 / bpm
        assert chance_level(steady, 60.0) == pytest.approx(published, abs=1e-3)
        assert chance_level(steady, 60.0) == pytest.approx(
            0.05 * np.sqrt(2 * np.pi) * bpm / 60, rel=1e-3
        )


def test_chance_is_what_random_stops_score_for_any_beats():
    stops = np.random.default_rng(1).uniform(0, 5.0, 400_000)
    late = UNEVEN + 1.5  # the first beat after 1.9 s, the last beyond the end
    assert chance_level(late, 5.0) == pytest.approx(
        beat_alignment(stops[:100_000], late), abs=0.004
    )
    assert chance_level(UNEVEN[::-1], 5.0, 0.2) == pytest.approx(
        beat_alignment(stops, UNEVEN, 0.2), abs=0.004
    )


def test_shifting_at_random_finds_the_chance_of_both_forms():
    rng = np.random.default_rng(2)
    found = kinematic_beats(stopping_at(BEATS, 20.0, 20), 20)
    shifted = shifted_level(beat_alignment, found, BEATS, 20.0, rng, times=2000)
    assert shifted == pytest.approx(chance_level(BEATS, 20.0), abs=0.02)
    # as many stops as beats, one period apart: both forms then have one chance level
    assert shifted_level(music_alignment, found, BEATS, 20.0, rng, times=2000) == pytest.approx(
        shifted, abs=0.03
    )


def test_an_aimless_shake_wins_the_music_form_and_is_chance_in_the_kinematic_one():
    music = np.arange(0.2, 20.0, 60 / 113)  # no common period with the shake
    found = kinematic_beats(shake(3.0, 20.0, 20, phase=0.7), 20)
    # six stops a second: the nearest is up to 1/12 s away
    wanted = 6 * 0.05 * np.sqrt(2 * np.pi) * erf(1 / 12 / (0.05 * np.sqrt(2)))
    assert music_alignment(found, music) == pytest.approx(
        wanted, abs=0.05
    ) and wanted == pytest.approx(0.68, abs=0.005)
    assert beat_alignment(found, music) == pytest.approx(chance_level(music, 20.0), abs=0.02)


def test_what_is_empty_is_told():
    with pytest.warns(NoBeatsWarning, match="never slows down"):
        assert np.isnan(beat_alignment(np.array([]), BEATS))
    assert music_alignment(np.array([]), BEATS) == 0.0
    for score in (beat_alignment, music_alignment):
        with pytest.raises(ValueError, match="no beat"):
            score(BEATS, np.array([]))
    with pytest.raises(ValueError, match="no beat"):
        chance_level(np.array([]), 5.0)
    with pytest.raises(ValueError, match="sigma"):
        beat_alignment(BEATS, BEATS, sigma=0.0)
    with pytest.raises(ValueError, match="two frames"):
        mean_speed(np.zeros((1, 2, 3)))


@pytest.mark.parametrize("fps", [20, 60, 120])
def test_a_hole_in_the_motion_is_told_at_every_frame_rate(fps):
    dance = stopping_at(UNEVEN, 4.5, fps)
    dance[30] = np.nan
    with pytest.raises(ValueError, match="frame 30 is not finite|contain NaN"):
        kinematic_beats(dance, fps)


def test_f_measure_is_that_of_the_published_fixtures(real_data):
    import json

    folder = real_data / "oracle" / "mir_eval_beat"
    for number, published in (("00", 0.6216), ("01", 0.5714)):
        true, found = (np.loadtxt(folder / f"{who}{number}.txt", ndmin=1) for who in ("ref", "est"))
        late = f_measure(
            found[found >= 5.0], true[true >= 5.0]
        )  # its `evaluate` leaves out the first five seconds
        assert late == pytest.approx(
            json.loads((folder / f"output{number}.json").read_text())["F-measure"], abs=1e-9
        )
        assert late == pytest.approx(published, abs=1e-4)


def test_f_measure_agrees_with_mir_eval_on_random_beats():
    beat = pytest.importorskip("mir_eval.beat")
    rng = np.random.default_rng(3)
    for found, true in ((17, 23), (40, 31), (5, 60)):
        a, b = (np.sort(rng.uniform(0, 9.0, n)) for n in (found, true))
        assert f_measure(a, b) == pytest.approx(beat.f_measure(b, a))


def test_f_measure_by_hand():
    assert f_measure(np.array([1.0, 2.0, 2.02, 9.0]), np.array([1.05, 2.0, 5.0])) == pytest.approx(
        2 * 2 / 7
    )
    assert f_measure(np.array([]), np.array([1.0])) == 0.0
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert f_measure(np.array([1.0, 2.0]), np.array([1.0, 2.0])) == 1.0
