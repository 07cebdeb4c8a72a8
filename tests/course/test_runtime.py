"""runtime.py: profile, seed, device, and the one line a notebook prints."""

import numpy as np
import pytest
import torch

from motiondiff_edu.course import runtime


@pytest.mark.parametrize(
    "word, wanted", [(None, "fast"), ("", "fast"), ("fast", "fast"), (" FULL ", "full")]
)
def test_profile_is_read_from_the_environment(monkeypatch, word, wanted):
    monkeypatch.delenv("MOTIONDIFF_PROFILE", raising=False)
    if word is not None:
        monkeypatch.setenv("MOTIONDIFF_PROFILE", word)
    assert runtime.profile() == wanted


def test_another_word_is_refused_with_the_two_there_are(monkeypatch):
    monkeypatch.setenv("MOTIONDIFF_PROFILE", "quick")
    with pytest.raises(runtime.ProfileError, match="'quick'.*'fast' or 'full'"):
        runtime.profile()


def test_start_prints_one_line_and_repeats_itself(monkeypatch, capsys):
    monkeypatch.delenv("MOTIONDIFF_PROFILE", raising=False)
    draws = []
    for _ in range(2):
        run = runtime.start(notebook="03", seed=5)
        draws.append(torch.cat([torch.randn(2, generator=run.generator), torch.randn(2)]))
        draws[-1] = (draws[-1], run.rng.normal(), np.random.rand())
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 2 and lines[0] == lines[1]
    for part in ("notebook 03", "profile fast", "seed 5", torch.__version__, "cpu"):
        assert part in lines[0]
    assert torch.equal(draws[0][0], draws[1][0]) and draws[0][1:] == draws[1][1:]


def test_another_seed_is_another_draw():
    first, second = (
        torch.randn(3, generator=runtime.start("03", seed=seed).generator) for seed in (0, 1)
    )
    assert not torch.equal(first, second)


def test_pick_follows_the_profile(monkeypatch):
    monkeypatch.setenv("MOTIONDIFF_PROFILE", "full")
    assert runtime.start("07").pick(400, 20_000) == 20_000
    monkeypatch.setenv("MOTIONDIFF_PROFILE", "fast")
    assert runtime.start("07").pick(400, 20_000) == 400


def test_fast_stays_on_the_cpu(monkeypatch):
    monkeypatch.setattr(torch.cuda, "is_available", lambda: True)
    monkeypatch.setenv("MOTIONDIFF_PROFILE", "fast")
    assert runtime.device().type == "cpu"
    monkeypatch.setenv("MOTIONDIFF_PROFILE", "full")
    assert runtime.device().type == "cuda"


@pytest.mark.parametrize("word, wanted", [("", False), ("0", False), ("1", True)])
def test_demo_is_known_and_said(monkeypatch, word, wanted):
    monkeypatch.setenv("MOTIONDIFF_DEMO", word)
    run = runtime.start("07")
    assert run.demo is wanted and ("no long training" in str(run)) is wanted
