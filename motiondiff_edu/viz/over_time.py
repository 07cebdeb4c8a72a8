"""Parts of the plots and lanes of music: a waveform's outline, and maps with columns in time."""

import numpy as np
from jaxtyping import Float
from matplotlib.axes import Axes

from .body import INK


def edges_of(times: Float[np.ndarray, "M"]) -> Float[np.ndarray, "M1"]:
    """The edges of columns, halfway between their times; the outer columns are symmetric.

    A single column is one second wide.
    """
    if len(times) == 1:
        return np.array([times[0] - 0.5, times[0] + 0.5])
    middle = (times[1:] + times[:-1]) / 2
    return np.concatenate([[2 * times[0] - middle[0]], middle, [2 * times[-1] - middle[-1]]])


def lows_and_highs(
    samples: Float[np.ndarray, "N"], bins: int
) -> tuple[Float[np.ndarray, "K"], Float[np.ndarray, "K"], Float[np.ndarray, "K"]]:
    """First index, lowest and highest sample of each of (at most) `bins` equal pieces."""
    starts = np.linspace(0, len(samples), min(bins, len(samples)) + 1).astype(int)[:-1]
    low = np.minimum.reduceat(samples, starts)
    high = np.maximum.reduceat(samples, starts)
    return starts.astype(np.float64), low, high


def draw_waveform(
    axis: Axes, audio: Float[np.ndarray, "N"], sample_rate: float | int, bins: int = 1200
) -> None:
    """A waveform over seconds: the range of samples in each of `bins` pieces."""
    starts, low, high = lows_and_highs(audio, bins)
    axis.fill_between(starts / sample_rate, low, high, color=INK, lw=0)
    axis.set_yticks([])
    axis.grid(False)


def time_map(
    axis: Axes,
    values: Float[np.ndarray, "T M"],
    columns: Float[np.ndarray, "M"],
    seconds: float,
    colours: str = "Purples",
):
    """A map with rows evenly over `seconds`, from the top down, and columns at their times.

    Larger values are darker.
    """
    rows = np.linspace(0, seconds, len(values) + 1)
    image = axis.pcolormesh(
        edges_of(columns), rows, values, cmap=colours, vmin=min(0, values.min()), vmax=values.max()
    )
    axis.set_ylim(seconds, 0)
    axis.grid(False)
    return image
