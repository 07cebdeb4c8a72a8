"""Silence in a song: a dancer comes to rest, waits, and counts on until the music returns.

Before the first beat and after the last the dancer stands at rest anyway.
"""

from dataclasses import replace

import numpy as np

from ..music.song import Song
from .sheet import Sheet

PAUSE = 1.75  # beats: a longer gap between two beats is a silence
SILENT = 0.0  # energy of the beats that are counted in silence; music has more


def counted_on(song: Song) -> Song:
    """The song with the beats that a dancer counts in its silences, evenly, with energy SILENT.

    A silence is a phrase of its own. A song without silences is returned as it is.
    """
    gaps = np.diff(song.beats)
    more = np.where(gaps > PAUSE * 60 / song.tempo, np.round(gaps * song.tempo / 60) - 1, 0)
    more = np.append(np.maximum(more, 0), 0).astype(int)
    if not more.any():
        return song
    old = np.repeat(np.arange(len(song.beats)), more + 1)  # the beat of the song before or at each
    count = np.arange(len(old)) - np.searchsorted(old, old)  # 0 at a beat of the song itself
    length = np.append(gaps, 0.0) / (more + 1)
    silent = count > 0
    turns = np.cumsum(np.diff(silent, prepend=False))  # every silence begins and ends a phrase
    return replace(
        song,
        beats=song.beats[old] + count * length[old],
        bar_position=(song.bar_position[old] + count) % song.metre,
        phrase=song.phrase[old] + turns,
        energy=np.where(silent, SILENT, song.energy[old]),
    )


def wait(p: Sheet) -> None:
    """Comes to rest on both feet within a beat or two, then only shifts the weight a little."""
    arrives = min(1.5 / p.rate, 0.6 * p.n)
    for name, value in p.rest.items():
        p.keys[name] = [(p.start + at * p.rate, value) for at in (arrives, max(arrives, p.n - 0.8))]
    shifts = np.arange(arrives + 1, p.n - 1.5, 2.3)
    side = p.rng.choice([-1.0, 1.0]) * (-1.0) ** np.arange(len(shifts))
    for count, value in zip(shifts, side * p.rng.uniform(0.08, 0.2, len(shifts)), strict=True):
        p.key("weight", (float(count), float(value)))
