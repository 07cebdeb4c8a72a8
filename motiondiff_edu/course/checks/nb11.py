"""Checks of notebook 11: hearing."""

import math

import numpy as np
import torch

from ._compare import compare
from ._drawn import tensors
from ._report import as_array, check, expect
from .zoo import several
from .zoo.nb11 import MISTAKES


def _spectra(rng: np.random.Generator):
    """Round numbers; with a silent frame; filters that all overlap."""
    X = torch.tensor([[3 + 4j, 0, 2j, 1], [0, 1j, 0, -2]], dtype=torch.complex64)
    filters = torch.tensor([[1.0, 0.5, 0, 0], [0, 0.5, 1, 0], [0, 0, 0, 0.25]])
    yield X, filters, 0.01
    yield torch.stack([X[0], torch.zeros(4)]), filters, 0.01
    mixed = torch.complex(tensors(rng, 4, 6), tensors(rng, 4, 6))
    mixed[2] *= 1e-4
    yield mixed, tensors(rng, 5, 6).abs(), 1e-3


def band_by_band(X, filters, floor: float) -> list:
    """Frame by frame and band by band, in plain Python."""
    return [
        [
            math.log(
                max(
                    floor,
                    sum(float(w) * abs(complex(x)) ** 2 for w, x in zip(band, frame, strict=True)),
                )
            )
            for band in filters
        ]
        for frame in X
    ]


@check
def log_mel_from_spectrum(mine):
    """mine(X, filters, floor) -> (M, bands)."""
    compare(
        mine, band_by_band, _spectra, "the log-Mel spectrogram", MISTAKES["log_mel_from_spectrum"]
    )
    return "With a floor of 1e-5, silence is log(1e-5) = -11.5."


@check
def mel_index(mine):
    """mine(T): nearest in time; where two are equally near, either is right."""
    late = {}
    for T in (1000, 7, 33):
        index = as_array(mine(T))
        expect(
            index.shape == (T,),
            f"for {T} motion frames there should be {T} indices, got shape {index.shape}",
        )
        expect((index == np.round(index)).all(), "an index is a whole number: round it")
        late[T] = index * 512 / 16_000 - np.arange(T) / 20
    if all((np.abs(times) <= 0.016 + 1e-6).all() for times in late.values()):
        return "At 49.95 s, motion is at frame 999, sound at frame 1561."
    for hint, wrong in MISTAKES["mel_index"].items():
        for one in several(wrong):
            same = all(np.array_equal(as_array(mine(T)), as_array(one(T))) for T in late)
            expect(not same, hint)
    T = next(T for T, times in late.items() if np.abs(times).max() > 0.016)
    worst = int(np.abs(late[T]).argmax())
    expect(
        False,
        f"of {T} frames, motion frame {worst} ({worst / 20:.2f} s) is matched with sound "
        f"{late[T][worst]:+.3f} s away from it",
    )


def _trackings(rng: np.random.Generator):
    """A missed first beat and two that do not exist; early beats; others, each with its own lag."""
    true = np.array([0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5])
    lags = np.array([0.01, 0.02, 0.05, 0.03, 0.06, 0.025])
    yield np.sort([*(true[1:] + lags), 1.79, 5.0]), true
    yield true[1:] - [0.03, 0.01, 0.02, 0.005, 0.04, 0.012], true
    beats = np.cumsum(rng.uniform(0.4, 0.7, size=12))
    found = beats[1:] + rng.normal(0.02, 0.03, size=11)
    yield np.sort([*found[:4], *found[5:], beats[6] + 0.19, beats[-1] + 2.0]), beats


def typical(found: np.ndarray, true: np.ndarray) -> float:
    """Beat by beat; then the one in the middle."""
    lags = sorted(beat - min(true, key=lambda one: abs(beat - one)) for beat in found)
    n = len(lags)
    return (lags[(n - 1) // 2] + lags[n // 2]) / 2


@check
def tracker_lag(mine):
    """mine(found, true): the lag that does not follow a few wrong beats."""
    compare(mine, typical, _trackings, "the lag", MISTAKES["tracker_lag"])
    return "We can subtract a constant lag, but not a wrong beat."
