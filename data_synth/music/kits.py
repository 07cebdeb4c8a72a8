"""Synthesised drums.

Each is a struck body (a tone whose pitch falls) and noise between two frequencies, which decay.
"""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.signal import butter, lfilter, sosfilt

from .song import SAMPLE_RATE


@dataclass(frozen=True)
class Strike:
    """The sound of a drum; Hz and seconds. A `shape` of "square" buzzes, "sine" is pure."""

    level: float
    body: float  # share of the tone; the rest is noise
    start: float = 200.0  # Hz when struck
    end: float = 200.0  # Hz at the end
    bend: float = 0.02
    decay: float = 0.1
    overtones: tuple[float, ...] = ()  # further partials, as multiples
    low: float = 500.0  # the noise's band
    high: float = 7500.0
    fade: float = 0.05
    attack: float = 0.0005
    bursts: int = 1
    shape: str = "sine"


SKIN = (1.59, 2.14, 2.65)
METAL = (1.34, 1.73, 2.11, 2.63, 3.17)
WOOD = (2.76, 5.4)
MACHINE = {
    "kick": Strike(1.0, 0.85, 230, 48, 0.03, 0.2, low=1500, high=6000, fade=0.008),
    "snare": Strike(0.75, 0.35, 260, 185, 0.02, 0.09, low=1200, high=7000, fade=0.11),
    "clap": Strike(0.75, 0.0, low=900, high=4500, fade=0.11, bursts=3),
    "rim": Strike(0.45, 0.8, 1750, 1650, 0.01, 0.018, (1.48,), low=2000, fade=0.01),
    "hat": Strike(
        0.42,
        0.1,
        3100,
        3100,
        decay=0.02,
        overtones=METAL,
        low=5500,
        high=7800,
        fade=0.03,
        shape="square",
    ),
    "open hat": Strike(
        0.4,
        0.1,
        3100,
        3100,
        decay=0.2,
        overtones=METAL,
        low=5000,
        high=7800,
        fade=0.2,
        shape="square",
    ),
    "shaker": Strike(0.3, 0.0, low=3800, high=7500, fade=0.04, attack=0.008),
    "tom": Strike(0.7, 0.95, 190, 105, 0.05, 0.2, low=500, high=3000, fade=0.02),
    "crash": Strike(
        0.45,
        0.1,
        2700,
        2700,
        decay=0.6,
        overtones=METAL,
        low=3000,
        high=7800,
        fade=0.7,
        shape="square",
    ),
}
KITS = {
    "machine": MACHINE,
    "acoustic": {
        "kick": Strike(1.0, 0.82, 130, 62, 0.02, 0.12, SKIN[:1], low=1500, high=5000, fade=0.01),
        "snare": Strike(0.8, 0.4, 220, 195, 0.02, 0.1, SKIN, low=1800, high=7500, fade=0.14),
        "clap": Strike(0.6, 0.0, low=1100, high=5500, fade=0.07, bursts=4, attack=0.001),
        "rim": Strike(0.5, 0.75, 980, 960, 0.01, 0.02, (1.8, 3.9), low=1500, fade=0.012),
        "hat": Strike(0.35, 0.15, 3450, 3450, decay=0.03, overtones=METAL[:3], low=4500, high=7900,
                      fade=0.04),
        "open hat": Strike(0.34, 0.15, 3450, 3450, decay=0.3, overtones=METAL[:3], low=4000,
                           high=7900, fade=0.25),
        "shaker": Strike(0.28, 0.0, low=3200, high=7000, fade=0.035, attack=0.01),
        "tom": Strike(0.75, 0.9, 150, 115, 0.04, 0.24, SKIN, low=800, high=3500, fade=0.03),
        "crash": Strike(0.42, 0.2, 1450, 1450, decay=0.7, overtones=METAL, low=2500, high=7900,
                        fade=0.8),
    },
    "brushes": {
        "kick": Strike(0.85, 0.9, 95, 70, 0.03, 0.15, SKIN[:1], low=400, high=2000, fade=0.02,
                       attack=0.003),
        "snare": Strike(0.6, 0.15, 210, 200, 0.02, 0.06, SKIN[:2], low=1500, high=6500, fade=0.1,
                        attack=0.006),
        "clap": Strike(0.5, 0.1, 900, 880, 0.01, 0.03, low=1200, high=3500, fade=0.05,
                       attack=0.002),
        "rim": Strike(0.45, 0.85, 820, 810, 0.01, 0.025, (2.3,), low=1500, fade=0.01),
        "hat": Strike(0.4, 0.35, 2350, 2350, decay=0.12, overtones=METAL, low=4500, high=7500,
                      fade=0.08),
        "open hat": Strike(0.35, 0.4, 2100, 2100, decay=0.4, overtones=METAL, low=4000, high=7500,
                           fade=0.3),
        "shaker": Strike(0.3, 0.0, low=2500, high=6000, fade=0.06, attack=0.012),
        "tom": Strike(0.6, 0.93, 130, 108, 0.04, 0.2, SKIN[:2], low=400, high=2000, fade=0.03,
                      attack=0.002),
        "crash": Strike(0.32, 0.4, 1250, 1250, decay=0.9, overtones=METAL, low=2500, high=7000,
                        fade=0.7, attack=0.003),
    },
    "percussion": {
        "kick": Strike(1.0, 0.9, 110, 72, 0.03, 0.22, SKIN[:1], low=500, high=3000, fade=0.012),
        "snare": Strike(0.65, 0.7, 380, 330, 0.01, 0.06, SKIN, low=1500, high=5500, fade=0.025),
        "clap": Strike(0.5, 0.95, 560, 555, 0.01, 0.09, (1.48, 2.9), low=2000, fade=0.01,
                       shape="square"),
        "rim": Strike(0.5, 0.97, 2450, 2400, 0.01, 0.03, (1.02,), low=2500, fade=0.004),
        "hat": Strike(0.4, 0.0, low=3500, high=7500, fade=0.03, attack=0.004),
        "open hat": Strike(0.35, 0.6, 2900, 2900, decay=0.3, overtones=METAL[:2], low=5000,
                           high=7900, fade=0.1),
        "shaker": Strike(0.36, 0.0, low=3000, high=7000, fade=0.05, attack=0.01),
        "tom": Strike(0.7, 0.92, 290, 255, 0.02, 0.11, SKIN, low=900, high=4000, fade=0.015),
        "crash": Strike(0.4, 0.3, 2200, 2200, decay=0.6, overtones=METAL, low=3000, high=7900,
                        fade=0.5),
    },
    "chip": {
        "kick": Strike(0.9, 0.95, 330, 42, 0.035, 0.11, shape="square", low=300, high=3000,
                       fade=0.02),
        "snare": Strike(0.6, 0.15, 240, 160, 0.02, 0.05, shape="square", low=700, high=6000,
                        fade=0.08),
        "clap": Strike(0.5, 0.0, low=1500, high=5000, fade=0.05, bursts=2),
        "rim": Strike(0.35, 0.9, 1300, 1100, 0.01, 0.02, shape="square", fade=0.008),
        "hat": Strike(0.35, 0.0, low=4500, high=7900, fade=0.018),
        "open hat": Strike(0.33, 0.0, low=4000, high=7900, fade=0.12),
        "shaker": Strike(0.27, 0.0, low=3000, high=7900, fade=0.025, attack=0.002),
        "tom": Strike(0.6, 0.95, 300, 120, 0.07, 0.13, shape="square", low=500, high=4000,
                      fade=0.02),
        "crash": Strike(0.4, 0.0, low=1500, high=7900, fade=0.4),
    },
    "mallets": {
        "kick": Strike(0.9, 0.97, 82, 96, 0.06, 0.2, (2.3,), low=300, high=1500, fade=0.01,
                       attack=0.002),
        "snare": Strike(0.65, 0.9, 430, 415, 0.01, 0.07, WOOD, low=1000, high=4000, fade=0.02),
        "clap": Strike(0.55, 0.9, 700, 690, 0.01, 0.06, WOOD, low=1500, high=5000, fade=0.015),
        "rim": Strike(0.5, 0.95, 1250, 1240, 0.01, 0.03, WOOD[:1], low=2000, fade=0.006),
        "hat": Strike(0.4, 0.5, 3800, 3750, decay=0.025, low=3000, high=6500, fade=0.02,
                      attack=0.002),
        "open hat": Strike(0.36, 0.8, 3300, 3300, decay=0.35, overtones=(1.004, 1.5), low=4500,
                           fade=0.1),
        "shaker": Strike(0.32, 0.0, low=1800, high=4500, fade=0.06, attack=0.01, bursts=2),
        "tom": Strike(0.7, 0.95, 205, 225, 0.05, 0.18, (2.3, 3.9), low=500, high=2500, fade=0.02,
                      attack=0.001),
        "crash": Strike(0.4, 0.75, 1700, 1690, decay=0.8, overtones=(1.41, 1.9, 2.3), low=3000,
                        fade=0.4),
    },
}  # fmt: skip
KITS["lofi"] = {  # a drum machine, recorded badly
    name: replace(
        s, high=min(s.high, 5200.0), low=0.6 * s.low, decay=0.8 * s.decay, fade=0.75 * s.fade
    )
    for name, s in MACHINE.items()
}
TOM_PITCH = (1.35, 1.0, 0.75)  # high to low


def _envelope(t: np.ndarray, decay: float, attack: float, bursts: int = 1) -> np.ndarray:
    """Rise in `attack` seconds, and fall to 1/e in `decay` seconds.

    Of several bursts 11 ms apart only the last rings.
    """
    env = np.minimum(t / attack, 1.0) * np.exp(-np.maximum(t - attack, 0) / decay)
    for k in range(1, bursts):
        after = t - 0.011 * k
        fresh = np.maximum(
            env * np.exp(-after.clip(0) / 0.004), _envelope(after.clip(0), decay, attack)
        )
        env = np.where(after > 0, fresh, env)
    return env


def own_kit(kit: dict[str, Strike], rng: np.random.Generator) -> dict[str, Strike]:
    """One player's kit: tuned, damped and balanced a little differently each time."""
    own = {}
    for name, strike in kit.items():
        pitch, ring, loud = np.exp(rng.normal(0, (0.09, 0.2, 0.25)))
        if name in ("hat", "open hat", "shaker"):
            loud *= np.exp(rng.normal(-0.15, 0.35))
        own[name] = replace(
            strike,
            level=strike.level * loud,
            start=strike.start * pitch,
            end=strike.end * pitch,
            decay=strike.decay * ring,
            fade=strike.fade * ring,
        )
    return own


def sound(strike: Strike, rng: np.random.Generator, pitch: float = 1.0) -> Float[np.ndarray, "n"]:
    """One stroke at full strength, peak `level`."""
    longest = max(strike.decay if strike.body > 0 else 0.0, strike.fade if strike.body < 1 else 0.0)
    t = (
        np.arange(
            round(min(6.0 * longest + strike.attack + 0.011 * strike.bursts, 1.6) * SAMPLE_RATE)
        )
        / SAMPLE_RATE
    )
    bent = strike.bend * (1 - np.exp(-t / strike.bend))
    cycles = pitch * (strike.end * t + (strike.start - strike.end) * bent)
    tone = np.zeros_like(t)
    for k, ratio in enumerate((1.0, *strike.overtones)):
        if pitch * ratio * max(strike.start, strike.end) < 0.48 * SAMPLE_RATE:
            wave = np.sin(2 * np.pi * ratio * cycles)
            wave = np.tanh(4 * wave) if strike.shape == "square" else wave
            tone += wave * 0.6**k * np.exp(-t / (strike.decay / (1 + 0.5 * k)))
    band = butter(
        2, [strike.low, min(strike.high, 0.495 * SAMPLE_RATE)], "band", fs=SAMPLE_RATE, output="sos"
    )
    hiss = sosfilt(band, rng.standard_normal(len(t))) * _envelope(
        t, strike.fade, strike.attack, strike.bursts
    )
    tone *= np.minimum(t / strike.attack, 1.0)
    tone, hiss = (part / max(np.abs(part).max(), 1e-9) for part in (tone, hiss))
    y = (strike.body * tone + (1 - strike.body) * hiss) * np.clip(
        (t[-1] - t) / (0.4 * t[-1]), 0, 1
    )  # the end fades out, also that of a cymbal
    return strike.level * y / np.abs(y).max()


def softer(y: Float[np.ndarray, "n"], velocity: float) -> Float[np.ndarray, "n"]:
    """The same stroke played softly is quieter and duller."""
    a = np.clip(0.65 * (1 - velocity), 0.0, 0.6)
    return velocity**1.3 * lfilter([1 - a], [1, -a], y)
