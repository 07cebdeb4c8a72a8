"""Mirror and time reversal are exact: bones, paths, and twice is the identity."""

from dataclasses import replace

import numpy as np
import pytest
import torch

from motiondiff_edu.motion.augment import augment, mirror, reverse_time
from motiondiff_edu.motion.clip import Clip
from motiondiff_edu.motion.kinematics import euler_to_matrix, forward_kinematics
from motiondiff_edu.motion.root_frame import root_path
from motiondiff_edu.motion.skeleton import BONES, CENTRE, MIRROR, OFFSETS, PARENTS, J


@pytest.fixture
def walk():
    """A figure of constant bones with lively joints, on a path with turns and side-steps."""
    rng, frames = np.random.default_rng(5), 57
    angles = 0.4 * rng.normal(size=(1, J, 3)) * np.sin(np.arange(frames) / 4)[:, None, None] + 0.2
    root = np.array([0.03, 0.95, 0.01]) + 0.02 * rng.normal(size=(frames, 3))
    poses, _ = forward_kinematics(euler_to_matrix(angles, "ZXY"), root, OFFSETS, PARENTS)
    t = np.arange(frames) / 20
    control = np.stack([1.2 + 0.5 * np.sin(t), 0.4 * np.cos(2 * t), 1.5 * np.sin(3 * t)], -1)
    control[-1] = control[-2]
    return Clip(
        poses, control, contacts=rng.random((frames, 2)) < 0.4, source="walk", info={"style": 3}
    )


def lengths(positions):
    parent, child = np.array(BONES).T
    return np.linalg.norm(positions[..., child, :] - positions[..., parent, :], axis=-1)


def test_mirror_keeps_bones_and_is_its_own_inverse(walk):
    np.testing.assert_allclose(lengths(mirror(walk).poses), lengths(walk.poses), atol=1e-12)
    twice = mirror(mirror(walk))
    for name in ("poses", "control", "contacts"):
        assert np.array_equal(getattr(twice, name), getattr(walk, name))


def test_mirrored_walk_integrates_to_the_mirrored_path(walk):
    """The world itself, seen in a mirror that stands along z.

    x is negated, and sides swap names.
    """
    seen = walk.world((2.0, 1.0, 0.5))[:, MIRROR] * [-1, 1, 1]
    np.testing.assert_allclose(mirror(walk).world((-2.0, 1.0, -0.5)), seen, atol=1e-12)
    assert np.array_equal(mirror(walk).contacts, walk.contacts[:, [1, 0]])
    assert np.abs(seen - walk.world((2.0, 1.0, 0.5))).max() > 0.1


def public_mirror(poses):
    """What the corpus' public preprocessing does, told in one line.

    The central joints keep their x.
    """
    out = poses[:, MIRROR] * [-1, 1, 1]
    out[:, CENTRE, 0] = poses[:, CENTRE, 0]
    return out


def test_the_public_mirror_tears_the_shoulders_off():
    """A neck 5 cm to the left between shoulders 15 cm away.

    15.1 cm become 5.4 and 25.1 (measured on its code).
    """
    neck = 11
    left = 13
    right = 17
    poses = np.zeros((1, J, 3))
    poses[0, neck] = [0.05, 1.45, 0]
    poses[0, left], poses[0, right] = [0.20, 1.43, 0], [-0.10, 1.43, 0]

    def bones_cm(p):
        return [100 * np.linalg.norm(p[0, j] - p[0, neck]) for j in (left, right)]

    assert bones_cm(poses) == pytest.approx([15.1, 15.1], abs=0.05)
    assert bones_cm(public_mirror(poses)) == pytest.approx([5.4, 25.1], abs=0.05)
    ours = mirror(Clip(poses, np.zeros((1, 3)))).poses
    assert bones_cm(ours) == pytest.approx([15.1, 15.1], abs=0.05)


def test_reversal_plays_the_same_world_backwards(walk):
    world, (root, heading) = walk.world(), root_path(walk.control)
    backwards = reverse_time(walk).world((*root[-1], heading[-1]))
    np.testing.assert_allclose(backwards, world[::-1], atol=1e-12)


def test_arrays_read_backwards_go_into_torch(walk):
    backwards = reverse_time(walk)
    assert torch.equal(torch.from_numpy(backwards.poses).flip(0), torch.from_numpy(walk.poses))
    for other, axis in ((backwards, 0), (mirror(walk), 1)):
        assert torch.equal(
            torch.from_numpy(other.contacts).flip(axis), torch.from_numpy(walk.contacts)
        )
    for clip in augment([walk]):
        assert [
            len(torch.from_numpy(part)) for part in (clip.poses, clip.control, clip.contacts)
        ] == [57, 57, 57]


def test_reversed_walk_integrates_back_to_its_start(walk):
    root, heading = root_path(walk.control, (3.0, -1.0, 0.2))
    back, turned = root_path(reverse_time(walk).control, (*root[-1], heading[-1]))
    np.testing.assert_allclose([*back[-1], turned[-1]], [3.0, -1.0, 0.2], atol=1e-12)


def test_reversal_without_the_shift_misses_the_start(walk):
    """Negating alone, as the public preprocessing does, uses the row that leads out of the clip."""
    root, heading = root_path(walk.control)
    back, _ = root_path(-walk.control[::-1], (*root[-1], heading[-1]))
    assert np.linalg.norm(back[-1] - root[0]) > 1e-3


def test_reversing_twice_is_the_identity_but_for_the_last_row(walk):
    open_ended = Clip(
        walk.poses, np.concatenate([walk.control[:-1], [[9.0, 9, 9]]]), contacts=walk.contacts
    )
    twice = reverse_time(reverse_time(open_ended))
    assert np.array_equal(twice.poses, open_ended.poses) and np.array_equal(
        twice.contacts, open_ended.contacts
    )
    assert np.array_equal(twice.control[:-1], open_ended.control[:-1])
    assert np.array_equal(twice.control[-1], open_ended.control[-2])
    assert np.array_equal(
        reverse_time(reverse_time(walk)).control, walk.control
    )  # a clip that keeps the convention


def test_reversal_of_a_single_frame():
    one = reverse_time(Clip(np.ones((1, J, 3)), np.array([[1.0, 2, 3]])))
    assert np.array_equal(one.control, [[-1.0, -2, -3]])


def test_augment_makes_four_with_the_same_source(walk):
    four = augment([walk])
    assert len(four) == 4 and {clip.source for clip in four} == {"walk"}
    ends = [clip.control[0, 1] for clip in four]  # the left speed tells the four apart
    forward, last = walk.control[0, 1], walk.control[-2, 1]
    assert ends == pytest.approx([forward, -forward, -last, last])
    assert augment([]) == []


def test_what_holds_for_the_recording_alone_is_left_out(walk):
    """The wild joints of a mirrored clip are others, and it started elsewhere."""
    known = replace(walk, info={"wild": np.ones((57, 21), bool), "start": 1, "style": 3})
    for changed in (mirror(known), reverse_time(known)):
        assert changed.info == {"style": 3}
