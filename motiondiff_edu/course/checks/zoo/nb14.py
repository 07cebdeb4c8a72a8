"""Wrong answers to the exercises of notebook 14."""

import numpy as np


def _table(stops, songs, score):
    return np.array([[score(s, song) for song in songs] for s in stops])


def _own_left_out(table):
    return table[~np.eye(len(table), dtype=bool)].mean()


def own_song(stops, songs, score):
    """This is the score itself, with which the shuffled one should be compared."""
    return np.mean([score(s, song) for s, song in zip(stops, songs, strict=True)])


def own_song_too(stops, songs, score):
    """The dance's own song is among the others and raises their mean."""
    return _table(stops, songs, score).mean()


def next_song_only(stops, songs, score):
    """Takes one other song for each dance instead of all."""
    return np.mean([score(s, song) for s, song in zip(stops, songs[1:] + songs[:1], strict=True)])


def each_pair_once(stops, songs, score):
    """Half of the pairs are missing: dance a to song b is not dance b to song a."""
    return _table(stops, songs, score)[np.triu_indices(len(stops), 1)].mean()


def half_of_the_pairs(stops, songs, score):
    """Takes the other half: each dance with the songs before its own."""
    return _table(stops, songs, score)[np.tril_indices(len(stops), -1)].mean()


def the_song_before(stops, songs, score):
    """Takes one other song for each dance, the one before."""
    return np.mean([score(s, songs[i - 1]) for i, s in enumerate(stops)])


def divided_by_dances(stops, songs, score):
    """Divides the sum over pairs by the number of dances."""
    table = _table(stops, songs, score)
    return table[~np.eye(len(table), dtype=bool)].sum() / len(table)


def own_song_as_nothing(stops, songs, score):
    """Own songs count as zeros, which lowers the mean most when there are few dances."""
    return (_table(stops, songs, score) * (1 - np.eye(len(stops)))).mean()


def exchanged(stops, songs, score):
    """Measures from the beats to the stops, which is the other form of the score."""
    return _own_left_out(_table(songs, stops, score))


def published_bracket(path, fps):
    """Closes the bracket as published: one position is divided by the frame time, not both."""
    dt = 1 / fps
    after = (path[2:] - path[1:-1]) / dt
    before = path[1:-1] - path[:-2] / dt
    return np.linalg.norm((after - before) / dt, axis=1).mean()


def _second(path):
    return path[2:] - 2 * path[1:-1] + path[:-2]


def one_frame_time(path, fps):
    """Divides by the frame time once; an acceleration needs it twice."""
    return np.linalg.norm(_second(path), axis=1).mean() * fps


def no_frame_time(path, fps):
    """Gives metres per frame, per frame.

    The same dance has a ninth of the expenditure at 60 frames a second as at 20.
    """
    return np.linalg.norm(_second(path), axis=1).mean()


def squared(path, fps):
    """In a mean of squares one jerk counts more than a whole lively dance."""
    return ((_second(path) * fps**2) ** 2).sum(1).mean()


def cancelled(path, fps):
    """Averages the vectors before it takes their length: opposite ones cancel."""
    return np.linalg.norm(_second(path).mean(0)) * fps**2


def change_of_speed(path, fps):
    """Moving in a circle at a steady speed is accelerated, too, but costs nothing here."""
    speed = np.linalg.norm(np.diff(path, axis=0), axis=1) * fps
    return np.abs(np.diff(speed)).mean() * fps


def always_60(path, fps):
    """Right at 60 frames a second only."""
    return np.linalg.norm(_second(path), axis=1).mean() * 60**2


ZOO = {
    "shuffled_score": {
        "own song": own_song,
        "own song among the others": own_song_too,
        "next song only": next_song_only,
        "each pair once": each_pair_once,
        "each pair once, the other half": half_of_the_pairs,
        "the song before only": the_song_before,
        "divided by the number of dances": divided_by_dances,
        "own song counted as nothing": own_song_as_nothing,
        "stops and beats exchanged": exchanged,
    },
    "expenditure": {
        "the published bracket": published_bracket,
        "frame time once": one_frame_time,
        "no frame time": no_frame_time,
        "divided by fps": lambda path, fps: np.linalg.norm(_second(path), axis=1).mean() / fps**2,
        "mean of the coordinates": lambda path, fps: np.abs(_second(path)).mean() * fps**2,
        "sum over frames": lambda path, fps: np.linalg.norm(_second(path), axis=1).sum() * fps**2,
        "gradient": lambda path, fps: (
            np.linalg.norm(np.gradient(np.gradient(path, axis=0), axis=0), axis=1).mean() * fps**2
        ),
        "squared": squared,
        "to and fro cancel": cancelled,
        "change of the speed": change_of_speed,
        "always 60 frames a second": always_60,
    },
}
