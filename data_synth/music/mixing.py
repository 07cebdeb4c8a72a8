"""From strokes and notes to one sound: each is rendered once and added at its times.

Room and loudness follow.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.signal import butter, fftconvolve, lfilter, sosfilt

from .form import LEAD, Form
from .grooves import Hit
from .harmony import Note
from .kits import KITS, TOM_PITCH, Strike, own_kit, softer, sound
from .song import DRUMS, SAMPLE_RATE
from .voices import VOICES, Voice, note

SOFTNESSES = 6  # strengths at which a drum is rendered; in between only its loudness differs
LEVELS = {
    "drums": 0.0,
    "bass": -3.5,
    "chords": -8.0,
    "lead": -8.5,
}  # dB, before each song's own balance


@dataclass(frozen=True, eq=False)
class Played:
    """Strokes with the player's timing: seconds and strength, one entry a stroke."""

    hits: list[Hit]
    seconds: Float[np.ndarray, "n"]
    velocity: Float[np.ndarray, "n"]


def play(form: Form, hits: list[Hit], rng: np.random.Generator) -> Played:
    """Add a player's unevenness: each drum has its own mean delay, and strokes vary, at most 15 ms.

    The beats themselves do not change.
    """
    spread, uneven = rng.uniform(0.001, 0.005), rng.uniform(0.03, 0.1)
    habit = dict(zip(DRUMS, rng.uniform(-0.003, 0.005, len(DRUMS)), strict=True))
    wander = spread * rng.standard_normal(len(hits)) + np.array([habit[hit.drum] for hit in hits])
    loud = np.array([hit.velocity for hit in hits]) * np.exp(
        uneven * rng.standard_normal(len(hits))
    )
    seconds = form.at(np.array([hit.position for hit in hits])) + np.clip(wander, -0.015, 0.015)
    return Played(hits, seconds, np.clip(loud, 0.05, 1.0))


def _add(out: np.ndarray, second: float, y: np.ndarray, gain: float) -> None:
    """Add y into `out`, whose sample 0 lies LEAD seconds before the recording."""
    first = round((second + LEAD) * SAMPLE_RATE)
    if first < 0:
        y, first = y[-first:], 0
    y = y[: max(0, len(out) - first)]
    out[first : first + len(y)] += gain * y


def drum_bus(
    played: Played, kit: dict[str, Strike], length: int, rng: np.random.Generator
) -> Float[np.ndarray, "N"]:
    """All strokes; each drum has three sounds, so that no two in a row are the same."""
    ready = {}
    out = np.zeros(length)
    sources = dict(
        zip(DRUMS, rng.spawn(len(DRUMS)), strict=True)
    )  # a drum's sound does not depend on the other drums
    raw = {}
    for drum in sorted({hit.drum for hit in played.hits}):
        pitches = TOM_PITCH if drum == "tom" else np.exp(sources[drum].normal(0, 0.015, 3))
        raw[drum] = [sound(kit[drum], sources[drum], float(pitch)) for pitch in pitches]
    for hit, second, velocity in zip(played.hits, played.seconds, played.velocity, strict=True):
        step = min(int(velocity * SOFTNESSES), SOFTNESSES - 1)
        key = (hit.drum, hit.sound, step)
        middle = (step + 0.5) / SOFTNESSES
        if key not in ready:
            ready[key] = softer(raw[hit.drum][hit.sound], middle)
        _add(out, second, ready[key], (velocity / middle) ** 1.3)
    return out


def voice_bus(
    form: Form, notes: Sequence[Note], voice: Voice, length: int, rng: np.random.Generator
) -> Float[np.ndarray, "N"]:
    """All notes of one voice."""
    ready = {}
    out = np.zeros(length)
    if not notes:
        return out
    start = form.at(np.array([n.position for n in notes]))
    end = form.at(np.array([n.position + n.length for n in notes]))
    start_jitter = np.clip(0.004 * rng.standard_normal(len(notes)), -0.01, 0.01)
    for n, first, last, late in zip(notes, start, end, start_jitter, strict=True):
        if -LEAD < first < length / SAMPLE_RATE:
            key = (n.pitch, round((last - first) * 50))
            if key not in ready:
                ready[key] = note(voice, n.pitch, max(key[1], 1) / 50)
            _add(out, first + late - voice.early, ready[key], n.velocity)
    return out


def duck(played: Played, length: int, depth: float, recover: float) -> Float[np.ndarray, "N"]:
    """Gain that falls at each kick and comes back within `recover` seconds."""
    push = np.zeros(length)
    for hit, second in zip(played.hits, played.seconds, strict=True):
        at = round((second + LEAD) * SAMPLE_RATE)
        if hit.drum == "kick" and 0 <= at < length:
            push[at] = 1.0
    a = np.exp(-1 / (recover * SAMPLE_RATE))
    return 1 - depth * np.minimum(lfilter([1], [1, -a], push), 1.0)


def room(
    y: Float[np.ndarray, "N"], seconds: float, rng: np.random.Generator
) -> Float[np.ndarray, "N"]:
    """The sound of the room alone.

    It is noise that falls by 60 dB in `seconds`, and gets duller towards its end.
    """
    t = np.arange(round(seconds * SAMPLE_RATE)) / SAMPLE_RATE
    tail = lfilter([0.5], [1, -0.5], rng.standard_normal(len(t))) * 10 ** (-3 * t / seconds)
    tail[: round(0.008 * SAMPLE_RATE)] = 0
    return fftconvolve(y, tail / np.sqrt((tail**2).sum()))[: len(y)]


def compress(y: Float[np.ndarray, "N"], amount: float) -> Float[np.ndarray, "N"]:
    """Smoothly turn down sounds that are louder than the average.

    With `amount` 0 nothing changes; with 1 they become nearly the average.
    """
    a = np.exp(-1 / (0.03 * SAMPLE_RATE))
    loud = lfilter([1 - a], [1, -a], y * y)
    usual = np.mean(y * y) + 1e-12
    return y * (1 + loud / usual) ** (-0.5 * amount)


def mix(
    form: Form,
    played: Played,
    notes: list[Note],
    genre: str,
    timbre: str,
    seconds: float,
    rng: np.random.Generator,
) -> Float[np.ndarray, "N"]:
    """The finished recording: balance, ducking, room, filters, compression, hiss.

    Its peak is 0.8 to 0.95.
    """
    strokes, voices, space, noise = rng.spawn(4)
    length = round((LEAD + seconds) * SAMPLE_RATE)
    n = round(seconds * SAMPLE_RATE)
    buses = {"drums": drum_bus(played, own_kit(KITS[timbre], strokes), length, strokes)}
    for kind, choices in VOICES[timbre].items():
        voice = choices[int(voices.integers(len(choices)))]
        own = [x for x in notes if x.voice == kind]
        buses[kind] = voice_bus(form, own, voice, length, voices)
    balance = dict(zip(buses, rng.normal(0, (2.0, 2.0, 3.0, 3.0)), strict=True))
    ducked = rng.random() < (0.8 if genre == "house" else 0.2)
    gain = duck(played, length, rng.uniform(0.3, 0.75) if ducked else 0.0, rng.uniform(0.06, 0.16))
    dry, wet = np.zeros(length), np.zeros(length)
    for kind, bus in buses.items():
        level = np.sqrt(np.mean(bus**2))
        if level > 0:
            bus = (
                bus
                * 10 ** ((LEVELS[kind] + balance[kind]) / 20)
                / level
                * (1 if kind == "drums" else gain)
            )
            dry += bus
            wet += {"bass": 0.0, "drums": 0.5}.get(kind, 1.0) * bus
    y = dry + rng.uniform(0.05, 0.3) * room(wet, rng.uniform(0.3, 1.2), space)
    return _master(y[-n:], timbre, rng, noise)


def _master(
    y: np.ndarray, timbre: str, rng: np.random.Generator, noise: np.random.Generator
) -> np.ndarray:
    low = rng.uniform(25, 60) if rng.random() < 0.8 else rng.uniform(100, 220)
    high = rng.uniform(2500, 6000)
    y = sosfilt(butter(2, low, "high", fs=SAMPLE_RATE, output="sos"), y)
    if rng.random() < (0.9 if timbre == "lofi" else 0.15):
        y = sosfilt(butter(2, high, "low", fs=SAMPLE_RATE, output="sos"), y)
    y = compress(y, rng.uniform(0.0, 0.5))
    drive = rng.uniform(0.3, 1.3)
    y = np.tanh(drive * y / max(np.percentile(np.abs(y), 99.5), 1e-9)) / drive
    y = y + 10 ** (rng.uniform(-75, -48) / 20) * noise.standard_normal(len(y))
    edge = min(round(0.003 * SAMPLE_RATE), len(y) // 2)
    y[:edge] *= np.linspace(0, 1, edge)
    y[len(y) - edge :] *= np.linspace(1, 0, edge)
    return (rng.uniform(0.8, 0.95) * y / max(np.abs(y).max(), 1e-9)).astype(np.float32)
