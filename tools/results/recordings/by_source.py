"""Measures whose intervals are over recordings: windows of one file are not independent."""

from collections.abc import Callable

import numpy as np
from jaxtyping import Float

from ..walks.scores import Measure, measure_of


def by_source(
    name: str, unit: str, value: Callable, values: Float[np.ndarray, "N"], sources: np.ndarray
) -> Measure:
    """A measure whose interval is over files: all windows of a file are drawn together."""
    files = [values[sources == file] for file in sorted(set(sources))]
    rows = np.empty(len(files), dtype=object)
    rows[:] = files
    if not len(rows):
        return Measure(name, np.nan, np.nan, np.nan, unit)
    return measure_of(name, unit, lambda drawn: value(np.concatenate(list(drawn))), rows)
