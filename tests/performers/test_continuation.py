"""Continuations of motions unlike the training: said, joined without a jump, given frames kept."""

import warnings

import numpy as np
import pytest
import torch

import motiondiff_edu as md
from data_synth.walking import drawn_walk, walk
from motiondiff_edu.conditions.control import constant_control
from motiondiff_edu.metrics.bodies import bone_lengths
from motiondiff_edu.metrics.keyframes import seam_over_motion, seam_step
from motiondiff_edu.metrics.walks import skating
from motiondiff_edu.motion.cleanup import LONGEST
from motiondiff_edu.motion.inverse_kinematics import drag
from motiondiff_edu.motion.motion import Motion, MotionWarning
from motiondiff_edu.motion.root_frame import control_from_path, to_root_frame
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.motion.skeleton import JOINTS, TOES, joint_index
from motiondiff_edu.performers.continuation import (
    OFF_FLOOR,
    UNLIKE,
    Start,
    around_seam,
    change_of,
    finish_continuation,
    in_words,
    unlike_training,
)

JUMP = 0.05  # m in a frame more than beside the seam: a jump that one sees
AHEAD = np.tile([1.0, 0.0, 0.0], (50, 1))


@pytest.fixture(scope="module")
def walker():
    return md.load("walker")


@pytest.fixture(scope="module")
def usual() -> Motion:
    return Motion.of_clip(walk(constant_control(1.0, seconds=3.0), seed=5))


@pytest.fixture(scope="module")
def unusual(usual) -> Motion:
    """The same walk with both hands above the head, which no walk of the training has."""
    moved = usual.positions.copy()
    for pose in moved:
        for hand in ("LeftHand", "RightHand"):
            above = pose[joint_index("Head")] + [0.0, 0.35, 0.0]
            pose[:] = drag(pose, joint_index(hand), above)
    return Motion(moved, usual.fps, root=usual.root, source="reaching")


def step(given: Motion, more: Motion) -> float:
    return seam_step(np.concatenate([given.positions, more.positions]), len(given))


def sliding(more: Motion) -> float:
    poses, _ = to_root_frame(more.positions, more.root[:, :2], more.root[:, 2], 20)
    return skating(poses, control_from_path(more.root[:, :2], more.root[:, 2], 20))


def as_the_network_says(monkeypatch) -> None:
    """Without the clean-up."""
    monkeypatch.setattr("motiondiff_edu.performers.continuation.clean_up", lambda whole, *_: whole)


def without_blending(monkeypatch) -> None:
    """Without the part of the clean-up that joins the seam."""
    monkeypatch.setattr("motiondiff_edu.motion.cleanup.blend_seams", lambda whole, *_: whole)


def test_a_usual_walk_keeps_its_body_and_stands_and_nothing_is_said(walker, usual, monkeypatch):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        more = walker.walk(usual, AHEAD, progress=False)
    assert step(usual, more) < JUMP
    lengths = bone_lengths(usual.positions)[0]
    np.testing.assert_allclose(bone_lengths(more.positions), lengths[None].repeat(50, 0), atol=2e-4)
    as_the_network_says(monkeypatch)
    plain = walker.walk(usual, AHEAD, progress=False)
    assert np.abs(bone_lengths(plain.positions) - lengths).max() > 2e-3
    assert sliding(more) < 0.6 * sliding(plain)
    assert np.linalg.norm(more.positions - plain.positions, axis=-1).mean() < 0.01


def test_what_is_given_is_marked_up_to_its_last_frame(usual):
    start = Start.of(usual, AHEAD[:5], 10)
    whole, known = around_seam(start, start.past[:5])
    given = (whole[:, None] == usual.positions[-1]).all((1, 2, 3)).nonzero()[0]
    assert given.tolist() == [len(whole) - 6]  # the last given frame, and then 5 new ones
    assert known[:-5].all() and not known[-5:].any()


def test_an_unusual_past_is_named_and_joined_without_a_jump(walker, unusual, monkeypatch):
    with pytest.warns(MotionWarning, match=r"reaching: the poses to continue are unlike .*Hand"):
        more = walker.walk(unusual, AHEAD, progress=False)
    without_blending(monkeypatch)
    with pytest.warns(MotionWarning, match="standard deviations away"):
        plain = walker.walk(unusual, AHEAD, progress=False)
    assert step(unusual, plain) > 0.2 and step(unusual, more) < JUMP
    n, hand = round(LONGEST * 20), joint_index("RightHand")
    np.testing.assert_array_equal(more.positions[n:, hand], plain.positions[n:, hand])
    assert np.abs(more.positions[:5] - plain.positions[:5]).max() > 0.1
    assert more.positions[..., 1].min() > -0.02


def test_a_motion_under_the_floor_goes_on_there(walker, usual):
    """It is not lifted at the seam, which would be a jump of the feet."""
    low = Motion(usual.positions - [0.0, 0.06, 0.0], usual.fps, root=usual.root, source="low")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MotionWarning)
        more = walker.walk(low, AHEAD, progress=False)
    assert more.positions[0, list(TOES), 1].min() < -0.02
    assert step(low, more) < JUMP


def test_each_sample_is_joined_for_itself(walker, unusual):
    with pytest.warns(MotionWarning):
        both = walker.walk(unusual, AHEAD, samples=2, progress=False)
        one = walker.walk(unusual, AHEAD, progress=False)
    assert all(step(unusual, more) < JUMP for more in both)
    np.testing.assert_allclose(both[0].positions, one.positions, atol=1e-4)


@pytest.mark.parametrize("frames", [1, 2, 3])
def test_short_continuations_are_left_alone_or_joined(walker, unusual, frames):
    with pytest.warns(MotionWarning):
        more = walker.walk(unusual, AHEAD[:frames], progress=False)
    assert len(more) == frames and np.isfinite(more.positions).all()


def test_joints_that_are_far_from_the_training_come_farthest_first():
    past = torch.zeros(10, 63)
    past[3, 3 * 4] = 3**0.5 * (UNLIKE + 1)
    past[7, 3 * 2 + 1] = 3**0.5 * (UNLIKE + 2)
    past[8, 3 * 1] = 3**0.5 * (UNLIKE - 0.1)
    found = unlike_training(Scaler.nothing(63), past)
    assert list(found) == [JOINTS[2], JOINTS[4]]
    assert found[JOINTS[2]] == pytest.approx(UNLIKE + 2, rel=1e-5)
    known = np.ones((10, 21), bool)
    known[7, 2] = False
    assert list(unlike_training(Scaler.nothing(63), past, known)) == [JOINTS[4]]


def begins(height: float = 0.0, size: float = 1.0) -> Start:
    """A start whose lowest joint is at this height, of a figure of this size."""
    given = np.full((1, 21, 3), height)
    return Start(given, np.zeros((10, 21, 3)), np.zeros((20, 3)), np.zeros((20, 3)), size)


def test_what_is_said():
    start = begins()
    assert in_words(start, JUMP, {}) == ""
    far = in_words(start, 0.2, {"Head": 6.0})
    assert "blended" not in far and "Head 6.0" in far
    assert in_words(start, 0.31, {}) == (
        "a joint would jump by 31 cm from the last pose, so the first frames are blended"
    )
    assert "by 15 cm" in in_words(begins(size=0.5), 0.3, {}), "in metres of the figure itself"
    assert "at" not in in_words(begins(OFF_FLOOR), 0.0, {})
    assert in_words(begins(1.68, 0.5), 0.01, {}) == (
        "the last pose is 0.84 m off the floor, and the walker comes down to it"
    )
    assert "unlike" not in in_words(start, 0.2, {}), "no joint is far from the training"
    four = {name: 9.0 for name in JOINTS[:4]}
    assert JOINTS[3] not in in_words(start, 0.2, four)


def test_a_control_that_no_walk_follows_is_said(walker, usual):
    hard = np.repeat([[1.2, 0.0, 0.0], [-1.5, 0.0, 0.0]], 20, axis=0)
    assert change_of(hard) == pytest.approx(2.7) and change_of(hard[:20]) == 0
    assert change_of(hard[:1]) == 0 and change_of(hard[18:24]) == pytest.approx(2.7)
    walks = [drawn_walk(8.0, np.random.default_rng([5, k])).control for k in range(20)]
    assert max(map(change_of, walks)) < 1.3
    with pytest.warns(MotionWarning, match=r"changes by 2\.\d m/s within half a second"):
        walker.walk(usual, md.joystick([(1, -1.5, 0, 0)]), progress=False)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        walker.walk(usual, md.joystick([(1, 0.0, 0, 0)]), progress=False)


def test_a_jump_is_measured_before_it_is_joined():
    given = np.zeros((20, 21, 3))
    given[:, :, 0] = 0.01 * np.arange(20)[:, None]
    given += np.random.default_rng(0).normal(size=(21, 3))
    new = given[-1] + 0.01 * np.arange(1, 31)[:, None, None] * [1.0, 0.0, 0.0]
    still = np.zeros((40, 3))
    start = Start(given, given[-10:], still, still)
    world, jump = finish_continuation(start, new)
    assert jump == pytest.approx(0.0)
    np.testing.assert_allclose(world[:, 0], new[:, 0])  # legs alone are held where they stand
    _, jump = finish_continuation(start, new + [0.0, 0.0, 0.05])
    assert jump == pytest.approx(np.hypot(0.01, 0.05) - 0.01)


def test_a_hand_that_jumps_out_of_stillness_is_blended_while_a_foot_swings(
    walker, usual, monkeypatch
):
    """The fastest joint of the second around the seam is the foot, and hides the hand."""
    held = usual.positions.copy()
    hand = joint_index("LeftHandIndex1")
    for pose in held[-20:]:
        above = pose[joint_index("LeftArm")] + [0.0, 0.4, 0.1]
        pose[:] = drag(pose, hand, above)
    waiting = Motion(held, usual.fps, root=usual.root, source="waiting")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MotionWarning)
        more = walker.walk(waiting, AHEAD, progress=False)
        without_blending(monkeypatch)
        plain = walker.walk(waiting, AHEAD, progress=False)
    assert step(waiting, plain) > 2 * JUMP > 2 * step(waiting, more)
    whole = np.concatenate([waiting.positions, plain.positions])
    assert seam_over_motion(whole, len(held)) < 1.1
