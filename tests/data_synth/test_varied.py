"""Varied songs: beats where the sound has them, whatever the tempo, the feel or the pauses."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import stft

from data_synth.music.bands import MORE_KITS, MORE_VOICES, draw_band
from data_synth.music.feels import FEELS, SHUFFLED, STRAIGHT, draw_feel, without_some
from data_synth.music.form import draw_form
from data_synth.music.grooves import GROOVES, Hit
from data_synth.music.harmony import Note
from data_synth.music.mixing import voice_bus
from data_synth.music.pauses import (
    music_starts,
    outside_silence,
    silence_starts,
    silenced,
    sounding,
    stretched,
)
from data_synth.music.song import DRUMS, GENRES, SAMPLE_RATE
from data_synth.music.tempi import (
    HELD_OUT_TEMPI,
    TEMPI,
    draw_tempo,
    held_out,
    most_wander,
    retimed,
    slowed,
    wander,
)
from data_synth.music.varied import Variety, accented, pulse, varied_song, varied_songs
from data_synth.music.voices import VOICES, Voice, note

SECONDS = 12.0


def rng(seed: int = 0) -> np.random.Generator:
    return np.random.default_rng(seed)


@pytest.fixture(scope="module")
def made():
    return list(varied_songs(24, 3, SECONDS))


@pytest.fixture(scope="module")
def paused():
    return list(varied_songs(8, 4, SECONDS, Variety(pauses=1.0, drumless=0.0)))


@pytest.fixture
def form():
    """Six bars of four beats at 120 BPM; the first beat is at 0.25 s."""
    drawn = draw_form(rng(), SECONDS, 120.0, 4, (0.5, 0.5))
    bars = [replace(bar, section="verse", level=0.6, fill=0) for bar in drawn.bars[:6]]
    return replace(drawn, bars=bars, times=0.25 + 0.5 * np.arange(24))


def rises(audio):
    """Times (s), and how much louder 14 bands got within 16 ms."""
    _, t, spectrum = stft(
        audio, SAMPLE_RATE, nperseg=256, noverlap=224, boundary=None, padded=False
    )
    bands = np.add.reduceat(
        np.log1p(1000 * np.abs(spectrum)), [0, 1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96], axis=0
    )
    return t[4:-4], np.maximum(bands[:, 8:] - bands[:, :-8], 0).sum(0)


LAGS = np.arange(-0.06, 0.0601, 0.004)


def rise_around(audio, moments):
    """How much louder the sound gets at each lag (s) around the moments, divided by its mean."""
    t, rise = rises(audio)
    inside = moments[(moments > 0.1) & (moments < len(audio) / SAMPLE_RATE - 0.1)]
    return np.interp(inside[:, None] + LAGS, t, rise / rise.mean())


def strokes(song):
    return np.sort(np.concatenate([song.hits[drum] for drum in ("kick", "snare", "clap", "rim")]))


# ---- truth


def test_same_seed_same_bytes_and_another_seed_another_song():
    first, again = varied_song(5, 4.0), varied_song(5, 4.0)
    other = varied_song(6, 4.0)
    assert first.audio.tobytes() == again.audio.tobytes() and first.info == again.info
    assert np.array_equal(first.beats, again.beats)
    assert not np.array_equal(first.audio, other.audio)


def test_songs_are_whole(made):
    for song in made:
        assert song.audio.dtype == np.float32 and len(song.audio) == SECONDS * SAMPLE_RATE
        assert np.isfinite(song.audio).all() and np.abs(song.audio).max() == pytest.approx(0.9)
        each = (song.bar_position, song.phrase, song.energy, song.info["section"])
        assert {len(x) for x in each} == {len(song.beats)} and len(song.beats) > 4
        assert set(np.diff(song.phrase)) <= {0, 1} and song.phrase[0] == 0
        assert song.genre in GENRES and song.metre == GENRES[song.genre][2]


def test_strokes_lie_on_the_grid_of_the_beats_through_ritardandi_and_pauses(made, paused):
    near = []
    for song in [*made, *paused]:
        s = song.info["swing"]
        gaps = np.diff(song.beats)
        for start, gap in zip(song.beats[:-1], gaps, strict=True):
            hits = strokes(song)
            hits = hits[(hits >= start) & (hits < start + gap)]
            if gap < 1.6 * 60 / song.tempo:  # no pause
                place = (hits - start) / gap
                even = np.where(place < s, 0.5 * place / s, 0.5 + 0.5 * (place - s) / (1 - s))
                off = np.abs(4 * even - np.round(4 * even)) / 4 * gap
                near += (off < 0.025).tolist()  # a player's unevenness is 15 ms, swing bends it
    assert len(near) > 300
    assert np.mean(near) > 0.93  # the others are triplets


def test_strokes_and_beats_sound_when_they_are_said_to(made):
    drums = np.concatenate([rise_around(song.audio, strokes(song)) for song in made])
    assert abs(LAGS[drums.mean(0).argmax()]) <= 0.008
    assert drums.mean(0).max() > 2
    beats = np.concatenate([rise_around(song.audio, song.beats) for song in made])
    assert abs(LAGS[beats.mean(0).argmax()]) <= 0.012
    assert beats.mean(0).max() > 1.5 * beats.mean()


def test_without_drums_the_beat_is_in_the_notes():
    songs = list(varied_songs(10, 5, SECONDS, Variety(drumless=1.0, pauses=0.0)))
    assert all(song.info["feel"] == "no drums" for song in songs)
    assert not any(len(times) for song in songs for times in song.hits.values())
    beats = np.concatenate([rise_around(song.audio, song.beats) for song in songs])
    assert abs(LAGS[beats.mean(0).argmax()]) <= 0.02
    assert beats.mean(0).max() > 1.5 * beats.mean()


def test_the_beat_is_not_always_marked_by_drums(made):
    marked = [
        (np.abs(song.beats[:, None] - strokes(song)[None]).min(1, initial=9.0) < 0.03).mean()
        for song in made
    ]
    assert min(marked) == 0.0 and max(marked) > 0.8 and 0.2 < np.median(marked) < 0.9


def test_wrong_inputs():
    with pytest.raises(ValueError, match="seed -1"):
        varied_song(-1)
    with pytest.raises(ValueError, match="0.5 s"):
        varied_song(1, 0.5)
    with pytest.raises(ValueError, match="not 0"):
        varied_songs(0, 0)


# ---- tempi


def test_held_out_tempi_are_never_drawn_unless_asked_for():
    drawn = np.array([draw_tempo(r) for r in [rng()] for _ in range(3000)])
    assert not any(held_out(tempo) for tempo in drawn)
    assert 60 <= drawn.min() < 61 and 178 < drawn.max() <= 180
    judged = [draw_tempo(r, HELD_OUT_TEMPI) for r in [rng()] for _ in range(300)]
    assert all(held_out(tempo) for tempo in judged)
    assert min(judged) < 74 and max(judged) > 146
    edges = sorted([*TEMPI, *HELD_OUT_TEMPI])
    assert edges[0][0] == 60 and edges[-1][1] == 180
    assert all(a[1] == b[0] for a, b in zip(edges, edges[1:], strict=False))  # no gap, no overlap


def test_songs_have_their_tempo(made):
    for song in made:
        assert not held_out(song.tempo)
        usual = 60 / np.median(np.diff(song.beats))
        assert usual == pytest.approx(song.tempo, rel=0.06)
    judged = varied_song(1, 6.0, Variety(tempi=HELD_OUT_TEMPI))
    assert held_out(judged.tempo)


def test_a_wandering_tempo_stays_in_its_range():
    for tempo in np.linspace(60.5, 179.5, 120):
        lengths = wander(60, most_wander(tempo), rng(int(tempo)))
        assert np.abs(lengths - 1).max() < 0.0501
        assert {held_out(t) for t in tempo / lengths} == {held_out(tempo)}


def test_a_ritardando_by_hand():
    lengths = slowed(np.ones(12), last=9, beats=4, most=1.4)
    expected = [1, 1, 1, 1, 1, 1, 1.1, 1.2, 1.3, 1.4, 1, 1]
    np.testing.assert_allclose(lengths, expected)


def test_retimed_beats_have_their_lengths_and_keep_the_first(form):
    lengths = rng().uniform(0.8, 1.2, 24)
    late = replace(form, times=form.times - 2.1)  # the first after 0 is number 4
    other = retimed(late, lengths, 90.0)
    np.testing.assert_allclose(np.diff(other.times), lengths[:-1] * 60 / 90)
    assert other.times[4] == pytest.approx(late.times[4])


# ---- pauses


def test_pauses_are_silent_and_have_no_beats(paused):
    where = set()
    for song in paused:
        for start, end in song.info["silences"]:
            where.add("start" if start == 0 else "end" if end == SECONDS else "middle")
            assert not ((song.beats > start) & (song.beats < end - 1e-9)).any()
            assert not any(
                ((t > start + 0.02) & (t < end - 0.02)).any() for t in song.hits.values()
            )
            rings = round((start + (1.2 if start else 0)) * SAMPLE_RATE)
            quiet = song.audio[rings : round((end - 0.05) * SAMPLE_RATE)]
            if len(quiet):
                assert (quiet**2).mean() < 1e-3 * (song.audio**2).mean()
        silent = sum(end - start for start, end in song.info["silences"])
        assert silent < 0.75 * SECONDS
    assert where == {"start", "middle", "end"}


def test_silent_bars_by_hand(form):
    resting = silenced(form, {0, 3, 4})
    assert [bar.section for bar in resting.bars] == [
        "silence", "verse", "verse", "silence", "silence", "verse",
    ]  # fmt: skip
    assert silence_starts(resting) == [12] and music_starts(resting) == [4, 20]
    lengths = stretched(resting, 2.0)
    expected = np.ones(24)
    expected[[0, 1, 2, 12, 13, 14, 16, 17, 18]] = 2.0
    np.testing.assert_array_equal(lengths, expected)


def test_notes_are_cut_off_before_a_silence(form):
    resting = silenced(form, {3})
    notes = [Note("lead", at, 2.0, 60, 0.5) for at in (4.0, 11.0, 13.0, 17.0)]
    kept = outside_silence(resting, notes)
    assert [(n.position, n.length) for n in kept] == [(4.0, 2.0), (11.0, 1.0), (17.0, 2.0)]


def test_a_pick_up_is_a_beat_and_silence_is_none(form):
    resting = silenced(form, {0, 3})
    hits, notes = [Hit("snare", 15.5, 0.5)], [Note("lead", 3.0, 0.5, 60, 0.5)]
    heard = sounding(resting, hits, notes)
    np.testing.assert_array_equal(np.flatnonzero(~heard), [0, 1, 2, 12, 13, 14])


# ---- feels


def test_patterns_are_whole():
    for feel in FEELS.values():
        assert set(feel.groove.patterns) <= set(DRUMS) and set(feel.groove.plays) <= set(DRUMS)
        for pattern in [p for rows in feel.groove.patterns.values() for p in rows]:
            assert [len(cell) for cell in pattern.split()] == [4] * 5
            assert set(pattern) <= set("Xxog. ")
    used = {p for rows in GROOVES.values() for drum in rows.values() for p in drum}
    fresh = {(name, p) for name, f in FEELS.items() for p in f.groove.patterns.get("kick", ())}
    assert len([p for _, p in fresh if p not in used]) > 0.5 * len(fresh)


def test_feels_suit_the_tempo_and_hide_no_held_out_one():
    r = rng()
    for tempo in (62.0, 100.0, 140.0, 178.0):
        drawn = {draw_feel("pop", tempo, 0.0, r)[0] for _ in range(300)}
        assert drawn == {
            name
            for name, feel in FEELS.items()
            if feel.tempi[0] <= tempo <= feel.tempi[1] and not (feel.half and tempo == 140.0)
        }
    name, feel = draw_feel("latin", 100.0, 1.0, r)
    assert name == "latin" and feel.groove.patterns is GROOVES["latin"]


def test_shuffled_eighths_are_late(form):
    late = replace(form, swing=0.66, swing_unit=0.5)  # beats are 0.5 s apart, the first at 0.25 s
    np.testing.assert_allclose(late.at(np.array([2.0, 2.5, 3.0])), [1.25, 1.25 + 0.33, 1.75])
    r = rng()
    swings = {draw_feel("pop", 100.0, 1.0, r)[1].swing for _ in range(60)}
    assert swings == {STRAIGHT, SHUFFLED} and SHUFFLED[0] > 0.55


def test_drums_are_left_out_whole():
    hits = [Hit(drum, float(k), 0.5) for k in range(9) for drum in DRUMS]
    assert without_some(hits, 0.0, rng()) == hits and without_some(hits, 1.0, rng()) == []
    some = {hit.drum for hit in without_some(hits, 0.5, rng(1))}
    assert 0 < len(some) < len(DRUMS)
    assert len(without_some(hits, 0.5, rng(1))) == 9 * len(some)


def test_accents_by_hand():
    notes = [Note("bass", at, 0.5, 40, 0.5) for at in (0.0, 0.5, 1.0, 4.0)]
    loud = {
        name: [n.velocity > 0.5 for n in accented(notes, 4, name, 0.2)]
        for name in ("beats", "off-beats", "bars", "none")
    }
    assert loud == {
        "beats": [True, False, True, True],
        "off-beats": [False, True, False, False],
        "bars": [True, False, False, True],
        "none": [False] * 4,
    }
    assert accented(notes, 4, "bars", 0.2)[0].velocity == pytest.approx(0.6)
    assert accented([], 4, "bars", 0.2) == []


def test_the_pulse_by_hand(form):
    resting = silenced(form, {0, 1, 2, 3})  # beats 16 to 23 have music
    hits = [Hit("kick", 16.0, 0.5), Hit("kick", 16.5, 0.5), Hit("kick", 3.0, 0.5)]
    notes = [Note("bass", 19.75, 0.5, 40, 0.5)]
    assert pulse(resting, hits, notes) == pytest.approx(2 / 8)
    assert pulse(resting, [], []) == 0.0


# ---- bands


def test_bands_are_whole_and_differ():
    r = rng()
    bands = [draw_band(r) for _ in range(60)]
    assert all(set(band.kit) == set(DRUMS) for band in bands)
    assert all(set(band.voices) == {"bass", "chords", "lead"} for band in bands)
    assert {band.name for band in bands} >= set(MORE_KITS)
    assert not any(band.name == "mallets" for band in bands)  # kept for judging
    for strike in [s for band in bands for s in band.kit.values()]:
        assert 0 < strike.low < strike.high < SAMPLE_RATE / 2
    assert all(set(kit) == set(DRUMS) for kit in MORE_KITS.values())


def test_every_voice_has_its_pitch_and_ends():
    for voice in {v for row in MORE_VOICES.values() for v in row}:
        y = note(voice, 57, 0.6)  # A3, 220 Hz
        power = np.abs(np.fft.rfft(y[: SAMPLE_RATE // 2] * np.hanning(SAMPLE_RATE // 2)))
        lines = power[: 110 * 30].reshape(-1, 110)  # 2 Hz a bin: multiples of 220 Hz
        harmonic = np.concatenate([lines[1:, :6], lines[:-1, -5:]], 1)
        assert (harmonic**2).sum() > 0.85 * (lines**2).sum()
        assert np.isfinite(y).all() and np.abs(y[-40:]).max() < 0.05 * np.abs(y).max()


def test_brass_gets_brighter_and_strings_darker():
    def brightness(voice, start):
        piece = note(voice, 57, 0.6)[start : start + 1600] * np.hanning(1600)
        power = np.abs(np.fft.rfft(piece)) ** 2
        return power[60:].sum() / power.sum()  # above 600 Hz

    brass = Voice(0.8, attack=0.004, decay=2, sustain=0.8, bright=9, bloom=0.2)
    assert brightness(brass, 6400) > 1.5 * brightness(brass, 0)
    plucked = VOICES["acoustic"]["chords"][1]
    assert brightness(plucked, 6400) < 0.7 * brightness(plucked, 0)


def test_a_slow_voice_starts_ahead(form):
    played = [Note("lead", 4.0, 1.0, 60, 0.8)]
    prompt = Voice(1.0, attack=0.05)
    early = replace(prompt, early=0.02)
    a = voice_bus(form, played, prompt, 6 * SAMPLE_RATE, rng(1))
    b = voice_bus(form, played, early, 6 * SAMPLE_RATE, rng(1))
    shift = np.flatnonzero(a)[0] - np.flatnonzero(b)[0]
    assert shift == pytest.approx(0.02 * SAMPLE_RATE, abs=1)
