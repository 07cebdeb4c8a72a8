"""metrics.walks, on walks that keep the control and walks that do not.

Nought when the feet go where the control says, else the difference in velocity.
"""

import numpy as np
import pytest
from gaits import FPS, control_of, gait, rest_pose

from motiondiff_edu.metrics.walks import (
    adherence,
    implied_root_velocity,
    residual_velocity,
    skating,
)
from motiondiff_edu.motion.root_frame import to_world
from motiondiff_edu.motion.skeleton import MIRROR, TOES

CONTROLS = [control_of(6), control_of(5, 0.9, 0.3, 0.8), control_of(5, -0.4, 0.0, -1.5)]


@pytest.mark.parametrize("control", CONTROLS)
def test_a_perfect_gait_adheres(control):
    assert adherence(gait(control), control) < 1e-9


def test_standing_still_under_no_control_adheres_and_under_a_control_does_not():
    still = np.tile(rest_pose(), (45, 1, 1))
    assert adherence(still, np.zeros((45, 3))) == 0
    assert adherence(still, np.tile([0.3, 0.4, 0.0], (45, 1))) == pytest.approx(0.5)


@pytest.mark.parametrize("control", CONTROLS)
def test_feet_that_walk_at_their_own_speed_are_off_by_the_difference(control):
    asked = control + [0.16, -0.12, 0.0]
    assert adherence(gait(control), asked) == pytest.approx(0.2)
    np.testing.assert_allclose(
        residual_velocity(gait(control), asked), np.tile([-0.16, 0.12], (len(asked) - 1, 1))
    )


def test_the_implied_velocity_keeps_the_toe_still_in_the_world():
    control = control_of(4, 1.1, -0.2, 0.9)
    poses = np.tile(rest_pose(), (80, 1, 1)) + np.random.default_rng(6).normal(
        0, 0.004, (80, 21, 3)
    )
    poses[:, TOES[1], 1] = 0.02 + 0 * poses[:, TOES[1], 1]
    poses[:, TOES[0], 1] = 0.0  # the left toe is planted throughout
    implied = np.append(implied_root_velocity(poses, control), [[0.0, 0.0]], 0)
    world = to_world(poses, np.concatenate([implied, control[:, 2:]], -1))
    np.testing.assert_allclose(world[:, TOES[0]], np.tile(world[0, TOES[0]], (80, 1)), atol=1e-9)


def test_a_ripple_that_cancels_within_the_second_skates_but_adheres():
    control = control_of(6)
    ripple = 0.3 * np.sin(2 * np.pi * np.arange(120) / FPS)  # one period a second, mean nought
    poses = gait(control)
    assert skating(poses, control + ripple[:, None] * [1, 0, 0]) > 0.15
    assert adherence(poses, control + ripple[:, None] * [1, 0, 0]) < 0.005


def test_mirror_and_batch():
    control = np.stack([control_of(4, 1.0, 0.2, 0.5), control_of(4, 0.6, 0.0, -0.5)])
    noise = np.random.default_rng(9).normal(0, 1e-4, (2, 80, 21, 3))  # no two toes equally low
    poses = np.stack([gait(one) for one in control]) + noise
    wrong = control[::-1]
    figures = adherence(poses, wrong)
    assert figures.shape == (2,) and (figures > 0.3).all()
    np.testing.assert_allclose(
        adherence(poses[:, :, MIRROR] * [-1, 1, 1], wrong * [1, -1, -1]), figures
    )


def test_seconds_in_flight_are_left_out_and_all_flight_has_no_figure():
    control = control_of(5)
    poses = gait(control)
    poses[38:62] += [0.4, 0.3, 0.0]
    assert adherence(poses, control) < 1e-9
    assert np.isnan(adherence(poses + [0, 0.1, 0], control))


def test_a_short_rest_at_the_end_does_not_count_as_a_second():
    control = control_of(2.2)  # 43 steps: two seconds and three steps
    asked = control.copy()
    asked[40:, 0] += 5.0
    assert adherence(gait(control), asked) < 1e-9


def test_half_a_second_at_the_end_counts():
    control = control_of(2.65)  # 52 steps: two seconds and twelve steps
    asked = control.copy()
    asked[40:, 0] += 3.0
    assert adherence(gait(control), asked) == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize(
    "poses, control", [((20, 21, 3), (30, 3)), ((2, 20, 21, 3), (3, 20, 3)), ((20, 21, 3), (3,))]
)
def test_a_control_of_another_length_is_named(poses, control):
    unchecked = getattr(
        adherence, "__wrapped__", adherence
    )  # as in a notebook: no shape is checked
    with pytest.raises(ValueError, match="a row of control for each pose"):
        unchecked(np.zeros(poses), np.zeros(control))
