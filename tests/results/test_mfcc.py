"""MFCC and beats as a network hears them.

Librosa's numbers from our own spectrogram, beats where they sound.
"""

from dataclasses import replace

import numpy as np
import pytest
import torch
from scipy.fft import dct

from data_synth.music import compose
from motiondiff_edu.conditions.music import log_mel
from motiondiff_edu.recipes.dancer import DANCER, training_windows
from motiondiff_edu.recipes.songs import training_songs
from tools.results.dances.mfcc import marks, mfcc_and_beats, with_music_features
from tools.results.dances.songs import mel_of

DATA = (1, 8.0)  # seed and seconds


def test_marks_keep_the_time_of_each_beat():
    row = marks(np.array([0.0, 0.5, 1.0]), 33)  # frames 0, 15.625, 31.25
    assert row.shape == (33,) and row.sum() == pytest.approx(3)
    assert (
        row[0] == 1
        and row[[15, 16]] == pytest.approx([0.375, 0.625])
        and row[[31, 32]] == pytest.approx([0.75, 0.25])
    )
    assert marks(np.array([-0.1, 5.0]), 33).sum() == 0
    assert marks(np.array([32.5 / 31.25]), 33)[32] == pytest.approx(
        0.5
    )  # the other half lies beyond


def test_coefficients_are_the_cosine_transform_of_the_log_mel():
    song = compose(5, "house", seconds=4.0)
    noise = (
        np.random.default_rng(0).normal(0, 0.1, len(song.audio)).astype(np.float32)
    )  # no band near the floor
    heard = mfcc_and_beats(replace(song, audio=noise))
    decibels = 10 / np.log(10) * log_mel(torch.from_numpy(noise), 16_000).numpy()
    assert heard.shape == (1 + len(noise) // 512, 22)
    np.testing.assert_allclose(
        heard[:, :20], dct(decibels, norm="ortho", axis=1)[:, :20], atol=0.02
    )
    assert heard[:, 20].sum() == pytest.approx(len(song.beats), abs=1)
    assert heard[:, 21].sum() == pytest.approx(len(song.downbeats), abs=1)
    times = np.arange(len(heard)) / 31.25
    first = heard[: int(31.25 * song.beats[:2].mean()), 20].numpy()
    assert (first * times[: len(first)]).sum() == pytest.approx(song.beats[0], abs=1e-4)


def test_the_same_windows_with_other_ears():
    seed, seconds = DATA
    recipe = replace(DANCER, songs=2, data_seed=seed, seconds=seconds, frames=40)
    windows = training_windows(recipe)
    other = with_music_features(windows, mfcc_and_beats, training_songs(2, *DATA))
    assert torch.equal(other.dances, windows.dances) and torch.equal(
        other.song_starts, windows.song_starts
    )
    assert other.mel.shape == (len(windows.mel), 22)
    back = with_music_features(other, mel_of, training_songs(2, *DATA))
    torch.testing.assert_close(back.mel, windows.mel)
    second = list(training_songs(2, *DATA))[1]
    frames = len(mfcc_and_beats(second))
    torch.testing.assert_close(
        other.mel_scaler.inverse(other.mel[-frames:]), mfcc_and_beats(second), atol=1e-3, rtol=0
    )
    with pytest.raises(ValueError, match="251 frames of features do not fit windows of 502"):
        with_music_features(windows, mfcc_and_beats, training_songs(1, *DATA))
