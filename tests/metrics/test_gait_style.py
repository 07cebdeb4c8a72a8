"""Styles of walks: by hand, whichever way the figure goes, and between pasts."""

import numpy as np
import pytest

from data_synth.variations import limbs_turned
from data_synth.walking import walk
from motiondiff_edu.conditions.control import constant_control
from motiondiff_edu.metrics.walks import HANDS, HEELS, NAMES, NECK, gait_style, style_kept
from motiondiff_edu.motion.kinematics import rot_y
from motiondiff_edu.motion.skeleton import OFFSETS, PARENTS

FPS = 20


def standing(frames: int = 41) -> np.ndarray:
    pose = np.zeros((21, 3))
    for joint, parent in enumerate(PARENTS):
        pose[joint] = OFFSETS[joint] + (pose[parent] if joint else 0)
    return np.tile(pose, (frames, 1, 1))


def test_the_numbers_by_hand_and_the_way_does_not_matter():
    positions, t = standing(), np.arange(41) / FPS
    positions[:, NECK, 2] += np.tan(0.2) * (positions[:, NECK, 1] - positions[:, 0, 1])
    positions[:, HANDS[0], 2] += 0.3 * np.sin(2 * np.pi * t)
    positions[:, HEELS[0], 2] += 0.2 * np.sin(2 * np.pi * (t + 0.06))
    positions[:, HEELS[0], 0] += 0.05
    width = 2 * 0.085 + 0.05
    swing = (0.3 * np.sin(2 * np.pi * t)).std()
    wanted = [0.2, width, swing, 2.0]  # two crossings in each second of a stride
    np.testing.assert_allclose(gait_style(positions), wanted, atol=1e-9)
    np.testing.assert_allclose(gait_style(positions @ rot_y(2.0).T + [3.0, 0, 1]), wanted)
    assert len(NAMES) == 4


def test_a_faster_walk_takes_more_steps():
    slow, fast = (
        gait_style(walk(constant_control(v, seconds=8.0), seed=1).world()) for v in (0.7, 1.5)
    )
    assert 1.0 < slow[3] < fast[3] < 2.6


def test_a_motion_is_nearest_to_its_own_style_and_chance_is_a_half():
    rng = np.random.default_rng(0)
    pasts = rng.normal(size=(40, 4)) * [0.1, 0.02, 0.1, 0.3]
    each = [str(k) for k in range(40)]
    assert (style_kept(pasts, pasts, each) == 1).all()
    assert style_kept(pasts, np.roll(pasts, 1, 0), each).mean() == pytest.approx(0.5, abs=0.06)
    same = np.tile(pasts.mean(0), (40, 1))
    assert style_kept(pasts, same, each).mean() == pytest.approx(0.5)
    assert (style_kept(np.zeros((3, 4)), np.zeros((3, 4)), "abc") == 0.5).all()


def test_another_past_of_the_same_person_does_not_count():
    pasts = np.array([[0.0, 0, 0, 0], [0.1, 0, 0, 0], [1.0, 0, 0, 0], [3.0, 0, 0, 0]])
    made = np.array([[0.1, 0, 0, 0], [0.0, 0, 0, 0], [0.0, 0, 0, 0], [3.0, 0, 0, 0]])
    assert style_kept(pasts, made, "aabb").tolist() == [1, 1, 0, 1]
    assert style_kept(pasts, made, "abcd")[0] == pytest.approx(2 / 3)


def test_who_stands_takes_no_steps():
    trembling = standing() + 0.001 * np.random.default_rng(0).normal(size=(41, 21, 3))
    assert gait_style(trembling)[3] == 0


def test_other_arms_are_another_style():
    positions = walk(constant_control(1.1, seconds=8.0), seed=1).world()
    moved = limbs_turned(positions, np.random.default_rng(0))
    assert np.abs(gait_style(moved) - gait_style(positions))[:3].max() > 0.02


@pytest.mark.parametrize("broken", ["pasts", "continuations"])
def test_a_style_that_is_not_finite_is_refused(broken):
    """One row of NaN would make the spread NaN, and give every continuation a share of 0."""
    pasts, made = (np.random.default_rng(k).normal(size=(6, 4)) for k in (0, 1))
    (pasts if broken == "pasts" else made)[3, 1] = np.nan
    with pytest.raises(ValueError, match=f"styles of the {broken} .* first at index .3, 1"):
        style_kept(pasts, made, "aabbcc")


@pytest.mark.parametrize(
    "wrong",
    [lambda: gait_style(standing(1)), lambda: style_kept(np.zeros((2, 4)), np.zeros((2, 4)), "aa")],
)
def test_too_little_is_refused(wrong):
    with pytest.raises(ValueError, match="two"):
        wrong()
