"""In-betweens in metres: what the network makes gets the bones and the feet of what is given."""

import numpy as np
import pytest
from seeds import seeded
from small_dancers import small_inbetweener
from walked_clips import clip

from data_synth.walking import random_control, walk
from motiondiff_edu.editing.inbetween import clean_samples, inbetween
from motiondiff_edu.editing.masks import body_part, gap, keyframes, seed
from motiondiff_edu.metrics.bodies import bone_lengths
from motiondiff_edu.metrics.walks import skating
from motiondiff_edu.motion.skeleton import HEELS, TOES

VISITED = [30, 20, 30, 20, 10, 20, 10]  # three steps, each made twice


@pytest.mark.parametrize(
    "known", [seed(40, 10), keyframes(40, 12), body_part(40, "lower body"), gap(40, 5, 20)]
)
def test_an_in_between_is_what_the_network_fills_in_and_then_cleaned_up(known):
    truth, filler = clip(), small_inbetweener(activity=True)
    holes = np.where(known[..., None], truth, np.nan)
    made = inbetween(filler, holes, known, samples=2, steps=3, resample=2, generator=seeded(1))
    filled = filler.fill(holes, known, samples=2, steps=VISITED, generator=seeded(1))
    assert np.array_equal(made, clean_samples(filled, known))
    assert np.abs(made - filled).max() > 1e-3
    assert all(np.array_equal(one[known], truth[known]) for one in made)


def test_all_known_is_the_input():
    truth, filler = clip(), small_inbetweener()
    everything = np.ones((40, 21), bool)
    assert np.array_equal(inbetween(filler, truth, everything, steps=5)[0], truth)


def lower(truth: np.ndarray, known: np.ndarray, metres: float) -> np.ndarray:
    """What a network would make that always generates the truth, so much lower."""
    return np.where(known[..., None], truth, truth - [0.0, metres, 0.0])[None]


@pytest.mark.parametrize("lowest", [0.0, -0.03])
def test_feet_stay_above_the_floor_or_the_lowest_given_joint(lowest):
    truth = clip()
    truth[..., 1] += lowest - truth[..., 1].min()
    known = keyframes(40, 13)
    at = truth[known][:, 1].min()
    sunk = lower(truth, known, 0.1)
    made = clean_samples(sunk, known)[0]
    feet = made[:, [*HEELS, *TOES], 1][~known.all(-1)]
    assert feet.min() == pytest.approx(min(0.0, at), abs=1e-6)
    assert sunk[0][..., 1].min() < -0.05


def test_one_given_joint_under_the_floor_does_not_lower_the_steps():
    truth = walk(random_control(3.0, np.random.default_rng(0), "turn"), 0).world()[:40]
    known = keyframes(40, 13)
    sunk = np.array(truth)
    sunk[13, TOES[0], 1] = -0.05
    feet = [
        clean_samples(lower(one, known, 0.0), known)[0][:, list(TOES), 1] for one in (truth, sunk)
    ]
    away = np.arange(40) > 20
    assert np.median(np.abs(feet[1] - feet[0])[away]) < 0.005


def test_bones_and_feet_are_cleaned_up():
    truth, known = clip(), gap(40, 12, 14)
    shaken = truth + 0.02 * np.random.default_rng(0).standard_normal((2, *truth.shape))
    filled = np.where(known[..., None], truth, shaken)
    made = clean_samples(filled, known)
    off, before = (np.abs(bone_lengths(x) - bone_lengths(truth)[0]).max() for x in (made, filled))
    assert off < 3e-3 < 5e-3 < before
    speeds = [np.nanmean(skating(x, np.zeros((2, 40, 3)))) for x in (made, filled)]
    assert speeds[0] < 0.7 * speeds[1]
    assert np.array_equal(made[:, known], filled[:, known])
