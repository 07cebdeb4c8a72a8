"""Tempi of varied songs, and how they change within a song.

Tempi from 60 to 180 beats a minute are used for training. Two ranges are kept out, so that a
network can be judged at tempi that it never heard, but for the bars of a ritardando that passes
through them.
"""

import numpy as np
from jaxtyping import Float

from .form import Form

Ranges = tuple[tuple[float, float], ...]

TEMPI: Ranges = ((60.0, 66.0), (74.0, 146.0), (154.0, 180.0))  # BPM
HELD_OUT_TEMPI: Ranges = ((66.0, 74.0), (146.0, 154.0))
WANDER = 0.05  # share of the beat's length by which it changes slowly, at most
# a tempo from which no song that wanders by so much gets into the tempi that are kept out
FAR_FROM_HELD_OUT: Ranges = (
    (60.0, 66.0 * (1 - WANDER)),
    (74.0 * (1 + WANDER), 146.0 * (1 - WANDER)),
    (154.0 * (1 + WANDER), 180.0),
)
SLOWER = (1.08, 1.35)  # length of the last beat of a ritardando, as a multiple of the usual
RITARDANDO = (3, 9)  # beats, the second excluded


def draw_tempo(rng: np.random.Generator, ranges: Ranges = TEMPI) -> float:
    """A tempo (BPM) from the ranges; equal ratios of tempi are equally likely."""
    lows, highs = np.log(ranges).T
    widths = highs - lows
    k = int(rng.choice(len(ranges), p=widths / widths.sum()))
    return float(np.exp(rng.uniform(lows[k], highs[k])))


def held_out(tempo: float) -> bool:
    """Whether this tempo (BPM) is kept out of training."""
    return any(low < tempo < high for low, high in HELD_OUT_TEMPI)


def most_wander(tempo: float) -> float:
    """The largest share by which the tempo may change so that it enters no other range."""
    edges = np.array([*TEMPI, *HELD_OUT_TEMPI]).ravel()
    return float(min(WANDER, 0.9 * np.abs(edges / tempo - 1).min()))


def wander(n: int, most: float, rng: np.random.Generator) -> Float[np.ndarray, "n"]:
    """Lengths of n beats divided by their usual length: slow waves, at most `most` from 1."""
    k = np.arange(n)
    waves = [
        np.sin(2 * np.pi * (k / rng.uniform(14, 60) + rng.random())) * rng.uniform(0.3, 1)
        for _ in range(2)
    ]
    wave = np.sum(waves, axis=0)
    return 1 + most * wave / max(1.0, float(np.abs(wave).max(initial=0.0)))


def slowed(
    lengths: Float[np.ndarray, "n"], last: int, beats: int, most: float
) -> Float[np.ndarray, "n"]:
    """The lengths with a ritardando over `beats` beats that ends with beat `last`.

    The lengths grow evenly; the last is `most` times its old length.
    """
    k = np.arange(len(lengths))
    share = np.where(k <= last, np.clip((k - last + beats) / beats, 0, 1), 0)
    return lengths * (1 + (most - 1) * share)


def retimed(form: Form, lengths: Float[np.ndarray, "B"], tempo: float) -> Form:
    """The form with beats of these lengths, in units of 60 / tempo seconds.

    The first beat after the recording's beginning stays where it is.
    """
    times = np.concatenate([[0.0], np.cumsum(lengths)[:-1]]) * 60 / tempo
    first = int(np.searchsorted(form.times, 0.0))
    times += form.times[first] - times[first]
    return Form(form.bars, times, form.groups, form.phrase_bars, form.swing, form.swing_unit)
