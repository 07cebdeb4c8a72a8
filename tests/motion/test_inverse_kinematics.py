"""A dragged joint.

Where it comes to, that no bone changes its length, that what need not move stays.
"""

import numpy as np
import pytest

from data_synth.walking import random_control, walk
from motiondiff_edu.motion.inverse_kinematics import (
    ankles_dragged,
    chain_to,
    descendants,
    drag,
    fabrik,
    tow_limb,
    two_bones,
)
from motiondiff_edu.motion.root_frame import to_world
from motiondiff_edu.motion.skeleton import (
    BONES,
    HEELS,
    JOINTS,
    OFFSETS,
    PARENTS,
    TOES,
    J,
    joint_index,
)

BENDS = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0]])
HAND, ANKLE, ELBOW, TIP = (
    joint_index(name) for name in ("LeftHand", "RightFoot", "LeftForeArm", "LeftHandIndex1")
)


def rest() -> np.ndarray:
    """Standing, arms out sideways, every limb straight."""
    pose = np.zeros((J, 3))
    for j in range(J):
        pose[j] = OFFSETS[j] + (pose[PARENTS[j]] if j else 0)
    return pose


@pytest.fixture(scope="module")
def pose():
    walked = walk(random_control(3.0, np.random.default_rng(2), "turn"), 2)
    return to_world(walked.poses, walked.control, (1.0, -2.0, 0.8))[31]


def bones(pose: np.ndarray) -> np.ndarray:
    return np.array([np.linalg.norm(pose[child] - pose[parent]) for parent, child in BONES])


def test_two_bones_make_the_triangle_of_their_lengths():
    limb = np.array([[0.0, 0, 0], [0, -3, 0.1], [0, -6.9, 0]])
    limb[1] *= 3 / np.linalg.norm(limb[1])
    limb[2] = limb[1] + 4 * (limb[2] - limb[1]) / np.linalg.norm(limb[2] - limb[1])
    root, middle, end = two_bones(
        limb, np.array([0.0, -5, 0]), BENDS
    )  # 3, 4, 5: the right angle is at the middle
    np.testing.assert_allclose(
        [root, middle, end], [[0, 0, 0], [0, -1.8, 2.4], [0, -5, 0]], atol=1e-12
    )
    far = two_bones(limb, np.array([0.0, -20, 0]), BENDS)[2]
    assert np.allclose(far / np.linalg.norm(far), [0, -1, 0]) and 6.99 < np.linalg.norm(far) < 7


def test_the_bend_turns_with_the_limb_and_does_not_flip():
    """A leg swung from hanging down to pointing ahead.

    The knee goes from ahead to up, never through the leg.
    """
    down = two_bones(
        np.array([[0.0, 0, 0], [0, -1, 0], [0, -2, 0]]), np.array([0.0, -1.9, 0]), BENDS
    )
    assert down[1, 2] > 0.3, "a straight leg bends ahead"
    for angle in np.linspace(0, np.pi / 2, 19):
        target = 1.9 * np.array([0, -np.cos(angle), np.sin(angle)])
        knee = two_bones(down, target, BENDS)[1]
        aside = np.array([0, np.sin(angle), np.cos(angle)])
        np.testing.assert_allclose(knee, target / 2 + np.sqrt(1 - 0.95**2) * aside, atol=1e-9)


@pytest.mark.parametrize("target", [(0.2, 2.1, 0.5), (1.9, 0.1, 0.2), (0.4, -0.3, 0.8)])
def test_fabrik_reaches_what_is_within_reach_and_keeps_bones_and_root(target):
    chain = np.array([[0.0, 0, 0], [0.1, 0.9, 0], [0, 1.5, 0.2], [0.2, 2.2, 0], [0.1, 2.6, 0]])
    found = fabrik(chain, np.array(target))
    np.testing.assert_allclose(found[-1], target, atol=1e-6)
    assert np.array_equal(found[0], chain[0])
    lengths = [np.linalg.norm(np.diff(c, axis=0), axis=1) for c in (chain, found)]
    np.testing.assert_allclose(lengths[1], lengths[0], atol=1e-12)


def test_fabrik_points_at_what_is_beyond():
    chain = np.array([[0.0, 0, 0], [0, 1, 0], [0.5, 1.5, 0]])
    found = fabrik(chain, np.array([10.0, 0, 0]))
    np.testing.assert_allclose(found, [[0, 0, 0], [1, 0, 0], [1 + np.sqrt(0.5), 0, 0]], atol=1e-3)


def test_fabrik_with_the_end_on_its_neighbour_keeps_the_bone():
    chain = np.array([[0.0, 0, 0], [0.1, 0.9, 0], [0, 1.5, 0.2], [0.2, 2.2, 0]])
    found = fabrik(chain, chain[2])
    np.testing.assert_allclose(found[-1], chain[2], atol=1e-6)
    lengths = [np.linalg.norm(np.diff(c, axis=0), axis=1) for c in (chain, found)]
    np.testing.assert_allclose(lengths[1], lengths[0], atol=1e-12)


def test_a_towed_hand_points_along_the_shaft():
    limb = np.array([[0.0, 0, 0], [0.3, 0, 0], [0.5, 0.15, 0], [0.6, 0.15, 0]])
    target = np.array([0.2, 0.4, 0.2])
    found = tow_limb(limb, target, BENDS)
    np.testing.assert_allclose(found[3], target, atol=1e-8)
    assert np.linalg.norm(found[3] - found[2]) == pytest.approx(0.1)
    back = tow_limb(limb, limb[2], BENDS)  # the tip to where the wrist is: the wrist makes way
    np.testing.assert_allclose(back[2:], [[0.4, 0.15, 0], [0.5, 0.15, 0]], atol=1e-8)


@pytest.mark.parametrize("joint", range(J), ids=JOINTS)
def test_every_joint_keeps_the_bones_comes_near_and_stays_where_it_is_dragged_to_itself(
    pose, joint
):
    for start in (pose, rest()):
        np.testing.assert_allclose(drag(start, joint, start[joint]), start, atol=1e-6)
        target = start[joint] + [0.03, -0.05, 0.04]
        moved = drag(start, joint, target)
        np.testing.assert_allclose(bones(moved), bones(start), atol=1e-9)
        assert np.linalg.norm(moved[joint] - target) < np.linalg.norm(start[joint] - target)
        np.testing.assert_allclose(
            bones(drag(start, joint, start[joint] + [3.0, 2, -4])), bones(start), atol=1e-9
        )


@pytest.mark.parametrize("joint", range(J), ids=JOINTS)
def test_a_joint_dragged_exactly_onto_another_keeps_the_bones(pose, joint):
    for start in (pose, rest()):
        for other in range(J):
            moved = drag(start, joint, start[other])
            np.testing.assert_allclose(
                bones(moved), bones(start), atol=1e-9, err_msg=f"onto {JOINTS[other]}"
            )


def test_a_hand_within_reach_arrives_and_only_its_arm_moves(pose):
    target = pose[joint_index("LeftArm")] + [0.1, 0.35, 0.2]
    moved = drag(pose, HAND, target)
    np.testing.assert_allclose(moved[HAND], target, atol=1e-9)
    still = [j for j in range(J) if j not in (ELBOW, HAND, TIP)]
    assert np.array_equal(moved[still], pose[still])
    before, after = (np.linalg.norm(p[TIP] - p[ELBOW]) for p in (pose, moved))
    assert after == pytest.approx(before), "the hand turns with the forearm"


def test_a_foot_keeps_its_direction(pose):
    moved = drag(pose, ANKLE, pose[ANKLE] + [0.0, 0.2, 0.0])
    np.testing.assert_allclose(
        moved[ANKLE + 1] - moved[ANKLE], pose[ANKLE + 1] - pose[ANKLE], atol=1e-12
    )


def test_the_pelvis_goes_down_and_the_feet_stay(pose):
    low = drag(pose, 0, pose[0] - [0, 0.25, 0])
    for foot in (*HEELS, *TOES):
        np.testing.assert_allclose(low[foot], pose[foot], atol=1e-9)
    upper = list(range(9, 21))
    np.testing.assert_allclose(low[upper], pose[upper] - [0, 0.25, 0], atol=1e-12)
    np.testing.assert_allclose(
        drag(pose, 1, pose[1] - [0, 0.25, 0]), low, atol=1e-12
    )  # a hip is of the pelvis
    far = drag(pose, 0, pose[0] + [4.0, 0, 0])
    assert far[HEELS[0], 0] > pose[HEELS[0], 0] + 2.5, "feet come along when legs are too short"


@pytest.mark.parametrize("name", ["Neck1", "RightArm"])
def test_the_trunk_bends_and_carries_arms_and_head_but_not_the_legs(pose, name):
    joint = joint_index(name)
    moved = drag(pose, joint, pose[joint] + [0.1, -0.08, 0.1])
    np.testing.assert_allclose(moved[joint], pose[joint] + [0.1, -0.08, 0.1], atol=1e-6)
    assert np.array_equal(moved[:9], pose[:9])
    carried = [joint_index(name) for name in ("Neck1", "Head", "LeftArm", "RightArm", "RightHand")]
    apart = [np.linalg.norm(p[carried][:, None] - p[carried][None], axis=-1) for p in (pose, moved)]
    np.testing.assert_allclose(apart[1], apart[0], atol=1e-9)


def test_chains_begin_where_the_limb_does():
    named = lambda name: [JOINTS[j] for j in chain_to(joint_index(name))]  # noqa: E731
    assert named("LeftHandIndex1") == ["LeftArm", "LeftForeArm", "LeftHand", "LeftHandIndex1"]
    assert named("RightFoot") == ["RightUpLeg", "RightLeg", "RightFoot"]
    assert named("Head") == ["Hips", "Spine", "Spine1", "Neck1", "Head"]
    assert named("RightArm") == ["Hips", "Spine", "Spine1", "RightArm"]
    assert descendants(11) == list(range(12, 21)) and descendants(15, True) == [15, 16]


def test_what_cannot_be_dragged(pose):
    with pytest.raises(IndexError, match="joint 21 is not one of the skeleton's 21"):
        drag(pose, 21, pose[0])
    with pytest.raises(ValueError, match="LeftHand cannot be dragged"):
        drag(pose, HAND, np.array([0.0, np.nan, 0]))


@pytest.mark.parametrize("heel", HEELS)
def test_ankles_of_many_frames_are_dragged_as_one_by_one(heel):
    """Reachable, out of reach, where they are, into the hip, and on a straight leg."""
    walked = walk(random_control(2.0, np.random.default_rng(3), "turn"), 4)
    poses = to_world(walked.poses, walked.control)
    poses[7] = rest()
    rng = np.random.default_rng(1)
    targets = poses[:, heel] + rng.normal(0, 0.15, (len(poses), 3))
    targets[3] += [4.0, 0.0, 0.0]
    targets[4], targets[5] = poses[4, heel], poses[5, heel - 2]
    found = ankles_dragged(poses, heel, targets)
    wanted = np.stack([drag(p, heel, t) for p, t in zip(poses, targets, strict=True)])
    np.testing.assert_allclose(found, wanted, atol=1e-12)
    assert np.abs(found - poses)[:, heel].max() > 0.2
    others = [j for j in range(J) if j not in (heel - 1, heel, *descendants(heel))]
    assert np.array_equal(found[:, others], poses[:, others])
    toe = descendants(heel)[0]
    foot, before = found[:, toe] - found[:, heel], poses[:, toe] - poses[:, heel]
    np.testing.assert_allclose(foot, before, atol=1e-12)
    np.testing.assert_allclose(*([bones(p) for p in some] for some in (found, poses)), atol=1e-9)
    assert not len(ankles_dragged(poses[:0], heel, targets[:0]))
    targets[6, 1] = np.nan
    with pytest.raises(ValueError, match=f"{JOINTS[heel]} cannot be dragged"):
        ankles_dragged(poses, heel, targets)
