"""Checks of notebook 14: measuring dances."""

import math

import numpy as np

from ._compare import compare
from ._report import check
from .zoo.nb14 import MISTAKES

STOPS = [np.array([1.0, 2.1, 3.0, 3.9]), np.array([0.95]), np.array([1.5, 2.5, 3.2])]
SONGS = [np.array([1.0, 2.0, 3.0]), np.array([0.9, 1.9]), np.array([1.45, 2.45, 3.45, 4.45, 5.45])]
SIGMA = 0.05


def pair(stops: np.ndarray, song: np.ndarray, sigma: float = SIGMA) -> float:
    """Kinematic form of the beat alignment, stop by stop."""
    return float(
        np.mean([np.exp(-(min((b - m) ** 2 for m in song)) / (2 * sigma**2)) for b in stops])
    )


def _wider(stops: np.ndarray, song: np.ndarray) -> float:
    return pair(stops, song, sigma=0.4)


def _evenings(rng: np.random.Generator):
    """Three dances by hand; others, whose score forgives more; a score that is always 1/4."""
    yield STOPS, SONGS, pair
    stops = [np.sort(rng.uniform(0, 6, size=n)) for n in (3, 5, 2, 4)]
    yield stops, [np.sort(rng.uniform(0, 6, size=n)) for n in (6, 4, 5, 3)], _wider
    yield [np.array([1.0])] * 5, [np.array([1.0])] * 5, lambda stops, song: 0.25


def pairs(stops: list, songs: list, score) -> float:
    """Pair by pair, with a running sum."""
    total, count = 0.0, 0
    for i, dance in enumerate(stops):
        for song in [*songs[:i], *songs[i + 1 :]]:
            total += score(dance, song)
            count += 1
    return total / count


@check
def shuffled_score(mine):
    """mine(stops, songs, score): mean score of each dance with each other song."""
    compare(mine, pairs, _evenings, "the shuffled score", MISTAKES["shuffled_score"], atol=1e-7)
    return "With shuffled songs, the score comes from chance and from rhythm that all songs share."


def _paths(rng: np.random.Generator):
    """A short path at 10 frames a second; 300 m away; a straight line; others."""
    short = ["1 0 50", "1 10 50", "4 30 50", "13 30 90", "13 30 90", "20 30 90", "20 35 90"]
    path = np.array([line.split() for line in short], float) / 100
    yield path, 10
    yield path + [300.0, 0.0, 40.0], 10
    yield np.tile(np.linspace(0, 7, 8)[:, None], 3), 4
    yield rng.normal(size=(9, 3)), 25


def frame_by_frame(path: np.ndarray, fps: float) -> float:
    """Frame by frame, coordinate by coordinate, in plain Python."""
    sizes = []
    for a, b, c in zip(path[:-2].tolist(), path[1:-1].tolist(), path[2:].tolist(), strict=True):
        by_axis = [((z - y) - (y - x)) * fps * fps for x, y, z in zip(a, b, c, strict=True)]
        sizes.append(math.hypot(*by_axis))
    return sum(sizes) / len(sizes)


@check
def expenditure(mine):
    """mine(path, fps): mean length of the acceleration of one joint, (T, 3)."""
    compare(mine, frame_by_frame, _paths, "the expenditure", MISTAKES["expenditure"], atol=1e-7)
    return "The same movement has the same expenditure wherever it is danced."
