"""Feet that stand, turns and travel, on figures whose numbers are known."""

import numpy as np
import pytest
from gaits import rest_pose

from motiondiff_edu.metrics.bodies import standing_feet, travel, turning
from motiondiff_edu.motion.skeleton import HEELS, TOES


def still(frames: int = 240) -> np.ndarray:
    return np.tile(rest_pose(), (frames, 1, 1))


def turned(angles: np.ndarray) -> np.ndarray:
    """The figure at rest, facing these angles (radians, from z to x)."""
    pose = still(len(angles))
    x, y, z = np.moveaxis(pose, -1, 0)
    sin, cos = np.sin(angles)[:, None], np.cos(angles)[:, None]
    return np.stack([x * cos + z * sin, y, z * cos - x * sin], -1)


def test_feet_that_never_leave_the_floor_stand():
    assert standing_feet(still()) == 1
    assert standing_feet(still() + [0, 3.0, 0]) == 1  # the floor may lie elsewhere


def test_a_foot_that_rises_half_of_the_time_stands_the_other_half():
    rising = still()
    rising[120:, [HEELS[1], TOES[1]], 1] += 0.16 * np.arange(120)[:, None] / 20
    # 119 of 238 frames; in the first that rises, the frame before is as low as it
    assert standing_feet(rising) == pytest.approx((1 + 119 / 238) / 2, abs=0.005)


def test_a_foot_that_slides_does_not_stand_and_a_slow_one_does():
    along = np.arange(240)[:, None, None] / 20 * [1.0, 0.0, 0.0]
    assert standing_feet(still() + 0.16 * along) == 0
    assert standing_feet(still() + 0.14 * along) == 1


@pytest.mark.parametrize("turns", [1, -1, 2.5])
def test_a_figure_that_spins_evenly_turns_that_often(turns):
    angles = 2 * np.pi * turns * np.arange(300) / 160
    assert turning(turned(angles)) == pytest.approx(360 * abs(turns), rel=1e-3)
    assert turning(turned(angles), seconds=4) == pytest.approx(180 * abs(turns), rel=1e-3)


def test_a_turn_there_and_back_counts_once_and_a_sway_as_far_as_it_goes():
    t = np.arange(400) / 20
    sway = np.radians(20) * np.sin(2 * np.pi * t / 5)
    smoothed = np.exp(-((2 * np.pi / 5 * 0.33) ** 2) / 2)  # what a Gaussian leaves of a sine
    assert turning(turned(sway)) == pytest.approx(40 * smoothed, rel=0.02)
    assert turning(turned(sway + 3.1)) == pytest.approx(turning(turned(sway)))  # across -pi
    assert turning(still()) == pytest.approx(0, abs=1e-9)


def test_a_straight_way_has_its_speed_and_a_place_none():
    along = np.arange(240)[:, None, None] / 20 * [0.3, 0.0, 0.4]
    assert travel(still() + along) == pytest.approx(0.5)
    assert travel(still()) == 0
    up = np.sin(np.arange(240))[:, None, None] * [0, 0.1, 0]
    assert travel(still() + up) == pytest.approx(0, abs=1e-12)  # up and down leads nowhere


def test_a_circle_has_the_speed_that_smoothing_leaves():
    t = np.arange(400) / 20
    period, radius = 4.0, 0.5
    angle = 2 * np.pi * t / period
    place = radius * np.stack([np.cos(angle), 0 * t, np.sin(angle)], -1)[:, None]
    left = np.exp(-((2 * np.pi / period * 0.25) ** 2) / 2)
    wanted = 2 * np.pi * radius / period * left
    assert travel(still(400) + place) == pytest.approx(wanted, rel=0.01)


def test_the_rate_of_frames_changes_nothing():
    t = np.arange(1200) / 60
    sway, way = 0.5 * np.sin(t), np.stack([0.2 * t, 0 * t, 0 * t], -1)[:, None]
    fine = turned(sway) + way
    for measure in (turning, travel, standing_feet):
        assert measure(fine, 60) == pytest.approx(measure(fine[::3], 20), rel=0.02)


def test_what_is_too_short_or_broken_is_said():
    with pytest.raises(ValueError, match="longer clip than 8 s"):
        turning(still(160))
    with pytest.raises(ValueError, match="three frames"):
        standing_feet(still(2))
    with pytest.raises(ValueError, match="two frames"):
        travel(still(1))
    broken = still()
    broken[3] = np.nan
    for measure in (turning, travel, standing_feet):
        with pytest.raises(ValueError, match="NaN"):
            measure(broken)
