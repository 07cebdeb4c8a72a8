"""Figures from plain arrays, with matplotlib.

Colour-blind safe, readable on a projector, each with its caption.
"""
