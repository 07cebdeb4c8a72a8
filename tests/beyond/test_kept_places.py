"""Feet that are given twice at one place stay, legs keep their bones, others are left alone."""

import numpy as np
import pytest
from synthetic_walk import walk

from motiondiff_edu.beyond.kept_places import LONGEST, SAME, kept_places, lines_between_plants
from motiondiff_edu.metrics.bone_lengths import bone_lengths
from motiondiff_edu.motion.skeleton import HEELS, TOES

T = 41


def standing_and_swaying() -> tuple[np.ndarray, np.ndarray]:
    """A pose that is held, and a motion that leaves it for a step of the left leg."""
    pose = walk(frames=1)[0][0]
    given = np.repeat(pose[None], T, 0)
    made, away = np.array(given), np.sin(np.linspace(0, np.pi, T))[:, None]
    for joint in (2, HEELS[0], TOES[0]):
        made[:, joint] += away * [0.0, 0.05, 0.1]
    return given, made


def ends() -> np.ndarray:
    known = np.zeros((T, 21), bool)
    known[[0, -1]] = True
    return known


def test_a_foot_that_is_given_twice_at_one_place_stays_and_the_leg_keeps_its_bones():
    given, made = standing_and_swaying()
    kept = kept_places(np.stack([made, given]), given, ends())
    np.testing.assert_allclose(kept[0][:, TOES[0]], given[:, TOES[0]], atol=2e-3)
    assert np.linalg.norm(made[:, TOES[0]] - given[:, TOES[0]], axis=-1).max() > 0.1
    np.testing.assert_allclose(bone_lengths(kept[0]), bone_lengths(made), atol=1e-9)
    np.testing.assert_allclose(kept[1], given, atol=1e-9)
    others = [joint for joint in range(21) if joint not in (2, HEELS[0], TOES[0])]
    np.testing.assert_allclose(kept[0][:, others], made[:, others], atol=1e-9)


@pytest.mark.parametrize("case", ["it is given elsewhere", "too long", "given once", "known leg"])
def test_other_feet_are_left_alone(case):
    given, made = standing_and_swaying()
    known = ends()
    if case == "it is given elsewhere":
        given[-1, TOES[0]] += [1.1 * SAME, 0.0, 0.0]
    if case == "too long":
        given, made = (np.repeat(x, 2, 0) for x in (given, made))
        known = np.zeros((2 * T, 21), bool)
        known[[0, LONGEST + 1]] = True
    if case == "given once":
        known[-1] = False
    if case == "known leg":
        known[:, HEELS[0]] = True
    np.testing.assert_allclose(kept_places(made, given, known), made, atol=1e-9)


def test_the_place_goes_evenly_from_the_one_given_to_the_other():
    toe = np.zeros((5, 3))
    toe[4] = [0.8 * SAME, 0.0, 0.0]
    place, stays = lines_between_plants(toe, np.array([True, False, False, False, True]))
    np.testing.assert_allclose(place[:, 0], 0.8 * SAME * np.arange(5) / 4)
    assert stays.tolist() == [False, True, True, True, False]
