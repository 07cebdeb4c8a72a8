"""Clean motions: bones of one length, feet that stand, given joints where they were."""

import numpy as np
import pytest

from data_synth.dancing.performance import dance
from data_synth.music import GENRES, compose
from data_synth.walking import walk
from motiondiff_edu.conditions.control import constant_control
from motiondiff_edu.metrics.bodies import bone_lengths
from motiondiff_edu.metrics.keyframes import seam_step
from motiondiff_edu.metrics.walks import skating
from motiondiff_edu.motion.cleanup import FARTHEST, Body, clean_up, floor_under, runs
from motiondiff_edu.motion.motion import Motion
from motiondiff_edu.motion.skeleton import BONE_LENGTHS, TOES

FPS = 20


@pytest.fixture(scope="module")
def clean() -> np.ndarray:
    return Motion.of_clip(walk(constant_control(1.0, seconds=3.0), seed=5)).positions


@pytest.fixture(scope="module")
def shaken(clean) -> np.ndarray:
    return wandering(clean)


def wandering(motion: np.ndarray, size: float = 0.02) -> np.ndarray:
    """As a network might give it: every joint wanders by centimetres, slowly."""
    rng = np.random.default_rng(0)
    phase, speed = rng.uniform(0, 6, (21, 3)), rng.uniform(1, 3, (21, 3))
    t = np.arange(len(motion))[:, None, None] / FPS
    return motion + size * np.sin(speed * t + phase)


def stretch(dance: np.ndarray) -> float:
    return float(bone_lengths(dance).std(0).max())


def sliding(dance: np.ndarray) -> float:
    return float(skating(dance[None], np.zeros((1, len(dance), 3)))[0])


def test_bones_of_a_dance_have_their_median_or_the_lengths_that_are_given(shaken):
    made = clean_up(shaken, FPS)
    np.testing.assert_allclose(
        bone_lengths(made)[0], np.median(bone_lengths(shaken), axis=0), atol=3e-3
    )
    assert stretch(made) < 1e-3 < 5e-3 < stretch(shaken)
    assert np.linalg.norm(made - shaken, axis=-1).mean() < 0.03
    longer = 1.1 * BONE_LENGTHS
    found = bone_lengths(clean_up(shaken, FPS, body=Body.of(shaken, bones=longer)))
    np.testing.assert_allclose(found, longer[None].repeat(60, 0), atol=2e-3)


def test_a_figure_that_stands_does_not_slide(clean):
    stands = wandering(np.repeat(clean[:1], 60, axis=0), size=0.01)
    assert sliding(clean_up(stands, FPS)) < 2e-3 < 0.01 < sliding(stands)


@pytest.mark.parametrize("genre", GENRES)
def test_a_dance_keeps_its_steps(genre):
    """Steps are lifted by 3 to 6 cm: a foot lock that takes them for stands would remove them."""
    made = dance(compose(11, genre, seconds=12.0), 3)
    kept = clean_up(made.positions, FPS, body=Body.of(made.positions, bones=BONE_LENGTHS))
    for foot, toe in enumerate(TOES):
        for first, last in runs(~made.contacts[:, foot]):
            ends = max(first - 1, 0), min(last, len(kept) - 1)
            own, left = (
                np.linalg.norm((x[ends[1]] - x[ends[0]])[[0, 2]])
                for x in (made.positions[:, toe], kept[:, toe])
            )
            assert own < 0.05 or left > 0.7 * own, f"{genre}: the step at {first / FPS} s is gone"


def test_no_toe_of_a_dance_is_under_the_floor(clean):
    sunk = clean - [0.0, 0.05, 0.0]
    assert sunk[:, list(TOES), 1].min() < -0.03
    assert clean_up(sunk, FPS)[:, list(TOES), 1].min() > -1e-3


def half_known(clean: np.ndarray) -> np.ndarray:
    known = np.zeros(clean.shape[:2], bool)
    known[:20] = True
    return known


def test_a_clean_walk_hardly_changes(clean):
    """A toe is held from when it lands until it leaves: that is some centimetres of its roll."""
    moved = np.linalg.norm(clean_up(clean, FPS, half_known(clean)) - clean, axis=-1)
    assert moved.mean() < 0.005 and moved.max() < 0.06


def test_a_continuation_that_jumps_is_joined(clean):
    jumps = np.concatenate([clean[:20], clean[20:] + [0.3, 0.0, 0.0]])
    made = clean_up(jumps, FPS, half_known(clean))
    assert seam_step(jumps, 20) > 0.2 and seam_step(made, 20) < 0.03


def test_known_joints_stay_and_give_the_lengths(clean, shaken):
    known = half_known(clean)
    half = np.where(known[..., None], clean, shaken)
    made = clean_up(half, FPS, known)
    np.testing.assert_array_equal(made[:20], clean[:20])
    np.testing.assert_allclose(bone_lengths(made[20:]), bone_lengths(clean[20:]), atol=3e-3)


@pytest.mark.parametrize("depth", [0.0, 0.1])
def test_the_floor_of_a_continuation_is_no_higher_than_what_is_given(clean, depth):
    low = clean - [0.0, depth, 0.0]
    low[30:, list(TOES), 1] -= 0.03
    lowest = min(0.0, low[:20, :, 1].min())
    made = clean_up(low, FPS, half_known(clean))
    assert low[30:, list(TOES), 1].min() < lowest - 0.01
    assert made[20:, list(TOES), 1].min() == pytest.approx(lowest, abs=1e-3)


def test_a_foot_that_glides_far_is_not_held(clean):
    """A figure pushed over the ground with its feet still would otherwise leave its legs behind."""
    still = np.repeat(clean[:1], 60, axis=0)
    glides = still + np.linspace(0, 2.4 * FARTHEST, 60)[:, None, None] * [1.0, 0.0, 0.0]
    np.testing.assert_allclose(clean_up(glides, FPS), glides, atol=1e-6)


def test_an_edited_motion_has_the_body_of_the_given_one_and_keeps_what_is_known(clean, shaken):
    known = np.zeros((len(clean), 21), bool)
    known[:, :9] = True
    edited = np.where(known[..., None], clean, shaken)
    made = clean_up(edited, FPS, known, body=Body.of(clean))
    assert np.array_equal(made[known], clean[known])
    lengths = bone_lengths(clean)
    assert np.abs(bone_lengths(made) - lengths).max() < 3e-3
    assert np.abs(bone_lengths(edited) - lengths).max() > 0.02


def test_an_edited_motion_stays_on_the_floor_of_the_given_one(clean, shaken):
    nothing = np.zeros((len(clean), 21), bool)
    made = clean_up(shaken - [0.0, 0.1, 0.0], FPS, nothing, floor=floor_under(clean))
    assert made[:, list(TOES), 1].min() > -1e-3
    floor = floor_under(clean - [0.0, 0.5, 0.0])
    low = clean_up(shaken - [0.0, 0.1, 0.0], FPS, nothing, floor=floor)
    assert low[:, list(TOES), 1].min() < -0.05
