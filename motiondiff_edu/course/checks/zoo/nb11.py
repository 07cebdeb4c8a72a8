"""Wrong answers to the exercises of notebook 11."""

import math

import numpy as np
import torch


def _power(X, filters):
    return (X.abs() ** 2) @ filters.T


def _log(change=lambda power, floor: power.clamp(min=floor).log(), power=_power):
    return lambda X, filters, floor: change(power(X, filters), floor)


def _largest(X, filters):
    """The loudest frequency of each band instead of the sum."""
    return ((X.abs() ** 2)[:, None] * filters).amax(-1)


def _gaps(found, true):
    return found[:, None] - true[None, :]


def _nearest(found, true):
    gaps = _gaps(found, true)
    return gaps[np.arange(len(found)), np.abs(gaps).argmin(1)]


def _last_before(found, true):
    """Compares with the last true beat before each found one."""
    at = np.clip(np.searchsorted(true, found, side="right") - 1, 0, None)
    return found - true[at]


MISTAKES = {
    "log_mel_from_spectrum": {
        "those are magnitudes; power is their square": _log(
            power=lambda X, filters: X.abs() @ filters.T
        ),
        "square each magnitude, then add up: the square of a sum is something else": (
            _log(power=lambda X, filters: (X.abs() @ filters.T) ** 2),
            _log(power=lambda X, filters: (X @ filters.T.to(X.dtype)).abs() ** 2),
        ),
        "that is the power of the real part; the imaginary part sounds, too": _log(
            power=lambda X, filters: X.real**2 @ filters.T
        ),
        "a band adds up its frequencies; this takes the largest": _log(power=_largest),
        "a band adds up its frequencies; this takes their mean": _log(
            power=lambda X, filters: _power(X, filters) / filters.shape[1]
        ),
        "the bands come first; here time comes first: return (M, bands)": _log(
            lambda power, floor: power.clamp(min=floor).log().T
        ),
        "that is the logarithm to base 10": _log(
            lambda power, floor: power.clamp(min=floor).log10()
        ),
        "that is the logarithm to base 2": _log(lambda power, floor: power.clamp(min=floor).log2()),
        "that is in decibels": _log(lambda power, floor: 10 * power.clamp(min=floor).log10()),
        "that is log(1 + power), in which soft sounds almost disappear": _log(
            lambda power, floor: power.log1p()
        ),
        "the logarithm is still missing": (
            _log(lambda power, floor: power),
            _log(lambda power, floor: power.clamp(min=floor)),
        ),
        "the floor was added; it is a lower limit": _log(
            lambda power, floor: (power + floor).log()
        ),
        "in silence it is minus infinity: limit the power to the floor before the logarithm": _log(
            lambda power, floor: power.log()
        ),
        "the floor limits the logarithm; it should limit the power": (
            _log(lambda power, floor: power.log().clamp(min=floor)),
            _log(lambda power, floor: torch.nan_to_num(power.log(), neginf=floor)),
        ),
        "the floor is a lower limit, not an upper one": _log(
            lambda power, floor: power.clamp(max=floor).log()
        ),
        "first the bands, then the logarithm: the filters add up power": lambda X, filters, floor: (
            (X.abs() ** 2).clamp(min=floor).log() @ filters.T
        ),
        "the floor belongs to the power in a band, not to that of a frequency": (
            lambda X, filters, floor: ((X.abs() ** 2).clamp(min=floor) @ filters.T).log()
        ),
    },
    "mel_index": {
        "that matches by index, frame t with frame t. Their frame rates differ": torch.arange,
        "a second has 31.25 Mel frames, not 32: after 50 s that is 1.2 s off": lambda T: (
            torch.round(torch.arange(T) * 32 / 20).long()
        ),
        "the two frame rates are swapped": lambda T: torch.round(
            torch.arange(T) * 20 / 31.25
        ).long(),
        "that is the frame before, not the nearest one: round, do not truncate": lambda T: (
            torch.arange(T) * 1.5625
        ).long(),
        "that is the frame after, not the nearest one: round": lambda T: torch.ceil(
            torch.arange(T) * 1.5625
        ).long(),
        "the hop is 512 samples; the window, 1024, does not matter here": lambda T: torch.round(
            torch.arange(T) / 20 * 16_000 / 1024
        ).long(),
        "motion has 20 frames a second: divide by 20 before you multiply by 31.25": (
            lambda T: torch.round(torch.arange(T) * 31.25).long(),
            lambda T: torch.round(torch.arange(T) * 20 / 512).long(),
        ),
    },
    "tracker_lag": {
        "late is found minus true, and should be positive": lambda found, true: (
            -np.median(_nearest(found, true))
        ),
        "that is the mean, which the wrong beats spoil": lambda found, true: _nearest(
            found, true
        ).mean(),
        "that is the mean of absolute values, which the wrong beats spoil": lambda found, true: (
            np.abs(_nearest(found, true)).mean()
        ),
        "beats that are early have a negative lag: do not take absolute values": (
            lambda found, true: np.median(np.abs(_nearest(found, true))),
            lambda found, true: np.median(np.abs(_gaps(found, true)).min(1)),
        ),
        "beats are compared by their index; the tracker may have missed the first": (
            lambda found, true: np.median(
                found[: min(len(found), len(true))] - true[: min(len(found), len(true))]
            ),
            lambda found, true: np.mean(
                found[: min(len(found), len(true))] - true[: min(len(found), len(true))]
            ),
        ),
        "these are all pairs; compare each found beat with the nearest true one": (
            lambda found, true: np.median(_gaps(found, true))
        ),
        "this looks for the nearest found beat of each true one; go from the found ones, since "
        "the tracker may have missed some": lambda found, true: np.median(-_nearest(true, found)),
        "the smallest gap is the most negative one; the nearest has the smallest *size*": (
            lambda found, true: np.median(_gaps(found, true).min(1))
        ),
        "this is the smallest lag; what is typical is the median": lambda found, true: _nearest(
            found, true
        ).min(),
        "this is the lag of the first beat; what is typical is the median of all": (
            lambda found, true: _nearest(found, true)[0]
        ),
        "this is a quartile; what is typical is the median, the middle one": (
            lambda found, true: np.quantile(_nearest(found, true), 0.25),
            lambda found, true: np.quantile(_nearest(found, true), 0.75),
        ),
        "the nearest true beat may come after the found one": lambda found, true: np.median(
            _last_before(found, true)
        ),
        "that is in milliseconds; return seconds": lambda found, true: (
            1000 * np.median(_nearest(found, true))
        ),
    },
}
OTHERS = {
    "log_mel_from_spectrum": {
        "floor where the logarithm of it belongs": lambda X, filters, floor: (
            _power(X, filters).clamp(min=math.exp(floor)).log()
        )
    },
    "mel_index": {
        "not whole": lambda T: torch.arange(T) * 1.5625,
        "one frame late": lambda T: torch.round(torch.arange(T) * 1.5625).long() + 1,
    },
}
