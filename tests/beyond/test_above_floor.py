"""Feet above the floor: lifted as far as they were under it, and nothing else moves."""

import numpy as np
from synthetic_walk import walk

from motiondiff_edu.beyond.above_floor import feet_above_floor
from motiondiff_edu.metrics.bone_lengths import bone_lengths
from motiondiff_edu.motion.skeleton import HEELS, TOES

LEGS = [2, 3, 4, 6, 7, 8]  # knees, ankles, toes


def test_a_sunken_walk_stands_on_the_floor_again():
    truth = walk(frames=41)[0]
    sunk = truth - [0.0, 0.06, 0.0]
    nothing = np.zeros(sunk.shape[:2], bool)
    made = feet_above_floor(sunk, nothing)
    feet = [*HEELS, *TOES]
    assert sunk[:, feet, 1].min() < -0.05 and made[:, feet, 1].min() > -1e-6
    others = [j for j in range(21) if j not in LEGS]
    np.testing.assert_array_equal(made[:, others], sunk[:, others])
    np.testing.assert_allclose(bone_lengths(made), bone_lengths(sunk), atol=1e-9)
    np.testing.assert_allclose(  # feet keep their slope
        made[:, list(TOES)] - made[:, list(HEELS)], sunk[:, list(TOES)] - sunk[:, list(HEELS)]
    )
    deep = np.minimum(sunk[:, [3, 4], 1].min(1), 0)
    np.testing.assert_allclose(made[:, 3, 1] - sunk[:, 3, 1], -deep, atol=1e-6)


def test_given_legs_and_feet_on_the_floor_stay():
    truth = walk(frames=21)[0]
    high = truth + [0.0, 0.02 - truth[..., 1].min(), 0.0]
    np.testing.assert_array_equal(feet_above_floor(high, np.zeros((21, 21), bool)), high)
    sunk = high - [0.0, 0.08, 0.0]
    np.testing.assert_array_equal(feet_above_floor(sunk, np.ones((21, 21), bool)), sunk)
