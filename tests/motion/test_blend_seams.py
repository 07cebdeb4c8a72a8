"""Seams: value and slope, nothing after a while, bones as generated, both ends of a gap."""

import numpy as np
import pytest
from synthetic_walk import walk

from motiondiff_edu.metrics.bodies import bone_lengths
from motiondiff_edu.metrics.keyframes import seam_jump
from motiondiff_edu.motion.cleanup import LONGEST, SECONDS, blend_seams, continue_smoothly, fade_out

N = round(20 * SECONDS)


def test_the_offset_fades_from_its_value_and_its_slope_to_nothing():
    offset, speed = np.array([[1.0, -2.0, 0.0]]), np.array([[0.0, 0.3, 0.5]])
    fine = 1000  # frames: the polynomial and its derivatives, nearly continuous
    found = fade_out(offset, speed / fine, fine)
    np.testing.assert_allclose(found[0], offset)
    np.testing.assert_allclose((found[1] - found[0]) * fine, speed, atol=2e-2)
    end = found[-5:, 0]
    for order in range(4):  # value and three derivatives by the frame
        assert np.abs(np.diff(end, n=order, axis=0)).max() < 1e-8
    assert fade_out(offset, speed, 10).shape == (10, 1, 3)


def poses(seed: int, frames: int = 60) -> np.ndarray:
    clip = walk(frames=frames, turn=0.3 * seed)
    return clip[0] - clip[0][:, :1] * [1.0, 0.0, 1.0]


def test_the_first_frame_goes_on_as_the_past_did():
    past, new = poses(1)[:10], poses(2)[25:55]
    made = continue_smoothly(past[-2:], new, 20)
    step, expected = made[0] - past[-1], (past[-1] - past[-2] + new[1] - new[0]) / 2
    assert np.abs(step - expected).max() < 0.02  # metres; directions are set to length one
    assert np.abs(new[0] - past[-1]).max() > 3 * np.abs(step).max()
    np.testing.assert_array_equal(made[N:], new[N:])
    np.testing.assert_allclose(bone_lengths(made), bone_lengths(new), atol=1e-12)


def test_what_does_not_jump_stays_nearly_as_it_is():
    whole = poses(1)
    made = continue_smoothly(whole[18:20], whole[20:], 20)
    assert np.abs(made - whole[20:]).max() < 0.03


@pytest.mark.parametrize(("far", "seconds"), [(0.1, SECONDS), (0.9, 0.9), (4.0, LONGEST)])
def test_a_joint_that_has_far_to_go_gets_more_time(far, seconds):
    past = poses(1)[:2]
    new = np.repeat(past[1:], 60, axis=0)
    new[:, :, 1] += far
    moved = np.abs(continue_smoothly(past, new, 20) - new).max((1, 2)) > 0
    assert np.flatnonzero(moved)[-1] + 1 == round(20 * seconds)


def test_nobody_flies_down_from_where_they_hang():
    """Poses a metre lower: the pelvis is there after a second, and never faster than 3 m/s."""
    past, new = poses(1)[:10], poses(1)[10:50] - [0.0, 1.0, 0.0]
    down = np.concatenate([past[-1:], continue_smoothly(past[-2:], new, 20)])[:, 0, 1]
    assert 20 * np.abs(np.diff(down)).max() < 3.0
    np.testing.assert_allclose(down[21:], new[20:, 0, 1])


@pytest.mark.parametrize("frames", [1, 2, 5])
def test_few_frames_are_joined_too(frames):
    past, new = poses(1)[:10], poses(2)[25 : 25 + frames]
    made = continue_smoothly(past[-2:], new, 20)
    assert made.shape == new.shape and np.isfinite(made).all()


def whole_frames(known: list[int], frames: int = 60) -> np.ndarray:
    return np.isin(np.arange(frames), known)[:, None].repeat(21, 1)


def test_both_ends_of_a_gap_go_on_as_what_is_given_does():
    truth, known = poses(1), whole_frames([*range(20), *range(45, 60)])
    made = np.where(known[..., None], truth, poses(2) + [0.1, 0.0, 0.2])
    joined = blend_seams(made, known, 20)
    assert np.array_equal(joined[known], made[known])
    for at, beside in ((20, 19), (44, 45)):
        other, on = made[2 * beside - at], 2 * at - beside
        expected = made[beside] + (made[beside] - other + made[on] - made[at]) / 2
        assert np.abs(joined[at] - expected).max() < 0.02 < 0.2 < np.abs(made[at] - expected).max()
    backwards = blend_seams(made[::-1], known[::-1], 20)[::-1]
    assert np.abs(backwards - joined).max() < 0.1  # the two ends overlap a little


def test_a_keyframe_is_passed_at_one_speed():
    """The figure comes to the keyframe at one speed and leaves it at another one."""
    known = whole_frames([0, 30, 59])
    made = poses(1)[:1].repeat(60, 0)
    made[:, :, 2] += np.interp(np.arange(60), [0, 30, 59], [0.0, 3.0, 3.5])[:, None]
    joined = blend_seams(made, known, 20)
    middle = whole_frames([30])
    assert seam_jump(joined[None], middle)[0] < 0.8 * seam_jump(made[None], middle)[0]
    before, after = joined[30] - joined[29], joined[31] - joined[30]
    np.testing.assert_allclose(before, after, atol=1e-2)
    np.testing.assert_allclose(joined[[0, 30, 59]], made[[0, 30, 59]])


def test_frames_with_a_known_joint_and_ends_that_are_not_given_stay():
    made = poses(2)
    for known in (whole_frames([]), whole_frames([0]), whole_frames([59])):
        assert np.array_equal(blend_seams(made, known, 20), made)
    part = whole_frames(list(range(20)))
    part[:, 0] = True
    assert np.array_equal(blend_seams(made, part, 20), made)
    beside = whole_frames(list(range(20)))
    beside[19, 5:] = False  # the frame before the gap is not given as a whole
    assert np.array_equal(blend_seams(made, beside, 20), made)
