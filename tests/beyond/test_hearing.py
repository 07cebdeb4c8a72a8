"""Counts by hand, songs heard faster only at tempi that are allowed, and bands without sound."""

import math

import numpy as np
import pytest
import torch

from data_synth.music.tempi import FAR_FROM_HELD_OUT, HELD_OUT_TEMPI, WANDER
from data_synth.music.varied import varied_song
from motiondiff_edu.beyond.hearing import (
    SILENT,
    MelAugmentation,
    augmented,
    beat_counts,
    gain_noise,
    interpolated_rows,
    on_circles,
    tempo_factors,
)


def draws(seed: int = 0) -> torch.Generator:
    return torch.Generator().manual_seed(seed)


def test_counts_by_hand():
    beats = np.array([1.0, 1.5, 2.0, 4.0, 4.5])
    times = np.array([0.5, 1.0, 1.25, 1.9, 3.0, 4.25, 4.5])
    made = beat_counts(times, beats, np.array([2, 0, 1, 2, 0]), 3)
    wanted = [[0, 2 / 3], [0.5, 2.5 / 3], [1.8, 3.8 / 3]]
    np.testing.assert_allclose(made[1:4], wanted)
    assert np.isnan(made[[0, 4, 6]]).all()  # before the first, in the pause, after the last
    assert made[5, 0] % 1 == 0.5 and made[5, 1] % 1 == pytest.approx(2.5 / 3)
    assert np.isnan(beat_counts(np.arange(3.0), beats[:1], np.array([0]), 4)).all()


def test_a_real_score_is_on_its_downbeats_and_never_goes_back():
    song = varied_song(12, 30.0)
    at = beat_counts(song.beats[:-1] + 1e-6, song.beats, song.bar_position, song.metre)
    known = ~np.isnan(at[:, 0])
    assert known.mean() > 0.9
    np.testing.assert_allclose(
        (at[known, 1] * song.metre) % song.metre, song.bar_position[:-1][known], atol=1e-3
    )
    assert (np.diff(at[known], axis=0) > 0).all()


def test_circles():
    count = torch.tensor([[[0.0, 0.25], [3.5, 1.5], [math.nan, math.nan]]])
    wanted = torch.tensor([[[1.0, 0, 0, 1], [-1, 0, -1, 0], [0, 0, 0, 0]]])
    torch.testing.assert_close(on_circles(count), wanted, atol=1e-5, rtol=0)


def test_no_song_is_heard_at_tempi_that_are_kept_out():
    tempi = torch.linspace(60, 180, 4000)
    faster = tempo_factors(tempi, FAR_FROM_HELD_OUT, (1 / 1.33, 1.33), draws())
    assert (faster <= 1.33).all() and (faster >= 1 / 1.33).all()
    changed = faster != 1
    assert changed.float().mean() > 0.8 and (faster[changed] > 1.2).float().mean() > 0.1
    # beats get longer and shorter by so much
    heard = (faster * tempi)[changed, None] / torch.tensor([1 + WANDER, 1 - WANDER])
    for low, high in HELD_OUT_TEMPI:
        assert not ((low + 1e-3 < heard[:, 1]) & (heard[:, 0] < high - 1e-3)).any()


def test_rows_between():
    rows = torch.tensor([[[0.0], [10.0], [30.0]]])
    at = torch.tensor([[-1.0, 0.0, 0.5, 1.25, 2.0, 7.0]])
    assert interpolated_rows(rows, at).flatten().tolist() == [0, 0, 5, 15, 30, 30]


def test_a_song_is_heard_higher_in_noise_and_without_bands():
    mel = torch.arange(80.0).expand(64, 10, 80)
    still = MelAugmentation((1.0, 0.0), 0.0, (0.0, 0.0), (0, 0.0))
    torch.testing.assert_close(augmented(mel, still, draws()), mel)
    higher = augmented(mel, MelAugmentation((1.0, 0.0), 4.0, (0.0, 0.0), (0, 0.0)), draws()) - mel
    assert higher.abs().max() <= 4 and higher[:, 0, 40].std() > 1.5
    noisy = augmented(mel, MelAugmentation((1.0, 0.0), 0.0, (0.5, 1.0), (0, 0.0)), draws()) - mel
    assert 0.15 < noisy.std() < 0.4 and noisy.std((1, 2)).max() < 0.6
    frames = noisy[:, :2].transpose(0, 1).flatten(1)
    assert abs(torch.corrcoef(frames)[0, 1]) < 0.1  # it differs from frame to frame
    deaf = augmented(mel, MelAugmentation((1.0, 0.0), 0.0, (0.0, 0.0), (40, 1.0)), draws())
    hidden = (deaf == SILENT).all(1)
    assert hidden.sum(1).max() <= 41 and 10 < hidden.float().sum(1).mean() < 30
    assert (deaf == SILENT).sum() == 10 * hidden.sum()  # always for the whole piece
    for row in hidden[hidden.any(1)]:
        (at,) = row.nonzero(as_tuple=True)
        assert at.max() - at.min() + 1 == len(at)  # next to each other


def test_music_with_gain_noise_differs_in_level_and_balance_alone():
    generator = torch.Generator().manual_seed(0)
    mel = torch.randn(400, 20, 5, generator=generator)
    change = gain_noise(mel, 0.3, generator) - mel
    alike = change[:, :1].expand_as(change)
    torch.testing.assert_close(change, alike, atol=1e-5, rtol=0)
    level = change[:, 0].mean(-1)
    tilt = (change[:, 0, -1] - change[:, 0, 0]) / 2
    line = level[:, None] + tilt[:, None] * torch.linspace(-1, 1, 5)
    torch.testing.assert_close(change[:, 0], line, atol=1e-5, rtol=0)
    assert level.std().item() == pytest.approx(0.3, rel=0.15)
    assert tilt.std().item() == pytest.approx(0.3, rel=0.15)
    assert abs(torch.corrcoef(torch.stack([level, tilt]))[0, 1]) < 0.2  # neither follows the other
