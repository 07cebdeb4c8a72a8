"""Walks: a commanded path in, a figure that walks it out.

And several right continuations of one past.
"""

from .styles import STYLES
from .walks import continuations, dataset, drawn_walk, random_control, walk

__all__ = ["STYLES", "continuations", "dataset", "drawn_walk", "random_control", "walk"]
