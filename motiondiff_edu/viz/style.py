"""How all plots look.

Large type, Okabe-Ito colours, and a caption that goes with the picture as its alt text.
"""

import base64
import html
import io
import os
from collections.abc import Sequence

import matplotlib
from matplotlib import cycler  # type: ignore[attr-defined]  # not in the stubs
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Text

OKABE_ITO = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#F0E442")
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*")
DASHES = ("-", "--", "-.", ":", (0, (5, 1)), (0, (1, 1)), (0, (8, 2, 1, 2)), (0, (3, 3)))
LARGE = 16
MEDIUM = 14
SMALL = 12
# whether a notebook is shown to a room (`motiondiff-edu demo`)
PROJECTED = os.environ.get("MOTIONDIFF_LARGE", "0") not in ("", "0")
DPI = 150 if PROJECTED else 100  # pixels an inch

_RC = {
    "font.size": MEDIUM,
    "axes.titlesize": LARGE,
    "axes.labelsize": MEDIUM,
    "xtick.labelsize": SMALL,
    "ytick.labelsize": SMALL,
    "legend.fontsize": SMALL,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.prop_cycle": cycler(color=OKABE_ITO[:7]),
    "lines.linewidth": 2.2,
    "axes.grid": True,
    "grid.alpha": 0.25,
}


class CaptionedFigure(Figure):
    """A plot that shows itself, once, with its caption below it.

    The caption is its alternative text as well.
    """

    def _repr_mimebundle_(self, include=None, exclude=None) -> tuple[dict, dict]:
        png = base64.b64encode(self.as_png()).decode()
        bundle = {
            "text/html": _html(caption(self), png),
            "image/png": png,
            "text/plain": caption(self),
        }
        return bundle, {"texts": texts(self)}

    def as_png(self) -> bytes:
        """The plot as PNG bytes."""
        return _png(self, DPI)


def texts(fig: Figure) -> str:
    """All that is written in a plot; its numbers back what a notebook says of it."""
    return " ".join(text.get_text() for text in fig.findobj(Text) if text.get_text())


def as_html(fig: Figure, dpi: int = DPI) -> str:
    """The picture, with its caption below it and as its alternative text."""
    return _html(caption(fig), base64.b64encode(_png(fig, dpi)).decode())


def _png(fig: Figure, dpi: int) -> bytes:
    buffer = io.BytesIO()
    fig.savefig(buffer, format="png", dpi=dpi)
    return buffer.getvalue()


def _html(words: str, png: str) -> str:
    words = html.escape(words, quote=True)
    picture = f'<img alt="{words}" style="max-width:100%" src="data:image/png;base64,{png}">'
    return (
        f'<figure style="margin:0">{picture}<figcaption '
        f'style="max-width:60em">{words}</figcaption></figure>'
    )


SHARED = {
    "": {},
    "x": {"sharex": True},
    "y": {"sharey": True},
    "xy": {"sharex": True, "sharey": True},
    "rows": {"sharey": "row"},
}


def figure(
    width: float | int,
    height: float | int,
    words: str,
    rows: int = 1,
    columns: int = 1,
    *,
    share: str = "",
    widths: Sequence[float] | None = None,
    heights: Sequence[float] | None = None,
) -> tuple[CaptionedFigure, list[Axes]]:
    """A plot of `width` x `height` inches with its caption, and its axes, always as a list.

    `share`: axes with one scale, "x", "y", "xy", or "rows" (one y for each row).
    `widths`, `heights`: ratios of the columns and of the rows.
    """
    with matplotlib.rc_context(_RC):
        fig = CaptionedFigure(figsize=(width, height), layout="constrained")
        ratios = {"width_ratios": widths, "height_ratios": heights}
        axes = fig.subplots(rows, columns, squeeze=False, **SHARED[share], **ratios)
    fig.get_layout_engine().set(h_pad=0.1)
    fig.set_label(words)
    return fig, list(axes.flat)


def caption(fig: Figure) -> str:
    """What the plot shows, in a sentence or two.

    Its caption, and the text for those who cannot see it.
    """
    return str(fig.get_label())


def add_caption(fig: Figure, words: str) -> Figure:
    """Replace the caption, to say what is to be seen here; returns the plot."""
    fig.set_label(words)
    return fig


def table(axis: Axes, rows: Sequence[str], columns: Sequence[str]) -> None:
    """Make a table of an axis with a cell at each whole number.

    Names to the left and above, nothing else around.
    """
    axis.set_xticks(range(len(columns)), columns)
    axis.set_yticks(range(len(rows)), rows)
    axis.tick_params(length=0, top=True, labeltop=True, bottom=False, labelbottom=False)
    axis.grid(False)
    axis.spines[:].set_visible(False)


def legend(
    axis: Axes,
    *,
    loc: str | None = None,
    ncols: int = 1,
    frameon: bool = False,
    fontsize: float | int = SMALL,
    bbox_to_anchor: tuple[float, float] | None = None,
    handlelength: float | None = None,
    handletextpad: float | None = None,
) -> None:
    """A legend, where there is something to explain; parameters as of `Axes.legend`."""
    if axis.get_legend_handles_labels()[0]:
        axis.legend(
            loc=loc,
            ncols=ncols,
            frameon=frameon,
            fontsize=fontsize,
            bbox_to_anchor=bbox_to_anchor,
            handlelength=handlelength,
            handletextpad=handletextpad,
        )
