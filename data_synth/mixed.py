"""Motion without music: walks, dances and performed sentences, for a network that learns them all.

The dances follow silent scores (`score.beat_song`). The genres take turns, with their own tempi.
"""

from collections.abc import Iterator

import numpy as np
from jaxtyping import Bool, Float

from .actions import clips
from .dancing import dance
from .music.score import beat_song
from .music.song import GENRES
from .walking import drawn_walk

Motion = tuple[Float[np.ndarray, "T 21 3"], Bool[np.ndarray, "T 2"]]


def motions(n: int, seed: int, seconds: float = 20.0) -> Iterator[Motion]:
    """n motions: positions in the world (metres, 20 frames/s), and which feet stand.

    Walks and dances alternate. The same seed gives the same bytes; different seeds share no motion.
    Raises ValueError as `beat_song` and `random_control` do.  Notebook: 15
    """
    for k in range(n):
        rng = np.random.default_rng([seed, 6, k])
        yield _danced(seconds, rng, k // 2) if k % 2 else _walked(seconds, rng)


def sentences(n: int, seed: int, seconds: float = 10.0) -> Iterator[Motion]:
    """n performed sentences of the training split (`actions.clips`): people jump, squat, sit, kick.

    Positions in the world (metres, 20 frames/s), and which feet stand.
    Raises ValueError as `actions.clips` does.
    """
    for one in clips(n, seed, "train", seconds=seconds):
        yield one.acted.positions, one.acted.contacts


def _walked(seconds: float, rng: np.random.Generator) -> Motion:
    clip = drawn_walk(seconds, rng)
    assert clip.contacts is not None  # a synthetic walk has them
    return clip.world(), clip.contacts


def _danced(seconds: float, rng: np.random.Generator, k: int) -> Motion:
    genre, (slowest, fastest, metre) = list(GENRES.items())[k % len(GENRES)]
    seed = int(rng.integers(2**31))
    made = dance(
        beat_song(seconds, rng.uniform(slowest, fastest), metre, genre, seed, drift=0.02), seed
    )
    return made.positions, made.contacts
