"""Measures whose intervals are over persons: windows of one person are not independent."""

from collections.abc import Callable

import numpy as np
from jaxtyping import Float

from ..walks.scores import Measure, measure_of
from .windows import person_of


def by_source(
    name: str, unit: str, value: Callable, values: Float[np.ndarray, "N"], sources: np.ndarray
) -> Measure:
    """A measure whose interval is over persons: all windows of one are drawn together."""
    whose = np.array([person_of(source) for source in sources])
    persons = [values[whose == person] for person in sorted(set(whose))]
    rows = np.empty(len(persons), dtype=object)
    rows[:] = persons
    if not len(rows):
        return Measure(name, np.nan, np.nan, np.nan, unit)
    return measure_of(name, unit, lambda drawn: value(np.concatenate(list(drawn))), rows)
