"""Bones keep their length, given joints their place."""

import numpy as np
import pytest

from data_synth.walking import random_control, walk
from motiondiff_edu.beyond.constant_bones import given_lengths, steady_bones
from motiondiff_edu.editing.masks import body_part, gap, keyframes
from motiondiff_edu.metrics.bone_lengths import bone_lengths
from motiondiff_edu.motion.skeleton import joint_index


@pytest.fixture(scope="module")
def clip():
    return walk(random_control(3.0, np.random.default_rng(0), "turn"), 0).world()


def knees(T):
    """All is given but a knee and a shoulder, between two given joints each.

    In the first frame they are, too.
    """
    known = np.ones((T, 21), bool)
    known[1:, [joint_index("LeftLeg"), joint_index("RightArm")]] = False
    return known


@pytest.mark.parametrize(
    "mask",
    [
        lambda T: gap(T, 10, 20),
        lambda T: keyframes(T, 15),
        knees,
        lambda T: body_part(T, "lower body") | keyframes(T, 20),
    ],
)
def test_bones_are_as_long_as_where_they_are_given(clip, mask):
    known = mask(len(clip))
    shaken = np.where(
        known[..., None], clip, clip + 0.04 * np.random.default_rng(1).standard_normal(clip.shape)
    )
    lengths = given_lengths(shaken, known)
    fixed = steady_bones(np.stack([shaken, shaken]), known, lengths)
    assert np.array_equal(fixed[0][known], clip[known]) and np.array_equal(fixed[0], fixed[1])
    given = ~np.isnan(lengths)
    off = np.abs(bone_lengths(fixed)[..., given] - bone_lengths(clip)[0][given])
    assert (
        off.max()
        < 0.002
        < np.abs(bone_lengths(shaken)[..., given] - bone_lengths(clip)[0][given]).max()
    )
    assert np.linalg.norm(fixed[0] - shaken, axis=-1).max() < 0.25  # and nobody is thrown about


def test_a_motion_with_right_bones_stays_as_it_is(clip):
    np.testing.assert_allclose(
        steady_bones(clip, gap(len(clip), 5, 9), bone_lengths(clip)[0]), clip, atol=1e-9
    )


def test_bones_that_are_never_given_are_left_alone(clip):
    known = body_part(len(clip), "trajectory")
    assert np.isnan(given_lengths(clip, known)).all()
    shaken = clip + 0.01
    assert np.array_equal(steady_bones(shaken, known, given_lengths(clip, known)), shaken)
