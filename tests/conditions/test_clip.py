"""CLIP's tokens are those of transformers itself, for each text alone; nothing asks the network."""

import copy
import json
import shutil
import socket
import sys
from dataclasses import replace
from pathlib import Path

import pytest
import tiny_clip
import torch

from motiondiff_edu.conditions import clip
from motiondiff_edu.conditions.clip import ClipEncoder, ClipTokens
from motiondiff_edu.conditions.text import Read, TextError

# the last has no word of the tokenizer, and is spelled: w i g g l e s
TEXTS = ["a person walks forward", "kicks", "with the left foot the person kicks", "wiggles"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    return tiny_clip.made(tmp_path_factory.mktemp("clip"))


@pytest.fixture(scope="module")
def tiny(folder) -> clip.ClipModel:
    return clip.load(folder)


@pytest.fixture
def calls(monkeypatch) -> list:
    """What was asked of the network; nothing answers."""
    asked = []

    def refuse(*address, **_):
        asked.append(address)
        raise OSError("no network in this test")

    monkeypatch.setattr(socket.socket, "connect", refuse)
    monkeypatch.setattr(socket, "getaddrinfo", refuse)
    return asked


def alone(folder: Path, text: str) -> torch.Tensor:
    """The states after the last layer norm of one text, by transformers alone (M, E)."""
    from transformers import CLIPTextModel

    model, tokenizer = CLIPTextModel.from_pretrained(folder).eval(), tiny_clip.tokenizer()
    ids = tokenizer(text, return_tensors="pt")
    with torch.no_grad():
        return model(**ids).last_hidden_state[0]


def test_the_tokens_are_those_of_transformers_for_each_text_alone(tiny, folder):
    found = tiny.tokens(TEXTS)
    assert found.hidden.shape == (4, 9, tiny_clip.WIDTH) == (4, 9, tiny.width)
    assert found.mask.sum(1).tolist() == [6, 3, 9, 9]
    assert tiny.longest == tiny_clip.LONGEST
    for text, hidden, mask in zip(TEXTS, found.hidden, found.mask, strict=True):
        torch.testing.assert_close(hidden[mask], alone(folder, text), atol=1e-5, rtol=1e-5)
        assert mask[: mask.sum()].all() and not hidden[~mask].any()


def test_the_last_layer_norm_is_in_them_and_they_are_not_pooled(tiny):
    """With its scale at 0 all tokens become its bias."""
    norm = tiny.model.final_layer_norm
    scale = norm.weight.clone()
    norm.weight.data.zero_()
    try:
        flat = tiny.tokens(["kicks"]).hidden[0]
    finally:
        norm.weight.data.copy_(scale)
    torch.testing.assert_close(flat, norm.bias.expand(3, -1))
    assert (tiny.tokens(["kicks"]).hidden[0].std(0) > 0.01).all()  # each token has its own


def test_a_texts_tokens_do_not_depend_on_the_batch_and_the_same_text_is_the_same(tiny):
    many = tiny.tokens([*TEXTS, TEXTS[1]])
    one = tiny.tokens([TEXTS[1]])
    torch.testing.assert_close(many.hidden[1, :3], one.hidden[0], atol=1e-5, rtol=1e-5)
    assert torch.equal(many.hidden[1], many.hidden[4]) and len(many) == 5
    left, right = tiny.tokens(["kicks left", "kicks right"]).hidden
    assert torch.equal(left[:2], right[:2]) and (left[2] - right[2]).abs().max() > 0.01


def test_a_table_has_the_same_tokens_in_half_precision(tiny, monkeypatch):
    monkeypatch.setattr(clip, "BATCH", 3)
    table = tiny.table(["", *TEXTS])
    chosen = table[torch.tensor([2, 0, 4, 2])]
    wanted = tiny.tokens([TEXTS[1], "", TEXTS[3], TEXTS[1]])
    assert torch.equal(chosen.mask, wanted.mask) and chosen.hidden.dtype == torch.float32
    torch.testing.assert_close(chosen.hidden, wanted.hidden, atol=2e-3, rtol=2e-3)
    assert table.rows.dtype == torch.float16 and len(table.rows) == table.counts.sum()


def test_the_empty_text_has_its_two_marks(tiny, folder):
    found = tiny.encoded([(), ("kicks",)])
    assert found.mask.tolist() == [[True, True, False], [True, True, True]]
    torch.testing.assert_close(found.hidden[0, :2], alone(folder, ""), atol=1e-5, rtol=1e-5)
    torch.testing.assert_close(found.hidden[1], alone(folder, "kicks"), atol=1e-5, rtol=1e-5)


def test_any_word_is_read_and_what_cannot_be_read_is_refused(tiny):
    assert tiny.read(" does a cartwheel\n") == Read("does a cartwheel", ("does a cartwheel",))
    longest = " ".join(["kicks"] * (tiny_clip.LONGEST - 2))
    assert tiny.tokens([tiny.read(longest).words[0]]).mask.sum() == tiny_clip.LONGEST
    with pytest.raises(TextError, match="has 25 tokens, with the marks.*reads 24 at most"):
        tiny.read(longest + " left")
    with pytest.raises(TextError, match="25 tokens"):
        tiny.tokens(["kicks", longest + " left"])
    with pytest.raises(TextError, match="the text is empty: say what the figure does"):
        tiny.read(" \n")
    with pytest.raises(TextError, match="no valid Unicode"):
        tiny.read("kicks \ud800")


def test_a_whole_clip_gives_its_half_that_reads(tmp_path, capfd):
    both = clip.load(tiny_clip.with_eyes(tmp_path))
    capfd.readouterr()
    again = clip.load(tmp_path)
    assert capfd.readouterr() == ("", "")  # no bars, no report of the half that is not used
    wanted = alone(tmp_path, "kicks left")
    for one in (both, again):
        torch.testing.assert_close(one.tokens(["kicks left"]).hidden[0], wanted)


def test_the_older_files_of_a_tokenizer_are_read(folder, tmp_path):
    shutil.copytree(folder, tmp_path / "old")
    (tmp_path / "old" / "tokenizer.json").unlink()
    (tmp_path / "old" / "tokenizer_config.json").unlink()
    tiny_clip.tokenizer().backend_tokenizer.model.save(str(tmp_path / "old"))  # vocab, merges
    found = clip.load(tmp_path / "old").ids([*TEXTS, "WALKS"])
    assert found[:4] == clip.load(folder).ids(TEXTS) and found[4] == found[4][:3]
    assert found[4][1] in found[0]  # in lower case it is "walks"


def test_it_is_frozen_and_has_no_dropout(tmp_path):
    made = clip.load(tiny_clip.made(tmp_path, attention_dropout=0.5))
    assert not made.model.training
    assert not any(p.requires_grad for p in made.model.parameters())
    first, second = (made.tokens(["kicks"]) for _ in range(2))
    assert torch.equal(first.hidden, second.hidden) and not first.hidden.requires_grad


def test_a_clip_that_was_downloaded_is_found_by_its_name(folder, tmp_path, calls, monkeypatch):
    kept = tmp_path / "models--somebody--one"
    shutil.copytree(folder, kept / "snapshots" / "abc")
    (kept / "refs").mkdir()
    (kept / "refs" / "main").write_text("abc")
    monkeypatch.setattr("huggingface_hub.constants.HF_HUB_CACHE", str(tmp_path))
    found = clip.load("somebody/one")
    assert found.name == "somebody/one" and calls == []
    torch.testing.assert_close(found.tokens(["kicks"]).hidden[0], alone(folder, "kicks"))


def test_loading_never_asks_the_network_of_itself(folder, calls):
    assert clip.load(folder).width == tiny_clip.WIDTH
    with pytest.raises(clip.ClipError) as told:
        clip.load("somebody/a-clip-that-is-not-here")
    assert calls == []
    words = str(told.value)
    assert words.startswith("there is no folder somebody/a-clip-that-is-not-here, and no CLIP of")
    assert 'clip.load("somebody/a-clip-that-is-not-here", download=True)' in words


def test_it_is_downloaded_where_that_is_asked_for(monkeypatch):
    asked = []

    def from_pretrained(name, local_files_only, **_):
        asked.append((name, local_files_only))
        raise OSError("We couldn't connect to the hub\nand more")

    monkeypatch.setattr("transformers.CLIPTextModel.from_pretrained", from_pretrained)
    with pytest.raises(clip.ClipError, match="a/b could not be downloaded .We couldn't connect"):
        clip.load("a/b", download=True)
    assert asked == [("a/b", False)]


def test_half_a_download_is_begun_again_and_not_taken_for_a_clip(folder, tmp_path, monkeypatch):
    kept = tmp_path / "models--a--b" / "snapshots" / "main"
    kept.mkdir(parents=True)
    shutil.copy(folder / "config.json", kept)
    monkeypatch.setattr("huggingface_hub.constants.HF_HUB_CACHE", str(tmp_path))
    with pytest.raises(clip.ClipError, match="has no CLIP that can be used"):
        clip.load("a/b")
    asked = []

    def from_pretrained(name, **_):
        asked.append(name)
        raise OSError("no network")

    monkeypatch.setattr("transformers.CLIPTextModel.from_pretrained", from_pretrained)
    with pytest.raises(clip.ClipError, match="a/b could not be downloaded"):
        clip.load("a/b", download=True)
    assert asked == ["a/b"]


SIZES = {"num_hidden_layers": 1_000_000, "hidden_size": 40_000, "intermediate_size": 5_000_000}


def damaged(folder: Path, target: Path, what: str) -> Path:
    """A copy of a CLIP with something wrong."""
    shutil.copytree(folder, target)
    if what == "another kind":
        from transformers import BertConfig, BertModel

        sizes = {"hidden_size": 32, "num_hidden_layers": 1, "num_attention_heads": 2}
        BertModel(BertConfig(vocab_size=300, intermediate_size=32, **sizes)).save_pretrained(target)
    elif what == "no weights":
        (target / "model.safetensors").unlink()
    elif what == "cut weights":
        weights = target / "model.safetensors"
        weights.write_bytes(weights.read_bytes()[:999])
    elif what == "no tokenizer":
        (target / "tokenizer.json").unlink()
        (target / "tokenizer_config.json").unlink()
    elif what in SIZES:
        config = json.loads((target / "config.json").read_text())
        (target / "config.json").write_text(json.dumps(config | {what: SIZES[what]}))
    elif what == "small vocabulary":
        tiny_clip.made(target, vocab_size=100)
    return target


@pytest.mark.parametrize(
    "what, told",
    [
        ("another kind", "is no CLIP: it lacks"),
        ("no weights", "has no CLIP that can be used"),
        ("cut weights", "has no CLIP that can be used"),
        *((size, "asks for more weights than the files have") for size in SIZES),
        ("no tokenizer", "has no tokenizer that fits: it knows 2 tokens"),
        (
            "small vocabulary",
            "has no tokenizer that fits: it knows .* tokens, the transformer 100;",
        ),
    ],
)
def test_a_faulty_folder_is_refused_in_words(folder, tmp_path, calls, what, told):
    with pytest.raises(clip.ClipError, match=told):
        clip.load(damaged(folder, tmp_path / "one", what))
    assert calls == []


def test_without_the_extra_the_message_names_it(folder, monkeypatch):
    monkeypatch.setitem(sys.modules, "transformers", None)
    with pytest.raises(ImportError, match=r'pip install "motiondiff_edu\[clip\]"'):
        clip.load(folder)


def test_another_clip_is_told_apart(tiny, tmp_path):
    other = clip.load(tiny_clip.made(tmp_path / "other", seed=1))
    clip.check(tiny, tiny_clip.WIDTH, tiny.sample())
    clip.check(other, tiny_clip.WIDTH)  # nothing is known of the one that is wanted
    with pytest.raises(clip.ClipError, match="gives other tokens than the CLIP"):
        clip.check(other, tiny_clip.WIDTH, tiny.sample())
    silent = replace(tiny, name="silent", model=copy.deepcopy(tiny.model))
    for weights in silent.model.parameters():
        weights.fill_(torch.nan)
    with pytest.raises(clip.ClipError, match="silent gives other tokens than the CLIP"):
        clip.check(silent, tiny_clip.WIDTH, tiny.sample())
    with pytest.raises(clip.ClipError, match="has tokens of 32 numbers; .* which has 512"):
        clip.check(tiny, 512, tiny.sample())


def test_the_encoder_projects_every_token_by_itself():
    torch.manual_seed(0)
    encoder = ClipEncoder(7, 5)
    texts = ClipTokens(torch.randn(2, 3, 7), torch.tensor([[True] * 3, [True, True, False]]))
    tokens, mask = encoder.tokens_of(texts)
    assert tokens.shape == (2, 3, 5) and torch.equal(mask, texts.mask)
    first, second = encoder.mlp[0], encoder.mlp[2]
    x = texts.hidden[1, 1]
    by_hand = second.weight @ torch.nn.functional.gelu(first.weight @ x + first.bias) + second.bias
    torch.testing.assert_close(tokens[1, 1], by_hand)
