"""Pitched instruments, made from one cycle of a wave.

The low partials last; the high ones decay first.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from jaxtyping import Float

from .song import SAMPLE_RATE

TABLE = 2048  # samples of one cycle


@dataclass(frozen=True)
class Voice:
    """A wave's partials, and its beginning and end; times are in seconds.

    `decay` is to 1/e; `sustain` the share that stays. `bloom` is how much later the partials from
    the third on come, as in brass. `early` is how far ahead of the beat a player begins, because
    the sound rises slowly.
    """

    roll: float  # partial k has amplitude k ** -roll
    odd: float = 1.0  # factor on the even partials
    attack: float = 0.004
    decay: float = 0.4
    sustain: float = 0.3
    release: float = 0.06
    bright: float = 0.15  # seconds until the partials from the third on have fallen to 1/e
    detune: float = 0.0  # cents between two strings
    vibrato: float = 0.0  # cents
    partials: tuple[float, ...] = ()  # amplitudes one by one, instead of roll and odd
    bloom: float = 0.0
    breath: float = 0.0  # noise of breath or bow, as a share of the tone
    early: float = 0.0


ORGAN = (1, 0.8, 0.5, 0.6, 0, 0.25, 0, 0.3)
BAR = (1, 0, 0, 0.45, 0, 0, 0, 0, 0, 0.12)
TINE = (1, 0.15, 0.05, 0.3, 0.04, 0, 0.12)
GUITAR = Voice(1.2, 0.8, 0.002, 0.5, 0.0, 0.08, 0.12, 4)
PIANO = Voice(1.3, 1.0, 0.002, 0.9, 0.05, 0.12, 0.2, 3)
TINES = Voice(1, 1, 0.002, 0.9, 0.1, 0.15, 0.1, 5, partials=TINE)
PAD = Voice(1.6, 0.9, 0.06, 2.0, 0.8, 0.25, 2.0, 14)
SAW = Voice(1.0, 1.0, 0.005, 0.3, 0.5, 0.06, 0.2, 12)
DRAWBARS = Voice(1, attack=0.003, sustain=0.7, bright=1, partials=ORGAN)
UPRIGHT = Voice(1.9, 1.0, 0.006, 0.5, 0.1, 0.05, 0.06)
ELECTRIC = Voice(1.4, 1.0, 0.003, 0.6, 0.35, 0.04, 0.1)
SYNTH = Voice(1.1, 1, 0.003, 0.2, 0.4, 0.03, 0.12)
SUB = Voice(2.6, 0.3, 0.005, 0.6, 0.6, 0.04)
WOODEN = Voice(1, attack=0.001, decay=0.25, sustain=0, bright=0.04, partials=BAR)
GLASS = Voice(2.5, 0.2, 0.001, 0.8, 0, 0.2, 0.1)
CLARINET = Voice(1.2, 0.15, 0.03, 1, 0.8, 0.08, 0.6, 0, 15)
FIDDLE = Voice(1.1, 0.9, 0.03, 1, 0.8, 0.1, 0.8, 0, 18)
SQUARE = Voice(1.0, 0.0, 0.001, 0.3, 0.5, 0.02, 2)
NASAL = Voice(1.0, 0.6, 0.001, 0.5, 0.6, 0.02, 2, 0, 14)
# timbre -> voice -> choices, of which a song draws one
VOICES = {
    "machine": {"bass": (SYNTH, SUB), "chords": (PAD, SAW, DRAWBARS), "lead": (SAW, SQUARE)},
    "acoustic": {
        "bass": (ELECTRIC, UPRIGHT),
        "chords": (PIANO, GUITAR),
        "lead": (GUITAR, PIANO, FIDDLE),
    },
    "brushes": {"bass": (UPRIGHT,), "chords": (PIANO, TINES, GUITAR), "lead": (CLARINET, PIANO)},
    "lofi": {"bass": (UPRIGHT, SUB), "chords": (TINES, PIANO, PAD), "lead": (TINES, GLASS)},
    "percussion": {
        "bass": (UPRIGHT, ELECTRIC),
        "chords": (PIANO, GUITAR, DRAWBARS),
        "lead": (FIDDLE, GUITAR),
    },
    "chip": {
        "bass": (Voice(2.0, 0.0, 0.001, 1, 0.8, 0.01, 2),),
        "chords": (SQUARE,),
        "lead": (NASAL, SQUARE),
    },
    "mallets": {"bass": (WOODEN,), "chords": (WOODEN, GLASS), "lead": (GLASS, TINES)},
}


@lru_cache(maxsize=1024)
def _cycle(voice: Voice, highest: int) -> tuple[np.ndarray, np.ndarray]:
    """One cycle with partials up to `highest` only, so that there is no aliasing.

    Returns its low and its high partials.
    """
    amplitude = np.array(
        voice.partials or [k**-voice.roll * (1 if k % 2 else voice.odd) for k in range(1, 33)]
    )
    k = np.arange(1, len(amplitude) + 1)
    amplitude = np.where(k <= highest, amplitude, 0.0)
    parts = []
    for chosen in (k <= 2, k > 2):
        spectrum = np.zeros(TABLE // 2 + 1, complex)
        spectrum[k] = np.where(chosen, amplitude, 0) * np.exp(
            2.4j * k * k
        )  # different phases, so that the wave has no spike
        parts.append(np.fft.irfft(spectrum, TABLE) * TABLE / np.sqrt((amplitude**2).sum()))
    return parts[0], parts[1]


def note(voice: Voice, pitch: int, seconds: float) -> Float[np.ndarray, "n"]:
    """One note of a MIDI pitch, held for `seconds`, then released."""
    hertz = 440.0 * 2 ** ((pitch - 69) / 12)
    t = np.arange(round((seconds + 5 * voice.release) * SAMPLE_RATE)) / SAMPLE_RATE
    dark, bright = _cycle(voice, int(0.45 * SAMPLE_RATE / hertz))
    cycles = hertz * t
    if voice.vibrato:  # begins late, as with singers and players
        depth = hertz * voice.vibrato * np.log(2) / 1200 * np.clip((t - 0.15) / 0.3, 0, 1)
        cycles = cycles + depth * np.sin(2 * np.pi * 5.3 * t) / (2 * np.pi * 5.3)
    glow = np.exp(-t / voice.bright)
    if voice.bloom:
        glow *= 1 - np.exp(-t / voice.bloom)
    ratios = (1.0,) if not voice.detune else 2.0 ** (np.array([-0.5, 0.5]) * voice.detune / 1200)
    y = np.zeros_like(t)
    for ratio in ratios:
        at = (ratio * TABLE * cycles).astype(np.int64) & (TABLE - 1)
        y += dark[at] + glow * bright[at]
    if voice.breath:
        y += voice.breath * len(ratios) * np.random.default_rng(pitch).standard_normal(len(t))
    shape = voice.sustain + (1 - voice.sustain) * np.exp(-t / voice.decay)
    shape = (
        shape
        * np.minimum(t / voice.attack, 1.0)
        * np.exp(-np.maximum(t - seconds, 0) / voice.release)
    )
    return y * shape / len(ratios)
