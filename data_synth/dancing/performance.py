"""Dances to a song.

A dance has phrases of moves from the genre's vocabulary, on the beat, with feet that stay planted.

    python -m data_synth dances --out FOLDER   # BVH for Blender, npz (no pickle) for all else

A dance depends on the song's score and a seed: two seeds give two dances to one song.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from motiondiff_edu.motion.root_frame import FPS

from .. import noise
from ..music import songs
from ..music.song import GENRES, Song
from .body import dancer
from .choreography import choreograph
from .curves import curve, felt_beats, springy, within_reach
from .follow import facing
from .gaze import ahead_of_the_turn
from .moves import MANNERS, Manner
from .script import ARM, LENGTHS, REST, START, Script, Step, Toe
from .steps import Roll, Track, track
from .waiting import counted_on

DANCES_A_SEED = 100_000
DAMPING, ARMS_LEAD = (
    0.6,
    1.0,
)  # of the arms' spring; the share of its delay by which the arms start earlier
ARMS = [f"{side}_{name}" for side in "lr" for name in ARM]
FASTEST = 250.0  # degrees a second, on average between two keys, that an arm's angle may change


@dataclass(frozen=True, eq=False)
class Dance:
    """World positions (metres), true contacts and the moves of a dance.

    Contacts say which foot is planted: left, right.

    `moves` has (first beat, name, mirrored) of every move.
    """

    positions: Float[np.ndarray, "T 21 3"]
    contacts: Bool[np.ndarray, "T 2"]
    moves: list[tuple[int, str, bool]]
    genre: str
    fps: float
    seed: int

    def __len__(self) -> int:
        return len(self.positions)


def dance(song: Song, seed: int, only: str | None = None) -> Dance:
    """A dance to the song's score, 20 frames/s, from (0, 0) facing z.

    With `only` it consists of that one move. In a silence of the song the dancer waits, and counts
    on: those beats are numbered, too.

    Raises ValueError when the song has fewer than two beats, its genre has no such moves, or the
    seed is negative.
    """
    if song.genre not in MANNERS:
        raise ValueError(f"no moves for the genre {song.genre!r}; there are {', '.join(MANNERS)}")
    if len(song.beats) < 2:
        raise ValueError(
            "a dance needs two beats or more, "
            f"this song of {song.seconds:.1f} s has {len(song.beats)}"
        )
    if seed < 0:
        raise ValueError(f"a seed is a whole number from 0 on, got {seed}")
    song = counted_on(song)
    script, moves = choreograph(song, np.random.default_rng([seed, song.seed, 31]), only)
    positions, contacts = perform(script, song, seed)
    names = [(m.start, m.name, m.mirrored) for m in moves]
    return Dance(positions, contacts, names, song.genre, FPS, seed)


def dances(
    n: int, seed: int, seconds: float = 30.0, *, each: int = 1, genre: str | None = None
) -> Iterator[tuple[Song, Dance]]:
    """n songs as `music.songs` has them, with `each` dances to every one.

    The dances to one song follow one another. Different seeds share no song, and no dancer's seed.
    Raises ValueError as `songs` and `dance` do, when `each` is below 1, and for more dances than a
    seed has.
    """
    if each < 1 or n * each > DANCES_A_SEED:
        raise ValueError(
            f"one dance to a song or more, {DANCES_A_SEED} in all; got {n} songs with {each} each"
        )
    return dances_to(songs(n, seed, seconds, genre=genre), seed * DANCES_A_SEED, each)


def dances_to(made: Iterable[Song], first: int, each: int = 1) -> Iterator[tuple[Song, Dance]]:
    """Dances to given songs, `each` to every one; their seeds count from `first`."""
    return (
        (song, dance(song, first + each * k + j))
        for k, song in enumerate(made)
        for j in range(each)
    )


def perform(
    script: Script, song: Song, seed: int
) -> tuple[Float[np.ndarray, "T 21 3"], Bool[np.ndarray, "T 2"]]:
    """Let a person dance the script, with their own timing, posture, spring and drift."""
    rng = np.random.default_rng([seed, song.seed, 32])
    manner = MANNERS[song.genre]
    t = np.arange(int(song.seconds * FPS)) / FPS
    felt = felt_beats(
        song.beats, rng, jitter=rng.uniform(0.012, 0.020), off=rng.normal(-manner.lead, 0.006)
    )
    return performed(script, t, felt, manner, seed, rng)


def performed(
    script: Script,
    t: Float[np.ndarray, "T"],
    felt: tuple[Float[np.ndarray, "N"], Float[np.ndarray, "N"]],
    manner: Manner,
    seed: int,
    rng: np.random.Generator,
    start: tuple[Toe, Toe] = START,
) -> tuple[Float[np.ndarray, "T 21 3"], Bool[np.ndarray, "T 2"]]:
    """Positions and contacts at the times t (seconds) of a script whose beats are felt at `felt`.

    felt   seconds, and the number of the beat at each
    seed   of the slow drift of the posture; `rng` draws the person
    start  where the toes stand before the first step
    """
    seconds, number = felt
    b = np.interp(t, seconds, number)
    delay = (
        2 * DAMPING / (2 * np.pi * manner.spring)
    )  # the arms' spring is late by this, so they start that much earlier
    early = np.interp(t + ARMS_LEAD * delay, seconds, number)
    channels = _channels(script, b, early, (seconds, number), manner, seed, rng)
    heading = facing(script, b)
    head, chest = ahead_of_the_turn(heading, FPS)
    channels["look"], channels["twist"] = channels["look"] + head, channels["twist"] + chest
    tracks = [
        _foot(script.steps[foot], start[foot], t, felt, channels[heel], manner.roll, rng)
        for foot, heel in enumerate(("l_heel", "r_heel"))
    ]
    positions = dancer(channels, (tracks[0], tracks[1]), heading, manner.level)
    return positions, np.stack([k.planted for k in tracks], -1)


def _channels(
    script: Script, b, early, grid, manner: Manner, seed: int, rng
) -> dict[str, Float[np.ndarray, "T"]]:
    """Every channel at every frame, with the person's posture and slow drift.

    The arms follow like a spring.
    """
    wander = noise.drift(noise.white(seed, len(b))[:, : len(REST)], 0.45, FPS)
    channels = {}
    for i, name in enumerate(REST):
        late = 0.012 * rng.standard_normal()
        keys = script.keys[name]
        is_arm = name in ARMS
        if is_arm:
            keys = within_reach(keys, np.interp([k[0] for k in keys], grid[1], grid[0]), FASTEST)
        flow = 0.5 * manner.flow if name == "drop" else manner.flow
        drifts, own = _person(name)
        value = curve((early if is_arm else b) - late, keys, manner.hold, flow)
        own = manner.variety * own * rng.standard_normal()
        channels[name] = value + drifts * wander[:, i] + own
    hertz = manner.spring * float(np.exp(0.12 * rng.standard_normal()))
    arms = springy(np.stack([channels[name] for name in ARMS], -1), FPS, hertz, DAMPING)
    return channels | dict(zip(ARMS, arms.T, strict=True))


def _person(name: str) -> tuple[float, float]:
    """The drift of a channel, and the difference of its posture between persons.

    Both are standard deviations, in degrees or metres.
    """
    if name == "weight" or name.endswith("heel"):
        return 0.0, 0.0
    if name in ARMS:
        return 2.0, 6.0
    return (0.003, 0.008) if name in LENGTHS else (0.9, 3.0)


def _foot(steps: list[Step], start: Toe, t, felt, heel, roll: Roll, rng) -> Track:
    """One foot's steps at the dancer's own times, each with an error of some milliseconds."""
    seconds, number = felt
    times = np.interp([(s.lift, s.land) for s in steps], number, seconds).reshape(-1, 2)
    times = times + 0.006 * rng.standard_normal(times.shape)
    flat = np.maximum.accumulate(times.ravel()).reshape(-1, 2)
    flat[:, 1] = np.maximum(flat[:, 1], flat[:, 0] + 0.06)
    return track(steps, start, flat, t, np.maximum(heel, 0.0), roll)


__all__ = ["Dance", "GENRES", "dance", "dances", "dances_to", "perform", "performed"]
