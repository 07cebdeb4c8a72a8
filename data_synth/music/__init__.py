"""Songs with known beats: composed, played and recorded from one seed."""

from .composer import SONGS_A_SEED, compose, songs
from .song import GENRES, SAMPLE_RATE, Song

__all__ = ["GENRES", "SAMPLE_RATE", "SONGS_A_SEED", "Song", "compose", "songs"]
