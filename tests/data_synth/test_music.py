"""Synthetic songs: same seed, same bytes; beats that keep time; hits that sound when they should.

Files; errors.
"""

import json

import numpy as np
import pytest
import soundfile
from scipy.signal import stft

from data_synth.music import SONGS_A_SEED, compose, songs
from data_synth.music.form import DRIFT, roles
from data_synth.music.grooves import GROOVES
from data_synth.music.harmony import BASS, CHORDS, PROGRESSIONS, chord_on, lead
from data_synth.music.kits import KITS
from data_synth.music.song import (
    DRUMS,
    GENRES,
    HELD_OUT_TIMBRE,
    SAMPLE_RATE,
    TIMBRES,
    TRAINING_TIMBRES,
)
from data_synth.music.voices import VOICES, note
from data_synth.music.write import main
from motiondiff_edu.metrics.dances import f_measure


@pytest.fixture(scope="module")
def made():
    """Three songs of every genre, 21 s each."""
    return list(songs(15, 4, 21.0))


def same(a, b):
    return a.audio.tobytes() == b.audio.tobytes() and all(
        np.array_equal(a.hits[d], b.hits[d]) for d in DRUMS
    )


def test_same_seed_same_bytes():
    first = compose(5, seconds=6.0)
    again = compose(5, seconds=6.0)
    other = compose(6, seconds=6.0)
    assert same(first, again) and np.array_equal(first.beats, again.beats)
    assert np.array_equal(first.energy, again.energy) and first.info == again.info
    assert not np.array_equal(first.audio, other.audio) and not np.array_equal(
        first.beats, other.beats
    )


def test_songs_are_compose_one_by_one():
    k, song = 2, list(songs(3, 8, 4.0, genre="latin"))[2]
    assert song.seed == 8 * SONGS_A_SEED + k and same(
        song, compose(song.seed, "latin", seconds=4.0)
    )
    assert [song.genre for song in songs(6, 0, 2.0)] == [*GENRES, "house"]


def test_every_genre_within_its_tempo_and_metre(made):
    for song in made:
        slowest, fastest, metre = GENRES[song.genre]
        assert slowest * 0.99 <= song.tempo <= fastest * 1.01 and song.metre == metre
        assert song.timbre in TRAINING_TIMBRES
    assert len({song.timbre for song in made}) >= 4


def test_beats_keep_time(made):
    for song in made:
        gaps = np.diff(song.beats)
        assert np.all(np.abs(gaps * song.tempo / 60 - 1) <= 2 * DRIFT)
        assert song.tempo == pytest.approx(60 / gaps.mean())
        assert (
            0 <= song.beats[0] < 61 / song.tempo
            and song.seconds - 61 / song.tempo <= song.beats[-1] < song.seconds
        )
    drift = [np.ptp(np.diff(song.beats)) * song.tempo / 60 for song in made]
    assert min(drift) < 1e-9 and max(drift) > 0.01  # some songs are steady, some are not


def test_songs_begin_anywhere(made):
    assert len({int(song.bar_position[0]) for song in made}) > 1
    assert np.std([song.beats[0] * song.tempo / 60 for song in made]) > 0.1


def test_bars_and_phrases(made):
    for song in [*made, compose(3, metre=5, seconds=21.0), compose(3, metre=7, seconds=21.0)]:
        assert np.array_equal(np.diff(song.bar_position) % song.metre, np.ones(len(song.beats) - 1))
        changes = np.flatnonzero(np.diff(song.phrase)) + 1
        assert song.phrase[0] == 0 and np.all(song.bar_position[changes] == 0)
        assert set(np.diff(song.phrase)) <= {0, 1}
        lengths = set(np.diff(changes).tolist())
        assert lengths <= (
            {2 * song.metre} if song.metre != 3 else {2 * song.metre, 4 * song.metre}
        )
        assert len(lengths) == 1
        assert np.array_equal(song.downbeats, song.beats[song.bar_position == 0])


def test_sound_is_finite_and_not_clipped(made):
    for song in made:
        peak = np.abs(song.audio).max()
        assert song.audio.dtype == np.float32 and len(song.audio) == 21 * SAMPLE_RATE
        assert np.isfinite(song.audio).all() and 0.79 < peak < 0.951
        at_peak = np.abs(song.audio) > 0.999 * peak
        assert not np.any(at_peak[:-2] & at_peak[1:-1] & at_peak[2:])
    loudness = [20 * np.log10(song.audio.std()) for song in made]
    assert np.ptp(loudness) > 3


def rises(audio):
    """Times (s), and how much louder 14 bands got within 16 ms.

    Frames of 16 ms, logarithms, rises summed.
    """
    hop, frame = 32, 256
    _, t, spectrum = stft(
        audio, SAMPLE_RATE, nperseg=frame, noverlap=frame - hop, boundary=None, padded=False
    )
    bands = np.add.reduceat(
        np.log1p(1000 * np.abs(spectrum)), [0, 1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96], axis=0
    )
    return t[4:-4], np.maximum(bands[:, 8:] - bands[:, :-8], 0).sum(0)


def test_hits_sound_when_they_are_said_to(made):
    for song in made:
        t, rise = rises(song.audio)
        anywhere = np.random.default_rng(0).uniform(0.1, song.seconds - 0.1, 300)

        def near(when, t=t, rise=rise):
            return np.array([rise[np.abs(t - x) <= 0.015].max() for x in when])

        hits = np.concatenate([song.hits[d] for d in ("kick", "snare", "clap")])
        hits = hits[(hits > 0.1) & (hits < song.seconds - 0.1)]
        assert len(hits) > 5
        assert np.mean(near(hits) > np.median(near(anywhere))) > 0.9


def test_drums_stay_near_the_grid():
    song = compose(
        2, "pop", seconds=21.0
    )  # no swing: everything lies on sixteenths, but for triplet fills
    place = np.interp(song.hits["kick"], song.beats, np.arange(len(song.beats)))
    inside = (song.hits["kick"] > song.beats[0]) & (song.hits["kick"] < song.beats[-1])
    off = np.abs(4 * place - np.round(4 * place))[inside] / 4 * 60 / song.tempo
    assert len(off) > 10 and off.max() < 0.016 and off.max() > 1e-5  # uneven, as people are


def test_breaks_are_quiet(made):
    calm = []
    busy = []
    soft = []
    loud = []
    for song in made:
        hits = np.sort(np.concatenate(list(song.hits.values())))
        ends = np.append(song.beats[1:], song.beats[-1] + 60 / song.tempo)
        each = np.searchsorted(hits, ends - 0.02) - np.searchsorted(hits, song.beats - 0.02)
        broken = np.array(song.info["section"]) == "break"
        assert np.array_equal(broken, song.energy <= 0.1) and np.all(
            (song.energy >= 0) & (song.energy <= 1)
        )
        calm += each[broken].tolist()
        busy += each[~broken].tolist()
        for first, end, quiet in zip(song.beats, ends, broken, strict=True):
            power = np.mean(song.audio[int(first * SAMPLE_RATE) : int(end * SAMPLE_RATE)] ** 2)
            (soft if quiet else loud).append(power)
    assert len(calm) > 20 and np.mean(calm) < 0.4 * np.mean(busy)
    assert np.mean(soft) < 0.5 * np.mean(loud)


def test_choruses_have_more_energy(made):
    by_section = {"verse": [], "chorus": []}
    for song in made:
        for name, values in by_section.items():
            values += song.energy[np.array(song.info["section"]) == name].tolist()
    assert np.mean(by_section["chorus"]) > np.mean(by_section["verse"]) + 0.2


def test_not_every_beat_has_a_kick(made):
    on_beats = []
    for song in made:
        near = np.abs(song.beats[:, None] - song.hits["kick"][None]).min(1, initial=1.0) < 0.02
        on_beats.append(near.mean())
    assert min(on_beats) < 0.2 and max(on_beats) > 0.75


def test_what_is_asked_for_is_given():
    song = compose(1, "pop", seconds=13.0, tempo=87.0, metre=5, timbre=HELD_OUT_TIMBRE)
    assert (song.genre, song.metre, song.timbre, song.seed) == ("pop", 5, "mallets", 1)
    assert song.tempo == pytest.approx(87.0, rel=0.005) and song.bar_position.max() == 4
    plain = compose(1, "pop", seconds=13.0, tempo=87.0, metre=5, timbre="chip")
    assert np.array_equal(song.beats, plain.beats)  # the same music on other instruments
    assert all(np.array_equal(song.hits[d], plain.hits[d]) for d in DRUMS)
    assert not np.array_equal(song.audio, plain.audio)


def test_the_held_out_timbre_is_never_drawn():
    assert HELD_OUT_TIMBRE not in TRAINING_TIMBRES
    assert {compose(k, seconds=2.0).timbre for k in range(24)} == set(TRAINING_TIMBRES)


@pytest.mark.parametrize("metre", [2, 3, 4, 5, 6, 7])
def test_every_metre_can_be_played_in_every_genre(metre):
    for seed, genre in enumerate(GENRES):
        song = compose(seed, genre, seconds=7.0, metre=metre)
        assert song.metre == metre and sum(len(times) for times in song.hits.values()) > 5


def test_shortest_and_slowest():
    song = compose(0, seconds=2.0, tempo=40.0)
    assert (
        len(song.audio) == 2 * SAMPLE_RATE
        and 1 <= len(song.beats) <= 2
        and song.tempo == pytest.approx(40, rel=0.03)
    )


def test_tables_are_whole():
    for table in (GROOVES, BASS, CHORDS, PROGRESSIONS):
        assert set(table) == set(GENRES)
    for patterns in [
        *(p for drums in GROOVES.values() for p in drums.values()),
        *BASS.values(),
        *CHORDS.values(),
    ]:
        for pattern in patterns:
            assert [len(cell) for cell in pattern.split()] == [4] * 5
    assert set(KITS) == set(VOICES) == set(TIMBRES)
    assert all(set(kit) == set(DRUMS) for kit in KITS.values())


def test_roles_of_beats():
    assert roles((2, 2)) == ["one", "back", "strong", "last"]
    assert roles((3,)) == ["one", "weak", "last"]
    assert roles((3, 2)) == ["one", "weak", "back", "strong", "last"]


def test_chords_by_hand():
    c = 0
    d = 2
    e = 4
    f = 5
    g = 7
    a = 9
    b = 11
    assert chord_on(0, c, "major", False).tones == (c, e, g)
    assert chord_on(4, a, "minor", False).tones == (
        e,
        8,
        b,
    )  # the dominant of A minor has a G sharp
    assert chord_on(4, c, "major", True).tones == (g, b, d, f)
    assert lead((f, a, c), (60, 64, 67)) == (60, 65, 69)  # C to F: C stays, E and G go up a step


def test_a_note_has_its_pitch_and_length():
    y = note(VOICES["acoustic"]["lead"][1], 69, 1.0)
    spectrum = np.abs(np.fft.rfft(y[:SAMPLE_RATE] * np.hanning(SAMPLE_RATE)))
    assert abs(int(spectrum.argmax()) - 440) <= 1  # A4; a bin is 1 Hz
    assert np.abs(y[-80:]).max() < 0.01 * np.abs(y).max()


@pytest.mark.slow
def test_a_beat_tracker_hears_most_beats_and_not_all(made):
    librosa = pytest.importorskip("librosa")
    scores, tempi = [], []
    for song in made:
        found = librosa.beat.beat_track(y=song.audio, sr=SAMPLE_RATE, hop_length=256, units="time")[
            1
        ]
        scores.append(
            max(f_measure(found - lag, song.beats) for lag in np.arange(-0.06, 0.061, 0.01))
        )
        ratio = 60 / np.median(np.diff(found)) / song.tempo
        tempi.append(min(abs(ratio / r - 1) for r in (1 / 2, 2 / 3, 1, 3 / 2, 2)) < 0.05)
    assert 0.55 < np.mean(scores) < 0.95 and np.mean(tempi) > 0.8


def test_command_writes_sound_and_score(tmp_path, capsys):
    main(
        [
            "--out",
            str(tmp_path / "new" / "songs"),
            "--songs",
            "2",
            "--seconds",
            "3.5",
            "--genre",
            "waltz",
            "--seed",
            "9",
        ]
    )
    folder = tmp_path / "new" / "songs"
    assert sorted(p.name for p in folder.iterdir()) == [
        "song_000.json",
        "song_000.wav",
        "song_001.json",
        "song_001.wav",
    ]
    song = compose(9 * SONGS_A_SEED + 1, "waltz", seconds=3.5)
    audio, rate = soundfile.read(folder / "song_001.wav")
    assert soundfile.info(folder / "song_001.wav").subtype == "PCM_16"
    assert (
        rate == SAMPLE_RATE
        and len(audio) == 56_000
        and np.abs(audio - song.audio).max() < 2 / 32768
    )
    score = json.loads((folder / "song_001.json").read_text())
    assert np.allclose(score["beats"], song.beats, atol=1e-4) and score["metre"] == 3
    assert set(score["downbeats"]) <= set(score["beats"]) and len(score["phrases"]) == len(
        score["beats"]
    )
    assert set(score["hits"]) == set(DRUMS) and score["tempo"] == pytest.approx(
        song.tempo, abs=1e-3
    )
    assert "2 songs of 3.5 s" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        (
            {"genre": "polka"},
            "no genre is called 'polka'; there are house, hiphop, pop, latin, waltz",
        ),
        ({"timbre": "kazoo"}, "no timbre is called 'kazoo'; there are machine"),
        ({"tempo": 5000}, "between 40 and 240 beats a minute, not at 5000"),
        ({"tempo": float("nan")}, "not at nan"),
        ({"tempo": 0.0}, "not at 0"),
        ({"metre": 11}, "2 to 7 beats"),
        ({"metre": 0}, "2 to 7 beats"),
        ({"seconds": 0.5}, "2 to 1200 seconds, not 0.5"),
        ({"seconds": float("inf")}, "not inf"),
        ({"seed": -3}, "a seed is a whole number from 0 on, got -3"),
    ],
)
def test_wrong_inputs(wrong, told):
    with pytest.raises(ValueError, match=told):
        compose(**({"seed": 0} | wrong))


def test_songs_fails_when_called_not_when_read():
    with pytest.raises(ValueError, match="not 0"):
        songs(0, 0)
    with pytest.raises(ValueError, match="polka"):
        songs(3, 0, genre="polka")


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--genre", "polka"], "there are house"),
        (["--tempo", "5000"], "40 and 240"),
        (["--songs", "0"], "not 0"),
    ],
)
def test_command_tells_what_is_wrong(tmp_path, capsys, arguments, told):
    with pytest.raises(SystemExit) as stop:
        main(["--out", str(tmp_path / "out"), *arguments])
    assert stop.value.code == 2 and told in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_command_refuses_a_file_for_a_folder(tmp_path, capsys):
    (tmp_path / "taken").write_text("mine")
    for out in (tmp_path / "taken", tmp_path / "taken" / "below"):
        with pytest.raises(SystemExit) as stop:
            main(["--out", str(out), "--seconds", "2"])
        assert stop.value.code == 2 and "give the name of a folder" in capsys.readouterr().err
    assert (tmp_path / "taken").read_text() == "mine"
