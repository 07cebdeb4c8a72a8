"""An edit of a motion: what is held follows from what was pinned and kept.

Answers are measured as they are.
"""

from functools import partial

import numpy as np
import pytest
from seeds import seeded
from small_dancers import small_inbetweener
from synthetic_walk import walk

from motiondiff_edu.baselines.interpolation import spherical
from motiondiff_edu.editing.edit import Edit, drag_in_words, make_between
from motiondiff_edu.editing.inbetween import inbetween
from motiondiff_edu.editing.masks import LOWER, PARTS
from motiondiff_edu.motion.skeleton import BONES, JOINTS, joint_index

T, HAND = 24, joint_index("RightHand")


@pytest.fixture(scope="module")
def motion() -> np.ndarray:
    return walk(frames=T, turn=0.6)[0]


def test_what_is_known_follows_from_pins_and_the_part_that_is_kept(motion):
    edit = Edit(motion)
    assert (
        not edit.known.any()
        and np.array_equal(edit.positions, motion)
        and str(edit) == "nothing is pinned or kept"
    )
    edit = edit.pin(3).pin(-1).keep("lower body")
    wanted = np.zeros((T, 21), bool)
    wanted[:, [0, *(joint_index(name) for name in LOWER)]] = True
    wanted[[3, 23]] = True
    assert np.array_equal(edit.known, wanted)
    assert str(edit) == "2 frames pinned, lower body kept"
    assert np.array_equal(edit.keep(None).unpin(3).known.any(1).nonzero()[0], [23])
    assert str(edit.unpin(3).unpin(23)) == "no frame pinned, lower body kept"


def test_a_dragged_joint_changes_its_frame_alone_and_the_edit_before_stays(motion):
    before = Edit(motion).pin(7).pin(15)
    target = motion[7, HAND] + [0.1, 0.2, 0.0]
    after = before.drag(7, "RightHand", target)
    np.testing.assert_allclose(after.positions[7, HAND], target, atol=1e-9)
    others = [t for t in range(T) if t != 7]
    assert np.array_equal(after.positions[others], motion[others]) and np.array_equal(
        before.positions, motion
    )
    for parent, child in BONES:
        lengths = [np.linalg.norm(p[7, child] - p[7, parent]) for p in (motion, after.positions)]
        assert lengths[1] == pytest.approx(lengths[0])
    assert after.moved == {7: ("RightHand",)} and str(after) == "2 frames pinned (1 edited)"
    assert after.drag(7, "Head", target).moved == {7: ("RightHand", "Head")}
    assert after.unpin(7).moved == {} == after.pin(7).moved
    assert drag_in_words(before, after, 7, "RightHand", target) == "moved by 22 cm"
    far = before.drag(7, "RightHand", motion[7, HAND] + [9.0, 0, 0])
    assert "out of reach of its bones" in drag_in_words(
        before, far, 7, "RightHand", motion[7, HAND] + [9.0, 0, 0]
    )


def test_a_pin_is_a_copy(motion):
    mine, pose = np.array(motion), np.array(motion[9])
    edit = Edit(mine).pin(3).pin(5, pose)
    edit.pins[3][:] = edit.pins[5][:] = 0
    assert np.array_equal(mine, motion) and np.array_equal(pose, motion[9])


def test_frames_count_from_the_end_as_well(motion):
    before = Edit(motion).pin(-1)
    target = motion[-1, HAND] + [0.1, 0.2, 0.0]
    after = before.drag(-1, "RightHand", target)
    assert (before.index(-1), before.index(0)) == (T - 1, 0) and list(after.moved) == [T - 1]
    assert drag_in_words(before, after, -1, "RightHand", target) == "moved by 22 cm"


def test_a_frame_can_be_pinned_in_another_pose_and_a_torn_one_is_told(motion):
    edit = Edit(motion).pin(5, motion[9])
    assert np.array_equal(edit.positions[5], motion[9]) and edit.torn == ()
    assert edit.keep("trajectory").torn == (5,)
    hand = Edit(motion).pin(5).drag(5, "RightHand", motion[5, HAND] + [0, 0.1, 0])
    assert hand.keep("upper body").torn == (5,) and hand.keep("lower body").torn == ()


def test_what_cannot_be_edited(motion):
    edit = Edit(motion).pin(2)
    for act in (edit.pin, edit.unpin):
        with pytest.raises(
            IndexError, match=r"frame 24 is not within a motion of 24 frames \(0 to 23\)"
        ):
            act(24)
    with pytest.raises(ValueError, match="frame 4 is not pinned"):
        edit.drag(4, "Head", motion[4, 12])
    with pytest.raises(KeyError, match="no joint is called 'Tail'"):
        edit.drag(2, "Tail", motion[4, 12])
    assert "whole body" in PARTS
    with pytest.raises(
        KeyError,
        match="no part is called 'whole body'; there are upper body, lower body, trajectory",
    ):
        edit.keep("whole body")


def test_an_untrained_network_keeps_what_is_held_bit_by_bit(motion):
    edit = Edit(motion).pin(0).pin(10).pin(23).keep("trajectory")
    edit = edit.drag(10, "RightHand", motion[10, HAND] + [0.0, 0.3, 0.1])
    make = partial(inbetween, small_inbetweener(), steps=4)
    made = make_between(edit, make, seeded(1), samples=3, resample=2)
    assert made.samples.shape == (3, T, 21, 3)
    assert all(np.array_equal(one[edit.known], edit.positions[edit.known]) for one in made.samples)
    assert made.keyframe_error.tolist() == [0, 0, 0] and (made.seam_jump > 0).all()
    again = make_between(edit, make, seeded(1), samples=3, resample=2)
    assert np.array_equal(again.samples, made.samples)


def test_what_finds_the_rest_is_told_how_many_and_how_carefully(motion):
    told = []

    def make(positions, known, *, samples, resample, generator):
        told.append((samples, resample, generator.initial_seed()))
        return np.stack([spherical(positions, known)] * samples)

    made = make_between(Edit(motion).pin(0).pin(20), make, seeded(6), samples=3, resample=4)
    assert len(made.samples) == 3 and told == [(3, 4, 6)]
    with pytest.raises(ValueError, match=r"shape \(3, 24, 21, 3\); \(2, 24, 21, 3\) is needed"):
        make_between(Edit(motion).pin(0), lambda p, k, **_: np.stack([p] * 3), seeded(), samples=2)


def test_measures_are_the_answers_own_and_said_in_words(motion):
    edit = Edit(motion).pin(0).pin(12).pin(23)

    def off(positions, known, **_):
        one = np.array(positions)
        one[12] += [0.0, 0.03, 0.04]  # 5 cm off in one of three pinned frames
        return one[None]

    made = make_between(edit, off, seeded())
    assert made.keyframe_error[0] == pytest.approx(0.05 / 3)
    same = make_between(edit, lambda p, k, **_: p[None], seeded())
    assert (
        same.seam_jump[0] == pytest.approx(same.motions_jump)
        and made.seam_jump[0] > same.seam_jump[0]
    )
    assert made.measured(0).startswith("keyframe error 16.7 mm, seam jump ")
    free = make_between(Edit(motion), lambda p, k, **_: p[None], seeded())
    assert free.measured(0) == "no keyframe"


@pytest.mark.parametrize(
    "answer, message",
    [
        (lambda p: p, r"shape \(24, 21, 3\); \(1, 24, 21, 3\) is needed"),
        (lambda p: p[None, :9], r"shape \(1, 9, 21, 3\)"),
        (lambda p: p[None][:0], r"shape \(0, 24, 21, 3\)"),
        (
            lambda p: np.where(np.arange(T)[:, None, None] == 6, np.nan, p)[None],
            "1 is not finite in frame 6, Hips",
        ),
    ],
)
def test_wrong_answers_are_told(motion, answer, message):
    with pytest.raises(ValueError, match=message):
        make_between(Edit(motion).pin(0), lambda p, k, **_: answer(p), seeded())


def test_nothing_left_to_make(motion):
    edit = Edit(motion)
    for frame in range(T):
        edit = edit.pin(frame)
    assert edit.known.sum() == T * len(JOINTS)
    with pytest.raises(ValueError, match="every frame is pinned, so there is nothing to generate"):
        make_between(edit, lambda p, k, **_: p[None], seeded())
