"""bone_lengths: exact on known stretches, and the floor that position noise sets."""

import numpy as np
import pytest
from gaits import control_of, gait, rest_pose

from motiondiff_edu.metrics.bodies import bone_lengths, bone_rmse, bone_rmse_within_clip
from motiondiff_edu.motion.root_frame import to_world
from motiondiff_edu.motion.skeleton import BONE_LENGTHS, MIRROR

STILL = np.tile(rest_pose(), (3, 7, 1, 1))  # (B, T, J, 3)


def test_the_skeleton_itself_has_no_error():
    assert bone_rmse(STILL) < 1e-12 and bone_rmse_within_clip(STILL) < 1e-12


def test_a_figure_one_percent_too_large_is_wrong_for_the_paper_and_rigid_within_the_clip():
    expected = 0.01 * 100 * np.sqrt(np.mean(BONE_LENGTHS**2))
    assert bone_rmse(1.01 * STILL) == pytest.approx(expected)
    assert bone_rmse_within_clip(1.01 * STILL) < 1e-12


def test_one_bone_longer_by_a_centimetre_in_half_of_the_frames():
    poses = np.tile(rest_pose(), (8, 1, 1))
    poses[::2, 4] += (
        0.01 * (rest_pose()[4] - rest_pose()[3]) / BONE_LENGTHS[3]
    )  # the left toe, away from its foot
    assert bone_rmse(poses) == pytest.approx(np.sqrt(0.5 / 20))
    assert bone_rmse_within_clip(poses) == pytest.approx(0.5 / np.sqrt(20))


def test_a_millimetre_of_noise_reads_as_a_seventh_of_a_centimetre():
    noise = np.random.default_rng(3).normal(0, 0.001, (5, 80, 21, 3))
    poses = np.tile(rest_pose(), (5, 80, 1, 1)) + noise
    assert bone_rmse(poses) == pytest.approx(0.1 * np.sqrt(2), rel=0.05)


def test_root_frame_world_and_mirror_image_agree():
    control = control_of(5, 1.1, 0.2, 0.7)
    poses = gait(control)
    world = to_world(poses, control, (3.0, -2.0, 1.0))
    assert bone_rmse(world) == pytest.approx(bone_rmse(poses))
    assert bone_rmse(poses[:, MIRROR] * [-1, 1, 1]) == pytest.approx(bone_rmse(poses))


def test_joints_of_another_skeleton_are_refused():
    with pytest.raises(ValueError, match="22.*retarget"):
        bone_lengths(np.zeros((4, 22, 3)))
