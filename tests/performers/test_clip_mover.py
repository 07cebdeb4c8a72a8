"""A mover that reads by CLIP: sentences to motions, its files without CLIP's weights, refusals."""

from dataclasses import asdict, replace

import numpy as np
import pytest
import tiny_clip
import torch
from safetensors import safe_open
from small_movers import mover_of

import motiondiff_edu as md
from motiondiff_edu.conditions import clip
from motiondiff_edu.conditions.clip import ClipTokens
from motiondiff_edu.conditions.text import TextError
from motiondiff_edu.performers.described_windows import DescribedWindows, exchanged_sides
from motiondiff_edu.performers.mover import Mover
from motiondiff_edu.performers.text_mofusion import TextMoFusionConfig
from motiondiff_edu.pretrained import checkpoints
from motiondiff_edu.pretrained.checkpoints import CheckpointError
from motiondiff_edu.pretrained.weights_file import write_weights

SMALL = TextMoFusionConfig(
    widths=(16, 24), heads=2, C=20, S=30, clip="somebody/tiny", clip_width=tiny_clip.WIDTH
)
WORDS = replace(SMALL, clip="", clip_width=512, words=("kick", "left", "walk"), word_layers=1)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tiny_clip.made(tmp_path_factory.mktemp("clip"))


@pytest.fixture(scope="module")
def tiny(folder) -> clip.ClipModel:
    return clip.load(folder)


@pytest.fixture(scope="module")
def mover(tiny) -> Mover:
    return mover_of(SMALL, card={"name": "tiny", "clip_sample": tiny.sample()}, clip=tiny)


def test_any_sentence_makes_a_motion(mover):
    """Words that nobody trained, and letters that are not English."""
    how = {"seconds": 2, "steps": 2, "progress": False}
    walks = mover.act("walks forward", **how)
    assert walks.positions.shape == (40, 21, 3) and walks.source == "walks forward"
    again, other = mover.act("walks forward", samples=2, **how)
    assert np.abs(again.positions - walks.positions).max() < 1e-4
    assert np.abs(other.positions - walks.positions).max() > 0.01
    for text in ("does a cartwheel", "läuft 3 m"):
        assert np.abs(mover.act(text, **how).positions - walks.positions).max() > 1e-3


@pytest.mark.parametrize("text, told", [(" ", "the text is empty"), ("x " * 40, "has 42 tokens")])
def test_an_empty_or_a_long_sentence_is_refused(mover, text, told):
    with pytest.raises(TextError, match=told):
        mover.act(text, progress=False)


def test_padding_is_not_seen_and_every_token_is(mover, tiny):
    x, s = torch.randn(2, 40, SMALL.D), torch.tensor([20, 3])
    texts = tiny.tokens(["kicks left", "a person walks forward"])
    padded = ~texts.mask
    assert padded.sum(1).tolist() == [2, 0]

    def answer(hidden):
        with torch.no_grad():
            return mover.model(x, s, mover.model.listen(ClipTokens(hidden, texts.mask)))

    plain = answer(texts.hidden)
    shouted = torch.where(padded[..., None], 100.0, texts.hidden)
    torch.testing.assert_close(answer(shouted), plain)
    for token in range(4):
        changed = texts.hidden.clone()
        changed[0, token] += 1
        assert (answer(changed)[0] - plain[0]).abs().max() > 1e-4
    alone = tiny.tokens(["kicks left"])
    with torch.no_grad():
        one = mover.model(x[:1], s[:1], mover.model.listen(alone))
    torch.testing.assert_close(one, plain[:1], atol=1e-4, rtol=1e-4)


def test_guidance_leads_away_from_the_empty_text(mover, tiny):
    texts, nothing = tiny.encoded([("walks forward",)]), tiny.tokens([""])
    x, s = torch.randn(1, 40, SMALL.D), torch.full((1,), 20)
    with torch.no_grad():
        plain, free = (mover.denoiser(one, 40)(x, s) for one in (texts, nothing))
        torch.testing.assert_close(mover.denoiser(texts, 40, 2.5)(x, s), 2.5 * plain - 1.5 * free)
    assert (plain - free).abs().max() > 1e-3


def test_a_file_has_the_mlp_and_nothing_of_clip(mover, folder, tiny, tmp_path):
    path = checkpoints.save(mover, tmp_path / "mine.safetensors", bits=32)
    with safe_open(path, "pt") as file:
        names = {name.removeprefix("model.") for name in file.keys() if name.startswith("model.")}
    assert names == set(mover.model.state_dict())
    assert {n for n in names if n.startswith("words.")} == {
        f"words.mlp.{k}.{part}" for k in (0, 2) for part in ("weight", "bias")
    }
    for where in (folder, str(folder), tiny):
        back = md.load(path, clip=where)
        assert back.config == mover.config and back.card == mover.card
        made = [
            who.act("kicks left", seconds=2, steps=2, guidance=2.0, progress=False).positions
            for who in (mover, back, back.to("cpu"))
        ]
        np.testing.assert_array_equal(made[0], made[1])
        np.testing.assert_array_equal(made[0], made[2])


def test_a_file_without_its_clip_says_which_one_is_missing(mover, tmp_path):
    path = checkpoints.save(mover, tmp_path / "mine.safetensors")
    with pytest.raises(CheckpointError) as told:
        md.load(path)
    assert str(told.value).startswith("mine.safetensors reads texts by somebody/tiny")
    assert 'clip.load("somebody/tiny", download=True)' in str(told.value)
    with pytest.raises(CheckpointError, match="there is no folder .*nowhere"):
        md.load(path, clip=tmp_path / "nowhere")


def test_another_clip_than_that_of_the_training_is_refused(mover, tmp_path):
    path = checkpoints.save(mover, tmp_path / "mine.safetensors")
    other = tiny_clip.made(tmp_path / "other", seed=1)
    with pytest.raises(CheckpointError, match="gives other tokens than the CLIP"):
        md.load(path, clip=other)
    wide = tiny_clip.made(tmp_path / "wide", hidden_size=40)
    with pytest.raises(CheckpointError, match="has tokens of 40 numbers"):
        md.load(path, clip=wide)


def test_a_network_reads_one_way(mover, tiny, tmp_path):
    with pytest.raises(ValueError, match="pass clip=conditions.clip.load..somebody/tiny"):
        Mover(mover.model, mover.schedule, mover.motion_scaler)
    words = mover_of(WORDS, card={"name": "tiny"})
    with pytest.raises(ValueError, match="reads words of its own, and takes no CLIP"):
        replace(words, clip=tiny)
    path = checkpoints.save(words, tmp_path / "words.safetensors")
    with pytest.raises(CheckpointError, match="words.safetensors does not read by CLIP"):
        md.load(path, clip=tiny)
    with pytest.raises(ValueError, match="words of its own or somebody/tiny, not both"):
        replace(SMALL, words=("walk",))
    with pytest.raises(ValueError, match="clip_width = 0 must be at least 1"):
        replace(SMALL, clip_width=0)


def test_a_file_from_before_clip_is_read_as_it_was(tmp_path):
    words = mover_of(WORDS, card={"name": "tiny"})
    path = checkpoints.save(words, tmp_path / "old.safetensors", bits=32)
    with safe_open(path, "pt") as file:
        tensors = {name: file.get_tensor(name) for name in file.keys()}
        settings = {k: v for k, v in file.metadata().items() if k in ("format", "network")}
    before = {k: v for k, v in asdict(WORDS).items() if not k.startswith("clip")}
    settings |= {"schedule": words.schedule.name}
    back = md.load(write_weights(path, tensors, settings, before, words.card))
    assert back.config == WORDS and back.clip is None
    assert {name.split(".")[0] for name in back.model.state_dict()} == {"words", "unet"}
    one, two = (who.act("kick", seconds=2, steps=2, progress=False) for who in (words, back))
    np.testing.assert_array_equal(one.positions, two.positions)


def test_sides_are_exchanged_in_whole_words():
    assert exchanged_sides("Left foot, then right; leftover") == "right foot, then left; leftover"
    assert exchanged_sides("the left-hand punch") == "the right-hand punch"


def test_windows_of_whole_texts_mirror_the_text_with_the_motion():
    rng = np.random.default_rng(0)
    positions = [rng.normal(size=(n, 21, 3)) for n in (17, 17, 24)]
    contacts = [rng.random((n, 2)) < 0.5 for n in (17, 17, 24)]
    captions = [
        ["kicks left", "the left foot kicks"],
        ["does a cartwheel", "a cartwheel"],
        ["kicks right", "hops"],
    ]
    windows = DescribedWindows.of_texts(positions, contacts, captions)
    assert sorted(windows.motions) == [16, 24] and len(windows) == 3
    texts = ("", "", *windows.words)
    assert set(windows.words) == {t for each in captions for t in each} | {"the right foot kicks"}
    pairs = {texts[k]: texts[int(other)] for k, other in enumerate(windows.exchanged) if k > 1}
    assert pairs["kicks left"] == "kicks right" and pairs["kicks right"] == "kicks left"
    assert pairs["hops"] == "hops" and pairs["the left foot kicks"] == "the right foot kicks"
    told = [[texts[int(k)] for k in row] for row in windows.captions[16][..., 0]]
    assert told == captions[:2] and windows.captions[24].shape == (1, 2, 1)
    captions[0] = ["Left hand waves", "LEFT AND Right"]
    more = DescribedWindows.of_texts(positions, contacts, captions)
    assert {"Left hand waves", "right hand waves", "left hand waves"} <= set(more.words)
    with pytest.raises(ValueError, match="motion 1 has 7 frames, and 8 are needed"):
        DescribedWindows.of_texts(
            [positions[0], positions[1][:7], positions[2]], contacts, captions
        )
    seen = {
        texts[int(k)]
        for seed in range(20)
        for k in windows.draw(64, torch.Generator().manual_seed(seed))[1][:, 0]
    }
    assert seen == set(windows.words)
