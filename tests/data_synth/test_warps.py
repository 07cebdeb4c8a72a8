"""Motion at another pace: the same path through space, slower, faster, and with pauses."""

import numpy as np
import pytest

from data_synth.mixed import motions
from data_synth.warps import FASTEST, PAUSE, PAUSES, SLOWEST, drawn, drawn_pace, times_of, warped
from motiondiff_edu.metrics.bodies import bone_lengths

FPS = 20.0


def seeded(seed: int = 0) -> np.random.Generator:
    return np.random.default_rng(seed)


@pytest.fixture(scope="module")
def walk():
    return next(iter(motions(1, 5, 8.0)))


def test_times_rise_from_the_first_frame_and_stay_within_the_motion():
    for seed in range(20):
        at = times_of(100, 0.5, seeded(seed), FPS)
        steps = np.diff(at)
        assert at[0] == 0 and 0.9 * 99 < at[-1] <= 99 or len(at) == 300
        assert (steps >= PAUSE - 1e-9).all() and (steps <= FASTEST + 1e-9).all()
        assert np.array_equal(at, times_of(100, 0.5, seeded(seed), FPS))


def test_paces_are_slow_and_fast_alike_and_some_are_pauses():
    paces = np.array([drawn_pace(0.5, seeded(seed)) for seed in range(1000)])
    moving = paces[paces > PAUSE]
    assert 1 - len(moving) / len(paces) == pytest.approx(PAUSES, abs=0.03)
    assert 0.5 <= moving.min() < 0.55 and 0.9 * FASTEST < moving.max() <= FASTEST
    assert np.median(moving) == pytest.approx(np.sqrt(0.5 * FASTEST), abs=0.1)


def test_the_motion_is_the_same_at_another_time(walk):
    positions, contacts = walk
    moved, stands = warped(positions, contacts, seeded(3), FPS)
    rng = seeded(3)
    at = times_of(len(positions), drawn(SLOWEST, 1.0, rng), rng, FPS)
    assert moved.shape == (len(at), 21, 3) and stands.shape == (len(at), 2)
    whole = np.floor(at).astype(int)[:-1]
    low = np.minimum(positions[whole], positions[whole + 1]) - 0.05
    high = np.maximum(positions[whole], positions[whole + 1]) + 0.05
    assert ((low < moved[:-1]) & (moved[:-1] < high)).all()
    assert np.array_equal(stands, contacts[np.round(at).astype(int)])
    assert np.abs(bone_lengths(moved) - bone_lengths(positions[:1])).max() < 0.01
    jolts = [np.abs(np.diff(one, n=2, axis=0)).max() for one in (moved, positions)]
    assert jolts[0] < FASTEST**2 * jolts[1], "the pace changes smoothly"
