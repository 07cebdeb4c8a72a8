"""From keys in beats to curves in time: a dancer arrives on the beat, rests, and moves on.

Between two keys a movement is like a person's reach for something: it starts and ends with no speed
and no acceleration (the minimum-jerk quintic). `hold` is the share of the time between keys without
movement; `flow` mixes in a curve that passes through the keys without a stop.
"""

import numpy as np
from jaxtyping import Float
from scipy.interpolate import PchipInterpolator
from scipy.signal import cont2discrete, lfilter

# beats before the first and after the last, at the tempo there: the dance does not end with the
# music
AROUND = 8


def least_jerk(u: Float[np.ndarray, "*T"]) -> Float[np.ndarray, "*T"]:
    """From 0 to 1 as u does, with no speed and no acceleration at either end.

    10 u^3 - 15 u^4 + 6 u^5.
    """
    u = np.clip(u, 0.0, 1.0)
    return u * u * u * (10 + u * (6 * u - 15))


def felt_beats(
    beats: Float[np.ndarray, "K"], rng: np.random.Generator, jitter: float, off: float
) -> tuple[Float[np.ndarray, "N"], Float[np.ndarray, "N"]]:
    """The dancer's own times of each half beat.

    Returns seconds, and the beat's number (-AROUND ... K - 1 + AROUND).

    A time has an error of N(0, jitter) seconds, half beats 1.3 times that; all are late by `off`.
    """
    first, last = beats[1] - beats[0], beats[-1] - beats[-2]
    steps = np.arange(1, AROUND + 1)
    known = np.concatenate([beats[0] - first * steps[::-1], beats, beats[-1] + last * steps])
    number = np.arange(2 * len(known) - 1) / 2 - AROUND
    seconds = np.interp(number, np.arange(len(known)) - AROUND, known)
    miss = (
        jitter * rng.standard_normal(len(seconds)) * np.where(np.arange(len(seconds)) % 2, 1.3, 1.0)
    )
    least = np.diff(seconds).min()
    return seconds + np.clip(miss, -0.3 * least, 0.3 * least) + off, number


def curve(
    b: Float[np.ndarray, "T"], keys: list[tuple[float, float]], hold: float, flow: float
) -> Float[np.ndarray, "T"]:
    """The value of a channel at beats b; it is constant before the first and after the last key."""
    at, value = np.array(keys).T
    if len(at) == 1:
        return np.full(len(b), value[0])
    i = np.clip(np.searchsorted(at, b, side="right") - 1, 0, len(at) - 2)
    u = (b - at[i]) / (at[i + 1] - at[i])
    eased = value[i] + (value[i + 1] - value[i]) * least_jerk((u - hold / 2) / (1 - hold))
    if flow == 0.0:
        return eased
    return (1 - flow) * eased + flow * PchipInterpolator(at, value)(np.clip(b, at[0], at[-1]))


def within_reach(
    keys: list[tuple[float, float]], seconds: Float[np.ndarray, "K2"], fastest: float
) -> list[tuple[float, float]]:
    """The keys, limited to `fastest` per second from the one before.

    When there is too little time, a hit is smaller.
    """
    kept = [keys[0]]
    for i in range(1, len(keys)):
        most = fastest * (seconds[i] - seconds[i - 1])
        last = kept[-1][1]
        kept.append((keys[i][0], last + min(max(keys[i][1] - last, -most), most)))
    return kept


def springy(
    x: Float[np.ndarray, "T k"], fps: float, hertz: float, damping: float
) -> Float[np.ndarray, "T k"]:
    """A curve that follows x like a spring: a little late, and a little too far at first."""
    w = 2 * np.pi * hertz
    num, den, _ = cont2discrete(([w * w], [1.0, 2 * damping * w, w * w]), 1 / fps, "foh")
    return x[:1] + lfilter(np.squeeze(num), den, x - x[:1], axis=0)
