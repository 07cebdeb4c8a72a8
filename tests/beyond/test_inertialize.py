"""Inertialisation: value and slope at the seam, nothing after half a second, bones as generated."""

import numpy as np
import pytest
from synthetic_walk import walk

from motiondiff_edu.beyond.inertialize import LONGEST, SECONDS, fading, inertialized, seconds_for
from motiondiff_edu.metrics.bone_lengths import bone_lengths

N = round(20 * SECONDS)


def test_the_offset_fades_from_its_value_and_its_slope_to_nothing():
    offset, speed = np.array([[1.0, -2.0, 0.0]]), np.array([[0.0, 0.3, 0.5]])
    fine = 1000  # frames: the polynomial and its derivatives, nearly continuous
    found = fading(offset, speed / fine, fine)
    np.testing.assert_allclose(found[0], offset)
    np.testing.assert_allclose((found[1] - found[0]) * fine, speed, atol=2e-2)
    end = found[-5:, 0]
    for order in range(4):  # value and three derivatives by the frame
        assert np.abs(np.diff(end, n=order, axis=0)).max() < 1e-8
    assert fading(offset, speed, 10).shape == (10, 1, 3)


def poses(seed: int, frames: int = 60) -> np.ndarray:
    clip = walk(frames=frames, turn=0.3 * seed)
    return clip[0] - clip[0][:, :1] * [1.0, 0.0, 1.0]


def test_the_first_frame_goes_on_as_the_past_did():
    past, new = poses(1)[:10], poses(2)[25:55]
    made = inertialized(past, new)
    before, step = past[-1] - past[-2], made[0] - past[-1]
    assert np.abs(step - before).max() < 0.01  # metres; directions are set to length one
    assert np.abs(new[0] - past[-1]).max() > 3 * np.abs(step).max()
    np.testing.assert_array_equal(made[N:], new[N:])
    np.testing.assert_allclose(bone_lengths(made), bone_lengths(new), atol=1e-12)


def test_what_does_not_jump_stays_nearly_as_it_is():
    whole = poses(1)
    made = inertialized(whole[:20], whole[20:])
    assert np.abs(made - whole[20:]).max() < 0.06  # a foot in the air is quick to slow down


@pytest.mark.parametrize(("far", "seconds"), [(0.1, SECONDS), (0.9, 0.9), (4.0, LONGEST)])
def test_a_joint_that_has_far_to_go_gets_more_time(far, seconds):
    past, new = np.zeros((2, 21, 3)), np.zeros((60, 21, 3))
    new[:, 7, 1] = far
    assert seconds_for(past, new) == pytest.approx(seconds)


def test_nobody_flies_down_from_where_they_hang():
    """Poses a metre lower: the pelvis is there after a second, and never faster than 3 m/s."""
    past, new = poses(1)[:10], poses(1)[10:50] - [0.0, 1.0, 0.0]
    down = np.concatenate([past[-1:], inertialized(past, new)])[:, 0, 1]
    assert 20 * np.abs(np.diff(down)).max() < 3.0
    np.testing.assert_allclose(down[21:], new[20:, 0, 1])


@pytest.mark.parametrize("frames", [1, 2, 5])
def test_few_frames_are_joined_too(frames):
    past, new = poses(1)[:10], poses(2)[25 : 25 + frames]
    made = inertialized(past, new)
    assert made.shape == new.shape and np.isfinite(made).all()
