"""Measures of in-betweens, and interpolation.

Hand-made motions, closed forms, what must not change.
"""

import numpy as np
import pytest

from data_synth.walking import random_control, walk
from motiondiff_edu.baselines.interpolation import linear, spherical
from motiondiff_edu.editing.masks import gap, keyframes
from motiondiff_edu.metrics.bodies import bone_rmse
from motiondiff_edu.metrics.keyframes import (
    energy_score,
    keyframe_error,
    npss,
    seam_jump,
    seams,
    unknown_error,
)
from motiondiff_edu.motion.root_frame import to_world


@pytest.fixture(scope="module")
def walks():
    clips = [walk(random_control(4.0, np.random.default_rng(k), "turn"), k) for k in range(4)]
    return np.stack([to_world(c.poses, c.control)[:60] for c in clips])


def test_errors_count_what_is_given_and_what_is_not(walks):
    known, made = gap(60, 20, 15), walks.copy()
    made[1, 25] += [0.0, 0.03, 0.04]  # 5 cm, in one of the fifteen frames
    assert keyframe_error(made, walks, known).tolist() == [0, 0, 0, 0]
    np.testing.assert_allclose(unknown_error(made, walks, known), [0, 0.05 / 15, 0, 0], atol=1e-12)
    made[2, 0, 3] += [0.1, 0, 0]
    np.testing.assert_allclose(keyframe_error(made, walks, known)[2], 0.1 / (45 * 21))
    with pytest.raises(ValueError, match="no joint is known"):
        keyframe_error(made, walks, np.zeros((60, 21), bool))
    with pytest.raises(ValueError, match="every joint is known"):
        unknown_error(made, walks, np.ones((60, 21), bool))


def test_the_energy_score_is_lowest_for_samples_of_the_truths_distribution():
    """One number: samples of N(0, 1) score lower than their mean, narrow or wide guesses."""
    rng = np.random.default_rng(0)
    truth = np.zeros((400, 1, 1, 3))
    truth[..., 0] = rng.normal(size=(400, 1, 1))
    known = np.zeros((1, 1), bool)

    def score(width: float) -> float:
        samples = np.zeros((30, 400, 1, 1, 3))
        samples[..., 0] = width * rng.normal(size=(30, 400, 1, 1))
        return energy_score(samples, truth, known).mean()

    assert score(1.0) < min(score(0.0), score(0.5), score(2.0))
    # E|X| - E|X - X'| / 2 of normal numbers, in closed form
    assert score(0.0) == pytest.approx(np.sqrt(2 / np.pi), abs=0.05)
    assert score(1.0) == pytest.approx(1 / np.sqrt(np.pi), abs=0.05)
    one = np.ones((1, 400, 1, 1, 3))
    np.testing.assert_allclose(energy_score(one, truth, known), unknown_error(one[0], truth, known))
    with pytest.raises(ValueError, match="no sample"):
        energy_score(one[:0], truth, known)


def test_npss_of_two_sines_is_the_distance_of_their_bins():
    t = np.arange(60) / 60
    wave = lambda k: np.sin(2 * np.pi * k * t)[None, :, None]  # noqa: E731
    assert npss(wave(5), wave(5)) == pytest.approx(0, abs=1e-9)
    assert npss(wave(8), wave(5)) == pytest.approx(3) and npss(wave(5), wave(9)) == pytest.approx(4)
    # bins k and T - k both move; with a mean, its bin 0 exchanges weight with them
    a, b = 0.5, 1.0
    k = 5
    weight = lambda size: (size**2 / 4) / (1 + size**2 / 2)  # noqa: E731
    side = weight(b) - weight(a)  # of either bin; bin 0 has lost twice as much
    moved = k * 2 * side + (60 - 2 * k) * side
    assert npss(1 + a * wave(k), 1 + b * wave(k)) == pytest.approx(moved)
    both = np.concatenate([wave(5), 0.1 * wave(7)], -1)  # a column counts by the truth's power
    off = np.concatenate([wave(5), 0.1 * wave(9)], -1)
    assert npss(off, both) == pytest.approx(2 * 0.01 / 1.01)
    assert npss(3 * wave(5), wave(5)) == pytest.approx(0, abs=1e-9)  # the amplitude does not matter


def test_seams_are_where_it_changes_what_is_given():
    assert seams(gap(60, 20, 15)).tolist() == [19, 20, 34, 35]
    assert seams(gap(60, 0, 15)).tolist() == [14, 15]
    assert seams(keyframes(60, 30)).tolist() == [1, 29, 30, 31, 58]
    assert len(seams(np.ones((60, 21), bool))) == 0


def test_a_jump_of_velocity_is_seen_at_the_seam_only(walks):
    known = gap(60, 20, 15)
    still = np.zeros((1, 60, 21, 3))
    still[:, 20:, :, 0] = 0.05 * np.arange(1, 41)[:, None]  # 1 m/s from frame 20 on
    assert seam_jump(still, known)[0] == pytest.approx(1 / 4)  # one of four seam frames
    late = np.roll(still, 5, axis=1)
    late[:, :5] = 0
    assert seam_jump(late, known)[0] == pytest.approx(0, abs=1e-9)
    assert np.isnan(seam_jump(walks, np.ones((60, 21), bool))).all()
    assert (seam_jump(walks, known) > 0).all()


def test_linear_is_numpys_interpolation_and_keeps_what_is_given(walks):
    known = keyframes(60, 15)
    holes = np.where(known[..., None], walks[0], np.nan)
    made = linear(holes, known)
    assert np.array_equal(made[known], walks[0][known]) and np.isfinite(made).all()
    np.testing.assert_allclose(made[7], walks[0][0] + 7 / 15 * (walks[0][15] - walks[0][0]))
    only = np.zeros((60, 21), bool)
    only[30] = True
    held = linear(walks[0], only)
    assert np.array_equal(held[0], walks[0][30]) and np.array_equal(held[59], walks[0][30])


def test_arcs_keep_the_bones_where_lines_do_not(walks):
    known = keyframes(60, 20)
    straight, arcs = (f(walks[0], known)[None] for f in (linear, spherical))
    assert np.array_equal(arcs[0][known], walks[0][known])
    assert bone_rmse(arcs) < 0.01 < 0.3 < bone_rmse(straight)


def test_an_arc_turns_evenly():
    positions = np.zeros((11, 21, 3))
    positions[:, 1:] = [0.0, -0.1, 0.0]
    positions[10, 1:] = [0.1, 0.0, 0.0]  # the first bone turns by a right angle
    known = np.zeros((11, 21), bool)
    known[[0, 10]] = True
    bone = spherical(positions, known)[:, 1]
    angles = np.degrees(np.arctan2(bone[:, 0], -bone[:, 1]))
    np.testing.assert_allclose(angles, np.linspace(0, 90, 11), atol=1e-6)


@pytest.mark.parametrize("down", [[0.0, -0.1, 0.0], [0.06, 0.0, -0.08], [0.1 / 3**0.5] * 3])
def test_an_arc_between_opposite_directions_keeps_the_bone_and_turns_evenly(down):
    positions = np.zeros((11, 21, 3))
    positions[:, 1:] = down
    positions[10, 1:] = -np.array(down)
    known = np.zeros((11, 21), bool)
    known[[0, 10]] = True
    bone = spherical(positions, known)[:, 1]
    np.testing.assert_allclose(np.linalg.norm(bone, axis=-1), 0.1, atol=1e-12)
    angles = np.degrees(np.arccos(np.clip(bone @ down / 0.01, -1, 1)))
    np.testing.assert_allclose(angles, np.linspace(0, 180, 11), atol=1e-5)


def test_a_joint_that_is_never_given(walks):
    known = gap(60, 5, 10)
    known[:, 4] = False
    for way in (linear, spherical):
        with pytest.raises(ValueError, match="joint 4 is never given"):
            way(walks[0], known)
