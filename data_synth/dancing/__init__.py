"""Dances to a song.

Phrases of moves from the genre's own vocabulary, on the beat, on feet that stay planted.
"""

from .performance import GENRES, Dance, dance, dances, perform

__all__ = ["GENRES", "Dance", "dance", "dances", "perform"]
