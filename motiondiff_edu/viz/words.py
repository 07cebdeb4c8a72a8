"""Plots of words and motions: attention over a sentence, and what was asked beside what is shown.

The functions take plain arrays and return a Figure with a caption.
Notebook: 16
"""

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float, Int
from matplotlib.figure import Figure

from ..beyond.timeline import ARMS, LEGS, MIDDLE, TO_COME, VERBS
from ..motion.cleanup import runs
from ..motion.root_frame import FPS
from .style import OKABE_ITO, SMALL, figure


def words_over_time(
    maps: Mapping[str, Float[np.ndarray, "T M"]],
    sentences: Sequence[Sequence[str]],
    seconds: float,
    words: str,
) -> Figure:
    """Attention over the words of sentences, side by side: time runs down, each word is a column.

    Rows sum to one; all maps have one scale.
    """
    fig, axes = figure(4.6 * len(maps), 4.2, words, 1, len(maps), share="y")
    most = max(float(weights.max()) for weights in maps.values())
    for axis, (name, weights), sentence in zip(axes, maps.items(), sentences, strict=True):
        reach = (-0.5, len(sentence) - 0.5, seconds, 0.0)
        image = axis.imshow(
            weights, extent=reach, aspect="auto", cmap="Blues", vmin=0, vmax=most,
            interpolation="nearest",
        )  # fmt: skip
        axis.set_xticks(range(len(sentence)), sentence, rotation=60, ha="right", fontsize=SMALL)
        axis.set_title(name)
    axes[0].set_ylabel("motion (s)")
    fig.colorbar(image, ax=axes, shrink=0.85).set_label("attention", fontsize=SMALL)
    return fig


def asked_and_shown(
    table: Int[np.ndarray, "R C"], rows: Sequence[str], columns: Sequence[str], words: str
) -> Figure:
    """How often what was asked for (a row) was recognised as what (a column), in numbers.

    Each row is shaded by its own shares.
    """
    fig, (axis,) = figure(1.2 + 0.85 * len(columns), 1.4 + 0.5 * len(rows), words)
    shares = table / np.maximum(table.sum(1, keepdims=True), 1)
    axis.imshow(shares, cmap="Blues", vmin=0, vmax=1, aspect="auto")
    for (row, column), count in np.ndenumerate(table):
        dark = shares[row, column] > 0.55
        axis.text(column, row, str(count), ha="center", va="center",
                  color="white" if dark else "black")  # fmt: skip
    axis.set_xticks(range(len(columns)), columns)
    axis.set_yticks(range(len(rows)), rows)
    axis.set(xlabel="recognised", ylabel="asked for")
    return fig


def timelines(plans: Mapping[str, Float[np.ndarray, "T 24"]], words: str) -> Figure:
    """Timelines (`beyond/timeline.py`, 20 frames/s), one below another.

    The lines are how many times are still to come; a hill is each time, with its verb below it.
    """
    fig, axes = figure(9.5, 0.8 + 2.0 * len(plans), words, len(plans), 1, share="x")
    for axis, (name, plan) in zip(axes, plans.items(), strict=True):
        at = np.arange(len(plan)) / FPS
        for part, (whose, verbs) in enumerate((("legs", LEGS), ("arms", ARMS))):
            colour = OKABE_ITO[part]
            columns = plan[:, [VERBS.index(verb) for verb in verbs]]
            axis.fill_between(at, plan[:, MIDDLE + part], color=colour, alpha=0.35, lw=0)
            axis.plot(at, plan[:, TO_COME + part], color=colour, label=f"{whose}: to come")
            for verb, column in zip(verbs, columns.T, strict=True):
                for first, last in runs(column > 0.5):
                    axis.text((first + last) / 2 / FPS, -0.25 - 0.75 * part, verb, color=colour,
                              ha="center", va="top", fontsize=SMALL)  # fmt: skip
        axis.set_title(name, loc="left", fontsize=SMALL)
        axis.set(ylim=(-1.9, max(4.5, plan[:, TO_COME:MIDDLE].max() + 0.4)), yticks=range(5))
    axes[0].legend(loc="upper right")
    axes[-1].set_xlabel("time (s)")
    return fig
