"""Motion at other levels: feet and bones stay, the figure goes lower and leans, smoothly."""

import numpy as np
import pytest

from data_synth.levels import LOWEST, at_levels, leaning, wave
from data_synth.mixed import motions
from motiondiff_edu.metrics.bodies import bone_lengths
from motiondiff_edu.motion.skeleton import HEELS, HIPS, TOES, joint_index

FEET = [*HEELS, *TOES]


@pytest.fixture(scope="module")
def made() -> list[tuple[np.ndarray, np.ndarray]]:
    upright = [positions for positions, _ in motions(6, 5, 8.0)]
    return [(one, at_levels(one, np.random.default_rng(k))) for k, one in enumerate(upright)]


def test_feet_stay_and_bones_keep_their_lengths(made):
    for upright, lower in made:
        np.testing.assert_allclose(lower[:, FEET], upright[:, FEET], atol=5e-3)
        np.testing.assert_allclose(bone_lengths(lower), bone_lengths(upright), atol=1e-9)
        assert lower[..., 1].min() > -0.01


def test_the_pelvis_goes_straight_down_by_at_most_half_a_metre(made):
    drops = [upright[:, HIPS] - lower[:, HIPS] for upright, lower in made]
    assert all(np.abs(drop[:, [0, 2]]).max() < 1e-9 for drop in drops)
    assert all(-1e-9 <= drop[:, 1].min() and drop[:, 1].max() <= LOWEST for drop in drops)
    assert max(drop[:, 1].max() for drop in drops) > 0.2


def test_knees_bend_forwards(made):
    for upright, lower in made:
        forward = np.cross(upright[:, 1] - upright[:, 5], [0.0, 1.0, 0.0])
        for heel in HEELS:
            middle = (lower[:, heel - 2] + lower[:, heel]) / 2
            bent = np.linalg.norm(lower[:, heel - 1] - middle, axis=-1) > 0.1
            ahead = ((lower[:, heel - 1] - middle) * forward).sum(-1)
            assert (ahead[bent] > 0).mean() > 0.9


def test_positive_leaning_is_forward():
    upright, _ = next(iter(motions(1, 5, 2.0)))
    head = joint_index("Head")
    moved = leaning(upright, np.full(len(upright), 0.5))
    forward = np.cross(upright[:, 1] - upright[:, 5], [0.0, 1.0, 0.0])
    assert (((moved - upright)[:, head] * forward).sum(-1) > 0).all()
    assert (moved[:, head, 1] < upright[:, head, 1]).all()
    assert np.array_equal(moved[:, FEET], upright[:, FEET])


def test_waves_are_smooth_and_drawn_by_their_generator():
    waves = np.stack([wave(200, np.random.default_rng(k), 20.0) for k in range(20)])
    assert waves.min() >= 0 and waves.max() <= 1 and waves.std() > 0.15
    assert np.abs(np.diff(waves, axis=1)).max() < 0.1
    assert np.array_equal(waves[3], wave(200, np.random.default_rng(3), 20.0))
