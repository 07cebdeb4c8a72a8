"""Rotations and forward kinematics against SciPy, and against a chain worked out by hand."""

import itertools

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from motiondiff_edu.motion.kinematics import (
    euler_to_matrix,
    forward_kinematics,
    rot_x,
    rot_y,
    rot_z,
)
from motiondiff_edu.motion.skeleton import BONE_LENGTHS, BONES, OFFSETS, PARENTS, J

ORDERS = ["".join(p) for p in itertools.permutations("XYZ")] + ["XYX", "ZXZ", "Y", "ZX"]


@pytest.fixture
def rng():
    return np.random.default_rng(17)


@pytest.mark.parametrize("order", ORDERS)
def test_euler_orders_equal_scipy(order, rng):
    angles = rng.uniform(-np.pi, np.pi, (5, 2, len(order)))
    theirs = Rotation.from_euler(
        order, angles.reshape(-1, len(order))
    ).as_matrix()  # capital letters: intrinsic
    np.testing.assert_allclose(euler_to_matrix(angles, order).reshape(-1, 3, 3), theirs, atol=1e-12)


def test_one_angle_alone_turns_as_it_says():
    quarter = np.pi / 2
    np.testing.assert_allclose(
        rot_y(quarter) @ [0, 0, 1], [1, 0, 0], atol=1e-15
    )  # z towards x: ccw from above
    np.testing.assert_allclose(rot_x(quarter) @ [0, 1, 0], [0, 0, 1], atol=1e-15)
    np.testing.assert_allclose(rot_z(quarter) @ [1, 0, 0], [0, 1, 0], atol=1e-15)
    assert rot_z(np.zeros((4, 3))).shape == (4, 3, 3, 3)


@pytest.mark.parametrize("order", ["ZXQ", "ZX", "zxy", ""])
def test_an_order_that_does_not_fit_is_refused(order):
    with pytest.raises(ValueError, match="rotation order"):
        euler_to_matrix(np.zeros((2, 3)), order)


def test_chain_worked_out_by_hand():
    """Root at (1, 2, 3) turned 90 degrees about z; then two bones, 2 up and 1 to x.

    The second joint turns back.
    """
    parents = np.array([-1, 0, 1])
    offsets = np.array([[9.0, 9, 9], [0, 2, 0], [1, 0, 0]])
    local = np.stack([rot_z(np.pi / 2), rot_z(-np.pi / 2), np.eye(3)])[None]
    positions, rotations = forward_kinematics(local, np.array([[1.0, 2, 3]]), offsets, parents)
    # up, turned by 90 degrees about z, points to -x; after turning back, x is x again
    np.testing.assert_allclose(positions[0], [[1, 2, 3], [-1, 2, 3], [0, 2, 3]], atol=1e-12)
    np.testing.assert_allclose(rotations[0, 1], np.eye(3), atol=1e-12)


def test_whole_skeleton_equals_scipy_chain(rng):
    frames = 7
    local = Rotation.random(frames * J, rng=rng)
    root = rng.normal(size=(frames, 3))
    positions, rotations = forward_kinematics(
        local.as_matrix().reshape(frames, J, 3, 3), root, OFFSETS, PARENTS
    )
    for t, j in itertools.product(range(frames), range(J)):
        chain = [j]
        point = root[t].copy()
        turn = Rotation.identity()
        while PARENTS[chain[0]] >= 0:
            chain.insert(0, int(PARENTS[chain[0]]))
        for before, joint in zip(chain[:-1], chain[1:], strict=True):
            turn = turn * local[t * J + before]
            point += turn.apply(OFFSETS[joint])
        np.testing.assert_allclose(positions[t, j], point, atol=1e-12)
        np.testing.assert_allclose(
            rotations[t, j], (turn * local[t * J + j]).as_matrix(), atol=1e-12
        )


def test_bones_keep_their_length_whatever_the_angles(rng):
    local = Rotation.random(5 * J, rng=rng).as_matrix().reshape(5, J, 3, 3)
    positions, _ = forward_kinematics(local, np.zeros((5, 3)), OFFSETS, PARENTS)
    parent, child = np.array(BONES).T
    lengths = np.linalg.norm(positions[:, child] - positions[:, parent], axis=-1)
    np.testing.assert_allclose(lengths, np.broadcast_to(BONE_LENGTHS, (5, 20)), atol=1e-12)


def test_a_child_before_its_parent_is_refused():
    with pytest.raises(ValueError, match="parent must come before"):
        forward_kinematics(
            np.tile(np.eye(3), (2, 3, 1, 1)),
            np.zeros((2, 3)),
            np.zeros((3, 3)),
            np.array([-1, 2, 0]),
        )


@pytest.mark.parametrize(
    "frame, joint, where", [(0, 0, (-3, 6, 5)), (100, 0, (-3, 6, 5)), (100, 2, (-8, 11, 5))]
)
def test_published_positions_of_a_sinusoidal_file(real_data, frame, joint, where):
    """World positions printed in another project's tests (fairmotion)."""
    from motiondiff_edu.motion.formats.bvh import read_bvh

    positions = read_bvh(real_data / "bvh" / "fairmotion_sinusoidal.bvh").world_positions()
    np.testing.assert_allclose(positions[frame, joint], where, atol=1e-4)
