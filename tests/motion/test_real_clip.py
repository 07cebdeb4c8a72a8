"""The main job on real input.

A motion-capture clip is retargeted, continued under new control, and written as BVH.
"""

import numpy as np
import pytest
import torch

from motiondiff_edu.conditions.control import joystick, splice
from motiondiff_edu.metrics.bodies import bone_rmse
from motiondiff_edu.metrics.walks import adherence
from motiondiff_edu.motion.formats.bvh import read_bvh
from motiondiff_edu.motion.formats.bvh.write import write_bvh
from motiondiff_edu.motion.retarget import load_clip
from motiondiff_edu.motion.root_frame import to_world
from motiondiff_edu.motion.skeleton import JOINTS
from motiondiff_edu.pretrained.checkpoints import available, load
from motiondiff_edu.rollout import generate

SECONDS = 10


@pytest.mark.skipif("walker" not in available(), reason="no walker is shipped: run make pretrained")
def test_a_real_clip_goes_on_under_new_control_and_comes_back_from_its_file(real_data, tmp_path):
    clip = load_clip(real_data / "bvh" / "cmu_02_01_walk.bvh")
    walker, T_h = load("walker"), load("walker").config.T_h
    ahead = joystick([(3, 1.2, 0.0, 0.0), (3, 1.0, 0.0, 0.5), (4, 1.4, 0.0, -0.3)])[: SECONDS * 20]
    control = splice(clip.control, ahead, T_h)
    past = torch.from_numpy(clip.features()[-T_h:])
    new = generate(walker, past, torch.from_numpy(control.astype(np.float32)), steps=10, seed=1)
    assert new.shape == (SECONDS * 20, 63)

    poses = torch.cat([past, new]).double().numpy().reshape(-1, len(JOINTS), 3)
    assert bone_rmse(poses[T_h:]) < 0.5  # cm: a body, not a cloud
    own = adherence(
        poses[T_h:], ahead
    )  # m/s: the feet go where they are told, and not where others are told
    assert own < 0.05 < 0.12 < adherence(poses[T_h:], ahead[::-1])
    first = np.abs(poses[T_h] - poses[T_h - 1]).max()
    assert first < 0.35  # metres: it goes on from where the clip ended
    lowest = poses[T_h:, :, 1].min(1)
    assert -0.1 < lowest.mean() < 0.06  # metres: it stands on the floor
    steps = np.abs(np.diff(poses[T_h:, 4, 2])).sum() / SECONDS
    assert steps > 0.5  # metres a second: the left toe swings, the figure does not glide

    world = to_world(poses, control)
    report = write_bvh(tmp_path / "continued.bvh", world)
    back = read_bvh(tmp_path / "continued.bvh")
    positions = (
        back.world_positions()[:, [back.names.index(name) for name in JOINTS]] / 100
    )  # the file is in cm
    assert np.abs(positions - report.positions).max() < 1e-3
