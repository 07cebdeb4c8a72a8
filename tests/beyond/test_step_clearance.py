"""Step clearance: planted toes lie on the floor, swinging toes over it; bones and given stay."""

import numpy as np
import pytest

from data_synth.walking import walk
from motiondiff_edu.beyond.step_clearance import CLEARANCE, SHARE, clear_steps, height_over
from motiondiff_edu.conditions.control import constant_control
from motiondiff_edu.editing.masks import keyframes
from motiondiff_edu.metrics.bone_lengths import bone_lengths
from motiondiff_edu.metrics.skating import skating
from motiondiff_edu.motion.inverse_kinematics import drag
from motiondiff_edu.motion.skeleton import HEELS, HIPS, LEFT, RIGHT, TOES

LEGS = [joint for side in (LEFT, RIGHT) for joint in side if joint < 9]


@pytest.fixture(scope="module")
def world() -> np.ndarray:
    return walk(constant_control(1.1, seconds=6.0), seed=3).world()


@pytest.fixture(scope="module")
def low(world) -> np.ndarray:
    """The walk whose toes swing at a tenth of their height, and hover two centimetres in stance."""
    moved = np.array(world)
    for toe, heel in zip(TOES, HEELS, strict=True):
        for t in range(len(moved)):
            height = 0.1 * moved[t, toe, 1] if moved[t, toe, 1] > 0.005 else 0.02
            moved[t] = drag(moved[t], heel, moved[t, heel] + [0, height - moved[t, toe, 1], 0])
    return moved


def sliding(positions: np.ndarray) -> float:
    return float(skating(positions[None], np.zeros((1, len(positions), 3)))[0])


def test_feet_that_pass_too_low_are_lifted_and_no_longer_seem_to_slide(world, low):
    nothing = np.zeros(low.shape[:2], bool)
    lifted = clear_steps(low, nothing)
    assert sliding(low) > 1.0 and sliding(lifted) < 0.1 * sliding(low)
    np.testing.assert_allclose(bone_lengths(lifted), bone_lengths(low), atol=2e-3)
    others = [joint for joint in range(21) if joint not in LEGS]
    assert np.array_equal(lifted[:, others], low[:, others])
    assert (np.abs(lifted - low)[..., [0, 2]].max(0)[[*TOES, *HEELS]] < 0.02).all()


def test_a_good_walk_is_hardly_changed(world):
    moved = clear_steps(world, np.zeros(world.shape[:2], bool))
    assert np.abs(moved - world)[:, [*TOES, *HEELS]].max() < 0.03
    assert np.median(np.abs(moved - world)) < 1e-3


def test_given_joints_stay_and_heights_go_to_them_smoothly(low):
    known = keyframes(len(low), 20)
    moved = clear_steps(low, known)
    assert np.array_equal(moved[known], low[known])
    jumps = [np.abs(np.diff(one[:, list(TOES), 1], axis=0)).max() for one in (low, moved)]
    assert jumps[1] < jumps[0] + 0.03


def test_the_height_of_one_step_by_hand():
    toe = np.zeros((12, 3))
    toe[:, 1] = 0.01
    toe[4:9, 2], toe[9:, 2] = np.linspace(0.02, 0.08, 5), 0.1
    standing = np.r_[np.ones(4, bool), np.zeros(5, bool), np.ones(3, bool)]
    height = height_over(toe, standing, np.zeros(12, bool), 0.0)
    assert np.array_equal(height[standing], np.zeros(7))
    share = np.sin(np.pi * np.arange(1, 6) / 6)
    np.testing.assert_allclose(height[4:9], SHARE * 0.1 * share)
    toe[9:, 2] = 2.0
    np.testing.assert_allclose(
        height_over(toe, standing, np.zeros(12, bool), 0.0)[6], CLEARANCE, atol=1e-12
    )
    higher = height_over(toe + [0, 1.0, 0], standing, np.zeros(12, bool), 0.0)
    np.testing.assert_allclose(higher, 1.01)  # it stands on something
    assert np.array_equal(height_over(toe, standing, np.ones(12, bool), 0.0), toe[:, 1])


def test_a_step_without_beginning_or_end_is_left(world):
    toe = np.full((6, 3), 0.01)
    nobody = np.zeros(6, bool)
    assert np.array_equal(height_over(toe, nobody, nobody, 0.0), toe[:, 1])
    assert clear_steps(world[:1], np.zeros((1, 21), bool)).shape == (1, 21, 3)
    assert HIPS not in LEGS
