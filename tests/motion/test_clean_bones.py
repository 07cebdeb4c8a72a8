"""Bones keep their length, given joints their place."""

from dataclasses import replace

import numpy as np
import pytest

from data_synth.walking import random_control, walk
from motiondiff_edu.editing.masks import body_part, gap, keyframes
from motiondiff_edu.metrics.bodies import bone_lengths
from motiondiff_edu.motion.cleanup import PELVIS, TRUNK, Body, clean_bones
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
    body = Body.of(shaken, known)
    fixed = clean_bones(np.stack([shaken, shaken]), known, body)
    assert np.array_equal(fixed[0][known], clip[known]) and np.array_equal(fixed[0], fixed[1])
    given = ~np.isnan(body.bones)
    off = np.abs(bone_lengths(fixed)[..., given] - bone_lengths(clip)[0][given])
    assert (
        off.max()
        < 0.004
        < np.abs(bone_lengths(shaken)[..., given] - bone_lengths(clip)[0][given]).max()
    )
    assert np.linalg.norm(fixed[0] - shaken, axis=-1).max() < 0.25  # and nobody is thrown about


def test_a_motion_with_right_bones_stays_as_it_is(clip):
    body = Body.of(clip, np.ones(clip.shape[:2], bool))
    np.testing.assert_allclose(clean_bones(clip, gap(len(clip), 5, 9), body), clip, atol=1e-3)


def test_bones_that_are_never_given_are_left_alone(clip):
    known = body_part(len(clip), "trajectory")
    body = Body.of(clip, known)
    assert all(np.isnan(one).all() for one in (body.bones, body.pelvis, body.trunk))
    shaken = clip + 0.01
    assert np.array_equal(clean_bones(shaken, known, body), shaken)


def test_a_body_is_completed_in_its_own_size(clip):
    known = body_part(len(clip), "lower body")
    tall = Body.of(np.stack([clip, 1.2 * clip]), known).completed()
    np.testing.assert_allclose(tall.bones, np.outer([1.0, 1.2], bone_lengths(clip)[0]), rtol=1e-6)
    np.testing.assert_allclose(tall.pelvis[0], apart(clip, PELVIS)[0], atol=2e-3)
    np.testing.assert_allclose(tall.pelvis[1], 1.2 * tall.pelvis[0])
    nothing = Body.of(clip, known & False).completed()
    np.testing.assert_allclose(nothing.bones, bone_lengths(clip)[0], rtol=1e-6)
    given = Body.of(1.3 * clip, known | True)
    assert np.array_equal(given.completed().bones, given.bones)  # what is known stays


def test_lengths_are_those_of_the_given_frames_of_each_motion(clip):
    known = keyframes(len(clip), 10)
    wrong = np.where(known[..., None], clip, 0.0)
    body = Body.of(np.stack([wrong, 2 * wrong]), known)
    np.testing.assert_allclose(body.bones[0], bone_lengths(clip)[0], atol=1e-9)
    np.testing.assert_allclose(body.bones[1], 2 * body.bones[0])
    least = apart(clip[known.all(1)], TRUNK).min(0)
    np.testing.assert_allclose(body.trunk[0], least)
    thin = Body.of(wrong, known, bones=np.ones(20))
    assert (thin.bones == 1).all()
    np.testing.assert_allclose(thin.trunk, least)
    assert np.array_equal(Body.of(clip).bones, Body.of(clip, known | True).bones)


def apart(positions, pairs):
    return np.stack(
        [np.linalg.norm(positions[..., b, :] - positions[..., a, :], axis=-1) for a, b in pairs], -1
    )


def test_hips_and_spine_keep_their_distances(clip):
    known = gap(len(clip), 5, 45)
    shaken = clip + 0.03 * np.random.default_rng(0).standard_normal(clip.shape)
    body = Body.of(clip, known)
    fixed = clean_bones(shaken, known, body)[5:45]
    assert np.abs(apart(fixed, PELVIS) - body.pelvis).max() < 2e-3
    assert np.abs(apart(shaken, PELVIS)[5:45] - body.pelvis).max() > 0.05


def test_a_trunk_that_came_out_too_short_is_not_folded(clip):
    """Its joints at two thirds of their height over the pelvis: bones alone would zigzag."""
    known, trunk = gap(len(clip), 5, 45), [9, 10, 11, 12]
    short = np.array(clip)
    short[:, trunk, 1] -= (short[:, trunk, 1] - short[:, :1, 1]) / 3
    short[:, trunk] += 0.01 * np.random.default_rng(0).standard_normal((len(clip), 4, 3))
    body = Body.of(clip, known)
    bones_alone = replace(body, trunk=np.full(3, np.nan), pelvis=np.full(3, np.nan))
    folded, straight = (
        apart(clean_bones(short, known, one)[5:45], TRUNK) / body.trunk
        for one in (bones_alone, body)
    )
    assert straight.min() > 0.97 and folded.min() < 0.95


def test_a_trunk_may_be_straighter_than_where_it_is_given(clip):
    body = Body.of(clip, np.ones(clip.shape[:2], bool))
    bent = replace(body, trunk=0.8 * body.trunk)
    np.testing.assert_allclose(clean_bones(clip, gap(len(clip), 5, 9), bent), clip, atol=1e-3)
