"""Wrong answers to the exercises of notebook 08."""

import numpy as np


def _steps(toes):
    height = np.maximum(toes[1:, :, 1], toes[:-1, :, 1])
    return height, np.linalg.norm(np.diff(toes[:, :, [0, 2]], axis=0), axis=-1)


def _lower(values, height):
    return values[np.arange(len(values)), height.argmin(1)]


def per_frame(toes, fps=20, below=0.03):
    """Gives metres per frame, a twentieth of the speed: every foot seems to stand still."""
    height, speed = _steps(toes)
    return _lower(speed, height)[height.min(1) < below].mean()


def in_the_air(toes, fps=20, below=0.03):
    """A swinging toe is fast, and should be; here it counts as sliding."""
    height, speed = _steps(toes)
    return fps * _lower(speed, height).mean()


def nothing_is_a_score(toes, fps=20, below=0.03):
    """Frames without a planted toe count as perfect, so a figure that flies wins."""
    height, speed = _steps(toes)
    return fps * np.where(height.min(1) < below, _lower(speed, height), 0).mean()


def both_toes(toes, fps=20, below=0.03):
    """While one toe stands, the other swings: its speed is counted as sliding."""
    height, speed = _steps(toes)
    return fps * speed[height.min(1) < below].mean()


def each_planted_toe(toes, fps=20, below=0.03):
    """Where both toes are low, both count: such frames weigh twice."""
    height, speed = _steps(toes)
    return fps * speed[height < below].mean()


def mean_height(toes, fps=20, below=0.03):
    """Chooses by the mean of both ends, so that a toe still landing counts as planted."""
    height = (toes[1:, :, 1] + toes[:-1, :, 1]) / 2
    _, speed = _steps(toes)
    return fps * _lower(speed, height)[height.min(1) < below].mean()


def slower_toe(toes, fps=20, below=0.03):
    """Chooses the toe by its speed, which is what it should measure."""
    height, speed = _steps(toes)
    return fps * speed.min(1)[height.min(1) < below].mean()


def upwards_too(toes, fps=20, below=0.03):
    """A toe that rises does not slide; only what happens along the floor counts."""
    height, _ = _steps(toes)
    return (
        fps
        * _lower(np.linalg.norm(np.diff(toes, axis=0), axis=-1), height)[
            height.min(1) < below
        ].mean()
    )


def first_end_only(toes, fps=20, below=0.03):
    """A toe that is low at first and rises in the same step counts as planted."""
    height, (_, speed) = toes[:-1, :, 1], _steps(toes)
    return fps * _lower(speed, height)[height.min(1) < below].mean()


def too_short_a_gap(runs, gap):
    """Does not join runs that are exactly `gap` frames apart."""
    return _merge(runs, gap - 1)


def _merge(runs, gap):
    merged = []
    for first, after in runs:
        if merged and first - merged[-1][1] <= gap:
            merged[-1] = (merged[-1][0], after)
        else:
            merged.append((first, after))
    return merged


def pairs_once(runs, gap):
    """Joins two runs and skips both: a third short run of the same step stays alone."""
    merged, k = [], 0
    while k < len(runs):
        join = k + 1 < len(runs) and runs[k + 1][0] - runs[k][1] <= gap
        merged.append((runs[k][0], runs[k + join][1]))
        k += 1 + join
    return merged


def last_one_lost(runs, gap):
    """Adds a step when the next one begins, so the last step is never added."""
    return _merge(runs, gap)[:-1]


def crumbs_dropped(runs, gap):
    """Drops short runs instead of joining them: a step with gaps is lost."""
    return [(first, after) for first, after in runs if after - first > gap]


def in_place(runs, gap):
    """The steps are right, but the caller's list is changed."""
    runs[:] = _merge(runs, gap)
    return runs


ZOO = {
    "toe_slide": {
        "a frame is a second": per_frame,
        "toes in the air judged": in_the_air,
        "air counts as standing still": nothing_is_a_score,
        "both toes judged": both_toes,
        "each planted toe judged": each_planted_toe,
        "mean of both heights": mean_height,
        "slower toe judged": slower_toe,
        "going up counts": upwards_too,
        "planted at one end": first_end_only,
    },
    "merge_steps": {
        "gap too short": too_short_a_gap,
        "joined in pairs, once": pairs_once,
        "last one lost": last_one_lost,
        "crumbs dropped, not joined": crumbs_dropped,
        "changes its input": in_place,
    },
}
