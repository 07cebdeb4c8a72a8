"""Songs as different as real ones: tempi from 60 to 180, feels, kits, voices, pauses, ritardandi.

    song = varied_song(3, seconds=20.0)                            # clean sound
    judged = varied_song(3, variety=Variety(tempi=HELD_OUT_TEMPI))  # at tempi kept out of training
    heard = recorded_song(song, seed=0)                            # recorded.py: room, MP3, noise

In `composer.compose` the genre decides grooves and tempi. Here these are drawn apart; a song still
has a genre, whose dance suits its tempo.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from .bands import Band, draw_band
from .composer import LONGEST, SHORTEST, SONGS_A_SEED, strokes
from .feels import Feel, draw_feel, without_some
from .form import LEAD, Form, draw_form, energies
from .grooves import Hit, write_drums
from .harmony import Chord, Note, draw_chords, write_bass, write_chords, write_melody
from .mixing import LEVELS, Played, drum_bus, duck, play, voice_bus
from .pauses import (
    draw_pauses,
    outside_silence,
    pick_ups,
    silence_starts,
    silenced,
    sounding,
    stretched,
)
from .song import GENRES, SAMPLE_RATE, Song
from .tempi import (
    RITARDANDO,
    SLOWER,
    TEMPI,
    Ranges,
    draw_tempo,
    most_wander,
    retimed,
    slowed,
    wander,
)


@dataclass(frozen=True)
class Variety:
    """How much songs differ. All but the tempi are probabilities.

    tempi       ranges of the tempo in BPM (tempi.py)
    waltz       a song has three beats in a bar
    drumless    it has no drums
    own_groove  it has the groove of its genre, not another feel, and all parts in its manner
    silent_drum each of its drums is left out
    pauses      it begins with silence; it pauses; it ends with silence (each)
    unsteady    its tempo wanders by up to 5 %
    ritardando  it slows down before it ends
    """

    tempi: Ranges = TEMPI
    waltz: float = 0.15
    drumless: float = 0.2
    own_groove: float = 0.6
    silent_drum: float = 0.15
    pauses: float = 0.2
    unsteady: float = 0.65
    ritardando: float = 0.2


VARIED = Variety()
QUIETER = {"drums": 12.0, "bass": 10.0}  # dB below LEVELS, at most
PULSE, ATTEMPTS = 0.7, 6  # parts with a lower pulse are drawn again, at most so often
SHORT = 0.25  # seconds: a shorter span without a beat is no silence


def varied_song(seed: int, seconds: float = 20.0, variety: Variety = VARIED) -> Song:
    """One song of this variety, as clean sound without a room.

    The same arguments give the same bytes. `beats` has no beats in a silence. `tempo` is that of
    the steady music, without ritardando. `info` also has "feel", "band", "emphasis" and "silences"
    (start and end in seconds).
    Raises ValueError for a negative seed, and for seconds outside 2-1200.
    """
    if seed < 0 or not SHORTEST <= seconds <= LONGEST:
        raise ValueError(
            f"a song has a seed from 0 on and {SHORTEST:g} to {LONGEST:g} seconds; "
            f"got seed {seed} and {seconds:g} s"
        )
    rng = np.random.default_rng([seed, 61])
    timing, drumming, music, player, studio, strength = rng.spawn(6)
    tempo = draw_tempo(rng, variety.tempi)
    genre = "waltz" if rng.random() < variety.waltz else _genre_for(tempo, rng)
    name, feel = draw_feel(genre, tempo, variety.own_groove, rng)
    form = _form(feel, genre, tempo, seconds, variety, timing)
    hits = _drums(form, feel, variety, drumming)
    emphasis, hits, notes = _notes(form, hits, music, genre if name == genre else None)
    name = name if hits else "no drums"
    played = play(form, hits, player)
    band = draw_band(studio)
    audio = mixed(form, played, notes, band, seconds, studio)

    music_beats = sounding(form, hits, notes)
    inside = np.flatnonzero((form.times >= 0) & (form.times < seconds) & music_beats)
    bars = [form.bars[b // form.metre] for b in inside]
    return Song(
        audio=audio,
        beats=form.times[inside],
        bar_position=inside % form.metre,
        phrase=np.unique([bar.phrase for bar in bars], return_inverse=True)[1],
        energy=energies(form, strength)[inside],
        hits=strokes(played, seconds),
        genre=genre,
        tempo=tempo,
        metre=form.metre,
        timbre=band.name,
        seed=int(seed),
        info={
            "section": [bar.section for bar in bars],
            "swing": form.swing,
            "feel": name,
            "emphasis": emphasis,
            "silences": _silences(form, music_beats, seconds),
        },
    )


def varied_songs(
    n: int, seed: int, seconds: float = 20.0, variety: Variety = VARIED
) -> Iterator[Song]:
    """Generator of n varied songs; song k is varied_song(seed * SONGS_A_SEED + k, ...).

    Raises ValueError if n is not between 1 and SONGS_A_SEED, and as varied_song does.
    """
    if not 1 <= n <= SONGS_A_SEED:
        raise ValueError(f"ask for 1 to {SONGS_A_SEED} songs, not {n}")
    return (varied_song(seed * SONGS_A_SEED + k, seconds, variety) for k in range(n))


def _genre_for(tempo: float, rng: np.random.Generator) -> str:
    """A genre in four whose dances suit the tempo: the nearer its own tempi, the likelier."""
    genres = [name for name, (_, _, metre) in GENRES.items() if metre == 4]
    away = [
        max(np.log(GENRES[name][0] / tempo), np.log(tempo / GENRES[name][1]), 0) for name in genres
    ]
    likely = np.exp(-np.array(away) / 0.15)
    return str(rng.choice(genres, p=likely / likely.sum()))


def _form(
    feel: Feel, genre: str, tempo: float, seconds: float, variety: Variety, rng: np.random.Generator
) -> Form:
    """Sections, pauses and the time of every beat."""
    swing = (float(rng.uniform(*feel.swing)), 0.5)
    form = draw_form(rng, seconds, tempo, GENRES[genre][2], swing)
    steady = np.ones(len(form.times))
    form = retimed(form, steady, tempo)
    form = silenced(form, draw_pauses(form, seconds, variety.pauses, rng))
    lengths = stretched(form, rng.uniform(0.7, 1.4))
    inside = (form.times >= 0) & (form.times < seconds)
    unsteady, slows = rng.random(2) < (variety.unsteady, variety.ritardando)
    if unsteady:
        lengths[inside] *= wander(int(inside.sum()), most_wander(tempo), rng)
    if slows:
        ends = [b for b in silence_starts(form) if form.times[b] > 0.6 * seconds]
        last = (ends[0] if ends else int(np.flatnonzero(inside)[-1])) - 1
        beats = int(rng.integers(*RITARDANDO))
        lengths = slowed(lengths, last, beats, rng.uniform(*SLOWER))
    return retimed(form, lengths, tempo)


def _drums(form: Form, feel: Feel, variety: Variety, rng: np.random.Generator) -> list[Hit]:
    """The strokes of the kit's drums that this song has; none at all in a drumless song."""
    drumless = rng.random() < variety.drumless
    hits = without_some(write_drums(form, feel.groove, rng), variety.silent_drum, rng)
    return [] if drumless else hits


def _notes(
    form: Form, hits: list[Hit], rng: np.random.Generator, genre: str | None
) -> tuple[str, list[Hit], list[Note]]:
    """The pitched parts, in the manner of a genre or (None) each of one of its own, and pick-ups.

    Also returns which notes are louder.
    """
    for own in rng.spawn(ATTEMPTS):
        chords, notes = _parts(form, own, genre)
        if pulse(form, hits, notes) >= PULSE:
            break
    more_hits, more_notes = pick_ups(form, chords, bool(hits), rng)
    emphasis = str(rng.choice(list(EMPHASES), p=[0.2, 0.4, 0.2, 0.2]))
    notes = accented([*notes, *more_notes], form.metre, emphasis, float(rng.uniform(0.1, 0.45)))
    return emphasis, sorted([*hits, *more_hits], key=lambda hit: hit.position), notes


def _parts(
    form: Form, rng: np.random.Generator, genre: str | None
) -> tuple[list[Chord], list[Note]]:
    """The chords of every bar, and the notes of bass, chords and tune."""
    drawn = (str(g) for g in rng.choice(list(GENRES), 4))
    progression, bass, chording, tune = [genre] * 4 if genre else drawn
    chords = draw_chords(form, progression, rng)
    notes = write_bass(form, chords, bass, rng) + write_chords(form, chords, chording, rng)
    notes += write_melody(form, chords, tune, rng)
    return chords, outside_silence(form, notes)


def pulse(form: Form, hits: list[Hit], notes: list[Note]) -> float:
    """The share of the beats, outside breaks and silences, in which a stroke or a note begins."""
    plays = np.repeat([bar.section not in ("break", "silence") for bar in form.bars], form.metre)
    places = np.array([x.position for x in hits] + [x.position for x in notes])
    onsets = np.floor(places + 1e-6).astype(int)
    begins = np.isin(np.arange(len(plays)), onsets)
    return float(begins[plays].mean())


EMPHASES = {  # which notes are louder, by their place in the bar (beats)
    "none": lambda place: np.zeros_like(place, bool),
    "beats": lambda place: np.abs(place - np.round(place)) < 0.05,
    "off-beats": lambda place: np.abs(place % 1 - 0.5) < 0.05,
    "bars": lambda place: place < 0.05,
}


def accented(notes: list[Note], metre: int, emphasis: str, by: float) -> list[Note]:
    """Notes at the emphasised places are louder by the factor 1 + `by`, all others softer."""
    places = np.array([n.position for n in notes]) % metre
    marked = EMPHASES[emphasis](places)
    return [
        replace(n, velocity=n.velocity * (1 + by if loud else 1 - by))
        for n, loud in zip(notes, marked, strict=True)
    ]


def mixed(
    form: Form,
    played: Played,
    notes: list[Note],
    band: Band,
    seconds: float,
    rng: np.random.Generator,
) -> Float[np.ndarray, "N"]:
    """All instruments in a random balance, dry; peak 0.9."""
    length = round((LEAD + seconds) * SAMPLE_RATE)
    strokes, singing = rng.spawn(2)
    buses = {"drums": [drum_bus(played, band.kit, length, strokes)]}
    for part, voices in band.voices.items():
        own = [n for n in notes if n.voice == part]
        buses[part] = [voice_bus(form, own, voice, length, singing) for voice in voices]
    ducked = rng.random() < 0.15
    gain = duck(played, length, rng.uniform(0.3, 0.7) if ducked else 0.0, rng.uniform(0.06, 0.16))
    y = np.zeros(length)
    for part, together in buses.items():
        quiet = rng.uniform(0, QUIETER.get(part, 0.0))
        for bus in together:
            level = np.sqrt(np.mean(bus**2))
            decibel = LEVELS[part] + rng.normal(0, 3.0) - quiet
            if level > 0:
                y += bus / level * 10 ** (decibel / 20) * (1 if part == "drums" else gain)
    y = y[-round(seconds * SAMPLE_RATE) :]
    edge = round(0.003 * SAMPLE_RATE)
    y[:edge] *= np.linspace(0, 1, edge)
    y[len(y) - edge :] *= np.linspace(1, 0, edge)
    return (0.9 * y / max(np.abs(y).max(), 1e-9)).astype(np.float32)


def _silences(form: Form, music: np.ndarray, seconds: float) -> list[tuple[float, float]]:
    """Start and end of every span of the recording without beats, above SHORT seconds."""
    edges = np.flatnonzero(np.diff(np.concatenate([[1], music.astype(int), [1]])))
    times = np.append(form.times, np.inf)
    spans = times[edges].reshape(-1, 2).clip(0, seconds)
    return [(float(start), float(end)) for start, end in spans if end > start + SHORT]


__all__ = ["VARIED", "Variety", "accented", "mixed", "varied_song", "varied_songs"]
