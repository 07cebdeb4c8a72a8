"""Who plays: a kit put together from many, and voices from pools, each a little different.

No mallets: that timbre is kept for judging (song.HELD_OUT_TIMBRE).
"""

from dataclasses import dataclass, replace

import numpy as np

from .kits import KITS, METAL, SKIN, Strike
from .song import DRUMS, TRAINING_TIMBRES
from .voices import VOICES, Voice

MORE_KITS = {
    "deep electronic": {
        "kick": Strike(1.0, 0.95, 160, 44, 0.04, 0.45, low=800, high=4000, fade=0.006),
        "snare": Strike(0.7, 0.5, 330, 180, 0.015, 0.07, low=900, high=7900, fade=0.09),
        "clap": Strike(0.7, 0.0, low=1000, high=3000, fade=0.16, bursts=4),
        "rim": Strike(0.5, 0.9, 1700, 1700, 0.01, 0.012, (1.32,), low=2500, fade=0.004),
        "hat": Strike(0.35, 0.05, 5200, 5200, decay=0.015, overtones=METAL[:2], low=6500, high=7950,
                      fade=0.022, shape="square"),
        "open hat": Strike(0.35, 0.05, 5200, 5200, decay=0.1, overtones=METAL[:2], low=6000,
                           high=7950, fade=0.16, shape="square"),
        "shaker": Strike(0.3, 0.0, low=5000, high=7900, fade=0.03, attack=0.004),
        "tom": Strike(0.75, 0.97, 165, 80, 0.06, 0.3, low=400, high=2000, fade=0.01),
        "crash": Strike(0.4, 0.6, 790, 790, decay=0.25, overtones=(1.48,), low=2000, high=6000,
                        fade=0.1, shape="square"),
    },
    "noisy electronic": {
        "kick": Strike(1.0, 0.7, 400, 55, 0.02, 0.16, (2.0,), low=300, high=7000, fade=0.03,
                       shape="square"),
        "snare": Strike(0.8, 0.1, 200, 150, 0.02, 0.05, low=400, high=7900, fade=0.2),
        "clap": Strike(0.7, 0.0, low=500, high=7900, fade=0.12, bursts=5),
        "rim": Strike(0.5, 0.4, 3300, 2100, 0.005, 0.015, low=3000, high=7900, fade=0.02),
        "hat": Strike(0.35, 0.3, 4100, 3900, decay=0.03, overtones=METAL, low=3000, high=7950,
                      fade=0.015, shape="square"),
        "open hat": Strike(0.35, 0.2, 4100, 3900, decay=0.1, overtones=METAL, low=2500, high=7950,
                           fade=0.3, shape="square"),
        "shaker": Strike(0.3, 0.0, low=2000, high=7900, fade=0.02, attack=0.02),
        "tom": Strike(0.7, 0.8, 420, 90, 0.08, 0.16, low=500, high=5000, fade=0.05),
        "crash": Strike(0.4, 0.0, low=800, high=7900, fade=0.9),
    },
    "swept brushes": {
        "kick": Strike(0.7, 0.95, 85, 66, 0.03, 0.12, SKIN[:1], low=300, high=1200, fade=0.02,
                       attack=0.004),
        "snare": Strike(0.5, 0.05, 200, 195, 0.02, 0.04, low=1800, high=7500, fade=0.14,
                        attack=0.012),
        "clap": Strike(0.4, 0.0, low=1500, high=6500, fade=0.1, attack=0.01),
        "rim": Strike(0.45, 0.85, 1150, 1140, 0.01, 0.02, (2.6,), low=1500, fade=0.008),
        "hat": Strike(0.4, 0.5, 2900, 2900, decay=0.25, overtones=METAL, low=4000, high=7800,
                      fade=0.12),
        "open hat": Strike(0.3, 0.1, 3300, 3300, decay=0.05, overtones=METAL, low=3500, high=7000,
                           fade=0.05, attack=0.002),
        "shaker": Strike(0.3, 0.0, low=2200, high=7500, fade=0.1, attack=0.015),
        "tom": Strike(0.55, 0.9, 118, 104, 0.04, 0.25, SKIN, low=300, high=1500, fade=0.04,
                      attack=0.003),
        "crash": Strike(0.35, 0.5, 1750, 1750, decay=1.1, overtones=METAL, low=2500, high=7500,
                        fade=0.9, attack=0.004),
    },
    "big room": {
        "kick": Strike(1.0, 0.75, 105, 54, 0.03, 0.22, SKIN[:2], low=900, high=5500, fade=0.02),
        "snare": Strike(0.9, 0.45, 205, 178, 0.02, 0.16, SKIN, low=900, high=7800, fade=0.24),
        "clap": Strike(0.6, 0.0, low=800, high=6000, fade=0.2, bursts=4),
        "rim": Strike(0.5, 0.7, 760, 740, 0.01, 0.03, (1.7, 3.1), low=1200, fade=0.02),
        "hat": Strike(0.4, 0.2, 2700, 2700, decay=0.06, overtones=METAL, low=3500, high=7900,
                      fade=0.07),
        "open hat": Strike(0.4, 0.2, 2700, 2700, decay=0.35, overtones=METAL, low=3000, high=7900,
                           fade=0.4),
        "shaker": Strike(0.3, 0.3, 5300, 5300, decay=0.05, overtones=(1.17, 1.36), low=4500,
                         high=7900, fade=0.06, bursts=2),
        "tom": Strike(0.8, 0.85, 128, 92, 0.05, 0.4, SKIN, low=600, high=3500, fade=0.05),
        "crash": Strike(0.5, 0.15, 1150, 1150, decay=0.9, overtones=METAL, low=1800, high=7900,
                        fade=1.0),
    },
    "hands": {
        "kick": Strike(0.9, 0.9, 95, 78, 0.02, 0.16, (1.9,), low=400, high=2500, fade=0.01,
                       attack=0.001),
        "snare": Strike(0.6, 0.6, 520, 470, 0.01, 0.05, SKIN, low=1500, high=6500, fade=0.03),
        "clap": Strike(0.55, 0.0, low=900, high=3800, fade=0.04, bursts=3),
        "rim": Strike(0.5, 0.9, 1950, 1900, 0.01, 0.02, (2.4,), low=2000, fade=0.006),
        "hat": Strike(0.35, 0.45, 6100, 6100, decay=0.08, overtones=(1.09, 1.22), low=5000,
                      high=7900, fade=0.06, bursts=2),
        "open hat": Strike(0.35, 0.6, 5400, 5400, decay=0.3, overtones=(1.13, 1.31), low=4500,
                           high=7900, fade=0.2),
        "shaker": Strike(0.35, 0.0, low=3500, high=7900, fade=0.05, attack=0.018),
        "tom": Strike(0.75, 0.9, 215, 196, 0.015, 0.16, SKIN, low=900, high=4500, fade=0.012),
        "crash": Strike(0.35, 0.7, 6400, 6350, decay=0.6, overtones=(1.05, 1.17), low=5000,
                        high=7900, fade=0.5),
    },
    "parade": {
        "kick": Strike(1.0, 0.88, 78, 60, 0.05, 0.4, SKIN[:2], low=200, high=1200, fade=0.03,
                       attack=0.003),
        "snare": Strike(0.7, 0.2, 310, 290, 0.01, 0.05, SKIN[:2], low=2200, high=7900, fade=0.08),
        "clap": Strike(0.5, 0.0, low=1100, high=5000, fade=0.05, bursts=3),
        "rim": Strike(0.5, 0.8, 1400, 1380, 0.01, 0.02, (1.9,), low=2500, fade=0.01),
        "hat": Strike(0.3, 0.6, 4300, 4300, decay=0.5, overtones=(1.5, 2.2), low=4000, high=7900,
                      fade=0.1),
        "open hat": Strike(0.45, 0.3, 950, 950, decay=0.7, overtones=METAL, low=2000, high=7900,
                           fade=0.6, attack=0.002),
        "shaker": Strike(0.3, 0.2, 5600, 5600, decay=0.06, overtones=(1.2,), low=4500, high=7900,
                         fade=0.05, bursts=2),
        "tom": Strike(0.75, 0.92, 98, 88, 0.04, 0.5, SKIN, low=300, high=1500, fade=0.04),
        "crash": Strike(0.5, 0.25, 700, 700, decay=1.2, overtones=METAL, low=1200, high=7900,
                        fade=1.1),
    },
}  # fmt: skip

CHURCH = (1, 0.9, 0.1, 0.7, 0, 0.2, 0, 0.5)
REEDS = (1, 0.7, 0.8, 0.4, 0.5, 0.3, 0.35, 0.2, 0.2, 0.1)
FLUTE = (1, 0.4, 0.12, 0.05)
AH = (0.8, 1, 0.9, 0.55, 0.3, 0.12, 0.1, 0.15, 0.2, 0.12)
OO = (1, 0.5, 0.12, 0.04, 0.02, 0.05, 0.04)
NYLON = Voice(1.4, 0.9, 0.001, 0.45, 0, 0.05, 0.08, 2)
STEEL = Voice(0.9, 0.9, 0.001, 0.8, 0, 0.08, 0.25, 5)
HARP = Voice(1.8, 0.6, 0.001, 1.0, 0, 0.3, 0.1)
BANJO = Voice(0.7, 0.9, 0.001, 0.2, 0, 0.03, 0.06)
HARPSICHORD = Voice(0.6, 1, 0.001, 0.5, 0, 0.04, 0.5, 2)
PIZZICATO = Voice(1.5, 0.8, 0.002, 0.12, 0, 0.06, 0.04)
STRINGS = Voice(1.0, 0.95, 0.06, 2, 0.85, 0.12, 3, 16, 8, breath=0.06, early=0.025)
MARKED_STRINGS = Voice(0.9, 0.95, 0.02, 0.2, 0.35, 0.07, 1, 14, breath=0.08, early=0.008)
CELLO = Voice(1.2, 0.8, 0.05, 1.5, 0.8, 0.1, 2, 0, 14, breath=0.05, early=0.02)
ORGAN = Voice(1, attack=0.02, sustain=1.0, bright=9, partials=CHURCH, early=0.008)
ACCORDION = Voice(1, 1, 0.03, 1, 0.9, 0.05, 9, 18, partials=REEDS, early=0.012)
BRASS = Voice(0.7, 1, 0.03, 0.5, 0.7, 0.06, 4, 10, 6, bloom=0.04, early=0.012)
TRUMPET = Voice(0.5, 1, 0.025, 0.7, 0.75, 0.06, 3, 0, 16, bloom=0.03, early=0.01)
HORN = Voice(1.3, 1, 0.05, 0.8, 0.8, 0.1, 3, 6, 5, bloom=0.08, early=0.02)
SAXOPHONE = Voice(0.8, 0.85, 0.02, 0.8, 0.75, 0.07, 3, 0, 14, bloom=0.03, breath=0.06, early=0.008)
FLUTES = Voice(1, 1, 0.03, 1, 0.85, 0.07, 2, 0, 12, FLUTE, breath=0.12, early=0.012)
SINGER = Voice(1, 1, 0.035, 0.8, 0.75, 0.08, 3, 0, 30, AH, breath=0.05, early=0.015)
CHOIR = Voice(1, 1, 0.08, 2, 0.9, 0.2, 3, 26, 10, OO, breath=0.05, early=0.035)
WIDE_SAW = Voice(0.9, 1, 0.004, 0.5, 0.7, 0.08, 1, 30)
PLUCKED_SYNTH = Voice(0.9, 1, 0.002, 0.15, 0.05, 0.08, 0.05, 10)
FUZZ = Voice(0.35, 1, 0.004, 1.5, 0.7, 0.04, 4, 6, 4, breath=0.03)
TUBA = Voice(1.2, 1, 0.025, 0.5, 0.6, 0.06, 1, bloom=0.03, breath=0.03, early=0.01)
BOWED_BASS = Voice(1.1, 0.8, 0.05, 1.5, 0.8, 0.12, 2, 4, 8, breath=0.06, early=0.02)
SLAP = Voice(0.7, 1, 0.001, 0.25, 0.15, 0.03, 0.08)
PEDALS = Voice(1, attack=0.015, sustain=0.95, bright=9, partials=(1, 0.6, 0.1, 0.3), early=0.006)
LONG_SUB = Voice(2.8, 0.2, 0.004, 0.8, 0.3, 0.08)
GROWL = Voice(0.8, 1, 0.005, 0.5, 0.7, 0.05, 1, 28)
MORE_VOICES = {
    "bass": (TUBA, BOWED_BASS, SLAP, PEDALS, LONG_SUB, GROWL, PIZZICATO, STEEL),
    "chords": (NYLON, STEEL, HARP, BANJO, HARPSICHORD, PIZZICATO, STRINGS, MARKED_STRINGS, ORGAN,
               ACCORDION, BRASS, HORN, CHOIR, WIDE_SAW, PLUCKED_SYNTH, FUZZ),
    "lead": (NYLON, STEEL, BANJO, HARPSICHORD, PIZZICATO, STRINGS, CELLO, ACCORDION, TRUMPET, HORN,
             SAXOPHONE, FLUTES, SINGER, WIDE_SAW, PLUCKED_SYNTH, FUZZ),
}  # fmt: skip


@dataclass(frozen=True)
class Band:
    """The instruments of a song: a kit, and for every part the voices that play it together."""

    name: str
    kit: dict[str, Strike]
    voices: dict[str, tuple[Voice, ...]]


def draw_band(rng: np.random.Generator) -> Band:
    """A band. Some kits are whole, some have each drum from another kit."""
    kits = {name: KITS[name] for name in TRAINING_TIMBRES} | MORE_KITS
    names = list(rng.choice(list(kits), len(DRUMS)))
    if rng.random() < 0.6:
        names = names[:1] * len(DRUMS)
    kit = {
        drum: _own_strike(kits[name][drum], rng) for drum, name in zip(DRUMS, names, strict=True)
    }
    voices = {}
    for part, more in MORE_VOICES.items():
        pool = [*more, *(v for name in TRAINING_TIMBRES for v in VOICES[name][part])]
        players = 2 if part != "bass" and rng.random() < 0.25 else 1
        chosen = rng.integers(len(pool), size=players)
        voices[part] = tuple(own_voice(pool[k], rng) for k in chosen)
    return Band(str(names[0]), kit, voices)


def own_voice(voice: Voice, rng: np.random.Generator) -> Voice:
    """One player's instrument: brighter or duller, and longer or shorter than others."""
    roll, decay, bright, release = np.exp(rng.normal(0, (0.15, 0.3, 0.4, 0.2)))
    return replace(
        voice,
        roll=voice.roll * float(roll),
        decay=voice.decay * float(decay),
        bright=voice.bright * float(bright),
        release=voice.release * float(release),
        sustain=float(np.clip(voice.sustain * np.exp(rng.normal(0, 0.2)), 0, 1)),
        breath=voice.breath * float(np.exp(rng.normal(0, 0.5))),
    )


def _own_strike(strike: Strike, rng: np.random.Generator) -> Strike:
    """A drum of another size and tension; its band of noise moves along."""
    pitch, ring, band = np.exp(rng.normal(0, (0.15, 0.3, 0.15)))
    low = min(strike.low * float(band), 6500.0)
    return replace(
        strike,
        start=strike.start * float(pitch),
        end=strike.end * float(pitch),
        decay=strike.decay * float(ring),
        fade=strike.fade * float(ring),
        low=low,
        high=min(max(strike.high * float(band), 1.2 * low), 7900.0),
    )
