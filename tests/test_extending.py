"""The examples of docs/EXTENDING.md do what the page says, on small stand-ins for the files."""

import io
import re
import shlex
import sys
import warnings
from contextlib import redirect_stdout
from dataclasses import dataclass, replace

import numpy as np
import pytest
import soundfile
import torch
from code_blocks import blocks, fences

import motiondiff_edu as md
from data_synth.music import compose
from data_synth.walking import walk
from motiondiff_edu.conditions.control import constant_control
from motiondiff_edu.motion.motion import MotionWarning
from motiondiff_edu.performers import networks
from motiondiff_edu.pretrained.checkpoints import CheckpointError, available
from motiondiff_edu.recipes import __main__ as command
from motiondiff_edu.rollout import generate

PAGE = "docs/EXTENDING.md"
SPEEDS = {"one": 1.0, "two": 0.8, "three": 1.2, "four": 1.4}  # of the walks, m/s
ARM = ("LeftForeArm", "LeftHand", "LeftHandIndex1")
pytestmark = [
    pytest.mark.skipif("walker" not in available(), reason="no weights: run make pretrained"),
    pytest.mark.slow,
]


def walking(speed: float, seconds: float, seed: int) -> md.Motion:
    clip = walk(constant_control(speed, seconds=seconds), seed=seed)
    return replace(md.Motion.of_clip(clip), source="made")


def waving(motion: md.Motion) -> md.Motion:
    """The same walk straight ahead, but the left arm goes up at its side and down, every 3 s."""
    joint, positions = motion.skeleton.names.index, motion.positions.copy()
    arm, shoulder = [joint(name) for name in ARM], positions[:, [joint("LeftArm")]]
    angle = 0.4 * np.pi * (1 - np.cos(2 * np.pi * np.arange(len(motion)) / 60))[:, None]
    across, up = np.moveaxis((positions[:, arm] - shoulder)[..., :2], -1, 0)
    cos, sin = np.cos(angle), np.sin(angle)
    turned = np.stack([cos * across - sin * up, sin * across + cos * up], axis=-1)
    positions[:, arm, :2] = shoulder[..., :2] + turned
    return replace(motion, positions=positions)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The folders that the page needs: walks of which two files cannot be used, and a dance."""
    place = tmp_path_factory.mktemp("extending")
    walks, dances = place / "my_walks", place / "my_dances"
    walks.mkdir()
    dances.mkdir()
    for seed, (name, speed) in enumerate(SPEEDS.items()):
        waving(walking(speed, 9.0, seed)).save(walks / f"{name}.bvh")
    whole = (walks / "one.bvh").read_text()
    (walks / "broken.bvh").write_text(whole[: len(whole) // 2])
    torn = replace(walking(1.0, 2.0, 7), source="torn")
    torn.positions[7, torn.skeleton.names.index("LeftFoot")] = np.nan
    torn.save(walks / "torn.npz")
    walking(0.4, 6.0, 8).save(dances / "one.bvh")
    soundfile.write(dances / "one.wav", compose(4, "pop", seconds=6.0).audio, 16_000)
    return place


@pytest.fixture(scope="module")
def page(root, folder):
    """The examples, run one after the other: what they have named, and what each one says.

    What a block of text on the page shows is in what the example above it says.
    """
    names: dict = {}
    shown = []
    said = ""
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        patch.setattr(networks, "_NETWORKS", dict(networks._NETWORKS))
        for language, text in fences(root, PAGE):
            if language == "text":
                shown.append((words(text), said))
            if language == "python":
                out = io.StringIO()
                with warnings.catch_warnings(record=True) as given, redirect_stdout(out):
                    warnings.simplefilter("always", MotionWarning)
                    exec(compile(text, PAGE, "exec"), names)
                said = words(" ".join([out.getvalue(), *(str(one.message) for one in given)]))
        yield Page(names, shown)


@dataclass
class Page:
    names: dict
    shown: list[tuple[str, str]]

    def __getitem__(self, name: str):
        return self.names[name]


def words(text: str) -> str:
    """A text without its line breaks."""
    return re.sub(r"\s+", " ", text).strip()


def hand_of(page: Page, name: str, first: int) -> float:
    """The mean height of a motion's left hand from a frame on, in metres."""
    return page[name].positions[first:, page["hand"], 1].mean()


def test_what_the_page_shows_is_what_the_examples_say(page):
    assert len(page.shown) == 3
    assert [text for text, said in page.shown if text not in said] == []


def test_a_file_in_centimetres_and_an_array_are_the_same_motion(page):
    mine, same = page["mine"], page["same"]
    first = page["walk"]
    assert mine.fps == same.fps == 30 and first.fps == 20 and len(mine) > 1.4 * len(first)
    np.testing.assert_allclose(mine.positions, same.positions, atol=1e-9)
    np.testing.assert_allclose(mine.positions[::3][:9], first.positions[::2][:9], atol=1e-3)


def test_a_walker_is_trained_on_four_walks_and_their_mirror_images(page, folder):
    card = page["walker"].card
    assert len(page["clips"]) == 8 and card["data"] == "8 given clips"
    assert card["control_range"]["low"][0] < 0.85 and card["control_range"]["high"][0] > 1.35
    assert md.load(folder / "tiny.safetensors").config == page["tiny"]
    assert page["windows"].draw(2, torch.Generator())[0].shape == (2, 10, 63)


def test_a_dancer_is_trained_on_a_dance_and_its_song(page, folder):
    assert page["dancer"].card["data"] == "given windows"
    assert len(page["dance"]) == 2 * 20 and page["dance"].audio is not None
    song = page["songs"][0]
    short = page["md"].read_motion(folder / "my_dances" / "one.bvh")[:99]
    with pytest.raises(ValueError, match="no dance has 100 frames"):
        page["DanceWindows"].of_motions([short], [song])


def test_the_plain_network_learns_is_saved_and_walks(page, folder, monkeypatch):
    plain, ahead = page["plain"], page["more"].positions[-1] - page["walk"].positions[-1]
    assert plain.card["final_loss"] < 0.25  # 1 is the variance of a pose
    assert 1.8 < ahead[0, 2] < 2.2 and abs(ahead[0, 0]) < 0.3
    again = plain.walk(page["walk"], md.joystick([(2, 1.0, 0, 0)]), seed=0, progress=False)
    np.testing.assert_allclose(again.positions, page["more"].positions, atol=1e-9)
    monkeypatch.delitem(networks._NETWORKS, "PlainNetwork")  # as in another program
    with pytest.raises(CheckpointError, match="unknown network, PlainNetwork.*register it first"):
        md.load(folder / "plain.safetensors")


def test_a_fourth_column_of_control_moves_the_hand(page):
    low, high = (hand_of(page, name, 20) for name in ("low", "high"))
    assert low == pytest.approx(0.95, abs=0.15) and high == pytest.approx(1.6, abs=0.2)
    assert page["reaching"].card["control_range"]["high"][3] > 1.5
    with pytest.raises(ValueError, match=r"a control is \(rows, 4\).*1 of your own"):
        page["reaching"].walk(page["walk"], page["ahead"], progress=False)


def test_generate_takes_every_row_of_the_fourth_column(page):
    clip = page["with_hand"][0]
    poses = generate(
        page["reaching"], clip.features()[:10], clip.control[:20].astype("f4"), steps=5
    )
    assert poses.shape == (10, 63)
    height = poses[:, 3 * page["hand"] + 1].numpy()
    assert np.abs(height - clip.control[10:20, 3]).mean() < 0.2


def test_tokens_at_the_rate_of_mel_frames_need_the_dancer_alone(page, folder):
    motions = [page["md"].read_motion(path) for path in page["files"]]
    rows = [torch.rand(1 + int(31.25 * one.seconds), 2) for one in motions]
    windows = page["DanceWindows"].of_motions(motions, rows)
    config = replace(page["config"], C=2)
    recipe = page["DanceRecipe"]("tokens", config, steps=1)
    dancer = page["train_dancer"](recipe, folder / "tokens-run.safetensors", windows)
    assert dancer.dance_mel(rows[0][None], 40, steps=2).shape == (1, 40, 21, 3)


def test_a_token_of_ones_own_moves_the_hand(page):
    made = page["metres"].inverse(page["made"][:, :, page["column"]].mean(1))
    torch.testing.assert_close(made, torch.tensor([[0.0], [0.25], [0.5]]), atol=0.1, rtol=0)
    assert np.mean(page["losses"][-10:]) < 0.5 * np.mean(page["losses"][:10])


def test_steps_at_low_noise_and_heuns_method_come_nearer(page):
    even, late = ((page[name] - page["every"]).abs().mean() for name in ("even", "late"))
    assert late < 0.3 * even and even < 0.1
    assert 0 < page["heun"] < 0.7 * page["euler"] < 0.07


def test_a_guided_walker_holds_its_hand_higher(page):
    free, held = (hand_of(page, name, 10) for name in ("free", "held"))
    assert free < 1.0 and held == pytest.approx(1.2, abs=0.1)
    assert type(page["guided"].to("cpu")) is page["HandAt"], "moved, it is what it was"


def test_the_command_of_the_page_begins_a_training_on_the_folder(root, folder, monkeypatch):
    (line,) = (block.strip() for block in blocks(root, PAGE, ""))
    _, _, module, *arguments = shlex.split(line)
    assert module == "motiondiff_edu.recipes" and arguments[-2:] == ["--device", "cuda"]
    asked = []

    def build(name, run, out, **given):
        asked.append((name, out.name, str(given["data"]), given["device"]))
        return out

    monkeypatch.chdir(folder)
    monkeypatch.setattr(command, "build", build)
    monkeypatch.setattr(sys, "argv", ["recipes", *arguments[:-1], "cpu"])
    command.main()
    assert asked == [("walker", "walker-own.safetensors", "my_walks", "cpu")]
