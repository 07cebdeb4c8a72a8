"""Where a dancer's attention reads: by level, and its share on beats."""

import io
from dataclasses import replace
from datetime import UTC, datetime

import notebook_cells
import numpy as np
import pytest
import torch
from bursts import clicks
from small_dancers import TINY
from small_dancers import dancer_to_mel as dancer

from motiondiff_edu.conditions.music import log_mel
from motiondiff_edu.course.analyses import attention_on_beats
from motiondiff_edu.cross_modal_attention import CrossModalAttention
from motiondiff_edu.mofusion import Level, MoFusion
from motiondiff_edu.pretrained import checkpoints


def maps(T: int = 30, s: int = 5, **changes):
    mel = torch.randn(50, 80, generator=torch.Generator().manual_seed(1)) - 6
    dance = np.random.default_rng(2).normal(size=(T, 21, 3))
    return attention_on_beats.attention_maps(
        dancer(**changes), mel, dance, s, generator=torch.Generator().manual_seed(4)
    )


def test_each_level_has_a_row_for_each_of_its_frames_and_a_column_for_each_token():
    found, times = maps(T=30)  # music: the 47 Mel frames of 1.5 s, every second of which is a token
    rows = {
        "down, 20 a second": 30,
        "down, 10 a second": 15,
        "bottom, 5 a second": 8,
        "up, 10 a second": 15,
        "up, 20 a second": 30,
    }
    assert {name: m.shape for name, m in found.items()} == {
        name: (n, 24) for name, n in rows.items()
    }
    assert list(found) == list(rows)
    assert times == pytest.approx(np.arange(24) * 0.064)
    for m in found.values():
        assert m.sum(1) == pytest.approx(np.ones(len(m)), abs=1e-5) and (m >= 0).all()
    assert (
        found["down, 20 a second"].std(0).max() > 1e-4
    )  # rows differ: they ask at different times


def test_rows_and_columns_lie_where_they_are_in_time(monkeypatch):
    """A network that may attend within 0.2 s only: where its weights are zero is known
    beforehand."""
    plain = Level.of

    def near(T, lengths, level, music, config):
        view, times = plain(T, lengths, level, music, config), torch.arange(0, T, 2**level) / 20
        away = (times[:, None] - music.times).abs()
        return replace(view, bias=torch.where(away <= 0.2, 0.0, -1e4)[None, None])

    monkeypatch.setattr(Level, "of", near)
    found, times = maps(T=30, heads=1)
    for (name, m), level in zip(found.items(), (0, 1, 2, 1, 0), strict=True):
        frames = np.arange(len(m)) * 2**level / 20
        away = np.abs(frames[:, None] - times)
        assert (m[away < 0.199] > 0).all() and (m[away > 0.201] < 1e-6).all(), name


def test_the_layers_are_those_of_the_network():
    names = [
        n for n, part in MoFusion(TINY).named_modules() if isinstance(part, CrossModalAttention)
    ]
    assert sorted(layer for layer, _, _ in attention_on_beats.layers_of(TINY)) == sorted(names)


def test_maps_come_from_the_seed_and_depend_on_the_step():
    one = maps(s=5)[0]
    again = maps(s=5)[0]
    other = maps(s=12)[0]
    for name in one:
        assert np.array_equal(one[name], again[name])
    assert np.abs(one["bottom, 5 a second"] - other["bottom, 5 a second"]).max() > 1e-5


def test_a_network_without_music_and_a_step_too_far_are_named():
    with pytest.raises(ValueError, match="need a U-Net with music"):
        maps(C=0)
    with pytest.raises(ValueError, match="has a HearingTransformer"):
        attention_on_beats.attention_maps(
            checkpoints.load("regression"), torch.zeros(50, 80), np.zeros((50, 21, 3)), 5
        )
    with pytest.raises(ValueError, match="1 to 12, not 13"):
        maps(s=13)


def test_beat_mass_by_hand():
    times = np.arange(6) * 0.064  # 0, .064, .128, .192, .256, .32
    weights = np.array([[0.5, 0.1, 0.1, 0.1, 0.1, 0.1], [0.0, 0.0, 0.0, 0.0, 0.25, 0.75]])
    assert attention_on_beats.beat_mass(weights, times, np.array([0.0])) == pytest.approx(
        (0.6 + 0.0) / 2
    )
    assert attention_on_beats.beat_mass(
        weights, times, np.array([0.0, 0.05, 0.3])
    ) == pytest.approx((0.9 + 1.0) / 2)
    assert attention_on_beats.beat_mass(
        weights, times, np.array([0.3]), near=0.03
    ) == pytest.approx((0.1 + 0.75) / 2)
    with pytest.raises(ValueError, match="no beats"):
        attention_on_beats.beat_mass(weights, times, np.array([]))


def test_beats_with_another_place_are_what_even_weights_get():
    times, beats = np.arange(150) * 0.064, np.arange(0.3, 9.5, 0.6)
    even = np.full((4, 150), 1 / 150)
    on_beats = (np.abs(times[:, None] - beats).min(1) <= 0.1).astype(float)[None]
    on_beats /= on_beats.sum()
    rng = np.random.default_rng(0)
    chance = attention_on_beats.beat_mass_by_chance(even, times, beats, rng)
    assert chance.shape == (500,) and chance.mean() == pytest.approx(0.2 / 0.6, abs=0.02)
    assert attention_on_beats.beat_mass(on_beats, times, beats) == pytest.approx(1.0)
    assert attention_on_beats.beat_mass_by_chance(
        on_beats, times, beats, rng
    ).mean() == pytest.approx(0.2 / 0.6, abs=0.03)


def test_seconds_read_by_hand():
    times = 0.7 + np.arange(5) * 0.064
    even = np.full(5, 0.2)
    one = np.eye(5)[3]
    two = np.array([0, 0.5, 0, 0, 0.5])
    for row, tokens in ((even, 5), (one, 1), (two, 2)):
        assert attention_on_beats.seconds_read(row[None], times) == pytest.approx(tokens * 0.064)
    assert attention_on_beats.seconds_read(np.stack([even, one]), times) == pytest.approx(3 * 0.064)


def test_share_near_counts_the_silenced_span():
    times = np.arange(5) * 0.1
    weights = np.array([[0.1, 0.2, 0.3, 0.25, 0.15], [1.0, 0, 0, 0, 0]])
    got = attention_on_beats.share_near(
        weights, times, np.array([0.05, 0.31]), before=0.02, after=0.12
    )
    assert got == pytest.approx(np.array([[0.2, 0.25 + 0.15], [0.0, 0.0]]))


def test_notebook_12_dances_to_an_upload_and_says_what_is_wrong_with_it(monkeypatch):
    """A file is uploaded to notebook 12, and the message is read.

    A button's error reaches nobody, so the cells are run here, with a small dancer.
    """
    soundfile = pytest.importorskip("soundfile")
    monkeypatch.setattr(checkpoints, "load", lambda name: dancer(S=20))
    path = next(path for path in notebook_cells.sources() if path.name.startswith("12"))
    cells = [
        c
        for c in notebook_cells.code(notebook_cells.read(path))
        if c["id"] in ("imports", "song", "own-song", "upload")
    ]
    names = notebook_cells.run(cells, {"display": lambda *shown: None})
    names["beats_of"] = lambda audio, rate: np.array([0.5, 1.0, 7.0])  # librosa is slow to import

    def upload(content: bytes) -> None:
        when = datetime.now(UTC)
        file = {
            "name": "a",
            "type": "b",
            "size": len(content),
            "content": memoryview(content),
            "last_modified": when,
        }
        names["upload"].value = (file,)

    whole = len(names["player"].music["beats"])
    buffer = io.BytesIO()
    soundfile.write(buffer, clicks(3.0, (0.5, 1.0)), 16_000, format="WAV")
    upload(buffer.getvalue())
    assert names["said"].value == "now it dances to a"
    assert names["player"].scene["figures"][0]["frames"] == 60 and whole > 2
    assert names["player"].music["beats"] == [0.5, 1.0]
    upload(b"these are words, and no music at all")
    assert (
        "text, not sound" in names["said"].value
        and names["player"].scene["figures"][0]["frames"] == 60
    )


def test_figures_say_what_they_show():
    pytest.importorskip("matplotlib")
    from motiondiff_edu.viz import sound as viz
    from motiondiff_edu.viz.style import caption

    found, times = maps(T=30)
    song, moments = clicks(1.5, (0.5,)), np.array([0.2, 0.5, 1.1])
    shares = attention_on_beats.share_near(found["down, 20 a second"], times, moments)
    figures = [
        viz.levels_over_sound(song, 16_000, found, times, np.array([0.5, 1.0]), 1.5, "one"),
        viz.time_maps({"a": found["down, 20 a second"]}, times, 1.5, "two"),
        viz.weight_and_effect(shares, np.ones((3, 30)), moments, 1.5, "three"),
        viz.before_and_after(
            {"song": log_mel(song, 16_000).numpy()}, np.arange(47) / 31.25, [0.5], "four"
        ),
    ]
    assert [caption(fig) for fig in figures] == ["one", "two", "three", "four"]
    assert len(figures[0].axes) == 6 and [len(axis.lines) for axis in figures[0].axes] == [2] * 6
    left, right = (axis.collections[0].get_array() for axis in figures[2].axes[:2])
    assert left.shape == (30, 3) and float(right.max()) == pytest.approx(
        100
    )  # metres come as centimetres
