"""Figures from plain arrays, with matplotlib: colour-blind safe, large enough for a projector, each with its caption."""
