"""Part of `python -m tools.results`: page."""
