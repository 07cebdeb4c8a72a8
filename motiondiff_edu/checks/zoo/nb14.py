"""Wrong answers to the exercises of notebook 14."""

import numpy as np


def _table(stops, songs, score):
    return np.array([[score(s, song) for song in songs] for s in stops])


def own_song(stops, songs, score):
    return np.mean([score(s, song) for s, song in zip(stops, songs, strict=True)])


def own_song_too(stops, songs, score):
    return _table(stops, songs, score).mean()


def next_song_only(stops, songs, score):
    return np.mean([score(s, song) for s, song in zip(stops, songs[1:] + songs[:1], strict=True)])


def each_pair_once(stops, songs, score):
    return _table(stops, songs, score)[np.triu_indices(len(stops), 1)].mean()


def own_song_as_nothing(stops, songs, score):
    return (_table(stops, songs, score) * (1 - np.eye(len(stops)))).mean()


def exchanged(stops, songs, score):
    return own_left_out(_table(songs, stops, score))


def own_left_out(table):
    return table[~np.eye(len(table), dtype=bool)].mean()


def published_bracket(path, fps):
    dt = 1 / fps
    after = (path[2:] - path[1:-1]) / dt
    before = path[1:-1] - path[:-2] / dt
    return np.linalg.norm((after - before) / dt, axis=1).mean()


def _second(path):
    return path[2:] - 2 * path[1:-1] + path[:-2]


def one_frame_time(path, fps):
    return np.linalg.norm(_second(path), axis=1).mean() * fps


def no_frame_time(path, fps):
    return np.linalg.norm(_second(path), axis=1).mean()


def squared(path, fps):
    return ((_second(path) * fps**2) ** 2).sum(1).mean()


def cancelled(path, fps):
    return np.linalg.norm(_second(path).mean(0)) * fps**2


def change_of_speed(path, fps):
    speed = np.linalg.norm(np.diff(path, axis=0), axis=1) * fps
    return np.abs(np.diff(speed)).mean() * fps


def always_60(path, fps):
    return np.linalg.norm(_second(path), axis=1).mean() * 60**2


ZOO = {
    "shuffled_score": {
        "own song": own_song,
        "own song among the others": own_song_too,
        "next song only": next_song_only,
        "each pair once": each_pair_once,
        "own song counted as nothing": own_song_as_nothing,
        "stops and beats exchanged": exchanged,
    },
    "expenditure": {
        "the published bracket": published_bracket,
        "frame time once": one_frame_time,
        "no frame time": no_frame_time,
        "squared": squared,
        "to and fro cancel": cancelled,
        "change of the speed": change_of_speed,
        "always 60 frames a second": always_60,
    },
}
