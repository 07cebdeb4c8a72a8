"""Planted faults: each changes the clip, and a strong one is told."""

import numpy as np
import pytest

from data_synth.walking import walk
from tools.results.gate import FAULTS, STRENGTHS, synthetic, told


@pytest.fixture(scope="module")
def clip():
    return walk(np.tile([1.1, 0.0, 0.2], (100, 1)), seed=3).world(), 20.0


@pytest.mark.parametrize("kind", FAULTS)
def test_a_fault_changes_the_clip_and_a_strong_one_is_told(kind, clip):
    points, fps = clip
    for k in range(len(STRENGTHS)):
        made, rate = FAULTS[kind](points, fps, k, np.random.default_rng(k))
        assert rate != fps or len(made) != len(points) or np.abs(made - points).max() > 0.02
        assert made.shape[1:] == (21, 3) and np.isfinite(made).all()
    assert told((made, rate))
    assert not told(clip)


def test_the_synthetic_clips_are_walks_dances_and_acts():
    made = list(synthetic(20))
    assert len(made) >= 15 and all(points.shape[1:] == (21, 3) for points, _ in made)
