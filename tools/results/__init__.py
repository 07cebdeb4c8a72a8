"""The papers' tables and figures, recomputed on the course's data.

`python -m tools.results` (or `make results`).
"""
