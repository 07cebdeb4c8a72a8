"""Plots of plain arrays with matplotlib, each with a caption.

The colours are safe for colour-blind readers, and the text is readable on a projector.
"""
