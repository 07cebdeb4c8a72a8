"""Dances to recorded music: the gain of one that hears, and of one that does not."""

import numpy as np
import pytest
import soundfile
import torch
from gaits import rest_pose

from tools.results.dances import real_music
from tools.results.dances.real_music import (
    MusicSize,
    Recording,
    gains_of,
    music_measures,
    music_records,
    recordings_of_music,
)

BEATS = np.arange(0.25, 20, 0.75)  # no whole share of 20 s: shifts lose the beat


def stopping(stops: np.ndarray, frames: int = 400) -> np.ndarray:
    """A figure that slows down at these times, and is fast between them."""
    t = np.arange(frames) / 20
    near = np.exp(-(np.abs(t[:, None] - stops).min(1) ** 2) / (2 * 0.1**2))
    way = np.cumsum(1.0 - 0.9 * near) / 20
    return rest_pose() + np.stack([way, 0 * way, 0 * way], -1)[:, None]


def heard(seed: int) -> np.ndarray:
    """Dances that stop on the beats, a little late or early."""
    rng = np.random.default_rng(seed)
    return np.stack([stopping(BEATS + rng.normal(0, 0.01, len(BEATS))) for _ in range(4)])


def unheard(seed: int) -> np.ndarray:
    """Dances that stop as often, at times of their own."""
    rng = np.random.default_rng(seed)
    return np.stack([stopping(np.sort(rng.uniform(0, 20, len(BEATS)))) for _ in range(4)])


def named(rows: dict) -> dict:
    return {one.name: one for one in music_measures(rows)}


def test_a_dance_on_the_beat_gains_and_one_that_ignores_music_does_not():
    own = named({f"song{k}": gains_of(heard(k), BEATS) for k in range(6)})["music_gain"]
    assert own.low > 0.4 and own.value > 0.5
    nothing = named({f"song{k}": gains_of(unheard(k), BEATS) for k in range(12)})["music_gain"]
    assert nothing.low < 0 < nothing.high and abs(nothing.value) < 0.05


def test_the_gain_is_a_difference_of_means_over_songs_and_a_long_song_counts_once():
    rows = {
        "short": np.array([[0.8, 0.2]]),
        "long": np.array([[0.4, 0.3]] * 9 + [[np.nan, np.nan]]),
    }
    found = named(rows)
    assert found["music_gain"].value == pytest.approx((0.6 + 0.1) / 2)
    assert found["music_alignment"].value == pytest.approx(0.6)
    assert found["music_alignment_shifted"].value == pytest.approx(0.25)
    assert found["music_gain.long"].value == pytest.approx(0.1)


def test_a_long_recording_is_danced_to_in_parts_with_their_own_beats():
    song = Recording("a", np.zeros(50 * 16_000), np.arange(0, 21, 0.5), True)
    (sound, beats), *more = song.parts(5)
    assert len(sound) == 320_000 and not more  # from 20 s on there are two beats
    np.testing.assert_allclose(beats, np.arange(0, 20, 0.5))
    late = Recording("a", np.zeros(50 * 16_000), np.arange(20.25, 40, 0.5), True)
    ((_, beats),) = late.parts(5)
    assert beats[0] == pytest.approx(0.25) and late.parts(1) == []
    short = Recording("a", np.zeros(5 * 16_000), np.arange(0, 5, 0.5), True)
    assert len(short.parts(5)) == 1


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A song with its beats in a file, a copy of it, a song without, a bird, and a text.

    The tracker, which is slow to compile, finds a beat every half second.
    """
    monkeypatch.setattr(
        real_music, "beats_of", lambda audio, rate: np.arange(0, len(audio) / 16_000, 0.5)
    )
    (tmp_path / "audio").mkdir()
    (tmp_path / "audio_beats_machine").mkdir()
    clicks = np.zeros(8 * 16_000)
    clicks[::8_000] = 0.9
    (tmp_path / "audio" / "README.md").write_text("songs")
    for name in ("one", "one_44k_stereo", "one_two", "robin"):
        soundfile.write(tmp_path / "audio" / f"{name}.wav", clicks, 16_000)
    text = "# by a program\n0.5\n1.0\n1.5\n2.0\n2.5\n"
    (tmp_path / "audio_beats_machine" / "one.tracker.beats").write_text(text)
    return tmp_path


def test_each_recording_of_music_is_read_once_with_the_beats_that_there_are(folder):
    one, two = recordings_of_music(folder)
    assert (one.name, one.from_file, two.name, two.from_file) == ("one", True, "one_two", False)
    np.testing.assert_allclose(one.beats, [0.5, 1.0, 1.5, 2.0, 2.5])
    np.testing.assert_allclose(two.beats, np.arange(0, 8, 0.5))


class Deaf:
    """Dances that do not depend on the music."""

    def dance_mel(self, mel, frames, *, generator):
        rng = np.random.default_rng(int(torch.randint(1000, (1,), generator=generator)))
        stops = [np.sort(rng.uniform(0, frames / 20, 10)) for _ in mel]
        return torch.from_numpy(np.stack([stopping(one, frames) for one in stops]))


def test_the_records_say_how_few_songs_they_count(folder, monkeypatch):
    monkeypatch.setenv("MOTIONDIFF_REAL_DATA", str(folder))
    records = {one["name"]: one for one in music_records(Deaf(), "w", MusicSize(1, 3), "c")}
    assert set(records) == {
        f"real.music_{k}" for k in ("gain", "alignment", "alignment_shifted")
    } | {"real.music_gain.one", "real.music_gain.one_two"}
    assert records["real.music_gain"]["seeds"]["songs"] == 2
    assert records["real.music_gain"]["seeds"]["from_file"] == 1


@pytest.mark.parametrize("place", ["", "empty"])
def test_without_recordings_it_says_where_they_are_looked_for(place, tmp_path, monkeypatch):
    monkeypatch.setenv("MOTIONDIFF_REAL_DATA", place and str(tmp_path))
    with pytest.raises(SystemExit, match="MOTIONDIFF_REAL_DATA must name a folder"):
        real_music.found_recordings()
