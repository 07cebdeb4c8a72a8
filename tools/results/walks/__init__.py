"""Part of `python -m tools.results`: walks."""
