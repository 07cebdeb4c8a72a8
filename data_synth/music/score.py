"""A silent score: beats, bars and phrases, with no music.

It is for tests, and for dances to your own count.
"""

import numpy as np

from .song import GENRES, SAMPLE_RATE, Song

PHRASE = 8  # beats in a phrase, at least; phrases end with a bar


def beat_song(
    seconds: float,
    tempo: float,
    metre: int = 4,
    genre: str = "pop",
    seed: int = 0,
    *,
    drift: float = 0.0,
) -> Song:
    """A silent Song whose beats are `60 / tempo` s apart.

    The first beat comes after a random pause.

    `drift` bends the tempo by up to that share, slowly; the last bars of every fourth phrase are a
    break (energy 0.15).
    Raises ValueError unless there is time for two beats, the genre is known, and the metre is 2 or
    more.
    """
    if genre not in GENRES:
        raise ValueError(f"no genre is called {genre!r}; there are {', '.join(GENRES)}")
    if metre < 2 or not 0 <= drift < 0.3:
        raise ValueError(
            f"a bar has 2 beats or more and drift lies in [0, 0.3), got {metre} and {drift}"
        )
    period = 60.0 / tempo
    if seconds < 2 * period:
        raise ValueError(
            f"{seconds} s at {tempo:g} BPM hold no two beats: more seconds, or a higher tempo"
        )
    rng = np.random.default_rng([seed, 21])
    first = rng.uniform(0.02, min(period, seconds - period))
    turn = rng.uniform(0, 2 * np.pi)
    count = np.arange(int(2 * seconds / period) + 2)
    swing = drift * 12 / (2 * np.pi) * (np.sin(2 * np.pi * count / 12 + turn) - np.sin(turn))
    beats = first + period * (count + swing)
    beats = beats[beats < seconds]
    number = np.arange(len(beats))
    bars = -(-PHRASE // metre)  # in a phrase
    phrase = number // (bars * metre)
    calm = (phrase % 4 == 3) & (number % (bars * metre) >= (bars - 1) * metre)
    return Song(
        audio=np.zeros(round(seconds * SAMPLE_RATE)),
        beats=beats,
        bar_position=number % metre,
        phrase=phrase,
        energy=np.where(calm, 0.15, 0.6 + 0.1 * (phrase % 4)),
        hits={"click": beats},
        genre=genre,
        tempo=60.0 / float(np.diff(beats).mean()) if len(beats) > 1 else float(tempo),
        metre=metre,
        timbre="silence",
        seed=seed,
    )
