"""The record of a set of dances.

Each number against what it must be for figures that stop when told.
"""

import numpy as np
import pytest
from moves import stopping_at, sway

from motiondiff_edu.metrics.dances import BeatScores, NoBeatsWarning, beat_scores, chance_level

TEMPI = (88, 103, 119, 131)
SONGS = [
    0.2 + 0.04 * k + np.arange(-1, 12) * 60 / bpm for k, bpm in enumerate(TEMPI)
]  # also before and after the clip


def within(beats):
    return beats[(beats >= 0) & (beats <= 4.95)]


def on_the_beat(fps=20):
    return np.stack(
        [stopping_at(within(song), 4.95, fps) for song in SONGS]
    )  # 100 frames of 20 a second


def test_dances_on_their_own_beats():
    scores = beat_scores(on_the_beat(), SONGS)
    assert scores.bas_clips.shape == (4,) and scores.bas > 0.9
    assert scores.bas_shuffled < 0.45  # the beats of three other songs
    assert scores.bas_chance_clips == pytest.approx([chance_level(song, 4.95) for song in SONGS])
    assert scores.beats_per_beat == pytest.approx(1.0, abs=0.12)
    assert scores.speed == pytest.approx(np.mean([2 * 0.3 * bpm / 60 for bpm in TEMPI]), rel=0.12)


def test_the_means_are_those_of_the_clips():
    numbers = BeatScores(*(np.array([1.0, 2.0, 6.0]) * k for k in range(1, 6)))
    assert [
        numbers.bas,
        numbers.bas_shuffled,
        numbers.bas_chance,
        numbers.beats_per_beat,
        numbers.speed,
    ] == [3.0, 6.0, 9.0, 12.0, 15.0]


def test_shuffled_is_each_dance_with_each_other_song():
    dances = on_the_beat()
    scores = beat_scores(dances, SONGS)
    one_by_one = [beat_scores(dances[:1], [song]).bas for song in SONGS[1:]]
    assert scores.bas_shuffled_clips[0] == pytest.approx(np.mean(one_by_one))
    assert np.isnan(beat_scores(dances[:1], SONGS[:1]).bas_shuffled)


def test_a_dance_that_never_slows_down_is_left_out_and_told():
    dances = np.concatenate([on_the_beat()[:3], sway(4.95, 20)[None]])
    with pytest.warns(NoBeatsWarning, match="1 of 4 dances"):
        scores = beat_scores(dances, SONGS)
    assert np.isnan(scores.bas_clips[3]) and np.isnan(scores.bas_shuffled_clips[3])
    assert scores.bas == pytest.approx(scores.bas_clips[:3].mean())
    assert scores.beats_per_beat_clips[3] == 0 and scores.bas_chance_clips[3] > 0


def test_songs_that_do_not_fit_are_refused():
    with pytest.raises(ValueError, match="each dance needs its song"):
        beat_scores(on_the_beat(), SONGS[:3])
    with pytest.raises(ValueError, match="song 1 has no beat in the 4.95 s"):
        beat_scores(on_the_beat()[:2], [SONGS[0], SONGS[1] * 1000 + 5000])


def test_another_dance_to_the_same_song_is_no_other_song():
    dances = on_the_beat()
    alone = beat_scores(dances, SONGS)
    twice = beat_scores(np.concatenate([dances, dances[:1]]), [*SONGS, SONGS[0].copy()])
    assert twice.bas_shuffled_clips[0] == pytest.approx(alone.bas_shuffled_clips[0])
    assert np.isnan(beat_scores(dances[[0, 0]], [SONGS[0]] * 2).bas_shuffled)
