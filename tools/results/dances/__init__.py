"""Part of `python -m tools.results`: dances."""
