"""The jump at a seam, by hand."""

import numpy as np
import pytest

from motiondiff_edu.metrics.keyframes import seam_over_motion, seam_over_past, seam_step


def moving(steps) -> np.ndarray:
    """Two joints; the first moves by these steps along x, the other stays."""
    x = np.concatenate([[0.0], np.cumsum(steps)])
    positions = np.zeros((len(x), 2, 3))
    positions[:, 0, 0] = x
    return positions


def test_the_step_to_the_seam_over_the_fastest_step_around_it():
    assert seam_over_motion(moving([1, 2, 6, 3, 1]), 3) == pytest.approx(6 / 3)
    assert seam_over_motion(moving([1, 8, 6, 3, 1]), 3) == pytest.approx(6 / 8)
    assert seam_over_motion(moving([1] * 30 + [4] + [1] * 30), 31) == pytest.approx(4)


def test_a_fast_continuation_does_not_excuse_a_jump():
    assert seam_over_past(moving([1, 2, 6, 30, 1]), 3) == pytest.approx(6 / 2)
    assert seam_over_past(moving([9] + [2] * 20 + [4, 1, 1]), 22) == pytest.approx(4 / 2)


def test_a_joint_that_jumps_is_seen_beside_one_that_swings():
    both = moving([1, 2, 6, 3, 1, 1])
    both[:, 1, 2] = np.cumsum([0, 8, 8, 0, 8, 8, 8])  # another joint is faster, but not at the seam
    assert seam_step(both, 3) == pytest.approx(6 - 3) and seam_over_motion(both, 3) < 1
    assert seam_step(moving([9, 1, 2, 6, 3, 1, 9]), 4) == pytest.approx(6 - 3)
    assert seam_step(moving([1, 7, 6, 1, 1]), 3) == 0, "the other joint stands"
    with pytest.raises(ValueError, match="from 2 to 4"):
        seam_step(both[:6], 5)


def test_only_a_second_around_it_counts():
    far = [9] + [1] * 25 + [4] + [2] * 25 + [9]
    assert seam_over_motion(moving(far), 27) == pytest.approx(4 / 2)
    assert seam_over_motion(moving(far), 27, fps=40) == pytest.approx(4 / 9)


@pytest.mark.parametrize("seam", [0, 1, 5, 9])
def test_a_seam_needs_frames_on_both_sides(seam):
    with pytest.raises(ValueError, match="the seam must be from 2 to 4"):
        seam_over_motion(moving([1, 1, 1, 1, 1]), seam)
