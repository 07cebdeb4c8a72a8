"""Where a motion leaves the given one: each kind is told, and what stays within is not."""

import re

import numpy as np
import pytest

from data_synth.walking import walk
from motiondiff_edu.metrics.strays import strays
from motiondiff_edu.motion.kinematics import rot_y
from motiondiff_edu.motion.skeleton import joint_index

RIGHT_HAND, LEFT_TOE = joint_index("RightHand"), joint_index("LeftToeBase")


FEET = [joint_index(side + part) for side in ("Left", "Right") for part in ("Foot", "ToeBase")]


@pytest.fixture(scope="module")
def halves() -> tuple[np.ndarray, np.ndarray]:
    """Four seconds of a walk, and the four that follow."""
    world = walk(np.tile([1.1, 0.0, 0.3], (160, 1)), seed=5).world()
    return world[:80], world[80:]


def test_a_walk_that_goes_on_strays_nowhere(halves):
    given, made = halves
    assert strays(made, given) == []
    turned = made @ rot_y(np.array(2.0)).T + [3.0, 0.0, -7.0]  # wherever it goes
    assert strays(turned, given) == []


def test_a_hand_that_rises_is_told(halves):
    given, made = halves
    raised = made.copy()
    rise = 0.7 * np.sin(np.linspace(0, np.pi, 40))
    raised[20:60, RIGHT_HAND, 1] += rise
    (words,) = strays(raised, given)
    assert (
        words.startswith("RightHand goes") and "above where the given motion ever has it" in words
    )
    assert "(2.0 s)" in words or "(1.9 s)" in words
    assert strays(raised, np.concatenate([given, raised])) == []  # it had risen before


def test_a_jump_and_a_fall_through_the_floor_are_told(halves):
    given, made = halves
    fast = made.copy()
    fast[40, LEFT_TOE] += [0.0, 0.0, 0.6]
    assert any("LeftToeBase moves at" in words for words in strays(fast, given))
    low = made - [0, 0.1, 0]
    assert any("10 cm under the lowest place" in words for words in strays(low, given))


def test_only_what_is_new_is_judged_and_gaps_are_no_evidence(halves):
    given, made = halves
    new = np.zeros(made.shape[:2], bool)
    raised = made.copy()
    raised[20:60, RIGHT_HAND, 1] += 0.8
    new[:, LEFT_TOE] = True
    assert strays(raised, given, new) == []
    new[:, RIGHT_HAND] = True
    assert len(strays(raised, given, new)) >= 1
    without = given.copy()
    without[:, RIGHT_HAND] = np.nan  # where it was never given, nothing can be said of its reach
    assert not any("goes" in words for words in strays(raised, without, new))


def test_keyframes_are_evidence_of_places_and_not_of_speeds(halves):
    given, made = halves
    apart = np.where(np.arange(80)[:, None, None] % 20, np.nan, given)
    assert strays(3 * given, 3 * apart) == []  # a foot is faster than 4 m/s, as in a run
    beside = np.abs(given[:, FEET[0]] - given[:, FEET[2]]).sum(-1).argmin()
    assert strays(given, given[beside : beside + 1]) == []  # one pose, with a foot beside the other
    raised = made.copy()
    rise = 0.5 * np.sin(np.linspace(0, np.pi, 40))
    raised[20:60, RIGHT_HAND, 1] += rise
    assert len(strays(raised, given)) == 1 and strays(raised, apart) == []
    raised[20:60, RIGHT_HAND, 1] += rise
    (words,) = strays(raised, apart)
    assert words.startswith("RightHand goes")


def test_a_foot_may_go_where_the_other_one_was(halves):
    given, made = halves
    kicked, before = made.copy(), given.copy()
    kicked[20:60, FEET[0], 1] += 0.6
    assert any("above where the given motion ever has a foot" in w for w in strays(kicked, given))
    before[20:60, FEET[2], 1] += 0.6
    assert strays(kicked, before) == []


def test_without_given_feet_nothing_is_said_of_the_floor(halves):
    given, made = halves
    without = given.copy()
    without[:, FEET] = np.nan
    sunk = made - [0, 0.4, 0]
    assert strays(sunk, without) == [] and len(strays(sunk, given)) == 1
    assert strays(made, np.full_like(given, np.nan)) == []


def test_a_jump_from_a_given_frame_to_a_generated_one_is_told(halves):
    given, _ = halves
    new = np.ones(given.shape[:2], bool)
    new[::20] = False
    assert strays(given, np.where(new[..., None], np.nan, given), new) == []
    still = np.repeat(given[:1], len(given), 0)
    off = still.copy()
    off[41:60, LEFT_TOE, 1] += np.linspace(0.54, 0, 19)  # at once; then 3 cm a frame back
    (words,) = strays(off, np.where(new[..., None], np.nan, still), new)
    assert re.fullmatch(
        r"LeftToeBase jumps by 51 cm where given and generated frames meet \(2\.[01] s\)", words
    )
    assert strays(off, off, np.zeros_like(new)) == []  # nothing was generated
