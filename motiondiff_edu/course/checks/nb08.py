"""Checks of notebook 08: measuring walks."""

import math

import numpy as np

from ._compare import compare
from ._report import check
from .zoo.nb08 import MISTAKES

# nine frames of two toes, every frame written out: x, height, z in centimetres
_LEFT = ["0 0 0", "3 1 4", "3 2 4", "7 3.5 4", "8 9 60", "9 6 99", "9 7 99", "9 8 99", "9 1 99"]
_RIGHT = [
    *("50 2.5 0", "50 2.5 0", "50 6 0", "50 2 0", "50 1 0"),
    *("62 0 5", "62 9 5", "62 8 5", "62 2 5"),
]


def _toes(rng: np.random.Generator):
    """Nine frames by hand; toes that stand; others, of which some steps are in the air.

    Once without the arguments that have defaults.
    """
    by_hand = np.array([[line.split() for line in side] for side in (_LEFT, _RIGHT)], float)
    yield by_hand.swapaxes(0, 1) / 100.0, 10, 0.03
    yield np.zeros((4, 2, 3)), 20, 0.03
    yield (by_hand.swapaxes(0, 1)[::-1] / 90.0,)  # at 20 frames/s, below 0.03
    edge = np.full((4, 2, 3), 0.5)  # a toe at exactly `below` is not planted
    edge[:, 0] = [[0.0, 0.03, 0], [0.2, 0.03, 0], [0.3, 0.01, 0], [0.35, 0.01, 0.1]]
    yield edge, 20, 0.03
    for fps, below in ((30, 0.05), (20, 0.04)):
        toes = rng.normal(size=(40, 2, 3))
        toes[..., 1] = 0.08 * rng.random((40, 2))
        yield toes, fps, below


def step_by_step(toes: np.ndarray, fps: float = 20, below: float = 0.03) -> float:
    """Step by step and toe by toe, in plain Python."""
    speeds = []
    for now, then in zip(toes[:-1].tolist(), toes[1:].tolist(), strict=True):
        heights = [max(now[toe][1], then[toe][1]) for toe in (0, 1)]
        toe = 0 if heights[0] <= heights[1] else 1
        if heights[toe] < below:
            speeds.append(math.hypot(then[toe][0] - now[toe][0], then[toe][2] - now[toe][2]) * fps)
    return sum(speeds) / len(speeds)


@check
def toe_slide(mine):
    """mine(toes, fps, below): mean speed of planted toes, in m/s."""
    compare(mine, step_by_step, _toes, "skating", MISTAKES["toe_slide"])
    return "A step in the air says nothing about sliding: it is left out, and does not count as 0."


def _runs(rng: np.random.Generator):
    """Runs by hand, with three gaps; none at all; others."""
    runs = [(0, 3), (4, 5), (6, 9), (13, 14), (17, 20)]
    for gap in (1, 3, 0, 4):
        yield list(runs), gap
    yield [], 2
    for gap in (1, 2, 3):
        ends = np.cumsum(rng.integers(1, 5, size=16)).reshape(8, 2)
        yield [(int(first), int(after)) for first, after in ends], gap


def painted(runs: list, gap: int) -> list:
    """Paints the frames of the runs and of the gaps, and reads the runs off."""
    frames = np.zeros(runs[-1][1] + 2 if runs else 2, bool)
    for first, after in runs:
        frames[first:after] = True
    for (_, after), (first, _) in zip(runs, runs[1:], strict=False):
        if first - after <= gap:
            frames[after:first] = True
    edges = np.flatnonzero(np.diff(np.concatenate([[False], frames]).astype(int)))
    return [(int(first), int(after)) for first, after in edges.reshape(-1, 2)]


@check
def merge_steps(mine):
    """mine(runs, gap): runs with short gaps closed; the list given stays as it is."""
    compare(mine, painted, _runs, "the steps (first, first after)", MISTAKES["merge_steps"])
    return "Now a single noisy frame no longer turns one step into two."
