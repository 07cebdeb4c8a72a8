"""Plots of repairs: errors over the length of a gap, and a map of dropout rate against what is
missing.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float
from matplotlib.figure import Figure

from .style import DASHES, MARKERS, MEDIUM, OKABE_ITO, figure, legend, table

Line = tuple[
    Sequence[float], Sequence[float], Sequence[float], Sequence[float]
]  # x, value, low, high


def over_gaps(
    panels: Mapping[str, Mapping[str, Line]],
    words: str,
    xlabel: str = "length of the gap (frames of 1/20 s)",
    log: Sequence[str] = (),
) -> Figure:
    """One panel for each measure, with a line for each method and its 95 % interval shaded.

    Measures in `log` have a logarithmic axis.
    """
    fig, axes = figure(4.8 * len(panels), 6.0, words, 1, len(panels))
    for axis, (measure, lines) in zip(axes, panels.items(), strict=True):
        for i, (name, (x, value, low, high)) in enumerate(lines.items()):
            line = axis.plot(x, value, ls=DASHES[i % 8], marker=MARKERS[i % 8], label=name)[0]
            axis.fill_between(x, low, high, color=line.get_color(), alpha=0.15, lw=0)
        axis.set(
            xlabel=xlabel,
            title=measure,
            **({"yscale": "log"} if measure in log else {"ylim": (0, None)}),
        )
        axis.set_xticks(x)
        legend(axis, loc="upper center", bbox_to_anchor=(0.5, -0.16), fontsize=MEDIUM)
    return fig


def by_fault(
    panels: Mapping[str, Mapping[str, tuple[float, float, float]]], words: str, xlabel: str
) -> Figure:
    """A panel for each fault, with a row (value, low, high) for each method of repair.

    The axis is logarithmic; further left is better.
    """
    fig, axes = figure(4.6 * len(panels), 4.2, words, 1, len(panels))
    names = list(dict.fromkeys(name for ways in panels.values() for name in ways))
    for axis, (fault, ways) in zip(axes, panels.items(), strict=True):
        for name, (value, low, high) in ways.items():
            row = names.index(name)
            style = {"fmt": MARKERS[row % 8], "color": OKABE_ITO[row % 7], "capsize": 4}
            axis.errorbar(value, row, xerr=[[value - low], [high - value]], **style)
        axis.set(
            xscale="log",
            xlabel=xlabel,
            title=fault,
            yticks=range(len(names)),
            ylim=(len(names) - 0.5, -0.5),
        )
        axis.set_xticks([1, 2, 5, 10, 20], ["1", "2", "5", "10", "20"])
        axis.set_xticks([], minor=True)
        axis.set_yticklabels(names if axis is axes[0] else [])
    return fig


def rate_map(
    panels: Mapping[str, Float[np.ndarray, "R M"]],
    rates: Sequence[str],
    missing: Sequence[str],
    words: str,
) -> Figure:
    """A map for each measure: dropout rates in rows, missing shares of the past in columns.

    The numbers are errors, so small is good. Colours compare within a column; the worst rate for a
    missing share is dark.
    """
    fig, axes = figure(1.2 + 5.0 * len(panels), 1.4 + 0.5 * len(rates), words, 1, len(panels))
    for axis, (measure, errors) in zip(axes, panels.items(), strict=True):
        low, high = errors.min(0), errors.max(0)
        shade = (errors - low) / np.maximum(high - low, 1e-12)
        axis.imshow(shade, cmap="Oranges", vmin=0, vmax=1.6, aspect="auto")
        for (row, column), error in np.ndenumerate(errors):
            weight = "bold" if error == low[column] else "normal"
            axis.text(column, row, f"{error:.3g}", ha="center", va="center", fontweight=weight)
        table(axis, rates, missing)
        axis.set_xlabel(f"share of the joints missing: {measure}", fontsize=MEDIUM)
    axes[0].set_ylabel("rate of dropout", fontsize=MEDIUM)
    return fig
