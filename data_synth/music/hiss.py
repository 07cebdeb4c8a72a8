"""Noise of recordings: hiss, rumble and mains hum, at a given distance below the sound."""

import numpy as np
from jaxtyping import Float

from .song import SAMPLE_RATE

LOWEST = 20.0  # Hz: below it the noise's spectrum is flat


def coloured(n: int, slope: float, rng: np.random.Generator) -> Float[np.ndarray, "n"]:
    """Noise whose power falls as 1 / f^slope; mean power 1.

    0 is white noise (hiss), 1 pink noise (a room with people), 2 brown noise (rumble).
    """
    hertz = np.maximum(np.fft.rfftfreq(n, 1 / SAMPLE_RATE), LOWEST)
    noise = np.fft.irfft(np.fft.rfft(rng.standard_normal(n)) * hertz ** (-slope / 2), n)
    return noise / np.sqrt(np.mean(noise**2))


def hum(n: int, hertz: float, rng: np.random.Generator) -> Float[np.ndarray, "n"]:
    """Mains hum of 50 or 60 Hz with its multiples, each weaker than the last; mean power 1."""
    t = np.arange(n) / SAMPLE_RATE
    parts = [
        rng.uniform(0.3, 1.0) / k * np.sin(2 * np.pi * (k * hertz * t + rng.random()))
        for k in range(1, 7)
    ]
    wave = np.sum(parts, axis=0)
    return wave / np.sqrt(np.mean(wave**2))


def with_noise(
    audio: Float[np.ndarray, "N"], noise: Float[np.ndarray, "N"], decibel: float
) -> Float[np.ndarray, "N"]:
    """The sound plus a noise of mean power 1 whose level is `decibel` below the sound's mean.

    Silence gets no noise.
    """
    return audio + 10 ** (-decibel / 20) * np.sqrt(np.mean(audio**2)) * noise
