"""Silence in a song: before it begins, after it ends, and general pauses in its middle.

A silent bar has no drums and no notes, except a pick-up into the next bar. Its beats are no beats
of the song, unless something sounds on them.
"""

from dataclasses import replace

import numpy as np
from jaxtyping import Bool

from .form import Bar, Form
from .grooves import Hit
from .harmony import Chord, Note

LONGEST = 4.5  # seconds of silence before it is stretched, but for a pause of one slow bar
PICK_UP = 0.4  # probability that a pick-up leads out of a silence


def silenced(form: Form, silent: set[int]) -> Form:
    """The form with these bars (by number) silent; the beats keep their times."""
    bars = [_silent(bar) if bar.number in silent else bar for bar in form.bars]
    return replace(form, bars=bars)


def _silent(bar: Bar) -> Bar:
    return replace(bar, section="silence", level=0.0, fill=0)


def draw_pauses(form: Form, seconds: float, chance: float, rng: np.random.Generator) -> set[int]:
    """Numbers of bars to silence: at the start, in the middle and at the end, each by `chance`.

    A song whose bars are too long for a silence at the start or in the middle has none there.
    """
    starts = form.times[:: form.metre]
    ends = np.append(starts[1:], np.inf)
    wants, lengths = rng.random(3) < chance, rng.uniform(0.3, 1.0, 3) * min(LONGEST, 0.25 * seconds)
    silent = set()
    if wants[0]:
        silent |= set(np.flatnonzero(ends < lengths[0]).tolist())
    if wants[2]:
        silent |= set(np.flatnonzero(starts > seconds - lengths[2]).tolist())
    middle = np.flatnonzero((starts > 0.35 * seconds) & (ends < 0.7 * seconds))
    if wants[1] and len(middle):
        first = int(middle[rng.integers(len(middle))])
        bars = max(1, int(lengths[1] / (ends[first] - starts[first])))
        silent |= set(range(first, first + bars))
    return silent


def stretched(form: Form, factor: float) -> np.ndarray:
    """Lengths of all beats: `factor` in silent bars, 1 elsewhere and on the last beat of each.

    So a pause lasts any time, not only whole bars.
    """
    lengths = np.ones(len(form.bars) * form.metre)
    for bar in form.bars:
        if bar.section == "silence":
            lengths[bar.number * form.metre : (bar.number + 1) * form.metre - 1] = factor
    return lengths


def silence_starts(form: Form) -> list[int]:
    """Beats at which a silence begins."""
    quiet = [bar.section == "silence" for bar in form.bars]
    return [k * form.metre for k in range(1, len(quiet)) if quiet[k] and not quiet[k - 1]]


def music_starts(form: Form) -> list[int]:
    """Beats at which the music begins after a silence."""
    quiet = [bar.section == "silence" for bar in form.bars]
    return [k * form.metre for k in range(1, len(quiet)) if quiet[k - 1] and not quiet[k]]


def outside_silence(form: Form, notes: list[Note]) -> list[Note]:
    """The notes that begin outside silent bars; none is held into a silence."""
    ends = np.array([*silence_starts(form), np.inf])
    kept = []
    for n in notes:
        if form.bars[int(n.position // form.metre)].section != "silence":
            left = ends[np.searchsorted(ends, n.position, side="right")] - n.position
            kept.append(replace(n, length=min(n.length, float(left))))
    return kept


def pick_ups(
    form: Form, chords: list[Chord], drums: bool, rng: np.random.Generator
) -> tuple[list[Hit], list[Note]]:
    """Strokes and notes in the last beat of some silences, getting louder towards the music."""
    hits, notes = [], []
    for beat in music_starts(form):
        draw, fast = rng.random(2)
        chord = chords[beat // form.metre]
        parts = 4 if fast < 0.3 else 2
        steps = [(beat - 1 + k / parts, 0.4 + 0.4 * (k + 1) / parts) for k in range(parts)]
        if draw < PICK_UP and drums:
            hits += [Hit("snare", at, loud, k % 3) for k, (at, loud) in enumerate(steps)]
        elif draw < PICK_UP:
            pitches = [60 + chord.tones[k % 3] for k in range(parts)]
            notes += [
                Note("chords", at, 0.9 / parts, pitch, loud)
                for (at, loud), pitch in zip(steps, pitches, strict=True)
            ]
    return hits, notes


def sounding(form: Form, hits: list[Hit], notes: list[Note]) -> Bool[np.ndarray, "B"]:
    """For every beat of the form, whether it is a beat of the music.

    All beats outside silent bars are; in a silent bar those on which a pick-up sounds.
    """
    music = np.repeat([bar.section != "silence" for bar in form.bars], form.metre)
    onsets = np.array([x.position for x in hits] + [x.position for x in notes])
    whole = np.unique(np.floor(onsets + 1e-6).astype(int))
    music[whole[(whole >= 0) & (whole < len(music))]] = True
    return music
