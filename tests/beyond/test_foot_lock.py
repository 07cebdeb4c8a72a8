"""Feet that slide are held, legs keep their bones, and what was given is not touched."""

import numpy as np
import pytest

from data_synth.walking import walk
from motiondiff_edu.beyond.foot_lock import SLOW, slow_for, stands, steady_feet, to_stands
from motiondiff_edu.editing.masks import body_part, gap, keyframes
from motiondiff_edu.metrics.bone_lengths import bone_lengths
from motiondiff_edu.motion.skeleton import HEELS, TOES

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
    held = steady_feet(slid, known)
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
    held = steady_feet(world, gap(100, 10, 80))
    assert np.linalg.norm(held - world, axis=-1).max() < 0.05


def test_several_motions_are_held_as_each_alone(clip):
    known = gap(100, 20, 60)
    both = np.stack([too_fast(clip, known), clip.world()])
    kept = both.copy()
    held = steady_feet(both[None], known)
    assert held.shape == (1, 2, 100, 21, 3) and np.array_equal(both, kept)
    assert np.array_equal(held[0, 1], steady_feet(both[1], known))


def test_given_legs_stay_and_all_given_is_the_input(clip):
    world = clip.world()
    lower = body_part(100, "lower body")
    assert np.array_equal(steady_feet(world, lower), world)
    assert np.array_equal(steady_feet(world, np.ones((100, 21), bool)), world)


def test_a_stand_is_where_the_toe_is_given_and_the_correction_fades_to_the_given():
    toe = np.zeros((30, 3))
    toe[:, 2] = np.concatenate(
        [np.arange(10) * 0.02, 0.2 + np.arange(1, 11) * 0.1, 1.2 + np.arange(10) * 0.02]
    )
    toe[10:20, 1] = 0.2  # stands while it slides (0.4 m/s), steps, and stands again
    standing = stands(toe, 20.0)
    assert standing[:10].all() and standing[20:].all() and not standing[11:19].any()
    given = np.zeros(30, bool)
    given[[2, 15]] = True
    moved = toe + to_stands(toe, given, stands(toe, 20.0))
    np.testing.assert_allclose(
        moved[:10, 2], toe[2, 2], atol=1e-12
    )  # at the given place, not at the median
    np.testing.assert_allclose(
        moved[21:, 2], np.median(toe[20:, 2])
    )  # farther from the given than the fade
    assert np.array_equal(moved[15], toe[15])
    assert (np.abs(np.diff(moved[:, 2])) < 0.25).all() and np.isfinite(moved).all()


def test_a_stand_s_correction_rises_smoothly_beside_a_frame_that_is_given_after_it():
    """A toe that creeps by 1 cm a frame for ten frames, then flies; it is given right after. Held
    at its median, the last frame of the stand would jump by 4.5 cm: there, 1 frame from the given
    one, only 3/36 - 2/216 of the correction are left; 6 frames away, all of it."""
    toe = np.zeros((20, 3))
    toe[:10, 2] = np.arange(10) * 0.01
    toe[10:, 2], toe[10:, 1] = 0.09 + np.arange(1, 11) * 0.1, 0.3
    given = np.zeros(20, bool)
    given[10] = True
    assert stands(toe, 20.0).tolist() == [True] * 10 + [False] * 10
    shift = to_stands(toe, given, stands(toe, 20.0))[:, 2]
    whole = 0.045 - toe[:10, 2]
    left = np.array([3 * (k / 6) ** 2 - 2 * (k / 6) ** 3 for k in range(1, 6)])
    np.testing.assert_allclose(shift[9:4:-1], left * whole[9:4:-1], atol=1e-12)
    np.testing.assert_allclose(shift[:5], whole[:5], atol=1e-12)
    assert (shift[10:] == 0).all()


def test_only_what_is_given_near_a_stand_matters():
    """Beside many stands, with frames given far and near, a toe is held as when each is alone."""
    rng = np.random.default_rng(3)
    toe, still = rng.normal(0, 0.02, (200, 3)), np.zeros(200, bool)
    for first in range(20, 180, 25):
        still[first : first + 8] = True
    given = rng.random(200) < 0.05
    given[20:28] = False
    whole = to_stands(toe, given, still)
    alone = to_stands(toe[:45], given[:45], still[:45])
    np.testing.assert_allclose(whole[:28], alone[:28], atol=1e-12)
    assert np.abs(whole[20:28]).max() > 1e-3


def test_nothing_stands_nothing_moves():
    flying = np.tile([0.0, 1.0, 0.0], (10, 1)) + np.arange(10)[:, None] * [0.0, 0.0, 0.3]
    assert (to_stands(flying, np.zeros(10, bool), stands(flying, 20.0)) == 0).all()


def test_a_standing_foot_is_slower_than_a_fast_pelvis():
    walked = np.zeros((30, 21, 3))
    walked[:, 0, 2] = 3.0 / 20 * np.arange(30)
    limit = slow_for(walked, 20.0)
    np.testing.assert_allclose(limit, 3.0)
    assert (slow_for(walked / 10, 20.0) == SLOW).all() and slow_for(walked[:1], 20.0) == [SLOW]
    for speed, standing in ((2.0, True), (4.0, False)):
        toe = np.zeros((30, 3))
        toe[:, 2] = speed / 20 * np.arange(30)
        assert stands(toe, 20.0, limit).all() == standing
        assert not stands(toe, 20.0).any()


@pytest.mark.parametrize(("length", "held"), [(0.3, True), (0.5, False)])
def test_a_foot_that_glides_far_is_left_alone(length, held):
    """From its median place, in the middle, it goes half of the length away."""
    toe = np.zeros((20, 3))
    toe[:, 0] = np.linspace(0, length, 20)
    moved = toe + to_stands(toe, np.zeros(20, bool), stands(toe, 20.0), farthest=0.2)
    assert np.allclose(moved[:, 0], length / 2) == held and np.array_equal(moved, toe) != held
