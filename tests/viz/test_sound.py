"""Figures of sound.

They hold what was given, carry a caption, and draw only the beats that lie in the picture.
"""

import io

import numpy as np
import pytest
from PIL import Image

from motiondiff_edu.viz import sound
from motiondiff_edu.viz.style import caption

SECONDS = np.arange(25) * 0.032
HZ = np.linspace(0, 8000, 33)
VALUES = np.random.default_rng(0).normal(size=(25, 33))
FIGURES = {
    "waveform": lambda: sound.waveform(SECONDS, np.sin(SECONDS), "words", beats=[-1, 0.1, 0.5, 9]),
    "spectra": lambda: sound.spectra(
        HZ, {"a": np.abs(VALUES[0]), "b": np.abs(VALUES[1])}, "words", mark=440
    ),
    "filters": lambda: sound.filters(HZ, np.eye(33)[1:-1], "words", every=3),
    "spectrogram": lambda: sound.spectrogram(SECONDS, HZ, VALUES, "words", beats=[0.4], top=4000),
    "mel": lambda: sound.mel_spectrogram(SECONDS, HZ, VALUES, "words", beats=[0.4]),
    "two clocks": lambda: sound.two_clocks(
        SECONDS, {"by index": SECONDS, "by time": 0 * SECONDS}, "words"
    ),
    "onsets": lambda: sound.onsets(
        SECONDS, VALUES[:, 0] ** 2, "words", beats=[0.4], found=[0.42, 7]
    ),
    "tempogram": lambda: sound.tempogram(SECONDS, HZ / 20 + 20, VALUES.T, 120, "words"),
    "lags": lambda: sound.lags(
        {"one": np.array([20.0, 25.0]), "two": np.array([500.0])}, "words", 20
    ),
}


@pytest.mark.parametrize("name", FIGURES)
def test_each_figure_has_a_caption_and_ink(name):
    fig = FIGURES[name]()
    assert caption(fig) == "words"
    picture = np.asarray(Image.open(io.BytesIO(fig.as_png())).convert("L"))
    assert picture.min() < 90 and picture.max() == 255 and 400 < picture.shape[1]


def test_beats_outside_of_the_picture_are_not_drawn():
    axis = FIGURES["waveform"]().axes[0]
    assert [line.get_xdata()[0] for line in axis.lines[1:]] == [0.1, 0.5]
    assert [text.get_text() for text in axis.get_legend().get_texts()] == ["beat"]
    triangles = [line for line in FIGURES["onsets"]().axes[0].lines if line.get_marker() == "v"]
    assert [list(line.get_xdata()) for line in triangles] == [[0.42]]


def test_mel_rows_are_named_by_their_frequency():
    axis = FIGURES["mel"]().axes[0]
    assert [text.get_text() for text in axis.get_yticklabels()] == [
        "100",
        "500",
        "1000",
        "2000",
        "4000",
        "7000",
    ]
    np.testing.assert_allclose(
        axis.get_yticks(), [0.4, 2, 4, 8, 16, 28]
    )  # a row is 250 Hz high here
    np.testing.assert_array_equal(axis.collections[0].get_array().reshape(33, 25), VALUES.T)


def test_levels_are_relative_to_the_loudest():
    line = sound.spectra(HZ[:3], {"a": np.array([10.0, 1.0, 0.1])}, "words").axes[0].lines[0]
    np.testing.assert_allclose(line.get_ydata(), [0, -20, -40])


def test_a_spectrogram_ends_at_its_top():
    low, high = FIGURES["spectrogram"]().axes[0].get_ylim()
    assert low >= -200 and 3800 <= high <= 4200


def test_a_tempogram_has_the_mean_over_time_beside_it():
    tempi = np.array([20.0, 60.0, 120.0, 400.0])  # the first and the last lie outside
    values = np.array([[9.0, 9.0, 9.0], [0.0, 0.3, 0.9], [1.0, 1.0, 4.0], [9.0, 9.0, 9.0]])
    left, right = sound.tempogram(np.arange(3) * 0.5, tempi, values, 90, "words").axes
    np.testing.assert_array_equal(left.collections[0].get_array().reshape(2, 3), values[1:3])
    mean, mark = right.lines
    np.testing.assert_allclose(mean.get_xydata(), [[0.4, 60], [2.0, 120]])
    assert set(mark.get_ydata()) == {90}


def test_a_delay_is_marked_at_the_median_and_cut_off():
    axis = sound.lags({"one": np.array([0.0, 10.0, 100.0, 500.0])}, "words", 20, reach=120).axes[0]
    dots, median = axis.lines[:2]
    assert dots.get_xdata().tolist() == [0, 10, 100, 120]
    assert median.get_xdata()[0] == 55  # the mean is 57.5
