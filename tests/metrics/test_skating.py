"""metrics.walks, on feet that stand, slide and fly.

Nought for feet that stand, the slide itself for feet that slide, nothing for feet in the air.
"""

import numpy as np
import pytest
from gaits import FPS, control_of, gait, rest_pose

from motiondiff_edu.metrics.walks import (
    adherence,
    ground_velocity,
    planted_share,
    planted_toe,
    skating,
)
from motiondiff_edu.motion.root_frame import forward_left, root_path, to_root_frame, to_world
from motiondiff_edu.motion.skeleton import MIRROR, TOES, joint_index

CONTROLS = [
    control_of(6),
    control_of(5, 0.9, 0.3, 0.8),
    control_of(5, -0.4, 0.0, -1.5),
    control_of(3, 0.0),
]


@pytest.mark.parametrize("control", CONTROLS)
def test_a_perfect_gait_does_not_skate(control):
    assert skating(gait(control), control) < 1e-9


def test_a_figure_that_stands_still_does_not_skate():
    assert skating(np.tile(rest_pose(), (9, 1, 1)), np.zeros((9, 3))) == 0


@pytest.mark.parametrize("control", CONTROLS)
def test_a_known_slide_is_read_as_it_is(control):
    faster = control + [0.12, 0.16, 0.0]  # carried along at 0.2 m/s more than the feet do
    assert skating(gait(control), faster) == pytest.approx(0.2)


def test_a_slide_built_into_the_feet_is_read_too():
    control = control_of(8)
    assert skating(gait(control, slide=0.2), control) == pytest.approx(0.2, rel=0.03)


def test_ground_velocity_is_the_velocity_in_the_world():
    rng = np.random.default_rng(4)
    poses = rng.normal(size=(11, 21, 3))
    control = rng.normal(size=(11, 3))
    world = to_world(poses, control, (1.0, 2.0, 0.5))[..., [0, 2]]
    heading = root_path(control, (1.0, 2.0, 0.5))[1]
    forward, left = forward_left((heading[1:] + heading[:-1]) / 2)
    for t in range(10):  # step by step, in the world, seen along the halfway heading
        velocity = (world[t + 1] - world[t]) * FPS
        expected = np.stack([velocity @ left[t], velocity @ forward[t]], -1)
        np.testing.assert_allclose(ground_velocity(poses, control)[t], expected, atol=1e-10)


def test_moving_turning_or_mirroring_the_world_changes_nothing():
    control = control_of(6, 1.0, 0.1, 0.6)
    poses = gait(control) + np.random.default_rng(5).normal(0, 0.003, (120, 21, 3))
    world = to_world(poses, control, (9.0, -4.0, 2.2))
    path, heading = root_path(control, (9.0, -4.0, 2.2))
    moved, control_again = to_root_frame(world, path, heading)
    mirrored = skating(poses[:, MIRROR] * [-1, 1, 1], control * [1, -1, -1])
    assert skating(moved, control_again) == pytest.approx(skating(poses, control), rel=1e-6)
    assert mirrored == pytest.approx(skating(poses, control))


def test_a_batch_gives_one_figure_a_clip():
    control = np.stack([control_of(4), control_of(4, 0.7)])
    poses = np.stack([gait(one) for one in control])
    figures = skating(poses, control + [[[0.0, 0, 0]], [[0.1, 0, 0]]])
    np.testing.assert_allclose(figures, [0, 0.1], atol=1e-9)


def test_a_floating_figure_has_no_figure_instead_of_a_good_one():
    control = control_of(3)
    poses = gait(control) + [0, 0.05, 0]
    assert np.isnan(skating(poses, control)) and planted_share(poses) == 0


def test_a_single_pose_makes_no_step_and_has_no_figure(recwarn):
    control = control_of(3)
    poses = gait(control)
    assert np.isnan(skating(poses[:1], control[:1])) and np.isnan(planted_share(poses[:1]))
    assert not recwarn.list


def test_flight_is_left_out():
    control = control_of(6)
    poses = gait(control)
    poses[40:60] += [0.3, 0.2, 0.0]  # a second in the air, and to the side
    side, planted = planted_toe(poses)
    assert not planted[39:60].any() and planted[:39].all() and skating(poses, control) < 1e-9


def test_the_lower_toe_is_the_one_that_is_judged():
    control = control_of(2, 0.0)
    poses = np.tile(rest_pose(), (40, 1, 1))
    poses[:, 8, 1] = 0.01  # right toe under 3 cm, a little above the left one, and sliding
    poses[:, 8, 2] += np.arange(40) * 0.01
    assert (planted_toe(poses)[0] == 0).all() and skating(poses, control) < 1e-9


def with_nan(array: np.ndarray, *where) -> np.ndarray:
    array = array.copy()
    array[where] = np.nan
    return array


@pytest.mark.parametrize("measure", [skating, adherence])
def test_what_is_missing_is_refused_and_not_left_out(measure):
    control = control_of(3)
    poses = gait(control)
    for broken in (with_nan(poses, slice(4, None, 10)), with_nan(poses, ..., TOES, 1)):
        with pytest.raises(ValueError, match="heights of the toes contain NaN .*fill or cut"):
            measure(broken, control)
    with pytest.raises(ValueError, match=r"x and z .* \(1 values, the first at index \(7, 1, 0\)"):
        measure(with_nan(poses, 7, TOES[1], 0), control)
    with pytest.raises(ValueError, match="rows of control contain NaN"):
        measure(poses, with_nan(control, 9, 2))


def test_a_figure_of_nan_does_not_float():
    poses = gait(control_of(3))
    for broken in (with_nan(poses, 4), np.full_like(poses, np.nan)):
        with pytest.raises(ValueError, match="heights of the toes contain NaN"):
            planted_share(broken)


def test_joints_that_are_not_measured_may_be_missing():
    control = control_of(3)
    poses = gait(control)
    broken = with_nan(poses, slice(None), joint_index("LeftHand"))
    assert skating(broken, control) == skating(poses, control)


@pytest.mark.parametrize("rows", [1, 2, 40])
def test_a_control_of_another_length_is_told_and_not_repeated(rows):
    control = control_of(5)
    poses = gait(control)
    unchecked = getattr(ground_velocity, "__wrapped__", ground_velocity)  # as in a notebook
    with pytest.raises(ValueError, match="a row of control for each pose"):
        unchecked(poses, control[:rows])
