"""A tone with bursts of noise: sound whose every hit is known."""

import numpy as np


def clicks(seconds: float, at: tuple[float, ...], tone: float = 0.1) -> np.ndarray:
    """A steady tone of 500 Hz, and short bursts of noise upon it."""
    t = np.arange(round(seconds * 16_000)) / 16_000
    sound = tone * np.sin(2 * np.pi * 500 * t)
    for moment in at:
        burst = np.where(t >= moment, np.exp(-np.maximum(t - moment, 0) / 0.02), 0.0)
        sound = sound + 0.5 * burst * np.random.default_rng(3).standard_normal(len(t))
    return sound.astype(np.float32)
