"""Dances to a song.

A dance has phrases of moves from the genre's vocabulary, on the beat, with feet that stay planted.
"""

from .performance import GENRES, Dance, dance, dances, dances_to, perform

__all__ = ["GENRES", "Dance", "dance", "dances", "dances_to", "perform"]
