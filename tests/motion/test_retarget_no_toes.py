"""Figures without toes and end sites.

They stand on their ankles, at any rate, with flat feet of ours.
"""

from dataclasses import replace

import numpy as np
import pytest
from foreign_walk import foreign, sound, without

from motiondiff_edu.motion.formats.bvh import read_bvh
from motiondiff_edu.motion.formats.dialects import guess_mapping
from motiondiff_edu.motion.resample import resample, resample_present
from motiondiff_edu.motion.retarget import retarget
from motiondiff_edu.motion.skeleton import BONE_LENGTHS, TOES

LEGS_AND_FEET = {2, 3, 4, 6, 7, 8}  # what a foot of another size moves
OTHERS = [j for j in range(21) if j not in LEGS_AND_FEET]
TOE_NAMES = {"LeftToeBase", "RightToeBase"}


def test_joints_that_a_file_lacks_stay_unknown_and_the_others_are_resampled():
    points = np.random.default_rng(6).normal(size=(47, 21, 3))
    cut = points.copy()
    cut[:, [4, 16]] = np.nan
    for fps, count in ((120.0, 8), (30.0, 31)):  # with the low-pass before the spline, and without
        whole = resample(points, fps, 20.0)
        partly = resample_present(cut, fps, 20.0)
        assert partly.shape == (count, 21, 3)
        assert np.isnan(partly[:, [4, 16]]).all()
        others = [j for j in range(21) if j not in (4, 16)]
        np.testing.assert_allclose(partly[:, others], whole[:, others])


@pytest.mark.parametrize(("fps", "frames"), [(120, 361), (30, 91), (20, 61)])
def test_a_walk_without_toes_is_the_walk_with_other_feet(tmp_path, fps, frames):
    bvh = read_bvh(foreign(tmp_path / "walk.bvh", fps=fps, frames=frames))
    bare = without(bvh, TOE_NAMES)
    assert not TOE_NAMES & set(guess_mapping(bare))
    whole, clip = retarget(bvh), retarget(bare)
    sound(clip)
    assert len(clip) == len(whole) == 61
    assert clip.control[:, 0].mean() == pytest.approx(whole.control[:, 0].mean(), rel=0.02)
    assert np.abs(clip.control[:, 1:]).max() < 0.08
    assert np.abs(clip.poses - whole.poses)[:, OTHERS].max() < 0.05


@pytest.mark.parametrize("offset", [0.0, 0.03])  # inches; 0.8 mm
@pytest.mark.parametrize("tip", ["HandIndex1", "ToeBase"])
def test_a_tip_on_its_own_joint_is_a_missing_one(tmp_path, tip, offset):
    bvh = read_bvh(foreign(tmp_path / "walk.bvh"))
    mapping = guess_mapping(bvh)
    offsets = bvh.offsets.copy()
    offsets[[bvh.names.index(mapping[side + tip]) for side in ("Left", "Right")]] = [0, -offset, 0]
    clip = retarget(replace(bvh, offsets=offsets), mapping)
    sound(clip)
    if tip == "ToeBase":
        lacking = retarget(without(bvh, TOE_NAMES))
        np.testing.assert_allclose(clip.poses, lacking.poses, atol=1e-9)
    for elbow, wrist, end in ((14, 15, 16), (18, 19, 20)) if tip == "HandIndex1" else ():
        forearm, hand = (
            np.diff(clip.poses[:, pair], axis=1)[:, 0] for pair in ((elbow, wrist), (wrist, end))
        )
        straight = (forearm * hand).sum(-1) / BONE_LENGTHS[wrist - 1] / BONE_LENGTHS[end - 1]
        np.testing.assert_allclose(straight, 1, atol=1e-9)


def test_a_real_walk_without_toes(real_data):
    bvh = read_bvh(real_data / "bvh/cmu_02_01_walk.bvh")
    clip, whole = retarget(without(bvh, TOE_NAMES)), retarget(bvh)
    lift = sound(clip)[:, list(TOES), 1].max(0)
    assert clip.control[:, 0].mean() == pytest.approx(whole.control[:, 0].mean(), rel=0.02)
    assert np.abs(clip.poses - whole.poses)[:, OTHERS].max() < 0.05
    assert (0.05 < lift).all() and (lift < 0.25).all() and 0.3 < clip.contacts.mean() < 0.75
