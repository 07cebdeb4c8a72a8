"""A hit is taken out of a song, and nothing else."""

import numpy as np
import pytest
from bursts import clicks

from motiondiff_edu.conditions import silence
from motiondiff_edu.conditions.music import log_mel


def test_a_silenced_hit_is_gone_and_nothing_else():
    song, tone = clicks(2.0, (0.5, 1.2)), clicks(2.0, ())
    quiet = silence.silence_hit(song, 1.2)
    t = np.arange(len(song)) / 16_000
    span = (t >= 1.2 - silence.EDGE) & (t <= 1.2 + silence.WIDTH + silence.EDGE)
    assert quiet.dtype == song.dtype and np.array_equal(quiet[~span], song[~span])
    hit = (t >= 1.2) & (t < 1.3)

    def power(x):
        return float(np.square(x[hit]).mean())

    assert power(quiet - tone) < 0.02 * power(song - tone)  # of the burst hardly anything is left
    assert power(quiet) == pytest.approx(power(tone), rel=0.15)  # and the tone goes on
    assert np.array_equal(silence.silence_hit(tone, 1.2)[~span], tone[~span])
    assert (
        np.abs(silence.silence_hit(tone, 1.2) - tone).max() < 0.01
    )  # where nothing is struck nothing goes


def test_a_hit_at_the_very_start_is_silenced_too():
    song = clicks(1.0, (0.0,), tone=0.0)
    assert np.abs(silence.silence_hit(song, 0.0)[:1600]).max() < 0.05 * np.abs(song).max()


@pytest.mark.parametrize(
    "time, width, words",
    [(2.0, 0.12, "no sound at 2 s"), (-0.1, 0.12, "no sound"), (1.0, 0.0, "above 0")],
)
def test_what_cannot_be_silenced_is_named(time, width, words):
    with pytest.raises(ValueError, match=words):
        silence.silence_hit(clicks(2.0, (0.5,)), time, width)


def test_what_rings_on_comes_back_without_another_blow():
    """A long burst: the loudness of the mended song never jumps, neither at the hit nor where the
    span ends."""
    t = np.arange(32_000) / 16_000
    ring = np.where(t >= 1.0, np.exp(-np.maximum(t - 1.0, 0) / 0.15), 0.0) * np.random.default_rng(
        5
    ).standard_normal(32_000)
    song = (0.01 * np.random.default_rng(6).standard_normal(32_000) + 0.3 * ring).astype(np.float32)

    def largest_rise(x):
        level = log_mel(x, 16_000).numpy().mean(1)
        return np.diff(level[25:45]).max()

    assert largest_rise(song) > 4 and largest_rise(silence.silence_hit(song, 1.0)) < 1.5
