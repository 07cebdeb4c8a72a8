"""The recordings that networks are trained on, and the split by person."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from data_synth.walking import walk
from motiondiff_edu.conditions.control import constant_control
from motiondiff_edu.editing.masks import keyframes
from motiondiff_edu.editing.plausible import SINKS, longest_glide
from motiondiff_edu.motion.formats.bvh.write import write_bvh
from motiondiff_edu.motion.skeleton import HIPS
from motiondiff_edu.recipes import __main__ as command
from motiondiff_edu.recipes.inbetweener import INBETWEENER, training_windows, varied
from motiondiff_edu.recipes.recordings import (
    SUBJECTS,
    TRAINED,
    is_training,
    recording_files,
    training_files,
    training_recordings,
)
from tools.results.recordings.windows import person_of

PLAIN = {"recordings": 0, "levels": 0.0, "paces": 0.0, "variations": 0.0, "unvaried": 0.0}
RECIPE = replace(INBETWEENER, motions=2, acts=1, seconds=6.0, **PLAIN)


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


def test_recordings_are_in_the_data_as_often_as_the_recipe_says(folder):
    alone, beside = (list(varied(replace(RECIPE, recordings=n))) for n in (0, 3))
    assert len(alone) == 3 and len(beside) == 6
    for one, other in zip(alone, beside, strict=False):
        assert np.array_equal(one[0], other[0])
    ((recorded, _),) = training_recordings()
    versions = [positions for positions, _ in beside[3:]]
    np.testing.assert_allclose(versions[0], recorded, atol=1e-6)
    assert len({len(one) for one in versions}) == 3, "two are at paces of their own"


def test_all_variations_together_and_data_that_trainings_share(folder):
    mixed = replace(RECIPE, recordings=2, levels=0.5, paces=0.5, variations=0.9)
    windows = training_windows(mixed)
    again = training_windows(replace(mixed, seed=1, steps=7, name="other", lr=1.0))
    assert again.dances is windows.dances, "they are not made again"
    assert training_windows(replace(mixed, data_seed=2)).dances is not windows.dances
    for positions, contacts in varied(mixed):
        assert len(positions) == len(contacts) and np.isfinite(positions).all()


@pytest.mark.parametrize(
    "what", ["levels.at_levels", "variations.with_upper_body_of", "variations.pelvis_moved",
             "variations.limbs_turned", "warps.warped"],
)  # fmt: skip
def test_each_variation_is_made(what, monkeypatch):
    """Without one of them the motions are others."""
    recipe = replace(RECIPE, levels=1.0, paces=1.0, variations=1.0)
    every = [one for one, _ in varied(recipe)]
    module, name = what.split(".")
    plain = {"warped": lambda positions, contacts, rng: (positions, contacts)}
    monkeypatch.setattr(
        f"data_synth.{module}.{name}", plain.get(name, lambda positions, other: positions)
    )
    without = [one for one, _ in varied(recipe)]
    pairs = zip(every, without, strict=True)
    assert not any(len(a) == len(b) and np.allclose(a, b, atol=1e-3) for a, b in pairs)


def test_some_motions_stay_as_they_were_made(folder):
    made = dict(levels=0.9, paces=0.9, variations=0.9, recordings=3)
    plain = list(varied(replace(RECIPE, unvaried=1.0, recordings=3)))
    every, some, none = (
        list(varied(replace(RECIPE, motions=12, unvaried=share, **made)))
        for share in (1.0, 0.5, 0.0)
    )
    same = [
        len(one) == len(made) and np.array_equal(one, made)
        for (one, _), (made, _) in zip(some, every, strict=True)
    ]
    assert 3 < sum(same) < 13, "about half of 16"
    kept = [k for k, one in enumerate(same) if not one]
    assert all(np.array_equal(some[k][0], none[k][0]) for k in kept), "others vary as before"
    assert all(np.array_equal(one, plain[-1][0]) for one, _ in plain[-3:])


def test_without_recordings_it_is_said_how_to_give_them(monkeypatch, tmp_path):
    monkeypatch.setenv("MOTIONDIFF_REAL_DATA", str(tmp_path))
    with pytest.raises(ValueError, match="MOTIONDIFF_REAL_DATA must name a folder"):
        training_windows(replace(RECIPE, recordings=1))
    assert training_files([Path("cmu_05_06.bvh")]) == []
    (tmp_path / "bvh").mkdir()
    write_bvh(tmp_path / "bvh" / "cmu_05_06.bvh", walk(constant_control(1.1), seed=1).world())
    with pytest.raises(ValueError, match="all of persons who are kept for judging"):
        training_windows(replace(RECIPE, recordings=1))
    monkeypatch.delenv("MOTIONDIFF_REAL_DATA")
    monkeypatch.chdir(tmp_path)  # whose bvh folder nobody has named
    with pytest.raises(ValueError, match="MOTIONDIFF_REAL_DATA must name a folder"):
        recording_files()


@pytest.mark.parametrize(
    "name",
    ["acrnn_salsa_01", "cmu_acrnn_x", "cmu_60_08", "cmu_094_02", "93_02", "CMU_60_01", "max_61_1"],
)
def test_who_may_be_in_the_training_collection_is_on_its_side(name):
    assert is_training(f"{name}.bvh")
    assert not any(
        map(is_training, ("cmu_05_06_dance.bvh", "cmu_max_131_01.bvh", "cmu_006_01.bvh"))
    )


def test_no_person_is_on_both_sides(real_data):
    files = recording_files()
    kept = [path.stem for path in files if not is_training(path.name)]
    trained = training_files(files)
    assert len(trained) > 20 and len(kept) > 25
    persons = [{person_of(name) for name in side} for side in (kept, [p.stem for p in trained])]
    assert persons[1] == {TRAINED[0]} and not persons[0] & persons[1]
    subjects = {int(name) for name in persons[0] if name.isdecimal()}
    assert len(subjects) > 4 and not subjects & SUBJECTS
    # files without a subject's number are of other collections; of one the subject is unknown
    others = ("bvh", "pybvh", "pymo", "animdraw", "fairmotion")
    assert all(name.startswith(others) for name in persons[0] if not name.isdecimal())


def test_no_recording_of_training_sinks_or_glides_so_that_it_would_be_drawn_again(real_data):
    """The limits of plausibility are those of training persons alone."""
    sinks, glides = [], []
    for positions, _ in training_recordings():
        known = keyframes(len(positions), 20)
        gaps = [positions[k : k + 21, HIPS, 1] for k in range(0, len(positions) - 20, 20)]
        sinks += [min(one[0], one[-1]) - one.min() for one in gaps]
        first, last = longest_glide(positions, known)
        glides.append(last - first)
    assert 0.9 * SINKS < max(sinks) < SINKS and len(sinks) > 400
    assert max(glides) == 0


def test_without_recordings_all_other_networks_can_be_trained(monkeypatch, capsys):
    monkeypatch.delenv("MOTIONDIFF_REAL_DATA", raising=False)
    names = ["dancer", "inbetweener", "walker"]
    assert command.buildable(names) == ["dancer", "walker"]
    told = capsys.readouterr().out
    assert told.startswith("inbetweener is left out") and "MOTIONDIFF_REAL_DATA must name" in told
    monkeypatch.setattr(command, "recording_files", lambda: ["one.bvh"])
    assert command.buildable(names) == names and not capsys.readouterr().out
