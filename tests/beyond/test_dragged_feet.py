"""Dragged feet: one alone takes a step; what stands, swings, glides or is given stays."""

import numpy as np
import pytest

from data_synth.walking import walk
from motiondiff_edu.beyond.dragged_feet import FAR, FAST, LEAST, LOW, MOST, RISE, lift_dragged_feet
from motiondiff_edu.metrics.bone_lengths import bone_lengths
from motiondiff_edu.motion.inverse_kinematics import ankles_moved
from motiondiff_edu.motion.skeleton import HEELS, TOES

LEFT, RIGHT = TOES
LEGS = {LEFT: [2, 3, 4], RIGHT: [6, 7, 8]}
NOTHING = np.zeros((30, 21), bool)


@pytest.fixture(scope="module")
def standing():
    """A figure that stands still for 30 frames, with knees so bent that its feet have room."""
    pose = walk(np.zeros((40, 3)), seed=3).world()[20]
    pose = pose - [0.0, 0.25, 0.0]
    still = np.repeat(pose[None], 30, 0)
    for toe, heel in zip(TOES, HEELS, strict=True):
        up = np.array([0.0, 1.0, 0.0]) * -still[:, toe, 1][:, None]
        still = ankles_moved(still, heel, up)
    return still


def dragged(still, ways: dict, first=10, frames=10):
    """Feet go aside along the floor, by so many metres within so many frames."""
    moved = still.copy()
    share = np.clip((np.arange(len(still)) - first) / frames, 0, 1)
    for toe, way in ways.items():
        heel = HEELS[TOES.index(toe)]
        aside = np.array([0.0, 0.0, 1.0]) * way * share[:, None]
        moved = ankles_moved(moved, heel, aside)
    return moved


@pytest.mark.parametrize("way, height", [(0.15, LEAST), (0.3, RISE * 0.3)])
def test_a_dragged_foot_takes_a_step_in_an_arc(standing, way, height):
    moved = dragged(standing, {LEFT: way})
    made = lift_dragged_feet(moved, NOTHING)
    arc = height * np.sin(np.pi * np.arange(11) / 10)
    np.testing.assert_allclose(made[10:21, LEFT, 1], arc, atol=1e-6)
    others = np.delete(np.arange(21), LEGS[LEFT])
    np.testing.assert_array_equal(made[:, others], moved[:, others])
    np.testing.assert_allclose(made[:11], moved[:11], atol=1e-9)
    np.testing.assert_allclose(made[20:], moved[20:], atol=1e-6)
    np.testing.assert_allclose(made[:, LEFT, [0, 2]], moved[:, LEFT, [0, 2]], atol=1e-6)
    np.testing.assert_allclose(bone_lengths(made), bone_lengths(moved), atol=1e-6)


def test_no_step_is_higher_than_the_highest(standing):
    made = lift_dragged_feet(dragged(standing, {LEFT: 0.45}), NOTHING)
    assert made[:, LEFT, 1].max() == pytest.approx(MOST, abs=1e-6)


def test_a_figure_that_glides_on_both_feet_does_not_float(standing):
    moved = dragged(standing, {LEFT: 0.2, RIGHT: 0.3})
    np.testing.assert_array_equal(lift_dragged_feet(moved, NOTHING), moved)
    overlapping = dragged(dragged(standing, {LEFT: 0.2}, 3, 8), {RIGHT: 0.2}, 10, 8)
    np.testing.assert_array_equal(lift_dragged_feet(overlapping, NOTHING), overlapping)


def test_two_feet_that_are_dragged_in_turn_are_both_lifted(standing):
    moved = dragged(dragged(standing, {LEFT: 0.2}, 3, 8), {RIGHT: 0.2}, 15, 8)
    made = lift_dragged_feet(moved, NOTHING)
    assert made[:14, LEFT, 1].max() > 0.9 * LEAST
    assert made[14:, RIGHT, 1].max() > 0.9 * LEAST


def test_what_is_short_slow_or_high_is_left_alone(standing):
    short = dragged(standing, {LEFT: 0.9 * FAR})
    slow = dragged(standing, {LEFT: 0.9 * FAST * 29 / 20}, first=0, frames=29)
    high = dragged(standing, {LEFT: 0.3}) + [0.0, 1.1 * LOW, 0.0]
    for moved in (standing, short, slow, high):
        np.testing.assert_array_equal(lift_dragged_feet(moved, NOTHING), moved)
    lifted = lift_dragged_feet(high, NOTHING, floor=1.1 * LOW)  # the floor is where it is said
    np.testing.assert_allclose(
        lifted, lift_dragged_feet(high - [0.0, 1.1 * LOW, 0.0], NOTHING) + [0.0, 1.1 * LOW, 0.0],
        atol=1e-9,
    )  # fmt: skip
    assert np.abs(lifted - high).max() > LEAST / 2


def test_given_legs_stay(standing):
    moved = dragged(standing, {LEFT: 0.3})
    known = NOTHING.copy()
    known[:16, 4] = True
    made = lift_dragged_feet(moved, known)
    np.testing.assert_array_equal(made[:16], moved[:16])
    assert made[16:, LEFT, 1].max() > 0.02  # what is left of the way is a step of its own


def test_a_walk_keeps_its_steps():
    world = walk(np.tile([1.2, 0.0, 0.0], (100, 1)), seed=3).world()
    made = lift_dragged_feet(world, np.zeros((100, 21), bool))
    assert np.linalg.norm(made - world, axis=-1).max() < 0.03
    assert np.abs(made - world)[..., 1].mean() < 1e-3
