"""Silence is waited through: the dancer comes to rest, stands alive, and is back on the beat."""

from dataclasses import replace

import numpy as np
import pytest

from data_synth.dancing import dance, dances_to
from data_synth.dancing.waiting import SILENT, counted_on
from data_synth.music.score import beat_song

SILENCE = (8.0, 13.0)


def with_silence(song, start, end):
    """The song without its beats in a span of time."""
    kept = (song.beats < start) | (song.beats > end)
    fields = ("beats", "bar_position", "phrase", "energy")
    return replace(song, **{name: getattr(song, name)[kept] for name in fields})


@pytest.fixture(scope="module")
def paused():
    return with_silence(beat_song(20.0, 120.0, seed=3), *SILENCE)


def speed(positions):
    """Mean over the joints, m/s, between frames."""
    return 20 * np.linalg.norm(np.diff(positions, axis=0), axis=-1).mean(-1)


def test_beats_are_counted_on_by_hand():
    song = beat_song(8.0, 120.0, seed=1)
    paused = with_silence(song, song.beats[5] - 0.1, song.beats[8] + 0.1)  # 5, 6, 7, 8 are gone
    counted = counted_on(paused)
    np.testing.assert_allclose(counted.beats, song.beats)
    np.testing.assert_array_equal(counted.bar_position, song.bar_position)
    np.testing.assert_array_equal(np.flatnonzero(counted.energy == SILENT), [5, 6, 7, 8])
    np.testing.assert_array_equal(np.flatnonzero(np.diff(counted.phrase))[:2], [4, 8])


def test_a_song_without_silence_is_left_as_it_is():
    song = beat_song(8.0, 90.0, drift=0.05)
    assert counted_on(song) is song


def test_the_dancer_waits_and_does_not_freeze(paused):
    for seed in range(3):
        danced = dance(paused, seed)
        assert "wait" in [name for _, name, _ in danced.moves]
        moves = speed(danced.positions)
        t = (np.arange(len(moves)) + 0.5) / 20
        waiting = moves[(t > SILENCE[0] + 1.5) & (t < SILENCE[1] - 1.0)]
        dancing = moves[(t < SILENCE[0] - 1) | (t > SILENCE[1] + 1)]
        assert waiting.mean() < 0.4 * dancing.mean()
        assert waiting.max() < 0.35  # m/s
        assert waiting.min() > 1e-3  # sways
        inside = slice(round((SILENCE[0] + 1.5) * 20), round((SILENCE[1] - 1.0) * 20))
        assert danced.contacts[inside].mean() > 0.95  # on both feet


def test_dances_to_given_songs_are_those_of_dance(paused):
    made = list(dances_to([paused, paused], first=40, each=2))
    assert len(made) == 4 and all(song is paused for song, _ in made)
    np.testing.assert_array_equal(made[3][1].positions, dance(paused, 43).positions)
