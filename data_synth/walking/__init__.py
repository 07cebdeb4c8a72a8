"""Walks: a figure walks along a commanded path.

One past has several right continuations.
"""

from .styles import STYLES
from .walks import continuations, dataset, drawn_walk, random_control, walk

__all__ = ["STYLES", "continuations", "dataset", "drawn_walk", "random_control", "walk"]
