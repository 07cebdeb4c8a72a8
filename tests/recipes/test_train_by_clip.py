"""A mover that reads by CLIP is trained end to end: captions are encoded once, CLIP is frozen."""

from dataclasses import replace

import numpy as np
import pytest
import tiny_clip
import torch

import motiondiff_edu as md
from motiondiff_edu.conditions import clip as clips
from motiondiff_edu.conditions.word_encoder import NOTHING
from motiondiff_edu.ddpm import cosine_schedule
from motiondiff_edu.performers.networks import network
from motiondiff_edu.performers.text_mofusion import TextMoFusionConfig
from motiondiff_edu.pretrained import checkpoints
from motiondiff_edu.recipes import __main__ as command
from motiondiff_edu.recipes.mover import (
    MOVER,
    MOVER_CLIP,
    MoverRecipe,
    loss_of,
    texts_by,
    train_mover,
    training_clips,
    training_texts,
)
from motiondiff_edu.training import TrainState, train_steps

TINY = TextMoFusionConfig(
    widths=(16, 24), heads=2, C=20, S=20, clip="somebody/tiny", clip_width=tiny_clip.WIDTH
)
SHORT = MoverRecipe("tiny", TINY, steps=6, clips=10, frames=200, no_text=0.2)


@pytest.fixture(scope="module")
def clip(tmp_path_factory) -> clips.ClipModel:
    """With room for captions that are spelled."""
    folder = tiny_clip.made(tmp_path_factory.mktemp("clip"), max_position_embeddings=300)
    return clips.load(folder)


@pytest.fixture(scope="module")
def windows():
    return training_texts(SHORT.clips, SHORT.data_seed)


def quiet(line: str) -> None:
    pass


def test_a_recipe_that_names_a_clip_trains_and_is_loaded_again(clip, windows, tmp_path):
    before = {name: p.clone() for name, p in clip.model.state_dict().items()}
    mover = train_mover(SHORT, tmp_path / "run.safetensors", windows, log=quiet, clip=clip)
    assert mover.config == TINY and mover.card["clips"] == 10
    assert mover.card["clip_sample"] == clip.sample() and mover.clip is clip
    for name, p in clip.model.state_dict().items():
        assert torch.equal(p, before[name]), name
    assert all(p.grad is None for p in clip.model.parameters())
    path = checkpoints.save(mover, tmp_path / "tiny.safetensors", bits=32)
    back = md.load(path, clip=clip)
    one, two = (
        who.act("kicks left", seconds=2, steps=2, progress=False).positions for who in (mover, back)
    )
    np.testing.assert_array_equal(one, two)


def test_the_texts_are_those_of_the_batch_and_are_encoded_once(clip, windows):
    passed = []
    watch = clip.model.register_forward_pre_hook(lambda _, inputs: passed.append(len(inputs[0])))
    texts_of = texts_by(clip, windows)
    assert sum(passed) == 2 + len(windows.words)
    drawn = []
    for seed in range(4):
        _, ids, _ = windows.draw(400, torch.Generator().manual_seed(seed))
        drawn.append((ids, texts_of(ids)))
    assert sum(passed) == 2 + len(windows.words)
    watch.remove()
    for ids, found in drawn:
        wanted = clip.tokens([windows.words[int(k) - 2] for k in ids[:, 0]])
        assert torch.equal(found.mask, wanted.mask)
        torch.testing.assert_close(found.hidden, wanted.hidden, atol=4e-3, rtol=4e-3)
    empty = texts_of(torch.tensor([[NOTHING]]))
    torch.testing.assert_close(empty.hidden, clip.tokens([""]).hidden, atol=4e-3, rtol=4e-3)


def test_the_loss_falls_and_depends_on_the_texts(clip, windows):
    torch.manual_seed(0)
    model, texts_of = network(TINY), texts_by(clip, windows)
    loss_fn = loss_of(replace(SHORT, no_text=0.0), windows, cosine_schedule(20), texts_of)
    state = TrainState.start(model, 0, torch.optim.Adam(model.parameters(), 3e-3), 0.9)
    losses = [
        one.loss for one in train_steps(state, loss_fn, 60, lr=lambda k: 3e-3, progress=False)
    ]
    assert np.mean(losses[-10:]) < 0.8 * np.mean(losses[:10])
    assert model.words.mlp[0].weight.grad.abs().sum() > 0

    def loss(recipe, texts_of):
        loss_fn = loss_of(recipe, windows, cosine_schedule(20), texts_of)
        return loss_fn(state.average, torch.Generator().manual_seed(4)).item()

    told = loss(SHORT, texts_of)
    nothing = loss(SHORT, lambda ids: clip.tokens([""] * len(ids)))
    assert told != nothing
    left_out = loss(replace(SHORT, no_text=1.0), texts_of)
    assert left_out == pytest.approx(nothing, rel=1e-3)


def test_a_killed_run_continues_and_another_clip_does_not_continue_it(clip, windows, tmp_path):
    whole = train_mover(SHORT, tmp_path / "whole", windows, log=quiet, clip=clip)

    class Killed(Exception):
        pass

    seen = []

    def until(line: str) -> None:
        seen.append(line)
        if len(seen) == 5:
            raise Killed

    run = tmp_path / "killed"
    with pytest.raises(Killed):
        train_mover(SHORT, run, windows, log=until, clip=clip)
    other = clips.load(tiny_clip.made(tmp_path / "other", seed=1, max_position_embeddings=300))
    with pytest.raises(ValueError, match="was begun with clip = "):
        train_mover(SHORT, run, windows, log=quiet, clip=other)
    texts = replace(windows, words=tuple(f"{text}." for text in windows.words))
    with pytest.raises(ValueError, match="was begun with texts = "):
        train_mover(SHORT, run, texts, log=quiet, clip=clip)
    resumed = train_mover(SHORT, run, windows, log=quiet, clip=clip)
    assert len(resumed.card["sittings"]) == 2
    for (name, a), (_, b) in zip(
        whole.model.state_dict().items(), resumed.model.state_dict().items(), strict=True
    ):
        assert np.allclose(a, b, atol=1e-6), name


def test_recipe_clip_and_windows_must_fit(clip, windows, tmp_path):
    words = training_clips(10, 1)
    reads = replace(SHORT, config=replace(TINY, clip=""))
    with pytest.raises(ValueError, match="these windows hold words"):
        train_mover(SHORT, tmp_path / "run", words, log=quiet, clip=clip)
    with pytest.raises(ValueError, match="these windows hold whole texts"):
        train_mover(reads, tmp_path / "run", windows, log=quiet)
    with pytest.raises(ValueError, match="its configuration names no CLIP"):
        train_mover(reads, tmp_path / "run", words, log=quiet, clip=clip)
    with pytest.raises(clips.ClipError, match="has tokens of 32 numbers"):
        train_mover(MOVER_CLIP, tmp_path / "run", windows, log=quiet, clip=clip)
    assert not (tmp_path / "run").exists()


def test_the_recipe_of_the_paper_differs_in_how_it_reads_alone():
    config = replace(MOVER_CLIP.config, clip="")
    assert replace(MOVER_CLIP, name="mover", config=config) == MOVER
    assert MOVER_CLIP.config.clip == clips.NAME and MOVER_CLIP.config.clip_width == 512
    planned = network(MOVER_CLIP.config)
    for part in (planned.planner, planned.performer):
        assert part.words.mlp[0].in_features == 512


def test_the_command_says_that_the_clip_is_missing(tmp_path, capsys, monkeypatch):
    """Before any data are made."""
    monkeypatch.setattr("huggingface_hub.constants.HF_HUB_CACHE", str(tmp_path))
    for further in ([], ["--clip", str(tmp_path / "nowhere")]):
        arguments = ["pretrained", "mover-clip", "--runs", str(tmp_path / "runs"), *further]
        monkeypatch.setattr("sys.argv", arguments)
        with pytest.raises(SystemExit) as left:
            command.main()
        told = capsys.readouterr().err
        assert left.value.code == 1 and told.startswith("mover-clip: there is no folder ")
        assert "download=True" in told and "Traceback" not in told
