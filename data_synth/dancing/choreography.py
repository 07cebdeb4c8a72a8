"""The choice of moves: they are drawn phrase by phrase, repeated, mirrored and varied.

It uses the score (beats, bars, phrases, energy), never the sound.
"""

from dataclasses import dataclass, replace

import numpy as np

from ..music.song import Song
from ..walking.footsteps import TOE_AHEAD
from .follow import followed
from .moves import MANNERS, Manner
from .script import REST, START, Script
from .sheet import Counts, Sheet
from .stage import Way, way
from .waiting import SILENT, wait

CALM = 0.25  # energy below this is a break


@dataclass(frozen=True)
class Move:
    """A move of a dance.

    It has the first beat, the number of beats, its name, and whether left and right are swapped.
    """

    start: int
    beats: int
    name: str
    mirrored: bool
    rate: float  # beats a count
    size: float


def slots(song: Song, rng: np.random.Generator) -> list[tuple[int, int]]:
    """(first beat, beats).

    Phrases and breaks are cut into whole bars, 4 to 8 beats where the metre allows it.
    """
    calm, silent = song.energy < CALM, song.energy == SILENT
    edges = np.flatnonzero(np.diff(song.phrase) | np.diff(calm) | np.diff(silent)) + 1
    waits = set((np.flatnonzero(np.diff(silent)) + 1).tolist())  # a silence is a piece of its own
    cuts = []
    for first, last in zip([0, *edges], [*edges, len(song.beats)], strict=True):
        at = int(first)
        while at < last:
            bars = max(
                round(float(rng.choice([4, 8], p=[0.4, 0.6])) / song.metre),
                2 if song.metre < 4 else 1,
            )
            pick_up = (
                song.metre - int(song.bar_position[at])
            ) % song.metre  # a phrase may begin before a bar
            length = min(bars * song.metre + pick_up, int(last) - at)
            if int(last) - at - length < 4:
                length = int(last) - at
            short = cuts and min(length, cuts[-1][1]) < 3  # a pick-up, or the rest of the last bar
            if short and at not in waits:
                cuts[-1] = (cuts[-1][0], cuts[-1][1] + length)
            else:
                cuts.append((at, length))
            at += length
    return cuts


def rate_of(song: Song, calm: bool, rng: np.random.Generator) -> float:
    """Beats per count: half time at high tempo, and sometimes double time at a low one."""
    period = 60.0 / song.tempo
    if period < 0.44 and song.metre % 2 == 0:
        return 2.0 if rng.random() < (0.75 if period < 0.40 else 0.35) else 1.0
    if period > 0.62 and not calm and rng.random() < 0.06:
        return 0.5
    if calm and song.metre % 2 == 0 and period < 0.55 and rng.random() < 0.4:
        return 2.0
    return 1.0


def choreograph(
    song: Song, rng: np.random.Generator, only: str | None = None
) -> tuple[Script, list[Move]]:
    """The script of a dance to this song, and its moves.

    `only` names the one move to dance.

    Raises ValueError when the genre has no move of that name.
    """
    manner = MANNERS[song.genre]
    if only is not None:
        known = {f.__name__: f for f in (*manner.moves, *manner.calm)}
        if only not in known:
            raise ValueError(f"{song.genre} has no move {only!r}; it has {', '.join(known)}")
        manner = replace(manner, moves=(known[only],), calm=(known[only],))
    rest = REST | manner.rest
    script, moves = Script(), []
    for name, value in rest.items():
        script.keys[name].append((-2.0, value))
    script.keys["heading"].append((-2.0, 0.0))
    stride = float(rng.normal(1.0, 0.09))
    before = Way()
    taste = rng.dirichlet(np.full(len(manner.moves), 2.5))
    for start, length in slots(song, rng):
        move = _draw(song, manner, start, length, moves, taste, rng)
        moves.append(move)
        count = max(1, round(length / move.rate))
        sheet = Sheet(
            script,
            Counts(start, count, length / count, song.metre),
            move.mirrored,
            move.size,
            stride * min(move.size, 1.08) ** 0.5,
            rest,
            rng,
        )
        _gather(sheet, script)
        if move.name != wait.__name__:
            before = sheet.way = way(
                manner.stage, script.home[:2], count, song.metre, before.turn[-1], move.size, rng
            )
        next(f for f in (*manner.moves, *manner.calm, wait) if f.__name__ == move.name)(sheet)
        sheet.close()
    _end(script, rest, len(song.beats))
    script.steps = followed(script, START, (-2.0, len(song.beats) + 1.5))
    return script, moves


def _draw(song, manner: Manner, start, length, moves, taste, rng) -> Move:
    """The next move: the last one mirrored, or a new one; in silence the dancer waits.

    It is small in breaks, and large where energy is high.
    """
    energy = float(song.energy[start : start + length].mean())
    if energy == SILENT:
        return Move(start, length, wait.__name__, False, 1.0, 1.0)
    calm = energy < CALM
    tempo = np.clip((60.0 / song.tempo / 0.5) ** 0.55, 0.78, 1.25)
    size = float(np.clip((0.84 + 0.50 * energy) * tempo * rng.normal(1, 0.08), 0.5, 1.4))
    rate = rate_of(song, calm, rng)
    size *= 1.2 if rate > 1 and not calm else 0.85 if rate < 1 else 1.0
    last = moves[-1] if moves else None
    if last and not calm and length >= 3 and last.name in {f.__name__ for f in manner.moves}:
        again = len(moves) > 1 and moves[-2].name == last.name
        if not again and rng.random() < 0.45:
            return Move(start, length, last.name, not last.mirrored, last.rate, size)
    pool = manner.calm if calm else manner.moves
    share = np.ones(len(pool)) if calm else taste.copy()
    for i, f in enumerate(pool):
        if last and f.__name__ == last.name and len(pool) > 1:
            share[i] = 0.0
    name = pool[int(rng.choice(len(pool), p=share / share.sum()))].__name__
    return Move(start, length, name, bool(rng.random() < 0.5), rate, size)


def _gather(sheet: Sheet, script: Script) -> None:
    """Set home between the feet again, so that offsets of a move do not add up."""
    middle = np.mean([toe[:2] for toe in script.toes], 0)
    x, z, heading = script.home
    back = TOE_AHEAD * np.array([np.sin(heading), np.cos(heading)])
    script.home = (float(middle[0] - back[0]), float(middle[1] - back[1]), heading)


def _end(script: Script, rest: dict[str, float], beats: int) -> None:
    """Let the dancer come to rest on both feet after the last beat."""
    script.enter(
        {name: [(beats + 0.5, value), (beats + 1.5, value)] for name, value in rest.items()}
    )
