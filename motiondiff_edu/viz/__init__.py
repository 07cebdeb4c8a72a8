"""Figures from plain arrays, with matplotlib: colour-blind safe, readable on a projector, each with
its caption."""
