"""Beats where the place comes round, in trembling and after a silence; and who has no ear."""

import math

import numpy as np
import pytest
import torch
from small_dancers import dancer_to_mel

from motiondiff_edu.course.analyses.heard_by import as_heard, crossings, heard_by, place_of
from motiondiff_edu.ddpm import cosine_schedule
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.performers.dancer import Dancer
from motiondiff_edu.performers.ear import GENRES, EarOutput
from motiondiff_edu.performers.hearing_mofusion import HearingConfig, HearingMoFusion

TIMES = np.arange(300) * 0.064
ALWAYS = np.ones(300, bool)


def test_beats_of_an_even_count_come_back():
    beats = np.arange(0.31, 19, 0.47)
    count = np.interp(TIMES, beats, np.arange(len(beats)), left=np.nan, right=np.nan)
    known = ~np.isnan(count)
    found = crossings(TIMES, np.nan_to_num(count) % 1, known)
    np.testing.assert_allclose(found, beats[1:-1], atol=1e-9)


def test_a_place_that_trembles_passes_once():
    rng = np.random.default_rng(0)
    count = TIMES / 0.5 + 0.03 * rng.standard_normal(300)
    found = crossings(TIMES, count % 1, ALWAYS)
    assert np.diff(found).min() > 0.35
    np.testing.assert_allclose(found, 0.5 * np.round(found / 0.5), atol=0.08)


def test_a_place_that_trembles_across_a_beat_passes_it_once():
    count = np.linspace(0.8, 1.2, 41) + 0.03 * (-1.0) ** np.arange(41)
    times = 0.01 * np.arange(41)
    across = (np.diff(np.floor(count)) > 0).sum()
    assert across > 2 and len(crossings(times, count % 1, np.ones(41, bool))) == 1


def test_no_beat_in_a_silence_and_all_after_it():
    known = (TIMES < 6) | (TIMES > 9)
    found = crossings(TIMES, (TIMES / 0.5) % 1, known)
    assert not ((found > 6.1) & (found < 8.9)).any()
    np.testing.assert_allclose(found[found > 9], np.arange(9.5, 19.1, 0.5))
    assert (found < 6).sum() >= 11


def test_places():
    circle = torch.tensor([[1.0, 0], [0, 2.0], [-1, 0], [0, -0.1]])
    np.testing.assert_allclose(place_of(circle), [0, 0.25, 0.5, 0.75], atol=1e-12)


def on_circle(count: torch.Tensor) -> torch.Tensor:
    angles = 2 * math.pi * count
    return torch.stack([angles.cos(), angles.sin()], -1)[None]


def test_what_an_ear_says_of_each_token_and_of_the_song():
    """Beats at 0.25 s and every half a second, every third a downbeat; the last 2 s are silent."""
    times = torch.arange(100, dtype=torch.float64) * 0.064
    count = (times - 0.25) / 0.5
    silent = times > 4.4
    logits = torch.zeros(1, 100, len(GENRES), dtype=torch.float64)
    logits[0, :25, 0] = 8.0  # a quarter of the song is sure of the first genre, the rest
    logits[0, 25:, 1] = 2.0  # leans to the second one
    said = EarOutput(
        on_circle(count), on_circle(count / 3), torch.where(silent, -3.0, 3.0)[None], logits
    )
    heard = as_heard(said, times)
    np.testing.assert_allclose(heard.beats, np.arange(0.25, 4.3, 0.5), atol=1e-9)
    np.testing.assert_allclose(heard.downbeats, np.arange(0.25, 4.3, 1.5), atol=1e-9)
    np.testing.assert_allclose(heard.sounds, 1 / (1 + np.exp(np.where(silent, 3, -3))), atol=1e-6)
    mean = np.exp([2.0, 1.5, 0, 0, 0])  # logits are averaged first, so who is sure counts more
    assert heard.genres == pytest.approx(dict(zip(GENRES, mean / mean.sum(), strict=True)))


def test_a_dancer_says_what_it_hears():
    torch.manual_seed(0)
    config = HearingConfig(S=12, widths=(16, 24), heads=2, music_layers=1, ear_width=16)
    motion = Scaler(torch.zeros(63), torch.ones(63))
    model = HearingMoFusion(config).eval()
    heard = heard_by(
        Dancer(model, cosine_schedule(12), motion, Scaler.nothing(80)), torch.ones(99, 80)
    )
    assert len(heard.times) == len(heard.beat) == len(heard.bar) == len(heard.sounds) == 50
    assert list(heard.genres) == list(GENRES) and sum(heard.genres.values()) == pytest.approx(1)
    with pytest.raises(ValueError, match="has no ear"):
        heard_by(dancer_to_mel(), torch.ones(99, 80))
