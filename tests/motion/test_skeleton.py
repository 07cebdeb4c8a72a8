"""The skeleton: a tree in order, symmetric, with constant bones."""

import numpy as np
import pytest

from motiondiff_edu.motion import skeleton as sk

# the parent list of the public locomotion corpus (0-based), read from its exporter: an independent
# source
CORPUS_PARENTS = [-1, 0, 1, 2, 3, 0, 5, 6, 7, 0, 9, 10, 11, 11, 13, 14, 15, 11, 17, 18, 19]


def test_tree_is_the_corpus_tree():
    assert sk.J == len(sk.JOINTS) == len(set(sk.JOINTS)) == 21
    assert sk.PARENTS.tolist() == CORPUS_PARENTS
    assert sk.OFFSETS.shape == (21, 3)


def test_every_joint_but_the_root_is_the_child_of_one_bone():
    assert [child for _, child in sk.BONES] == list(range(1, 21))
    assert all(parent < child for parent, child in sk.BONES)


def test_bone_lengths_follow_the_order_of_bones():
    for (_, child), length in zip(sk.BONES, sk.BONE_LENGTHS, strict=True):
        assert length == pytest.approx(np.sqrt((sk.OFFSETS[child] ** 2).sum()))
    thigh, shank = (sk.BONE_LENGTHS[sk.joint_index(name) - 1] for name in ("LeftLeg", "LeftFoot"))
    assert thigh + shank == pytest.approx(0.835)


def test_mirror_swaps_sides_and_is_its_own_inverse():
    assert np.array_equal(sk.MIRROR[sk.MIRROR], np.arange(sk.J))
    assert [sk.MIRROR[j] for j in sk.LEFT] == list(sk.RIGHT)
    assert all(sk.MIRROR[j] == j for j in sk.CENTRE)
    assert sorted(sk.LEFT + sk.RIGHT + sk.CENTRE) == list(range(sk.J))
    np.testing.assert_allclose(sk.OFFSETS[sk.MIRROR] * [-1, 1, 1], sk.OFFSETS)


def test_named_joints_are_what_they_say():
    assert [sk.JOINTS[j] for j in sk.HEELS + sk.TOES] == [
        "LeftFoot",
        "RightFoot",
        "LeftToeBase",
        "RightToeBase",
    ]
    assert sk.JOINTS[sk.HIPS] == "Hips" and sk.PARENTS[sk.HIPS] == -1


def test_the_resting_toe_stands_on_the_floor_and_left_is_positive_x():
    height = {name: 0.0 for name in sk.JOINTS}
    for j, name in enumerate(sk.JOINTS):
        height[name] = sk.OFFSETS[j, 1] + (height[sk.JOINTS[sk.PARENTS[j]]] if j else 0.0)
    assert height["LeftToeBase"] == height["RightToeBase"] == pytest.approx(0.0, abs=1e-12)
    assert sk.OFFSETS[sk.joint_index("LeftUpLeg"), 0] > 0


def test_unknown_joint_names_those_there_are():
    with pytest.raises(KeyError, match="LeftHandIndex1"):
        sk.joint_index("LeftPinky")


def test_pairs_of_bones_are_left_and_right():
    """The eight of an arm and a leg, and none in the middle."""
    names = [(sk.JOINTS[parent], sk.JOINTS[child]) for parent, child in sk.BONES]
    for left, right in sk.BONE_PAIRS:
        assert tuple(n.replace("Left", "Right") for n in names[left]) == names[right]
        assert names[left] != names[right]
    assert len(sk.BONE_PAIRS) == len(set(sk.BONE_PAIRS)) == 8
