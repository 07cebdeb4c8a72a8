"""The dancers' measures.

The data scores as the data, shifted dances lose it, gains and ratios are what they say.
"""

import numpy as np
import pytest

from tools.results.dances.scores import (
    BEATS,
    BONES,
    VARIETY,
    beat_rows,
    bone_gain,
    bone_rows,
    features_of,
    longer,
    repeat_measure,
    rows_of,
    share,
    variety_rows,
)
from tools.results.dances.songs import FPS, judged_songs
from tools.results.walks.scores import measures


@pytest.fixture(scope="module")
def songs():
    return judged_songs(5, draws=3, frames=100)


def named(measures) -> dict[str, float]:
    return {measure.name: measure.value for measure in measures}


def beats_of(own, data) -> dict[str, float]:
    return named(measures(BEATS, beat_rows(own, data)))


def test_songs_and_dances_are_of_the_same_seconds(songs):
    assert songs.truth.shape == (5, 3, 100, 21, 3) and songs.mel.shape[2] == 80
    assert songs.mel.shape[1] / 31.25 >= 100 / FPS
    for song, beats in zip(songs.songs, songs.beats(100), strict=True):
        assert set(beats) <= set(song.beats) and beats.max() < 99 / 20 + 0.25 and len(beats) > 4
    assert len({song.genre for song in songs.songs}) > 1


def test_the_datas_own_dances_have_the_datas_measures(songs):
    beats = songs.beats(100)
    data = rows_of(songs.truth[:, 0][None], beats)
    found = beats_of(data, data)
    assert found["skating_mps"] == found["skating_data_mps"] < 0.05
    slid = songs.truth[:, 0][None] + 0.01 * np.arange(songs.truth.shape[2])[:, None, None] * [
        1.0,
        0.0,
        0.0,
    ]
    assert beats_of(rows_of(slid, beats), data)["skating_mps"] == pytest.approx(0.2, abs=0.05)
    assert (
        found["bas_share"]
        == found["speed_over_data"]
        == found["beats_per_beat_over_data"]
        == pytest.approx(1)
    )
    assert found["bas"] > found["bas_shuffled"] + 0.15
    other = beats_of(rows_of(songs.truth[:, 1][None], beats), data)
    assert 0.5 < other["bas_share"] < 1.6  # another right dance to the same songs
    late = np.roll(songs.truth[:, 0], 6, axis=1)  # 0.3 s: no beat any more
    assert beats_of(rows_of(late[None], beats), data)["bas_share"] < 0.4


def test_share_by_hand():
    own, shuffled, data, data_shuffled = (np.full(3, x) for x in (0.5, 0.2, 0.8, 0.2))
    assert share(own, shuffled, data, data_shuffled) == pytest.approx(0.5)
    short = [own, shuffled, data, data_shuffled]
    assert longer("x", short, short).value == pytest.approx(1)
    assert longer("x", [np.full(3, 0.35), *short[1:]], short).value == pytest.approx(0.5)


def test_bones(songs):
    still = bone_rows(songs.truth[:, 0][None])
    assert named(measures(BONES, still))["bone_rmse_cm"] == pytest.approx(0, abs=1e-9)
    longer_legs = songs.truth[:, 0].copy()
    longer_legs[..., [3, 4], :] += [0.0, -0.02, 0.0]
    more = bone_rows(longer_legs[None])
    assert named(measures(BONES, more))["bone_rmse_cm"] > 0.2
    # half the error, a quarter of its square
    assert bone_gain(more["bones"] / 4, more["bones"]) == pytest.approx(0.5)


def test_variety(songs):
    features = features_of(songs.truth)
    pooled = features_of(songs.truth[:, :1])[:, 0]
    found = named(measures(VARIETY, variety_rows(features, features, pooled)))
    assert found["multimodality_over_data"] == pytest.approx(1) and found["multimodality"] > 0
    assert found["fid"] == found["fid_data"] > 0 and found["diversity"] == found["diversity_data"]
    same = np.repeat(features[:, :1], 3, axis=1)
    alike = named(measures(VARIETY, variety_rows(same, features, pooled)))
    assert alike["multimodality"] == 0 and alike["multimodality_data"] == found["multimodality"]


def test_a_loop_repeats_and_a_dance_less(songs):
    loop = np.tile(songs.truth[:1, 0, :40], (1, 5, 1, 1))
    long = judged_songs(2, frames=200).truth[:, 0]
    assert repeat_measure(loop).value > 0.99 > repeat_measure(long).value
