"""Feet that slide are held, legs keep their bones, and what was given is not touched."""

import numpy as np
import pytest

from data_synth.walking import walk
from motiondiff_edu.editing.masks import body_part, gap, keyframes
from motiondiff_edu.metrics.bodies import bone_lengths
from motiondiff_edu.metrics.walks import skating
from motiondiff_edu.motion.cleanup import (
    CLEARANCE,
    FARTHEST,
    SAME,
    SHARE,
    SLOW,
    SOON,
    kept_places,
    lift_to_floor,
    lock_feet,
    slow_for,
    stands,
    toe_path,
)
from motiondiff_edu.motion.directions import UP
from motiondiff_edu.motion.inverse_kinematics import ankles_dragged
from motiondiff_edu.motion.skeleton import HEELS, TOES

FPS = 20.0
LEGS = [joint for toe, heel in zip(TOES, HEELS, strict=True) for joint in (heel - 1, heel, toe)]


@pytest.fixture(scope="module")
def clip():
    return walk(np.tile([1.2, 0.0, 0.0], (100, 1)), seed=3)


def sliding(positions, contacts):
    """Mean speed over the ground (m/s) of toes that stand in the truth, from frame to frame."""
    toes = positions[:, list(TOES)][..., [0, 2]]
    return (20 * np.linalg.norm(np.diff(toes, axis=0), axis=-1))[
        contacts[1:] & contacts[:-1]
    ].mean()


def too_fast(clip, known):
    """The walk; what is not known of it runs ahead by up to 30 cm and back, and slides."""
    world, ahead = clip.world(), np.array([0.0, 0.0, 0.3])
    return np.where(
        known[..., None],
        world,
        world + np.sin(np.linspace(0, 3 * np.pi, 100))[:, None, None] ** 2 * ahead,
    )


@pytest.mark.parametrize("mask", [lambda T: gap(T, 20, 60), lambda T: keyframes(T, 33)])
def test_sliding_feet_are_held(clip, mask):
    known = mask(100)
    slid = too_fast(clip, known)
    held = lock_feet(slid, known, FPS)
    before, after = (sliding(x, clip.contacts) for x in (slid, held))
    assert before > 0.25 and after < before / 3
    others = np.delete(np.arange(21), LEGS)
    assert np.array_equal(held[:, others], slid[:, others]) and np.array_equal(
        held[known], slid[known]
    )
    np.testing.assert_allclose(
        bone_lengths(held)[~known.all(1)], bone_lengths(slid)[~known.all(1)], atol=2e-3
    )


def test_a_walk_that_does_not_slide_is_hardly_moved(clip):
    world = clip.world()
    held = lock_feet(world, gap(100, 10, 80), FPS)
    assert np.linalg.norm(held - world, axis=-1).max() < 0.05


def test_given_legs_stay_and_all_given_is_the_input(clip):
    world = clip.world()
    lower = body_part(100, "lower body")
    assert np.array_equal(lock_feet(world, lower, FPS), world)
    assert np.array_equal(lock_feet(world, np.ones((100, 21), bool), FPS), world)


def test_a_stand_is_where_the_toe_is_given_and_meets_what_is_given_in_the_air():
    toe = np.zeros((30, 3))
    toe[:, 2] = np.concatenate(
        [np.arange(10) * 0.02, 0.2 + np.arange(1, 11) * 0.1, 1.2 + np.arange(10) * 0.02]
    )
    toe[10:20, 1] = 0.2  # stands while it slides (0.4 m/s), steps, and stands again
    standing = stands(toe, FPS)
    assert standing[:10].all() and standing[20:].all() and not standing[11:19].any()
    given = np.zeros(30, bool)
    given[[2, 15]] = True
    moved = toe_path(toe, given, standing)
    np.testing.assert_allclose(moved[:10, 2], toe[2, 2], atol=1e-12)  # not at the median
    np.testing.assert_allclose(moved[21:, 2], np.median(toe[20:, 2]))
    assert np.array_equal(moved[given], toe[given])
    assert (np.abs(np.diff(moved[:, 2])) < 0.25).all() and np.isfinite(moved).all()


def test_a_stand_given_at_two_places_goes_evenly_from_one_to_the_other():
    toe = np.zeros((9, 3))
    toe[:, 0] = [0, 5, 5, 5, 5, 5, 5, 5, 0.08]
    given = np.arange(9) % 8 == 0
    toe[:, 0] = np.where(given, toe[:, 0], 0.01 * toe[:, 0])
    moved = toe_path(toe, given, np.ones(9, bool))
    np.testing.assert_allclose(moved[:, 0], 0.01 * np.arange(9), atol=1e-12)


def test_nothing_stands_nothing_moves():
    flying = np.tile([0.0, 1.0, 0.0], (10, 1)) + np.arange(10)[:, None] * [0.0, 0.0, 0.3]
    assert np.array_equal(toe_path(flying, np.zeros(10, bool), stands(flying, FPS)), flying)


def test_a_standing_foot_is_slower_than_a_fast_pelvis():
    walked = np.zeros((30, 21, 3))
    walked[:, 0, 2] = 3.0 / 20 * np.arange(30)
    limit = slow_for(walked, FPS)
    np.testing.assert_allclose(limit, 3.0)
    assert (slow_for(walked / 10, FPS) == SLOW).all() and slow_for(walked[:1], FPS) == [SLOW]
    for speed, standing in ((2.0, True), (4.0, False)):
        toe = np.zeros((30, 3))
        toe[:, 2] = speed / 20 * np.arange(30)
        assert stands(toe, FPS, limit).all() == standing
        assert not stands(toe, FPS).any()


@pytest.mark.parametrize(("length", "held"), [(1.6 * FARTHEST, True), (2.4 * FARTHEST, False)])
def test_a_foot_that_glides_far_is_left_alone(length, held):
    """From its median place, in the middle, it goes half of the length away."""
    toe = np.zeros((30, 3))
    toe[:, 0] = np.linspace(0, length, 30)
    moved = toe_path(toe, np.zeros(30, bool), stands(toe, FPS))
    assert np.allclose(moved[:, 0], length / 2) == held and np.array_equal(moved, toe) != held


def test_the_height_of_one_step_by_hand():
    toe = np.zeros((12, 3))
    toe[4:9, 2], toe[9:, 2] = np.linspace(0.02, 0.08, 5), 0.1
    standing = np.r_[np.ones(4, bool), np.zeros(5, bool), np.ones(3, bool)]
    nothing = np.zeros(12, bool)
    height = toe_path(toe, nothing, standing, floor=-0.01)[:, 1]
    assert np.array_equal(height[standing], np.zeros(7))
    arc = SHARE * 0.1 * np.sin(np.pi * np.arange(1, 6) / 6)
    np.testing.assert_allclose(height[4:9], np.maximum(arc - 0.01, 0), atol=1e-12)
    toe[9:, 2] = 2.0
    assert toe_path(toe, nothing, standing)[6, 1] == pytest.approx(CLEARANCE)
    higher = toe + [0.0, 1.0, 0.0]
    np.testing.assert_allclose(toe_path(higher, nothing, standing)[:, 1], 1.0)  # on something
    assert np.array_equal(toe_path(toe, ~nothing, standing), toe)


def test_a_step_without_beginning_or_end_is_left():
    toe, nothing = np.full((6, 3), 0.01), np.zeros(6, bool)
    toe[:, 0] = np.arange(6)
    for standing in (nothing, np.arange(6) < 3, np.arange(6) >= 3):
        assert np.array_equal(toe_path(toe, nothing, standing)[:, 1], toe[:, 1])


def test_feet_that_pass_too_low_are_lifted_and_no_longer_seem_to_slide(clip):
    world = clip.world()
    low = np.array(world)
    for toe, heel in zip(TOES, HEELS, strict=True):
        down = 0.9 * np.maximum(world[:, toe, 1] - 0.005, 0)[:, None] * [0.0, 1.0, 0.0]
        by = np.where(world[:, toe, 1:2] < 0.005, 0.02, 0) * UP - down
        low = ankles_dragged(low, heel, low[:, heel] + by)
    lifted = lock_feet(low, np.zeros(low.shape[:2], bool), FPS)
    still = np.zeros((len(low), 3))
    assert skating(low, still) > 0.5 and skating(lifted, still) < 0.3 * skating(low, still)
    np.testing.assert_allclose(bone_lengths(lifted), bone_lengths(low), atol=2e-3)


def test_a_toe_that_is_given_twice_at_one_place_has_not_left_it():
    toe = np.zeros((21, 3))
    toe[:, 1:] = np.sin(np.linspace(0, np.pi, 21))[:, None] * [0.05, 0.1]
    toe[20, 0] = 0.8 * SAME
    ends = np.arange(21) % 20 == 0
    kept = kept_places(toe, ends)
    np.testing.assert_allclose(kept, np.linspace(toe[0], toe[20], 21), atol=1e-12)
    elsewhere = toe + np.linspace(0, 1.1 * SAME, 21)[:, None]
    assert np.array_equal(kept_places(elsewhere, ends), elsewhere)
    assert np.array_equal(kept_places(toe, np.arange(21) < 1), toe)
    long = np.resize(toe, (SOON + 2, 3))
    long[-1] = long[0]
    late = np.arange(len(long)) % (SOON + 1) == 0
    assert late.sum() == 2 and np.array_equal(kept_places(long, late), long)


def test_a_leg_follows_the_place_that_its_toe_keeps(clip):
    """A pose that is held, and a motion that leaves it for a step of the left leg."""
    pose = clip.world()[40]
    given = np.repeat(pose[None], 41, 0)
    made, known = np.array(given), np.zeros((41, 21), bool)
    known[[0, -1]] = True
    away = np.sin(np.linspace(0, np.pi, 41))[:, None] * [0.0, 0.15, 0.05]
    made = ankles_dragged(made, HEELS[0], made[:, HEELS[0]] + away)
    locked = lock_feet(made, known, FPS)
    assert np.linalg.norm(made[:, TOES[0]] - given[:, TOES[0]], axis=-1).max() > 0.1
    np.testing.assert_allclose(locked[:, TOES[0]], given[:, TOES[0]], atol=2e-3)
    legged = known.copy()
    legged[:, HEELS[0]] = True
    assert np.array_equal(lock_feet(made, legged, FPS)[:, TOES[0]], made[:, TOES[0]])


def test_a_sunken_walk_stands_on_the_floor_again(clip):
    truth = clip.world()
    sunk = truth - [0.0, 0.06, 0.0]
    nothing, feet = np.zeros(sunk.shape[:2], bool), [*HEELS, *TOES]
    made = lift_to_floor(sunk, nothing)
    assert sunk[:, feet, 1].min() < -0.05 and made[:, feet, 1].min() > -1e-6
    others = [j for j in range(21) if j not in LEGS]
    np.testing.assert_array_equal(made[:, others], sunk[:, others])
    np.testing.assert_allclose(bone_lengths(made), bone_lengths(sunk), atol=1e-9)
    np.testing.assert_allclose(  # feet keep their slope
        made[:, list(TOES)] - made[:, list(HEELS)], sunk[:, list(TOES)] - sunk[:, list(HEELS)]
    )
    deep = np.minimum(sunk[:, [3, 4], 1].min(1), 0)
    np.testing.assert_allclose(made[:, 3, 1] - sunk[:, 3, 1], -deep, atol=1e-6)
    assert np.array_equal(lift_to_floor(sunk, nothing, floor=-1.0), sunk)
    assert np.array_equal(lift_to_floor(sunk, ~nothing), sunk)
