"""What an ear hears is measured: an ear that is right has 1, one that counts double does not."""

from dataclasses import replace

import numpy as np
import pytest

from data_synth.music import compose
from motiondiff_edu.course.analyses.heard_by import Heard
from tools.results.dances import hearing
from tools.results.dances.hearing import hearing_measures, hearing_of

SONGS = [compose(3, "pop", seconds=8.0), compose(4, "waltz", seconds=8.0)]


def right(song, faster: float = 1.0) -> Heard:
    """What an ear says that hears everything, or `faster` beats than there are."""
    times = np.arange(0, 8, 0.064)
    count = np.interp(times, song.beats, np.arange(len(song.beats)))
    known = (times > song.beats[0] - 0.06) & (times < song.beats[-1] + 0.06)
    bar = (count + song.bar_position[0]) / song.metre
    genres = {song.genre: 0.9, "house": 0.1}
    return Heard(times, faster * count % 1, bar % 1, known.astype(float), genres)


@pytest.mark.parametrize(("faster", "beats"), [(1.0, (0.93, 1.0)), (2.0, (0.5, 0.75))])
def test_beats_are_counted_as_they_are_heard(monkeypatch, faster, beats):
    told = iter([right(song, faster) for song in SONGS])
    monkeypatch.setattr(hearing, "heard_by", lambda dancer, mel: next(told))
    found = hearing_of(None, SONGS)
    measures = {one.name: one.value for one in hearing_measures(found)}
    low, high = beats
    assert low <= measures["beats_f"] <= high
    assert measures["tracker_f"] > 0.9 and measures["genre_accuracy"] == 1
    assert measures["downbeats_f"] > 0.85


def test_a_genre_that_is_not_heard_counts_nothing(monkeypatch):
    wrong = replace(right(SONGS[0]), genres={"pop": 0.2, "latin": 0.8})
    monkeypatch.setattr(hearing, "heard_by", lambda dancer, mel: wrong)
    assert hearing_of(None, SONGS[:1]).genre.tolist() == [0]
