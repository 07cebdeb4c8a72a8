"""Finished motions: bones of one length, feet that stand, given joints where they were."""

import numpy as np
import pytest

from data_synth.walking import walk
from motiondiff_edu.conditions.control import constant_control
from motiondiff_edu.metrics.bone_lengths import bone_lengths
from motiondiff_edu.metrics.skating import skating
from motiondiff_edu.motion.motion import Motion
from motiondiff_edu.motion.skeleton import TOES
from motiondiff_edu.performers.finished import GLIDE, finished

FPS = 20


@pytest.fixture(scope="module")
def clean() -> np.ndarray:
    return Motion.of_clip(walk(constant_control(1.0, seconds=3.0), seed=5)).positions


@pytest.fixture(scope="module")
def shaken(clean) -> np.ndarray:
    return wandering(clean)


def wandering(motion: np.ndarray) -> np.ndarray:
    """As a network might give it: every joint wanders by centimetres, slowly."""
    rng = np.random.default_rng(0)
    phase, speed = rng.uniform(0, 6, (21, 3)), rng.uniform(1, 3, (21, 3))
    t = np.arange(len(motion))[:, None, None] / FPS
    return motion + 0.02 * np.sin(speed * t + phase)


def stretch(dance: np.ndarray) -> float:
    return float(bone_lengths(dance).std(0).max())


def sliding(dance: np.ndarray) -> float:
    return float(skating(dance[None], np.zeros((1, len(dance), 3)))[0])


def test_bones_keep_their_median(shaken):
    made = finished(shaken, FPS)
    np.testing.assert_allclose(
        bone_lengths(made)[0], np.median(bone_lengths(shaken), axis=0), atol=3e-3
    )
    assert stretch(made) < 1e-3 < 5e-3 < stretch(shaken)
    assert np.linalg.norm(made - shaken, axis=-1).mean() < 0.03


def test_a_figure_that_stands_does_not_slide(clean):
    stands = wandering(np.repeat(clean[:1], 60, axis=0))
    assert sliding(finished(stands, FPS)) < 1e-3 < 0.02 < sliding(stands)


def test_a_clean_walk_hardly_changes(clean):
    """A toe is held from when it lands until it leaves: that is some centimetres of its roll."""
    moved = np.linalg.norm(finished(clean, FPS) - clean, axis=-1)
    assert moved.mean() < 0.005 and moved.max() < 0.06


def test_no_toe_is_under_the_floor(clean):
    sunk = clean - [0.0, 0.05, 0.0]
    assert sunk[:, list(TOES), 1].min() < -0.03
    assert finished(sunk, FPS)[:, list(TOES), 1].min() > -1e-3


def test_known_joints_stay_and_give_the_lengths(clean, shaken):
    known = np.zeros(clean.shape[:2], bool)
    known[:20] = True
    half = np.where(known[..., None], clean, shaken)
    made = finished(half, FPS, known)
    np.testing.assert_array_equal(made[:20], clean[:20])
    np.testing.assert_allclose(bone_lengths(made[20:]), bone_lengths(clean[20:]), atol=3e-3)


def test_a_foot_that_glides_far_is_not_held(clean):
    """A figure pushed over the ground with its feet still would otherwise leave its legs behind."""
    still = np.repeat(clean[:1], 60, axis=0)
    glides = still + np.linspace(0, 3 * GLIDE, 60)[:, None, None] * [1.0, 0.0, 0.0]
    np.testing.assert_allclose(finished(glides, FPS), glides, atol=1e-6)
