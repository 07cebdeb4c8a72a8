"""Training on one's own files, where one says: `recipes NAME --data FOLDER --device DEVICE`."""

import sys
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from data_synth.walking import walk
from motiondiff_edu.motion.formats.files import read_motions
from motiondiff_edu.motion.motion import Motion, MotionError, MotionWarning
from motiondiff_edu.performers.windows import Windows
from motiondiff_edu.recipes import __main__ as command
from motiondiff_edu.recipes.walker import WALKER_PRINTED, clips_of

TINY = replace(
    WALKER_PRINTED,
    name="tiny",
    config=replace(
        WALKER_PRINTED.config, width=16, heads=2, hidden=24, motion_layers=1, control_layers=1
    ),
    steps=2,
    batch=3,
)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Two motions, one of them deeper; one with a hole; a file that is damaged; another."""
    place = tmp_path / "mine"
    (place / "deeper").mkdir(parents=True)
    control = np.tile([1.2, 0.0, 0.1], (60, 1))
    for seed, name in enumerate(("one.npz", "deeper/two.bvh")):
        Motion.of_clip(walk(control, seed=seed)).save(place / name)
    (place / "broken.bvh").write_text("HIERARCHY\nROOT Hips\n{")
    (place / "notes.txt").write_text("nothing to read here")
    torn = Motion.of_clip(walk(control, seed=2))
    torn.positions[7, 3] = np.nan
    torn.save(place / "torn.npz")
    return place


def test_other_rates_are_resampled_and_what_is_too_short_is_left_out(folder):
    fast = Motion.of_clip(walk(np.tile([1.0, 0.0, 0.0], (40, 1)), seed=4)).resampled(60)
    fast.save(folder / "fast.npz")
    fast[:2].save(folder / "short.npz")  # one frame at 20 frames/s
    with pytest.warns(MotionWarning, match=r"left out: short.npz.* one frame"):
        clips, motions = clips_of(folder), read_motions(folder)
    assert {clip.fps for clip in clips} == {20} == {motion.fps for motion in motions}
    assert len(clips) == 2 * len(motions) == 6
    assert Windows.of(motions).starts.numel() == sum(len(one) - 19 for one in motions)


def test_every_file_that_can_be_read_is_trained_on_and_mirrored(folder):
    with pytest.warns(MotionWarning) as told:
        clips = clips_of(folder)
    left_out = [str(one.message) for one in told if "left out" in str(one.message)]
    assert len(left_out) == 2 and "broken.bvh" in left_out[0] and "no position" in left_out[1]
    assert "torn.npz" in left_out[1], "its file, and not only what the motion is called"
    assert len(clips) == 4 and all(len(clip) == 60 and clip.fps == 20 for clip in clips)
    first, mirrored = clips[:2]
    np.testing.assert_allclose(mirrored.control, first.control * [1, -1, -1], atol=1e-9)


def test_a_walker_is_trained_on_a_folder_and_its_card_says_so(folder, tmp_path, monkeypatch):
    monkeypatch.setattr(command, "RECIPES", {"tiny": TINY})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MotionWarning)
        walker = command.trained("tiny", tmp_path / "run", device="cpu", data=folder)
    assert walker.card["data"] == "4 given clips" and walker.card["frames"] == 4 * 60
    fastest = walker.card["control_range"]["high"][0]
    assert 1.0 < fastest < 1.5, "the control of these walks, not of the synthetic data"


def test_a_folder_without_motions_is_refused(tmp_path):
    with pytest.raises(MotionError, match="no file in .* could be used"):
        clips_of(tmp_path)
    with pytest.raises(MotionError, match="is no folder"):
        clips_of(tmp_path / "nothing")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["walker", "--device", "nowhere"], "--device nowhere cannot be used here"),
        (["dancer", "--data", "mine"], "--data is for walkers"),
        (["--data", "mine"], "--data is for walkers"),
    ],
)
def test_what_cannot_be_done_is_said_before_the_work(arguments, words, monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["recipes", *arguments])
    monkeypatch.setattr(command, "build", None)
    with pytest.raises(SystemExit):
        command.main()
    assert words in capsys.readouterr().err
