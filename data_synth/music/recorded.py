"""A recording of a song: what a room, a microphone, a studio and a file format do to its sound.

    audio = recorded(song.audio, np.random.default_rng(3))

Everything is drawn from the rng. The beats stay where they are: no effect delays the sound.
The order is that of real life: the room, the desk (equaliser, compressor, overload), noise, fades,
the file, and the level at which it is played.
"""

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from .coding import coded
from .effects import (
    Compressor,
    at_rate,
    clipped,
    compressed,
    equalised,
    faded,
    levelled,
    limited,
    saturated,
)
from .hiss import coloured, hum, with_noise
from .rooms import Room, in_room
from .song import SAMPLE_RATE, Song

# Hz, where an equaliser's curve bends
EQUALISER = np.array([30.0, 60, 120, 250, 500, 1000, 2000, 4000, 7000])


def recorded(audio: Float[np.ndarray, "N"], rng: np.random.Generator) -> Float[np.ndarray, "N"]:
    """A recording of clean mono sound at 16 kHz, as float32; no sample is beyond 1."""
    y = levelled(np.asarray(audio, np.float64), -20.0, peak=np.inf)
    for heard in (_room, _desk, _overload, _noise, _fades, _file, _level):
        y = heard(y, rng.spawn(1)[0])
    return y.astype(np.float32)


def recorded_song(song: Song, seed: int) -> Song:
    """The same song with the sound of a recording; its score does not change."""
    return replace(song, audio=recorded(song.audio, np.random.default_rng([song.seed, seed, 51])))


def _room(y: Float[np.ndarray, "N"], rng: np.random.Generator) -> Float[np.ndarray, "N"]:
    """Usually a small room or a studio's reverb, sometimes a hall."""
    hall = rng.random() < 0.25
    seconds = rng.uniform(1.0, 2.4) if hall else rng.uniform(0.1, 0.8)
    wet = rng.uniform(0.1, 0.8) if hall else rng.uniform(0.02, 0.5)
    return in_room(y, Room(seconds, wet, rng.uniform(0.2, 0.95)), rng)


def _desk(y: Float[np.ndarray, "N"], rng: np.random.Generator) -> Float[np.ndarray, "N"]:
    """A curve that wanders, tilts and rolls off at both ends; then a compressor."""
    octaves = np.log2(EQUALISER / 500)
    gains = rng.uniform(0.5, 3.0) * rng.standard_normal(len(EQUALISER))
    gains += rng.normal(-0.8, 1.2) * octaves
    if rng.random() < 0.3:  # a small loudspeaker
        gains -= np.maximum(rng.uniform(-2, 0) - octaves, 0) * 12
    if rng.random() < 0.3:  # an old or distant recording
        gains -= np.maximum(octaves - rng.uniform(1, 3), 0) * 12
    y = equalised(y, EQUALISER, np.clip(gains, -45, 15))
    y = levelled(y, -20.0, peak=np.inf)
    if rng.random() < 0.75:
        threshold, ratio = rng.uniform(-32, -14), rng.uniform(1.5, 8)
        attack, release = rng.uniform(0.003, 0.03), rng.uniform(0.05, 0.5)
        y = compressed(y, Compressor(threshold, ratio, attack, release))
    return y


def _overload(y: Float[np.ndarray, "N"], rng: np.random.Generator) -> Float[np.ndarray, "N"]:
    """A limiter, tape, or an input with too much gain; or nothing of this."""
    kind = rng.choice(["nothing", "limiter", "tape", "clipping"], p=[0.3, 0.4, 0.2, 0.1])
    ceiling = float(max(np.percentile(np.abs(y), rng.uniform(98.5, 99.9)), 1e-6))
    if kind == "limiter":
        return limited(y, ceiling)
    if kind == "tape":
        return saturated(y, 1 / ceiling)
    return clipped(y, 1.5 * ceiling) if kind == "clipping" else y


def _noise(y: Float[np.ndarray, "N"], rng: np.random.Generator) -> Float[np.ndarray, "N"]:
    """Hiss that is usually hardly heard; one recording in six hums."""
    y = with_noise(y, coloured(len(y), rng.uniform(0, 1.5), rng), _distance(rng))
    if rng.random() < 1 / 6:
        y = with_noise(y, hum(len(y), float(rng.choice([50.0, 60.0])), rng), rng.uniform(25, 50))
    return y


def _distance(rng: np.random.Generator) -> float:
    """Decibels of the noise below the sound: clean in most recordings, noisy in some."""
    return float(rng.uniform(45, 80) if rng.random() < 0.75 else rng.uniform(18, 45))


def _fades(y: Float[np.ndarray, "N"], rng: np.random.Generator) -> Float[np.ndarray, "N"]:
    """One recording in seven fades in, one in seven fades out; the others only have soft edges."""
    longest = min(len(y) / SAMPLE_RATE / 4, 6.0)
    slow = rng.random(2) < 1 / 7
    fade_in, fade_out = np.where(slow, rng.uniform(0.2, 1.0, 2) * longest, 0.003)
    return faded(y, float(fade_in), float(fade_out))


def _file(y: Float[np.ndarray, "N"], rng: np.random.Generator) -> Float[np.ndarray, "N"]:
    """Lossy coding of most recordings; a few have a low sample rate."""
    if rng.random() < 0.06:
        y = at_rate(y, 2)
    if rng.random() < 0.6:
        y = coded(y, np.exp(rng.uniform(np.log(0.1), np.log(1.2))), rng.uniform(4500, 8000))
    return y


def _level(y: Float[np.ndarray, "N"], rng: np.random.Generator) -> Float[np.ndarray, "N"]:
    """A mean level between -30 and -8 dB, as far as no sample passes 1."""
    return levelled(y, rng.uniform(-30, -8))


__all__ = ["recorded", "recorded_song"]
