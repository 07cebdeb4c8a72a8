"""Repetition: a loop is 1, noise near 0, and neither place nor heading counts."""

import numpy as np
import pytest
from gaits import rest_pose
from scipy.ndimage import gaussian_filter1d

from motiondiff_edu.metrics.bodies import (
    autocorrelation,
    pose_changes,
    repeat_score,
    self_similarity,
)

RNG = np.random.default_rng(1)


def aimless(frames, smooth=4, mode="reflect", seed=2):
    noise = np.random.default_rng(seed).normal(size=(frames, 21, 3))
    return rest_pose() + 0.15 * gaussian_filter1d(noise, smooth, axis=0, mode=mode)


def loop(times=4, frames=50):
    """Two and a half seconds, over and over."""
    return np.tile(aimless(frames, mode="wrap"), (times, 1, 1))


def turned(positions, angles, places):
    """The same poses, each turned about y by its angle and put somewhere else."""
    sin, cos = np.sin(angles)[:, None], np.cos(angles)[:, None]
    x, y, z = np.moveaxis(positions, -1, 0)
    return np.stack([x * cos + z * sin, y, z * cos - x * sin], -1) + places[:, None] * [
        1.0,
        0.0,
        1.0,
    ]


def test_a_loop_repeats_after_its_length():
    x = pose_changes(loop())
    assert autocorrelation(x, 50) == pytest.approx(1.0) == autocorrelation(x, 100)
    assert repeat_score(loop()) == pytest.approx(1.0)
    assert max(autocorrelation(x, lag) for lag in range(20, 45)) < 0.5


def test_noise_and_aimless_movement_do_not_repeat():
    noise = rest_pose() + RNG.normal(0, 0.1, (160, 21, 3))
    assert repeat_score(noise) < 0.1
    assert repeat_score(aimless(160)) < 0.3
    assert autocorrelation(pose_changes(aimless(160)), 0) == pytest.approx(1.0)


def test_place_and_heading_do_not_count():
    angles = np.cumsum(RNG.normal(0, 0.3, 200))
    places = np.cumsum(RNG.normal(0, 0.1, (200, 1)), 0)
    elsewhere = turned(loop(), angles, places)
    np.testing.assert_allclose(pose_changes(elsewhere), pose_changes(loop()), atol=1e-9)
    assert repeat_score(elsewhere) == pytest.approx(1.0)


def test_the_matrix_is_that_of_cosines():
    positions = aimless(9)
    matrix, x = self_similarity(positions), pose_changes(positions)
    assert (
        matrix.shape == (9, 9) and np.allclose(np.diag(matrix), 1) and np.allclose(matrix, matrix.T)
    )
    assert matrix[2, 7] == pytest.approx(x[2] @ x[7] / np.linalg.norm(x[2]) / np.linalg.norm(x[7]))
    to_and_fro = rest_pose() + 0.1 * np.array([1.0, -1.0])[:, None, None] * RNG.normal(
        size=(21, 3)
    ) * [0, 1, 0]
    np.testing.assert_allclose(self_similarity(to_and_fro), [[1, -1], [-1, 1]], atol=1e-9)


def test_autocorrelation_by_hand():
    """One joint up and down.

    x = +1, -1, +1, -1 ... is opposite at odd lags and the same at even ones.
    """
    positions = np.tile(rest_pose(), (60, 1, 1))
    positions[:, 12, 1] += 0.1 * (-1.0) ** np.arange(60)
    found = [autocorrelation(pose_changes(positions), lag) for lag in range(21)]
    np.testing.assert_allclose(found, (-1.0) ** np.arange(21), atol=1e-9)
    assert repeat_score(positions) == pytest.approx(1.0)  # at the one lag that fits, a second


@pytest.mark.parametrize(
    "positions, told",
    [
        (np.tile(rest_pose(), (90, 1, 1)), "keeps one pose"),
        (aimless(50), "too short for a lag"),
        (np.where(np.arange(90)[:, None, None] == 3, np.nan, aimless(90)), "NaN"),
    ],
)
def test_what_cannot_repeat_is_refused(positions, told):
    with pytest.raises(ValueError, match=told):
        repeat_score(positions)
