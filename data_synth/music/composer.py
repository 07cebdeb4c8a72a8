"""Songs with known beats: composed, played and recorded from one seed.

python -m data_synth songs --out FOLDER [--songs 10] [--seconds 30] [--seed 0] [--genre NAME]

The order is like a musician's: a form (form.py), a groove (grooves.py), harmony and tune
(harmony.py), instruments (kits.py, voices.py), a recording (mixing.py).
"""

from collections.abc import Iterator

import numpy as np
from jaxtyping import Float

from .form import GROUPS, draw_form, energies
from .grooves import groove_of, write_drums
from .harmony import draw_chords, write_bass, write_chords, write_melody
from .mixing import Played, mix, play
from .song import DRUMS, GENRES, SAMPLE_RATE, TIMBRES, TRAINING_TIMBRES, Song

SLOWEST, FASTEST = 40.0, 240.0  # possible BPM
SHORTEST, LONGEST = 2.0, 1200.0  # seconds
SONGS_A_SEED = 1_000_000
# genre: (probability of swing, least, most, the short notes' length in beats)
SWING = {
    "hiphop": (0.8, 0.54, 0.64, 0.25),
    "waltz": (0.4, 0.58, 0.66, 0.5),
    "house": (0.4, 0.52, 0.58, 0.25),
}


def _check(
    seed: int,
    genre: str | None,
    seconds: float,
    tempo: float | None,
    metre: int | None,
    timbre: str | None,
):
    if seed < 0:
        raise ValueError(f"a seed is a whole number from 0 on, got {seed}")
    if genre is not None and genre not in GENRES:
        raise ValueError(f"no genre is called {genre!r}; there are {', '.join(GENRES)}")
    if timbre is not None and timbre not in TIMBRES:
        raise ValueError(f"no timbre is called {timbre!r}; there are {', '.join(TIMBRES)}")
    if not SHORTEST <= seconds <= LONGEST:
        raise ValueError(f"a song lasts {SHORTEST:g} to {LONGEST:g} seconds, not {seconds:g}")
    if tempo is not None and not SLOWEST <= tempo <= FASTEST:
        raise ValueError(
            f"a tempo lies between {SLOWEST:g} and {FASTEST:g} beats a minute, not at {tempo:g}"
        )
    if metre is not None and metre not in GROUPS:
        raise ValueError(f"a bar has {min(GROUPS)} to {max(GROUPS)} beats (metre), not {metre}")


def compose(
    seed: int,
    genre: str | None = None,
    *,
    seconds: float = 30.0,
    tempo: float | None = None,
    metre: int | None = None,
    timbre: str | None = None,
) -> Song:
    """One song. What is not given is drawn: genre, tempo (BPM), metre, one of TRAINING_TIMBRES.

    The same arguments give the same bytes. With another `timbre` it is the same music on other
    instruments.
    Raises ValueError for an unknown genre or timbre, a metre outside 2-7, or a tempo outside
    40-240.
    """
    _check(seed, genre, seconds, tempo, metre, timbre)
    rng = np.random.default_rng([seed, 7])
    genre, tempo, metre, timbre = _chosen(genre, tempo, metre, timbre, rng)
    forming, drums, harmony, bass, keys, tune, player, studio, strength = rng.spawn(9)
    form = draw_form(forming, seconds, tempo, metre, _swing(genre, rng))
    chords = draw_chords(form, genre, harmony)
    played = play(form, write_drums(form, groove_of(genre), drums), player)
    notes = write_bass(form, chords, genre, bass) + write_chords(form, chords, genre, keys)
    notes += write_melody(form, chords, genre, tune)
    audio = mix(form, played, notes, genre, timbre, seconds, studio)

    inside = np.flatnonzero((form.times >= 0) & (form.times < seconds))
    bars = [form.bars[b // metre] for b in inside]
    beats = form.times[inside]
    phrase = np.array([bar.phrase for bar in bars])
    mean = 60.0 * (len(beats) - 1) / (beats[-1] - beats[0]) if len(beats) > 1 else tempo
    return Song(
        audio=audio,
        beats=beats,
        bar_position=inside % metre,
        phrase=phrase - phrase[0],
        energy=energies(form, strength)[inside],
        hits=strokes(played, len(audio) / SAMPLE_RATE),
        genre=genre,
        tempo=float(mean),
        metre=metre,
        timbre=timbre,
        seed=int(seed),
        info={"section": [bar.section for bar in bars], "swing": form.swing},
    )


def _chosen(genre, tempo, metre, timbre, rng: np.random.Generator) -> tuple[str, float, int, str]:
    """Draw the arguments that are not given.

    All of them are drawn in any case, so that a given one does not change later draws.
    """
    drawn = str(rng.choice(list(GENRES))), rng.random(), str(rng.choice(TRAINING_TIMBRES))
    genre, timbre = genre or drawn[0], timbre or drawn[2]
    slowest, fastest, usual = GENRES[genre]
    return (
        genre,
        float(tempo or slowest + drawn[1] * (fastest - slowest)),
        int(metre or usual),
        timbre,
    )


def strokes(played: Played, seconds: float) -> dict[str, Float[np.ndarray, "_"]]:
    """Times of each drum's strokes within the song, in seconds."""
    names = np.array([hit.drum for hit in played.hits])
    sounds = (played.seconds >= 0) & (played.seconds < seconds)
    return {drum: np.sort(played.seconds[sounds & (names == drum)]) for drum in DRUMS}


def _swing(genre: str, rng: np.random.Generator) -> tuple[float, float]:
    """Position of the second of two short notes, and their length in beats."""
    chance, least, most, unit = SWING.get(genre, (0.0, 0.5, 0.5, 0.25))
    swings, where = rng.random() < chance, rng.uniform(least, most)
    return (where if swings else 0.5), unit


def songs(
    n: int,
    seed: int,
    seconds: float = 30.0,
    *,
    genre: str | None = None,
    tempo: float | None = None,
    metre: int | None = None,
    timbre: str | None = None,
) -> Iterator[Song]:
    """Generator of n songs; without `genre` the genres take turns.

    Song k is compose(seed * SONGS_A_SEED + k, its genre, ...): different seeds share no song.
    Raises ValueError if n is not between 1 and SONGS_A_SEED, and as compose does.
    """
    if not 1 <= n <= SONGS_A_SEED:
        raise ValueError(f"ask for 1 to {SONGS_A_SEED} songs, not {n}")
    _check(seed, genre, seconds, tempo, metre, timbre)
    turns = [genre] if genre else list(GENRES)
    return (
        compose(
            seed * SONGS_A_SEED + k,
            turns[k % len(turns)],
            seconds=seconds,
            tempo=tempo,
            metre=metre,
            timbre=timbre,
        )
        for k in range(n)
    )


__all__ = ["compose", "songs"]
