"""The dance frame: there and back, where a dance starts, and its mirror."""

import numpy as np
import pytest
import torch

from motiondiff_edu.motion.dance_frame import at_origin, facing, mirror, to_features, to_positions
from motiondiff_edu.motion.kinematics import rot_y
from motiondiff_edu.motion.skeleton import HIPS, LEFT, RIGHT


def dance(seed: int = 0) -> np.ndarray:
    from data_synth.walking import random_control, walk

    rng = np.random.default_rng(seed)
    return walk(random_control(2, rng, "turn"), seed).poses


def test_there_and_back():
    placed = at_origin(dance())
    features = to_features(dance())
    assert features.shape == (len(placed), 63)
    np.testing.assert_allclose(to_positions(torch.from_numpy(features)).numpy(), placed, atol=1e-12)
    np.testing.assert_allclose(features[:, :3], placed[:, HIPS])
    np.testing.assert_allclose(features[:, 3:6], placed[:, 1] - placed[:, 0])


def test_wherever_and_however_turned_a_dance_has_the_same_features():
    moved = dance(1) @ rot_y(np.array(2.3)).T + np.array([4.0, 0.0, -7.0])
    np.testing.assert_allclose(to_features(moved), to_features(dance(1)), atol=1e-12)
    placed = at_origin(moved)
    np.testing.assert_allclose(placed[0, HIPS, [0, 2]], 0, atol=1e-12)
    assert facing(placed[:1])[0] == pytest.approx(0, abs=1e-12)
    assert facing(moved[:1])[0] == pytest.approx(facing(dance(1)[:1])[0] + 2.3)
    np.testing.assert_allclose(moved[..., 1], placed[..., 1])  # heights are heights


def test_mirrored_twice_is_itself_and_left_is_right():
    motion = at_origin(dance(2))
    np.testing.assert_allclose(mirror(mirror(motion)), motion)
    np.testing.assert_allclose(mirror(motion)[:, LEFT] * [-1, 1, 1], motion[:, RIGHT])
    assert facing(mirror(motion))[7] == pytest.approx(-facing(motion)[7])


def test_another_skeleton_is_refused():
    with pytest.raises(ValueError, match="21 joints"):
        to_features(np.zeros((4, 22, 3)))
