"""Checks of notebook 08: measuring walks."""

import numpy as np

from ._report import check, expect, expect_close


def _toes() -> np.ndarray:
    """Nine frames of two toes, every frame written out: x, height, z in centimetres."""
    left = [
        (0, 0, 0),
        (3, 1, 4),
        (3, 2, 4),
        (7, 3.5, 4),
        (8, 9, 60),
        (9, 6, 99),
        (9, 7, 99),
        (9, 8, 99),
        (9, 1, 99),
    ]
    right = [
        (50, 2.5, 0),
        (50, 2.5, 0),
        (50, 6, 0),
        (50, 2, 0),
        (50, 1, 0),
        (62, 0, 5),
        (62, 9, 5),
        (62, 8, 5),
        (62, 2, 5),
    ]
    return np.stack([left, right], axis=1) / 100.0


def slides_of(height: np.ndarray, slide: np.ndarray) -> float:
    """Mean slide of the toe that is lower by this measure of height, where it is under 3 cm."""
    rows, lower = np.arange(len(height)), height.argmin(1)
    return slide[rows, lower][height[rows, lower] < 0.03].mean()


@check
def toe_slide(mine):
    """mine(toes, fps, below): mean speed of planted toes, on steps whose slide is known."""
    toes = _toes()
    slides = np.array(
        [0.05, 0.0, 0.0, 0.13]
    )  # steps 0, 1: left; 3, 4: right; the others have no toe low at both ends
    answer = mine(toes, fps=10, below=0.03)
    expect(
        not np.isnan(np.asarray(answer, float)).any(),
        "your answer is NaN; were any steps left to average?",
    )
    frame_low = np.linalg.norm(np.diff(toes[:, :, [0, 2]], axis=0), axis=-1)
    lower_now = toes[:-1, :, 1].argmin(1)
    now = frame_low[np.arange(8), lower_now][toes[:-1, :, 1].min(1) < 0.03]
    whole = np.linalg.norm(np.diff(toes, axis=0), axis=-1)
    both = np.maximum(toes[1:, :, 1], toes[:-1, :, 1])
    low = both.min(1) < 0.03
    halfway = (toes[1:, :, 1] + toes[:-1, :, 1]) / 2
    expect_close(
        answer,
        10 * slides.mean(),
        "skating of two toes at 10 frames a second",
        mistakes={
            "a speed is per second: multiply by fps": slides.mean(),
            "you used 20 for fps; the argument was 10": 20 * slides.mean(),
            "steps without a planted toe count as sliding of zero; leave them out": 10
            * slides.sum()
            / 8,
            "both toes are counted; count only the lower one": 10 * frame_low[low].mean(),
            "each toe under `below` is counted; where both are, count only the lower one": 10
            * frame_low[both < 0.03].mean(),
            "the height of a step is that of its higher end, not the mean of both": 10
            * slides_of(halfway, frame_low),
            "this is the higher toe; take the lower one": 10
            * frame_low[np.arange(8), both.argmax(1)][low].mean(),
            "steps in the air are counted, too; is a toe under `below`?": 10
            * frame_low[np.arange(8), both.argmin(1)].mean(),
            "the height is taken at the first end of the step only": 10 * now.mean(),
            "this is the slower toe; speed is what we measure, so choose by height": 10
            * frame_low[low].min(1).mean(),
            "upward movement is no sliding: use only x and z": 10
            * whole[np.arange(8), both.argmin(1)][low].mean(),
        },
    )
    still = np.zeros((4, 2, 3))
    expect_close(mine(still, fps=20, below=0.03), 0.0, "skating of toes that stand still")
    return "Half of the steps here are in the air, and say nothing about sliding."


@check
def merge_steps(mine):
    """mine(runs, gap): runs with short gaps closed; the list given stays as it is."""
    runs = [(0, 3), (4, 5), (6, 9), (13, 14), (17, 20)]

    def pairs(answer):
        expect(answer is not None, "your answer returns nothing; is a `return` missing?")
        return [tuple(int(x) for x in pair) for pair in answer]

    one = pairs(mine(list(runs), 1))
    expect(
        one != [(0, 5), (6, 9), (13, 14), (17, 20)],
        "three short runs in a row must become one step; yours made two",
    )
    expect(one != runs, "a gap of exactly `gap` frames is closed as well")
    expect(one != [(0, 9), (17, 20)] and one != [(0, 9), (13, 14)], "a step is missing at the end")
    expect(
        one == [(0, 9), (13, 14), (17, 20)],
        f"from {runs} with gap 1 you make {one}; the gaps are 1, 1, 4 and 3 frames wide",
    )
    wide = pairs(mine(list(runs), 3))
    expect(
        wide == [(0, 9), (13, 20)],
        f"from {runs} with gap 3 you make {wide}; the gaps are 1, 1, 4 and 3 frames wide",
    )
    expect(pairs(mine(list(runs), 0)) == runs, "with gap 0 nothing here may be joined")
    expect(pairs(mine([], 2)) == [], "without runs there is nothing to join: return an empty list")
    kept = list(runs)
    mine(kept, 4)
    expect(kept == runs, "your function changes the list it was given; build a new one")
    return "Now a single noisy frame no longer turns one step into two."
