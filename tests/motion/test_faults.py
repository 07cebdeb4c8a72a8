"""What cannot be right in a capture is found, and only that."""

import warnings

import numpy as np
import pytest
import torch

from motiondiff_edu.editing.inbetween import clean_samples
from motiondiff_edu.editing.inpaint import guide_and_blend, inpaint
from motiondiff_edu.metrics.bodies import bone_lengths
from motiondiff_edu.motion.faults import wild_joints
from motiondiff_edu.motion.retarget import load_clip
from motiondiff_edu.motion.skeleton import HIPS, JOINTS
from motiondiff_edu.pretrained import checkpoints


def test_moments_of_one_fault_are_joined_and_given_a_margin():
    speeds = np.ones((240, 21))  # 2 s at 120 frames/s
    speeds[[60, 96], 4] = 20.0  # 0.5 s and 0.8 s: exchanged, and exchanged back
    speeds[100, 7] = 11.0  # hasty beside it
    speeds[200, 4] = 11.0  # 0.87 s later: another fault
    found = wild_joints(speeds, 120.0, 40, 20.0)
    assert np.flatnonzero(found[:, 4]).tolist() == [*range(9, 18), *range(32, 36)]
    assert np.flatnonzero(found[:, 7]).tolist() == list(range(15, 19))
    assert not np.delete(found, [4, 7], axis=1).any()


def test_fast_is_not_wild():
    speeds = np.full((100, 21), 12.0)
    assert not wild_joints(speeds, 60.0, 33, 20.0).any()


def test_where_the_pelvis_is_doubted_all_is():
    speeds = np.ones((100, 21))
    speeds[50, HIPS] = 30.0
    found = wild_joints(speeds, 50.0, 40, 20.0)
    assert found[20].all() and found.any(1).sum() == found.all(1).sum() == 3


def test_the_swapped_markers_of_a_real_dance(real_data):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        clip = load_clip(real_data / "bvh" / "cmu_acrnn_salsa_10.bvh")
        calm = load_clip(real_data / "bvh" / "cmu_02_01_walk.bvh")
    wild = clip.info["wild"]
    assert wild.shape == (len(clip), 21) and not calm.info["wild"].any()
    frames = np.flatnonzero(wild[:, JOINTS.index("RightToeBase")])
    assert 45 <= frames[0] < frames[-1] <= 63  # frames 270 to 366 of the file, at 120 frames/s
    assert not wild[:40].any() and not wild[70:].any()
    assert wild[:, JOINTS.index("LeftForeArm")].sum() < len(frames)


@pytest.mark.parametrize("whole", [False, True])
def test_the_swapped_markers_are_mended(real_data, whole):
    """Before, feet are thrown about.

    After, in the middle one of three draws, no more than elsewhere in the dance; and bones keep
    their lengths.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        clip = load_clip(real_data / "bvh" / "cmu_acrnn_salsa_10.bvh")
    before, wild = clip.world(), clip.info["wild"]
    known = ~np.repeat(wild.any(1, keepdims=True), 21, axis=1) if whole else ~wild
    network = checkpoints.load("unconditional")
    draw = torch.Generator().manual_seed(0)
    how = {"samples": 3, "steps": 10, "generator": draw, "steer": guide_and_blend}
    draws = clean_samples(inpaint(network, before, known, **how), known)
    assert all(np.array_equal(after[known], before[known]) for after in draws)
    assert all(np.ptp(bone_lengths(after), axis=0).max() < 0.002 for after in draws)
    feet = [JOINTS.index(name) for name in ("LeftToeBase", "RightToeBase")]
    thrown, *made = (
        400 * np.linalg.norm(np.diff(x, 2, axis=0), axis=-1)[:, feet] for x in (before, *draws)
    )  # m/s^2
    calm = np.median([one[46:64].max() for one in made])
    assert thrown[46:64].max() > 150 and calm < max(90, thrown[70:].max())
