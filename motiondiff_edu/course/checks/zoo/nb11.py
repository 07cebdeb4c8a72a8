"""Wrong answers to the exercises of notebook 11."""

import numpy as np
import torch


def _power(X, filters):
    return (X.abs() ** 2) @ filters.T


def magnitude(X, filters, floor):
    """Adds magnitudes in the bands; energies should be added, the squares of them."""
    return (X.abs() @ filters.T).clamp(min=floor).log()


def no_floor(X, filters, floor):
    """Silence becomes minus infinity, and one such value ruins every mean."""
    return _power(X, filters).log()


def floor_after_the_log(X, filters, floor):
    """Silence gets the floor itself instead of its logarithm."""
    return torch.nan_to_num(_power(X, filters).log(), neginf=floor)


def _gaps(found, true):
    return found[:, None] - true[None, :]


def _nearest(found, true):
    gaps = _gaps(found, true)
    return gaps[np.arange(len(found)), np.abs(gaps).argmin(1)]


ZOO = {
    "log_mel_from_spectrum": {
        "magnitude for power": magnitude,
        "log of zero": no_floor,
        "floor put on the logarithm": floor_after_the_log,
        "floor added": lambda X, filters, floor: (_power(X, filters) + floor).log(),
        "logarithm before the bands": lambda X, filters, floor: (
            (X.abs() ** 2).clamp(min=floor).log() @ filters.T
        ),
        "decibels": lambda X, filters, floor: 10 * _power(X, filters).clamp(min=floor).log10(),
        "bands before time": lambda X, filters, floor: _power(X, filters).clamp(min=floor).log().T,
        "real part for magnitude": lambda X, filters, floor: (
            (X.real**2 @ filters.T).clamp(min=floor).log()
        ),
    },
    "mel_index": {
        "aligned by index": lambda T: torch.arange(T),
        "32 frames a second": lambda T: torch.round(torch.arange(T) * 32 / 20).long(),
        "clocks swapped": lambda T: torch.round(torch.arange(T) * 20 / 31.25).long(),
        "cut off": lambda T: (torch.arange(T) * 1.5625).long(),
        "n_fft for the hop": lambda T: torch.round(torch.arange(T) / 20 * 16_000 / 1024).long(),
        "not whole": lambda T: torch.arange(T) * 1.5625,
        "Hz for seconds": lambda T: torch.round(torch.arange(T) * 20 / 512).long(),
    },
    "tracker_lag": {
        "mean": lambda found, true: _nearest(found, true).mean(),
        "sign turned": lambda found, true: -np.median(_nearest(found, true)),
        "by index": lambda found, true: np.median(found[: len(true)] - true[: len(found)]),
        "sizes": lambda found, true: np.median(np.abs(_nearest(found, true))),
        "all pairs": lambda found, true: np.median(_gaps(found, true)),
    },
}
