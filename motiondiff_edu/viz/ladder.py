"""A comparison of recipes: a row per recipe, a panel per measure, a dot per training run."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from textwrap import wrap

from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

from .body import GREY
from .style import MARKERS, OKABE_ITO, figure

WIDE = 5


@dataclass(frozen=True)
class Rung:
    """A row: its label, its group, and for each measure a value for each training seed.

    None stands for a training that gave no number.
    """

    words: str
    group: str
    values: Mapping[str, Sequence[float | None]]


def ladder(rungs: Sequence[Rung], measures: Sequence[str], words: str) -> Figure:
    """Dots of all seeds; groups differ in colour and marker.

    An axis is logarithmic where its values differ by more than a factor of WIDE.
    A line marks the mean of the group's first row. The other rows of the group differ from that row
    in one choice. Values that are not positive or not finite are left out.
    """
    groups = list(dict.fromkeys(rung.group for rung in rungs))
    panels = len(measures)
    fig, axes = figure(5 + 3.2 * panels, 1.6 + 0.34 * len(rungs), words, 1, panels, share="y")
    for axis, measure in zip(axes, measures, strict=True):
        for row, rung in enumerate(rungs):
            k = groups.index(rung.group)
            seen = _drawn(rung, measure)
            axis.plot(
                seen, [row] * len(seen), MARKERS[k % 8], color=OKABE_ITO[k % 7], ms=7, alpha=0.8
            )
        for k, group in enumerate(groups):
            rows = [row for row, rung in enumerate(rungs) if rung.group == group]
            first = _drawn(rungs[rows[0]], measure)
            if first:
                mean = sum(first) / len(first)
                axis.plot([mean, mean], [rows[0], rows[-1]], "--", color=OKABE_ITO[k % 7], lw=1.2)
            if k:
                axis.axhline(rows[0] - 0.5, color=GREY, lw=0.8)
        axis.set_title("\n".join(wrap(measure, 28)))
        drawn = [x for rung in rungs for x in _drawn(rung, measure)]
        if drawn and max(drawn) > WIDE * min(drawn):
            axis.set_xscale("log")
            axis.xaxis.set_major_formatter(lambda x, _: f"{x:g}")
            axis.xaxis.set_minor_formatter(NullFormatter())
        axis.set_yticks(range(len(rungs)), [rung.words for rung in rungs])
    axes[0].invert_yaxis()
    return fig


def _drawn(rung: Rung, measure: str) -> list[float]:
    """The values that can be drawn, also on a logarithmic axis."""
    return [x for x in rung.values.get(measure, ()) if x is not None and 0 < x < float("inf")]
