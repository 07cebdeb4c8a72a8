"""The songs on which dancers are judged, how their dances use the floor, guidance and tempi."""

from dataclasses import replace

import numpy as np
import pytest
from gaits import rest_pose
from small_dancers import dancer_to_mel

from data_synth.music.tempi import HELD_OUT_TEMPI, held_out
from data_synth.music.varied import varied_songs
from tools.results.dances import parts
from tools.results.dances.floor import data_floor_measures, floor_measures, floor_rows, over_genres
from tools.results.dances.parts import WAYS, DanceSize, Stage, way_records
from tools.results.dances.scores import share, worst_share
from tools.results.dances.songs import FEWEST, JUDGED, UNSEEN, judged_songs, songs_like_real

TRAINING_SEED = 1


def spinning(turns: float, frames: int = 240) -> np.ndarray:
    """A figure at rest that turns so often in 8 s."""
    angle = 2 * np.pi * turns * np.arange(frames) / 160
    x, y, z = np.moveaxis(np.tile(rest_pose(), (frames, 1, 1)), -1, 0)
    sin, cos = np.sin(angle)[:, None], np.cos(angle)[:, None]
    return np.stack([x * cos + z * sin, y, z * cos - x * sin], -1)


def named(measures) -> dict[str, float]:
    return {measure.name: measure.value for measure in measures}


@pytest.fixture(scope="module")
def songs():
    return songs_like_real(8, UNSEEN)


def test_they_are_recordings_at_tempi_of_training_that_soon_have_beats(songs):
    assert all(not held_out(song.tempo) and song.seconds == 21 for song in songs)
    assert all((song.beats < 5).sum() >= FEWEST for song in songs)
    (clean,) = varied_songs(1, UNSEEN, 21.0, JUDGED)
    first = next(song for song in songs if song.seed == clean.seed)
    assert np.array_equal(first.beats, clean.beats)
    assert not np.allclose(first.audio, clean.audio)  # a room, a desk, a file
    again = songs_like_real(2, UNSEEN)
    assert all(np.array_equal(a.audio, b.audio) for a, b in zip(again, songs, strict=False))


def test_no_training_has_their_seeds(songs):
    trained = {song.seed for song in songs_like_real(2, TRAINING_SEED)}
    assert not trained & {song.seed for song in songs}
    assert min(song.seed for song in songs) > 1500 + max(trained)


@pytest.mark.parametrize("k", [0, 1])
def test_kept_out_tempi_are_those_and_one_range_each(k):
    tempi = list(parts.TEMPI_KEPT_OUT.values())[k]
    low, high = HELD_OUT_TEMPI[k]
    found = songs_like_real(3, UNSEEN + 4, replace(JUDGED, tempi=tempi))
    assert all(low <= song.tempo <= high for song in found)


def test_dances_are_of_the_seconds_asked_for_and_each_another():
    found = judged_songs(2, draws=2, frames=100)
    assert found.truth.shape == (2, 2, 100, 21, 3) and len(found.genres) == 2
    assert np.abs(found.truth[0, 0] - found.truth[0, 1]).max() > 0.1


def test_the_floor_of_a_dancer_beside_the_datas():
    own = np.stack([spinning(0.5), spinning(0.5)])
    data = np.stack([spinning(1), spinning(1)])
    found = named(floor_measures(floor_rows(own), floor_rows(data)))
    assert found["turn_8s_deg"] == pytest.approx(180, rel=1e-3)
    assert found["turning_over_data"] == pytest.approx(0.5, rel=1e-3)
    assert found["standing_feet"] == 1 == found["standing_feet_over_data"]


def test_a_mean_over_genres_counts_a_rare_one_as_much():
    genres = np.array(["pop"] * 9 + ["waltz"])
    assert over_genres(np.array([0.0] * 9 + [1.0]), genres) == pytest.approx(0.5)
    assert over_genres(np.array([0.0] * 9 + [np.nan]), genres) == 0
    dances = np.stack([spinning(0)] * 3 + [spinning(2)])
    found = named(data_floor_measures(dances, np.array(["pop"] * 3 + ["waltz"])))
    assert found["turn_8s_deg"] == pytest.approx(360, rel=1e-3)
    assert found["waltz.turn_8s_deg"] == pytest.approx(720, rel=1e-3)
    assert found["pop.standing_feet"] == 1


def test_the_worse_of_two_ranges_by_hand():
    good = [np.full(3, x) for x in (0.8, 0.2, 0.8, 0.2)]
    bad = [np.full(3, x) for x in (0.5, 0.2, 0.8, 0.2)]
    for groups in ([good, bad], [bad, good]):
        assert worst_share("x", groups).value == pytest.approx(0.5) == share(*bad)


class Heard:
    """A dancer whose dances depend on guidance and steps alone, and who keeps what it was asked."""

    def __init__(self):
        self.dancer, self.asked = dancer_to_mel(), []

    def dance_mel(self, mel, frames, *, generator=None, guidance=4, steps=25):
        self.asked.append((guidance, steps))
        made = self.dancer.dance_mel(mel, frames, generator=generator, steps=2)
        return made * guidance * steps


def test_each_way_is_asked_for_and_measured(monkeypatch):
    stage = Stage(DanceSize(songs=2, seeds=1, pieces=1, each=2))
    heard = Heard()
    stage.dancer = lambda name: heard
    monkeypatch.setattr(parts, "weights_digest", lambda path: "w")
    stage.weights = {"dancer": None}
    found = {one["name"]: one for one in way_records(stage, "c")}
    assert set(heard.asked) == {(1, 25), (2, 25), (4, 10), (4, 50)}
    speeds = {way: found[f"dancer.{way}.speed_mps"]["value"] for way in WAYS}
    assert speeds["guided.2"] == pytest.approx(2 * speeds["guided.1"], rel=1e-3)
    assert speeds["steps50"] == pytest.approx(5 * speeds["steps10"], rel=1e-3)
    for kind in ("bas_share", "multimodality_over_data", "fid", "speed_over_data"):
        assert all(f"dancer.{way}.{kind}" in found for way in WAYS)
    said = {way: found[f"dancer.{way}.fid"]["seeds"] for way in WAYS}
    assert said["guided.2"]["guidance"] == 2 and "guidance" not in said["steps10"]
    assert [said[way]["steps"] for way in ("guided.1", "steps10", "steps50")] == [25, 10, 50]
