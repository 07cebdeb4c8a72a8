"""Checks of notebook 14: measuring dances."""

import numpy as np

from ._report import check, expect_close

STOPS = [np.array([1.0, 2.1, 3.0, 3.9]), np.array([0.95]), np.array([1.5, 2.5, 3.2])]
SONGS = [np.array([1.0, 2.0, 3.0]), np.array([0.9, 1.9]), np.array([1.45, 2.45, 3.45, 4.45, 5.45])]
SIGMA = 0.05


def pair(stops: np.ndarray, song: np.ndarray, sigma: float = SIGMA) -> float:
    """Kinematic form of the beat alignment, stop by stop."""
    return float(
        np.mean([np.exp(-(min((b - m) ** 2 for m in song)) / (2 * sigma**2)) for b in stops])
    )


@check
def shuffled_score(mine):
    """mine(stops, songs, score): mean score of each dance with each other song."""
    n = len(STOPS)
    table = np.array([[pair(stops, song) for song in SONGS] for stops in STOPS])
    others = ~np.eye(n, dtype=bool)
    right = table[others].mean()
    own = np.diag(table).mean()
    all_pairs = table.mean()
    next_only = np.mean([table[i, (i + 1) % n] for i in range(n)])
    once = table[np.triu_indices(n, 1)].mean()
    once_below = table[np.tril_indices(n, -1)].mean()
    before_only = np.mean([table[i, i - 1] for i in range(n)])
    music = np.array([[pair(song, stops) for song in SONGS] for stops in STOPS])[others].mean()
    expect_close(
        mine([s.copy() for s in STOPS], [s.copy() for s in SONGS], pair),
        right,
        "the shuffled score of three dances and songs",
        mistakes={
            "this is each dance with its *own* song": own,
            "a dance's own song is among the others; leave it out": all_pairs,
            "each dance is scored with one other song only; score it with all": next_only,
            "each dance is scored with the song before its own; score it with all": before_only,
            "dance 1 with song 2 is not dance 2 with song 1: both count": once,
            "dance 2 with song 1 is not dance 1 with song 2: both count": once_below,
            "this is divided by the number of dances; how many pairs are there?": table[
                others
            ].sum()
            / n,
            "the own song counts as 0 here; do not count it as a pair": table[others].sum() / n**2,
            "stops and beats are swapped: score(stops, song)": music,
            "take the mean over all pairs, not their sum": table[others].sum(),
        },
        rtol=1e-6,
    )
    constant = mine([np.array([1.0])] * 5, [np.array([1.0])] * 5, lambda stops, song: 0.25)
    expect_close(constant, 0.25, "the shuffled score when every pair scores 0.25")
    return "With shuffled songs, the score comes from chance and from rhythm that all songs share."


@check
def expenditure(mine):
    """mine(path, fps): mean length of the acceleration of one joint, (T, 3)."""
    path = (
        np.array(
            [
                (0.1, 0, 5),
                (0.1, 1, 5),
                (0.4, 3, 5),
                (1.3, 3, 9),
                (1.3, 3, 9),
                (2.0, 3, 9),
                (2.0, 3.5, 9),
            ]
        )
        / 10
    )
    fps = 10
    second = path[2:] - 2 * path[1:-1] + path[:-2]
    sizes = np.linalg.norm(second, axis=1)
    bracket = ((path[2:] - path[1:-1]) * fps - (path[1:-1] - path[:-2] * fps)) * fps
    speed = np.linalg.norm(np.diff(path, axis=0), axis=1)
    expect_close(
        mine(path, fps),
        fps**2 * sizes.mean(),
        "the expenditure of a short path at 10 frames a second",
        mistakes={
            "that is the published fault: the bracket closes after the earlier position": (
                np.linalg.norm(bracket, axis=1).mean()
            ),
            "divide by the frame time twice, once for each difference": fps * sizes.mean(),
            "the frame time is missing: these are metres per frame, per frame": sizes.mean(),
            "divide by the frame time, 1 / fps: that means multiply by fps": sizes.mean() / fps**2,
            "take the length of the vector, not the mean size of its coordinates": fps**2
            * np.abs(second).mean(),
            "take the mean over the frames, not the sum": fps**2 * sizes.sum(),
            ("np.gradient spans two frames; take each frame's difference to the next"): fps**2
            * np.linalg.norm(np.gradient(np.gradient(path, axis=0), axis=0), axis=1).mean(),
            "you used 60 for fps; the argument was 10": 60**2 * sizes.mean(),
            "the lengths are squared; this feature does not square them": fps**4
            * (sizes**2).mean(),
            "take the length in each frame, then the mean: opposite directions must not cancel": fps
            ** 2
            * np.linalg.norm(second.mean(0)),
            "that is the speed; the acceleration is the change of the velocity": fps * speed.mean(),
            (
                "the change of the *speed* misses turning; "
                "take the change of the velocity, a vector"
            ): fps**2 * np.abs(np.diff(speed)).mean(),
        },
        rtol=1e-6,
    )
    away = mine(path + [300.0, 0.0, 40.0], fps)
    expect_close(
        away, fps**2 * sizes.mean(), "the expenditure of the same path 300 m away", rtol=1e-4
    )
    expect_close(
        mine(np.tile(np.linspace(0, 7, 8)[:, None], 3), 4),
        0.0,
        "the expenditure of a straight line at constant speed",
    )
    return "The same movement has the same expenditure wherever it is danced."
