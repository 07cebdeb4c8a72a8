"""What a mixing desk does to a sound: equaliser, compressor, limiter, clipping, fades, level.

All sound is mono at 16 kHz. No effect delays the sound, so none moves a beat.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.ndimage import minimum_filter1d, uniform_filter1d
from scipy.signal import resample_poly

from .song import SAMPLE_RATE

BLOCK = 64  # samples (4 ms) over which a compressor measures the level
AHEAD = 80  # samples (5 ms) by which a limiter turns down before a peak
TINY = 1e-12


def decibels(power: Float[np.ndarray, "*n"]) -> Float[np.ndarray, "*n"]:
    """10 log10 of a power; a full-scale square wave has 0 dB, a full-scale sine -3 dB."""
    return 10 * np.log10(power + TINY)


def equalised(
    audio: Float[np.ndarray, "N"], hertz: Float[np.ndarray, "k"], gains: Float[np.ndarray, "k"]
) -> Float[np.ndarray, "N"]:
    """The sound with each frequency louder by `gains` decibels.

    Between the given frequencies (ascending, above 0) the gain is linear in the logarithm of the
    frequency, and beyond them it is constant. The filter is symmetric in time, so it has no delay.
    """
    padded = len(audio) + SAMPLE_RATE // 2
    spectrum = np.fft.rfft(audio, padded)
    each = np.maximum(np.fft.rfftfreq(padded, 1 / SAMPLE_RATE), 1.0)
    gain = np.interp(np.log(each), np.log(hertz), gains)
    return np.fft.irfft(spectrum * 10 ** (gain / 20), padded)[: len(audio)]


@dataclass(frozen=True)
class Compressor:
    """Settings of a compressor.

    threshold  level in dB above which it turns down
    ratio      a sound that is x dB above the threshold leaves x / ratio dB above it
    attack     seconds in which it follows a rising level
    release    seconds in which it follows a falling level
    """

    threshold: float
    ratio: float
    attack: float = 0.01
    release: float = 0.15


def compressed(audio: Float[np.ndarray, "N"], compressor: Compressor) -> Float[np.ndarray, "N"]:
    """The sound with its loud moments turned down; quiet ones do not change."""
    blocks = -(-len(audio) // BLOCK)
    power = np.pad(audio, (0, blocks * BLOCK - len(audio))).reshape(blocks, BLOCK)
    level = followed(decibels((power**2).mean(1)), compressor)
    gain = -np.maximum(level - compressor.threshold, 0.0) * (1 - 1 / compressor.ratio)
    middles = BLOCK * (np.arange(blocks) + 0.5)
    return audio * 10 ** (np.interp(np.arange(len(audio)), middles, gain) / 20)


def followed(level: Float[np.ndarray, "n"], compressor: Compressor) -> Float[np.ndarray, "n"]:
    """The level (dB, one value a block) as a compressor measures it: smoothed over time.

    It follows a rise within the attack and a fall within the release (to 1/e).
    """
    rising = np.exp(-BLOCK / SAMPLE_RATE / compressor.attack)
    falling = np.exp(-BLOCK / SAMPLE_RATE / compressor.release)
    now = float(level[0])
    followed = []
    for aim in level.tolist():
        keep = rising if aim > now else falling
        now = keep * now + (1 - keep) * aim
        followed.append(now)
    return np.array(followed)


def limited(audio: Float[np.ndarray, "N"], ceiling: float) -> Float[np.ndarray, "N"]:
    """The sound with no sample beyond the ceiling, turned down smoothly around each peak.

    Sound further than 5 ms from a peak above the ceiling does not change.
    """
    gain = np.minimum(1.0, ceiling / np.maximum(np.abs(audio), TINY))
    lowest = minimum_filter1d(gain, 2 * AHEAD + 1, mode="nearest")
    smooth = uniform_filter1d(lowest, AHEAD + 1, mode="nearest")
    # in exact arithmetic the smoothed gain is never above `gain`; rounding may put it there
    return np.clip(audio * np.minimum(smooth, 1.0), -ceiling, ceiling)


def clipped(audio: Float[np.ndarray, "N"], ceiling: float) -> Float[np.ndarray, "N"]:
    """The sound with every sample beyond the ceiling cut off, as by an input with too much gain."""
    return np.clip(audio, -ceiling, ceiling)


def saturated(audio: Float[np.ndarray, "N"], drive: float) -> Float[np.ndarray, "N"]:
    """The sound through an overdriven amplifier or tape: tanh(drive x) / drive.

    Quiet sound does not change; nothing is beyond 1 / drive.
    """
    return np.tanh(drive * audio) / drive


def faded(
    audio: Float[np.ndarray, "N"], fade_in: float | int, fade_out: float | int
) -> Float[np.ndarray, "N"]:
    """The sound faded in and out over so many seconds; the gain is a quarter of a sine's period."""
    n = np.arange(len(audio)) / SAMPLE_RATE
    up = np.clip(n / fade_in, 0, 1) if fade_in else np.ones(len(audio))
    down = np.clip((n[-1] - n) / fade_out, 0, 1) if fade_out else np.ones(len(audio))
    return audio * np.sin(np.pi / 2 * up) * np.sin(np.pi / 2 * down)


def at_rate(audio: Float[np.ndarray, "N"], divisor: int) -> Float[np.ndarray, "N"]:
    """The sound after a recording at 16 kHz / divisor: frequencies above half of that are gone."""
    if divisor == 1:
        return audio
    return resample_poly(resample_poly(audio, 1, divisor), divisor, 1)[: len(audio)]


def levelled(
    audio: Float[np.ndarray, "N"], decibel: float, peak: float = 0.99
) -> Float[np.ndarray, "N"]:
    """The sound at a mean level (dB; a full-scale square wave has 0), quieter where it would
    pass `peak`. Silence stays silent.
    """
    largest, mean = np.abs(audio).max(), np.sqrt(np.mean(audio**2))
    if largest == 0:
        return audio
    return audio * min(10 ** (decibel / 20) / mean, peak / largest)


def loudness(audio: Float[np.ndarray, "N"]) -> float:
    """The mean level in dB."""
    return float(10 * np.log10(np.mean(audio**2) + TINY))
