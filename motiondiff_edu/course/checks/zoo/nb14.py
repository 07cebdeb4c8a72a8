"""Wrong answers to the exercises of notebook 14."""

import numpy as np


def _table(stops, songs, score):
    return np.array([[score(s, song) for song in songs] for s in stops])


def _others(table):
    return table[~np.eye(len(table), dtype=bool)]


def _of(reduce):
    """Another summary of the table of all pairs."""
    return lambda stops, songs, score: reduce(_table(stops, songs, score))


def all_songs_at_once(stops, songs, score):
    """Lays the other songs over one another: there is always a beat near."""
    n = len(stops)
    together = [np.sort(np.concatenate([songs[j] for j in range(n) if j != i])) for i in range(n)]
    return np.mean([score(stops[i], together[i]) for i in range(n)])


def _second(path):
    return path[2:] - 2 * path[1:-1] + path[:-2]


def _sizes(path):
    return np.linalg.norm(_second(path), axis=1)


def published_bracket(path, fps):
    """Closes the bracket as published: one position is divided by the frame time, not both."""
    dt = 1 / fps
    after = (path[2:] - path[1:-1]) / dt
    before = path[1:-1] - path[:-2] / dt
    return np.linalg.norm((after - before) / dt, axis=1).mean()


def change_of_speed(path, fps):
    """Moving in a circle at a steady speed is accelerated, too, but costs nothing here."""
    speed = np.linalg.norm(np.diff(path, axis=0), axis=1) * fps
    return np.abs(np.diff(speed)).mean() * fps


def in_place(path, fps):
    """The right number, but the path begins at 0 afterwards."""
    path -= path[0].copy()
    return _sizes(path).mean() * fps**2


MISTAKES = {
    "shuffled_score": {
        "this is each dance with its *own* song": _of(lambda table: np.diag(table).mean()),
        "a dance's own song is among the others; leave it out": _of(lambda table: table.mean()),
        "each dance is scored with one other song only; score it with all": (
            _of(lambda table: np.mean([table[i, (i + 1) % len(table)] for i in range(len(table))])),
            _of(lambda table: np.mean([table[i, i - 1] for i in range(len(table))])),
        ),
        "dance 1 with song 2 is not dance 2 with song 1: both count": (
            _of(lambda table: table[np.triu_indices(len(table), 1)].mean()),
            _of(lambda table: table[np.tril_indices(len(table), -1)].mean()),
        ),
        "this is divided by the number of dances; how many pairs are there?": _of(
            lambda table: _others(table).sum() / len(table)
        ),
        "the own song counts as 0 here; do not count it as a pair": _of(
            lambda table: _others(table).sum() / table.size
        ),
        "stops and beats are swapped: score(stops, song)": (
            lambda stops, songs, score: _others(_table(songs, stops, score)).mean(),
            lambda stops, songs, score: _others(
                _table(stops, songs, lambda a, b: score(b, a))
            ).mean(),
        ),
        "take the mean over all pairs, not their sum": _of(lambda table: _others(table).sum()),
        "this is the best of the other songs; take the mean of all": (
            _of(lambda table: np.where(np.eye(len(table)), -np.inf, table).max(1).mean()),
            _of(lambda table: np.where(np.eye(len(table)), -np.inf, table).max(0).mean()),
            _of(lambda table: _others(table).max()),
        ),
        "take the mean over all pairs, not the median": _of(
            lambda table: np.median(_others(table))
        ),
        "the other songs lie over one another here; score each by itself": all_songs_at_once,
        "this is one number for each dance; take the mean of all": _of(
            lambda table: np.array([np.delete(row, i).mean() for i, row in enumerate(table)])
        ),
    },
    "expenditure": {
        "that is the published fault: the bracket closes after the earlier position": (
            published_bracket
        ),
        "divide by the frame time twice, once for each difference": lambda path, fps: (
            _sizes(path).mean() * fps
        ),
        "the frame time is missing: these are metres per frame, per frame": lambda path, fps: (
            _sizes(path).mean()
        ),
        "divide by the frame time, 1 / fps: that means multiply by fps": lambda path, fps: (
            _sizes(path).mean() / fps**2
        ),
        "differences are between frames, along axis 0; np.diff takes the last axis by itself": (
            lambda path, fps: np.linalg.norm(np.diff(path, 2), axis=1).mean() * fps**2,
            lambda path, fps: (
                np.linalg.norm(np.diff(np.diff(path, axis=0)), axis=1).mean() * fps**2
            ),
        ),
        "each frame has a vector, and its length is over axis 1": lambda path, fps: (
            np.linalg.norm(_second(path), axis=0).mean() * fps**2
        ),
        "take the length of the vector, not the mean size of its coordinates": lambda path, fps: (
            np.abs(_second(path)).mean() * fps**2
        ),
        "take the length of the vector, not the sum of its coordinates' sizes": lambda path, fps: (
            np.abs(_second(path)).sum(1).mean() * fps**2
        ),
        "take the mean over the frames, not the sum": lambda path, fps: _sizes(path).sum() * fps**2,
        "T frames have T - 2 accelerations; this divides by T": lambda path, fps: (
            _sizes(path).sum() * fps**2 / len(path)
        ),
        "take the mean of the lengths, not the root of the mean square": lambda path, fps: (
            np.sqrt((_sizes(path) ** 2).mean()) * fps**2
        ),
        "take the mean over the frames, not the median": lambda path, fps: (
            np.median(_sizes(path)) * fps**2
        ),
        "np.gradient spans two frames; take each frame's difference to the next": (
            lambda path, fps: (
                np.linalg.norm(np.gradient(np.gradient(path, axis=0), axis=0), axis=1).mean()
                * fps**2
            )
        ),
        "you used 20 or 60 for fps; it is an argument": (
            lambda path, fps: _sizes(path).mean() * 60**2,
            lambda path, fps: _sizes(path).mean() * 20**2,
        ),
        "the lengths are squared; this feature does not square them": lambda path, fps: (
            ((_second(path) * fps**2) ** 2).sum(1).mean()
        ),
        "without an axis, np.linalg.norm makes one length of all frames: take axis=1": (
            lambda path, fps: np.linalg.norm(_second(path)) * fps**2,
            lambda path, fps: np.linalg.norm(_second(path)) * fps**2 / (len(path) - 2),
        ),
        "take the length in each frame, then the mean: opposite directions must not cancel": (
            lambda path, fps: np.linalg.norm(_second(path).mean(0)) * fps**2
        ),
        "that is the speed; the acceleration is the change of the velocity": lambda path, fps: (
            np.linalg.norm(np.diff(path, axis=0), axis=1).mean() * fps
        ),
        "the change of the *speed* misses turning; take the change of the velocity, a vector": (
            change_of_speed
        ),
        "these are accelerations of each frame; take their mean": lambda path, fps: (
            _sizes(path) * fps**2
        ),
    },
}
OTHERS = {"expenditure": {"in place": in_place}}
