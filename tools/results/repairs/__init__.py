"""Part of `python -m tools.results`: repairs."""
