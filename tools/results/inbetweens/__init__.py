"""Part of `python -m tools.results`: inbetweens."""
