"""What was generated is judged beside what was given: jumps are told, walks are not."""

import numpy as np
import pytest
from gaits import rest_pose

from motiondiff_edu.baselines.interpolation import linear
from motiondiff_edu.editing.masks import keyframes
from motiondiff_edu.editing.plausible import (
    AGAIN,
    CALMED,
    CALMER,
    DRAWS,
    SINKS,
    STILL,
    folded,
    longest_glide,
    lower_than_given,
    parts_of,
    until_plausible,
    wilder_than_given,
)
from motiondiff_edu.motion.dance_frame import Place
from motiondiff_edu.motion.skeleton import JOINTS, TOES


def standing(frames: int = 41, speed: float = 0.0) -> np.ndarray:
    """The rest pose, moved along z at a speed in m/s."""
    moved = np.zeros((frames, 1, 3))
    moved[:, 0, 2] = speed / 20 * np.arange(frames)
    return rest_pose() + moved


KNOWN = keyframes(41, 20)


@pytest.mark.parametrize("speed", [0.0, 1.4, 6.0])
def test_a_motion_that_does_what_the_keyframes_ask_is_plausible(speed):
    given = standing(speed=speed)
    assert wilder_than_given(given, given, KNOWN) == ""


def test_a_pelvis_that_leaves_the_way_is_told_with_its_gap():
    given = standing(speed=1.0)
    made = given.copy()
    made[25:30, :, 0] += 1.5  # there and back: 1.5 m in a frame
    words = wilder_than_given(made, given, KNOWN)
    assert "30.0 m/s between frames 20 and 40, where 1.0 m/s would do. The network" in words


def test_a_hand_faster_than_any_actors_is_told():
    given = standing()
    made = given.copy()
    made[10, JOINTS.index("LeftHand"), 1] += 2.0
    assert "40 m/s near frame" in wilder_than_given(made, given, KNOWN)


def test_a_given_joint_may_be_as_fast_as_it_is():
    given = standing()
    given[20, JOINTS.index("LeftHand"), 1] += 2.0
    everything = np.ones((41, len(JOINTS)), bool)
    assert wilder_than_given(given, given, everything) == ""


def test_an_end_that_leads_nowhere_is_free():
    """Half a second is given, then nothing: the figure may walk off at any pace of a person."""
    given = standing()
    known = np.zeros((41, len(JOINTS)), bool)
    known[:10] = True
    made = given.copy()
    made[10:, :, 2] += 0.2 * np.arange(31)[:, None]
    assert wilder_than_given(made, given, known) == ""


def test_a_figure_that_stands_and_moves_glides():
    made = standing(speed=1.0)
    assert longest_glide(made, KNOWN) == (0, 40)
    assert longest_glide(standing(speed=0.5), KNOWN) == (0, 0)  # slower than SLIDES
    assert longest_glide(made, np.ones_like(KNOWN)) == (0, 0)  # it was given so
    made[21:, TOES[0], 1] += 0.2  # from here on one foot is in the air
    assert longest_glide(made, KNOWN) == (0, 20)
    made[8:, TOES[1], 1] += 0.2
    assert longest_glide(made, KNOWN) == (0, 0)  # 0.35 s


def turned_round(straight: bool) -> np.ndarray:
    """The rest pose turns by almost a half circle, along straight lines or round its axis."""
    angles = np.linspace(0.0, 0.95 * np.pi, 41)
    pose = rest_pose()[None]
    made = np.stack([Place(np.zeros(3), np.array(angle)).leave(pose)[0] for angle in angles])
    return linear(made, keyframes(41, 40)) if straight else made


def test_a_figure_that_folds_is_told_and_one_that_turns_is_not():
    turns, folds = turned_round(False), turned_round(True)
    known = keyframes(41, 40)
    assert not folded(turns, turns, known).any()
    found = np.flatnonzero(folded(folds, turns, known))
    assert found.tolist() == list(range(found[0], found[-1] + 1)) and 20 in found
    assert 10 < len(found) < 35, "at the ends it is open"
    assert not folded(folds, folds, np.ones_like(known)).any(), "it was given so"
    feet = np.zeros_like(known)
    feet[:, list(TOES)] = True
    assert not folded(folds, turns, feet).any(), "nobody knows how wide it should be"
    low = turns.copy()  # the collars alone
    low[15:18, JOINTS.index("LeftArm")] = low[15:18, JOINTS.index("RightArm")] + 0.05
    assert np.flatnonzero(folded(low, turns, known)).tolist() == [15, 16, 17]


def test_a_fold_is_drawn_again_and_else_told():
    turns, folds = turned_round(False), turned_round(True)
    known, drawn = keyframes(41, 40), []

    def again(remainder):
        drawn.append(remainder)
        return turns

    made, note = until_plausible(folds, turns, known, again)
    assert np.array_equal(made, turns) and note == "" and drawn == [1.0]
    made, note = until_plausible(folds, turns, known, lambda remainder: folds)
    assert "folds flat near frame 20, and no other of 4 draws was better" in note


def test_a_glide_is_drawn_again_until_a_figure_steps():
    glides, stands = standing(speed=1.0), standing()
    drawn = []

    def again(remainder):
        drawn.append(remainder)
        return stands if len(drawn) == 2 else glides

    made, note = until_plausible(glides, glides, KNOWN, again)
    assert np.array_equal(made, stands) and note == "" and drawn == [1.0, 1.0]


def test_where_every_draw_glides_the_shortest_is_given_back_and_it_is_said():
    glides, shorter = standing(speed=1.0), standing(speed=1.0)
    shorter[30:, TOES[0], 1] += 0.2
    draws = [glides, shorter, glides]
    left = list(draws)
    made, note = until_plausible(glides, glides, KNOWN, lambda remainder: left.pop(0))
    assert not left and len(draws) == DRAWS - 1
    assert np.array_equal(made, shorter)
    assert "both feet slide between frames 0 and 29" in note


def test_a_figure_that_sinks_is_told_and_one_that_squats_is_not():
    given, made = standing(), standing()
    made[25:30, :, 1] -= SINKS + 0.05
    assert "sinks to" in lower_than_given(made, given, KNOWN)
    assert "between frames 20 and 40, where it is given at" in lower_than_given(made, given, KNOWN)
    wide = keyframes(41, 40)  # there is time to go lower
    assert lower_than_given(made, given, wide) == ""
    made[25:30, :, 1] += 0.1
    assert lower_than_given(made, given, KNOWN) == ""


def jumping(metres: float) -> np.ndarray:
    """Standing, and there and back by so much in a frame."""
    made = standing()
    made[25:30, :, 0] += metres
    return made


def test_a_wild_motion_is_drawn_again_and_it_is_said():
    drawn, stands = [], standing()

    def again(remainder):
        drawn.append(remainder)
        return stands

    made, note = until_plausible(jumping(1.5), standing(), KNOWN, again)
    assert np.array_equal(made, stands) and drawn == [1.0]
    assert "30.0 m/s" in note and note.endswith(AGAIN)


def test_where_every_draw_is_wild_the_first_is_given_back_and_it_is_said():
    first, drawn = jumping(1.5), []

    def again(remainder):
        drawn.append(remainder)
        return jumping(2.0)

    made, note = until_plausible(first, standing(), KNOWN, again)
    assert np.array_equal(made, first) and note.endswith(STILL)
    assert drawn == [1.0] * (DRAWS - 1) + list(CALMER)


def test_what_stays_wild_is_drawn_nearer_to_straight_lines():
    made, note = until_plausible(
        jumping(1.5), standing(), KNOWN, lambda remainder: jumping(1.5 * remainder)
    )
    assert np.array_equal(made, jumping(0.0)) and "30.0 m/s" in note and note.endswith(CALMED)


def test_only_the_part_with_the_fault_is_drawn_again():
    """A hand waves in both parts; the other draw waves otherwise, and stays where it should."""
    first, other = jumping(1.5), standing()
    hand = JOINTS.index("LeftHand")
    first[5:15, hand, 1] += 0.1
    other[5:15, hand, 1] += 0.2
    other[25:35, hand, 1] += 0.2
    made, note = until_plausible(first, standing(), KNOWN, lambda remainder: other)
    assert np.array_equal(made[:21], first[:21]) and np.array_equal(made[20:], other[20:])
    assert note.endswith(AGAIN)


def test_parts_lie_between_frames_that_are_given_whole():
    known = np.zeros((10, len(JOINTS)), bool)
    known[[2, 6, 7]] = True
    known[4, :5] = True  # some joints are no end of a part
    assert parts_of(known) == [slice(0, 3), slice(2, 7), slice(7, 10)]
    assert parts_of(np.zeros_like(known)) == [slice(0, 10)]


def test_a_fault_over_several_parts_is_mended_as_a_whole():
    """Feet slide for half a second, with a keyframe in the middle of it: no part is that long."""
    glides, known = standing(), keyframes(41, 20)
    glides[15:26, :, 2] += 0.04 * np.arange(11)[:, None]
    glides[26:, :, 2] += 0.4
    assert longest_glide(glides, known) == (15, 25)
    made, note = until_plausible(glides, standing(), known, lambda remainder: standing())
    assert np.array_equal(made, standing()) and note == ""


def test_a_glide_is_better_than_a_jump():
    glides, jumps = standing(speed=1.0), standing(speed=1.0)
    jumps[25:30, :, 0] += 9.0
    left = [glides, jumps, jumps]
    made, note = until_plausible(jumps, glides, KNOWN, lambda remainder: left.pop(0))
    assert not left and "both feet slide between frames 0 and 40" in note
    assert np.array_equal(made, glides)


def test_a_plausible_motion_is_given_back_as_it_is():
    given = standing()
    made, note = until_plausible(given, given, KNOWN, lambda remainder: pytest.fail("drawn again"))
    assert made is given and note == ""
