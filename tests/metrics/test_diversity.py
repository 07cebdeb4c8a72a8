"""diversity: the spread of known spreads, and what it does not see."""

import numpy as np
import pytest
from gaits import rest_pose

from motiondiff_edu.metrics.distributions import spread


def test_equal_rollouts_have_no_spread():
    assert spread(np.tile(rest_pose(), (5, 30, 1, 1))) < 1e-12


def test_independent_noise_of_one_millimetre_spreads_by_root_three_millimetres():
    noise = np.random.default_rng(7).normal(0, 0.001, (40, 60, 21, 3))
    assert spread(rest_pose() + noise) == pytest.approx(0.001 * np.sqrt(3), rel=0.03)


def test_two_rollouts_a_known_way_apart():
    apart = np.stack(
        [np.tile(rest_pose(), (30, 1, 1)), np.tile(rest_pose() + [0.1, 0, 0], (30, 1, 1))]
    )
    assert spread(apart) == pytest.approx(0.1 / np.sqrt(2))


def test_the_first_second_is_not_looked_at():
    rollouts = np.tile(rest_pose(), (3, 30, 1, 1))
    rollouts[0, :20] += 5.0
    assert spread(rollouts) < 1e-12 and spread(rollouts, skip_s=0.0) > 1


def test_a_batch_of_pasts_and_bad_input():
    rollouts = np.random.default_rng(8).normal(size=(4, 6, 25, 21, 3))
    assert np.asarray(spread(rollouts)).shape == (4,)
    assert spread(rollouts)[2] == pytest.approx(spread(rollouts[2]))
    with pytest.raises(ValueError, match="at least 2"):
        spread(rollouts[0, :1])
    with pytest.raises(ValueError, match="end before"):
        spread(rollouts[:, :, :20])
