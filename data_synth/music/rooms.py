"""The sound of a room: direct sound first, then single echoes from the walls, then a tail.

All sound is mono at 16 kHz. The direct sound stays where it was, so a room moves no beat.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.signal import fftconvolve, lfilter

from .song import SAMPLE_RATE

FIRST_ECHO, TAIL = 0.004, 0.03  # seconds after the direct sound
ECHOES = 6  # from the floor, the ceiling and four walls


@dataclass(frozen=True)
class Room:
    """A room.

    seconds  in which the tail falls by 60 dB
    wet      energy of echoes and tail, as a fraction of the direct sound's
    dull     0 to 1: how much of the high frequencies the walls take away
    """

    seconds: float
    wet: float
    dull: float = 0.5


def impulse_response(room: Room, rng: np.random.Generator) -> Float[np.ndarray, "n"]:
    """The room's answer to a click: 1, then echoes up to 30 ms, then noise that decays.

    The amplitude falls as 10^(-3 t / seconds), which is 60 dB in `seconds`.
    """
    t = np.arange(round(1.2 * room.seconds * SAMPLE_RATE) + 2) / SAMPLE_RATE
    dull = 0.9 * room.dull
    later = lfilter([1 - dull], [1, -dull], rng.standard_normal(len(t)))
    later /= later.std()
    later[t < FIRST_ECHO] = 0.0
    early = (t >= FIRST_ECHO) & (t < TAIL)
    later[early] *= 0.3
    when = rng.uniform(FIRST_ECHO, TAIL, ECHOES)
    places = np.minimum((when * SAMPLE_RATE).astype(int), len(t) - 1)
    later[places] += rng.choice([-1.0, 1.0], ECHOES) * rng.uniform(3.0, 8.0, ECHOES)
    later *= 10 ** (-3 * t / room.seconds)
    later *= np.sqrt(room.wet / max((later**2).sum(), 1e-12))
    later[0] = 1.0
    return later


def in_room(
    audio: Float[np.ndarray, "N"], room: Room, rng: np.random.Generator
) -> Float[np.ndarray, "N"]:
    """The sound as it is heard in the room; what rings beyond the end is cut off."""
    return fftconvolve(audio, impulse_response(room, rng))[: len(audio)]
