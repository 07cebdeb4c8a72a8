"""Widgets for notebooks. They show what the library computed, and compute nothing themselves."""
