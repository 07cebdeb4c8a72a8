"""The recordings that networks are trained on, and the split by person."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from data_synth.walking import walk
from motiondiff_edu.conditions.control import constant_control
from motiondiff_edu.motion.bvh.write import write_bvh
from motiondiff_edu.recipes.dancers import INBETWEENS
from motiondiff_edu.recipes.recordings import (
    is_training,
    recording_files,
    training_files,
    training_recordings,
)
from motiondiff_edu.recipes.train_dancer import training_windows

RECIPE = replace(INBETWEENS, motions=2, acts=1, seconds=6.0)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A walk of each side, and one training trial in both folders."""
    for one, names in {"bvh": ["cmu_acrnn_x_1", "else"], "cmu30": ["acrnn_x_1", "cmu_5"]}.items():
        (tmp_path / one).mkdir()
        for k, name in enumerate(names):
            clip = walk(constant_control(1.1, seconds=8.0), seed=k)
            write_bvh(tmp_path / one / f"{name}.bvh", clip.world())
    monkeypatch.setenv("MOTIONDIFF_REAL_DATA", str(tmp_path))
    return tmp_path


def test_a_trial_in_two_folders_is_taken_once_and_others_are_left(folder):
    assert len(recording_files()) == 4
    found = training_recordings()
    assert len(found) == 1
    positions, contacts = found[0]
    assert len(positions) == len(contacts) == 160 and 0.3 < contacts.mean() < 0.9


def test_recordings_are_in_the_windows_as_often_as_the_recipe_says(folder):
    alone = training_windows(RECIPE)
    beside = training_windows(replace(RECIPE, recordings=3))
    frames = len(alone.dances)
    assert np.array_equal(alone.dances, beside.dances[:frames])
    more = len(beside.dances) - frames
    assert 3 * 100 < more < 3 * 480, "three versions of eight seconds, each at its own pace"
    again = training_windows(replace(RECIPE, recordings=3, steps=7))
    assert np.array_equal(again.dances, beside.dances)


def test_without_recordings_it_is_said_how_to_give_them(monkeypatch, tmp_path):
    monkeypatch.setenv("MOTIONDIFF_REAL_DATA", str(tmp_path))
    with pytest.raises(ValueError, match="MOTIONDIFF_REAL_DATA must name a folder"):
        training_windows(replace(RECIPE, recordings=1))
    assert training_files([Path("cmu_05_06.bvh")]) == []


def test_no_person_is_on_both_sides(real_data):
    files = recording_files()
    kept = [path.stem for path in files if not is_training(path.name)]
    trained = training_files(files)
    assert len(trained) > 20 and len(kept) > 25
    subjects = ("cmu_0", "cmu_1", "cmu_max", "bvh", "pybvh", "pymo", "animdraw", "fairmotion")
    assert all(name.startswith(subjects) for name in kept)
    assert all("acrnn_" in path.name for path in trained)
