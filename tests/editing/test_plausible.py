"""What was generated is judged beside what was given: jumps are told, walks are not."""

import numpy as np
import pytest
from gaits import rest_pose

from motiondiff_edu.editing.masks import keyframes
from motiondiff_edu.editing.plausible import wilder_than_given
from motiondiff_edu.motion.skeleton import JOINTS


def standing(frames: int = 41, speed: float = 0.0) -> np.ndarray:
    """The rest pose, moved along z at a speed in m/s."""
    moved = np.zeros((frames, 1, 3))
    moved[:, 0, 2] = speed / 20 * np.arange(frames)
    return rest_pose() + moved


KNOWN = keyframes(41, 20)


@pytest.mark.parametrize("speed", [0.0, 1.4, 6.0])
def test_a_motion_that_does_what_the_keyframes_ask_is_plausible(speed):
    given = standing(speed=speed)
    assert wilder_than_given(given[None], given, KNOWN) == ""


def test_a_pelvis_that_leaves_the_way_is_told_with_its_gap():
    given = standing(speed=1.0)
    made = np.stack([given, given])
    made[1, 25:30, :, 0] += 1.5  # there and back: 1.5 m in a frame
    words = wilder_than_given(made, given, KNOWN)
    assert "30.0 m/s between frames 20 and 40, where 1.0 m/s would do (1 such gaps)" in words


def test_a_hand_faster_than_any_actors_is_told():
    given = standing()
    made = given[None].copy()
    made[0, 10, JOINTS.index("LeftHand"), 1] += 2.0
    assert "40 m/s near frame" in wilder_than_given(made, given, KNOWN)


def test_a_given_joint_may_be_as_fast_as_it_is():
    given = standing()
    given[20, JOINTS.index("LeftHand"), 1] += 2.0
    everything = np.ones((41, len(JOINTS)), bool)
    assert wilder_than_given(given[None], given, everything) == ""


def test_an_end_that_leads_nowhere_is_free():
    """Half a second is given, then nothing: the figure may walk off at any pace of a person."""
    given = standing()
    known = np.zeros((41, len(JOINTS)), bool)
    known[:10] = True
    made = given[None].copy()
    made[0, 10:, :, 2] += 0.2 * np.arange(31)[:, None]
    assert wilder_than_given(made, given, known) == ""
