"""Motion with other poses: feet and bones stay; limbs, pelvis and trunk move otherwise."""

import numpy as np
import pytest

from data_synth.levels import LEGS
from data_synth.mixed import motions
from data_synth.variations import (
    SPINE,
    UPPER,
    drawn_swings,
    drawn_turn,
    limbs_turned,
    pelvis_moved,
    with_upper_body_of,
)
from motiondiff_edu.metrics.bodies import bone_lengths
from motiondiff_edu.motion.dance_frame import facing
from motiondiff_edu.motion.inverse_kinematics import descendants
from motiondiff_edu.motion.skeleton import HEELS, HIPS, JOINTS, TOES, J, joint_index


@pytest.fixture(scope="module")
def two() -> list[np.ndarray]:
    """A walk of eight seconds, and a dance of six."""
    walk, dance = (positions for positions, _ in motions(2, 5, 8.0))
    return [walk, dance[:120]]


def test_what_hangs_on_a_joint_is_all_of_its_limb():
    assert [JOINTS[joint] for joint in descendants(joint_index("LeftArm"))] == [
        "LeftForeArm", "LeftHand", "LeftHandIndex1",
    ]  # fmt: skip
    assert set(descendants(joint_index("Spine"))) == set(UPPER) - {joint_index("Spine")}


def test_limbs_turn_and_legs_and_bones_stay(two):
    for seed, positions in enumerate(two):
        moved = limbs_turned(positions, np.random.default_rng(seed))
        np.testing.assert_allclose(moved[:, [HIPS, *LEGS]], positions[:, [HIPS, *LEGS]], atol=1e-9)
        np.testing.assert_allclose(bone_lengths(moved), bone_lengths(positions), atol=1e-9)
        hands = [joint_index("LeftHand"), joint_index("RightHand")]
        assert np.linalg.norm(moved - positions, axis=-1)[:, hands].max(0).min() > 0.03
        assert np.array_equal(moved, limbs_turned(positions, np.random.default_rng(seed)))
        fastest = [np.abs(np.diff(one, n=2, axis=0)).max() for one in (positions, moved)]
        # a limb that is turned outward is on a longer arm in the dance's own turns
        assert fastest[1] < 1.3 * fastest[0] + 0.1, "turns come and go smoothly"


def test_the_pelvis_moves_with_all_above_it_and_feet_and_bones_stay(two):
    feet = [*HEELS, *TOES]
    for seed, positions in enumerate(two):
        moved = pelvis_moved(positions, np.random.default_rng(seed))
        np.testing.assert_allclose(moved[:, feet], positions[:, feet], atol=5e-3)
        np.testing.assert_allclose(bone_lengths(moved), bone_lengths(positions), atol=1e-9)
        assert np.linalg.norm((moved - positions)[:, HIPS], axis=-1).max() > 0.01
        assert np.linalg.norm((moved - positions)[:, joint_index("Head")], axis=-1).max() > 0.05
        above = [
            np.linalg.norm(one[:, UPPER, None] - one[:, None, UPPER], axis=-1)
            for one in (moved, positions)
        ]
        np.testing.assert_allclose(*above, atol=1e-9)  # it moves as one piece
        assert np.array_equal(moved, pelvis_moved(positions, np.random.default_rng(seed)))


def test_a_pelvis_that_would_stretch_a_leg_comes_down(two):
    """If it did not, feet would be dragged along in a third of the frames."""
    walk, _ = two
    feet = [*HEELS, *TOES]
    for seed in range(12):
        moved = pelvis_moved(walk, np.random.default_rng(seed))
        assert (np.abs(moved[:, feet] - walk[:, feet]).max((1, 2)) > 0.01).mean() < 0.02


def test_turns_hold_a_pose_and_swing_within_their_angle():
    swings = np.stack([drawn_swings(200, np.random.default_rng(k), 20.0) for k in range(20)])
    assert swings.shape == (20, 200, 3) and np.abs(swings).max() <= 1 and swings.std() > 0.4
    angles = np.stack(
        [drawn_turn(200, 0.5, np.random.default_rng(k), 20.0).magnitude() for k in range(40)]
    )
    assert 0.3 < angles.max() <= 0.5 * (0.6 + 3**0.5)
    turns = [(np.diff(np.sign(np.diff(one[:, 0]))) != 0).sum() for one in swings]
    assert min(turns) < 6 < 20 < max(turns), "slow swings and fast ones"


def test_the_upper_body_is_the_others_and_faces_the_way_of_the_legs(two):
    legs, upper = two
    moved = with_upper_body_of(legs, upper)
    assert len(moved) == 160 and len(with_upper_body_of(upper, legs)) == 120
    kept = [HIPS, SPINE, *LEGS]  # hips and the lowest joint of the spine are one bone of a body
    np.testing.assert_allclose(moved[:, kept], legs[:, kept], atol=1e-9)
    np.testing.assert_allclose(bone_lengths(moved), bone_lengths(legs), atol=1e-9)
    moved = moved[:120]
    head = joint_index("Head")
    ahead = [
        np.einsum(
            "ti,ti->t", one[:, head] - one[:, SPINE], np.stack([np.sin(f), 0 * f, np.cos(f)], -1)
        )
        for one, f in ((moved, facing(moved)), (upper, facing(upper)))
    ]
    np.testing.assert_allclose(*ahead, atol=1e-9)
    assert len(UPPER) + len(LEGS) + 1 == J
