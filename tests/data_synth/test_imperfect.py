"""Faults with known truth: who is missing, how often, and that the rest is untouched."""

import numpy as np
import pytest

from data_synth.imperfect import ARM, bursts, dead_joints, dropped_frames, jitter, random_joints
from motiondiff_edu.motion.skeleton import joint_index

CLEAN = np.random.default_rng(0).normal(size=(7, 40, 21, 3))


def test_what_is_missing_is_nan_and_what_is_known_is_untouched():
    rng = np.random.default_rng(1)
    for fault in (
        dead_joints(CLEAN),
        random_joints(CLEAN, 0.3, rng),
        dropped_frames(CLEAN, 5, 4),
        bursts(CLEAN, rng),
    ):
        assert np.isnan(fault.positions[~fault.known]).all() and 0 < (~fault.known).mean() < 0.6
        assert np.array_equal(fault.positions[fault.known], CLEAN[fault.known])


def test_dead_joints_are_those_named():
    gone = ~dead_joints(CLEAN[0]).known
    assert gone.all(0).nonzero()[0].tolist() == sorted(joint_index(name) for name in ARM)
    assert gone.sum() == 4 * 40


def test_a_share_of_the_joints_is_missing_throughout_others_in_each_motion():
    gone = ~random_joints(CLEAN, 0.3, np.random.default_rng(2)).known
    assert (
        np.array_equal(gone.any(1), gone.all(1)) and (gone[:, 0].sum(-1) == 6).all()
    )  # 30 % of 21
    assert len({tuple(row) for row in gone[:, 0]}) > 1
    assert (~random_joints(CLEAN, 0.0, np.random.default_rng(2)).known).sum() == 0
    assert (
        ~random_joints(CLEAN[0], 0.3, np.random.default_rng(2)).known[0]
    ).sum() == 6  # a single motion


def test_dropped_frames():
    gone = ~dropped_frames(CLEAN, 3, 4).known
    assert gone[:, 3:7].all() and gone.sum() == 7 * 4 * 21


def test_bursts_are_short_and_as_frequent_as_asked():
    long = np.zeros((1, 4000, 21, 3))
    gone = ~bursts(long, np.random.default_rng(3), every=50.0, longest=3).known[0]
    starts = (gone & ~np.vstack([np.zeros((1, 21), bool), gone[:-1]])).sum()
    assert starts == pytest.approx(4000 * 21 / 50, rel=0.1)
    padded = np.pad(gone[:, 0], 1)
    runs = np.flatnonzero(np.diff(padded.astype(int)) == -1) - np.flatnonzero(
        np.diff(padded.astype(int)) == 1
    )
    assert runs.max() <= 6 and np.median(runs) in (1, 2, 3)  # two bursts may touch


def test_jitter_has_the_size_that_was_asked_for():
    fault = jitter(CLEAN, 0.01, np.random.default_rng(4))
    assert fault.known.all() and (fault.positions - CLEAN).std() == pytest.approx(0.01, rel=0.02)


def test_wrong_inputs():
    with pytest.raises(KeyError):
        dead_joints(CLEAN, ["Tail"])
    with pytest.raises(ValueError, match="frames 38 to 41"):
        dropped_frames(CLEAN, 38, 4)
    with pytest.raises(ValueError, match="between 0 and 1"):
        random_joints(CLEAN, 1.5, np.random.default_rng(0))
    with pytest.raises(ValueError, match="21 joints"):
        dropped_frames(CLEAN[:, :, :20], 0, 1)
