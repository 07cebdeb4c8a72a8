"""Measures of in-betweens.

Are the given frames kept? How far are the others from the truth? Is there a jump where they meet?

Distances are in metres, for positions (N, T, J, 3) of N motions and `known` (T, J).
Source: CondMDI and GMD for the first two, with every frame counted once; NPSS: Gopalakrishnan and
others, 2019; the measure of the seam is ours.
Notebook: 15
"""

from itertools import combinations

import numpy as np
from jaxtyping import Bool, Float, Int

Motions = Float[np.ndarray, "N T J 3"]


def keyframe_error(
    made: Motions, truth: Motions, known: Bool[np.ndarray, "T J"]
) -> Float[np.ndarray, "N"]:
    """Mean distance of the given joints from their given positions; 0 if they are kept.

    Raises ValueError when nothing was given.  Notebook: 15
    """
    return _distance(made, truth, known, "no joint is known")


def unknown_error(
    made: Motions, truth: Motions, known: Bool[np.ndarray, "T J"]
) -> Float[np.ndarray, "N"]:
    """Mean distance of all other joints from the truth.

    The mean of several samples is closer than the samples are on average.

    Raises ValueError when everything was given.  Notebook: 15
    """
    return _distance(made, truth, ~known, "every joint is known")


def energy_score(
    samples: Float[np.ndarray, "S N T J 3"], truth: Motions, known: Bool[np.ndarray, "T J"]
) -> Float[np.ndarray, "N"]:
    """How far samples are from the truth, minus half of how far they are from each other; metres.

    It is lowest on average for samples of the true distribution: neither their mean alone nor a
    wide guess does as well. For a single answer it is `unknown_error`.
    Raises ValueError when everything was given, or for no sample.
    Source: the energy score (Gneiting and Raftery, 2007), with the mean distance of a joint.
    """
    if not len(samples):
        raise ValueError("there is no sample to score")
    error = np.mean([unknown_error(one, truth, known) for one in samples], 0)
    if len(samples) == 1:
        return error
    pairs = combinations(samples, 2)
    return error - 0.5 * np.mean([unknown_error(a, b, known) for a, b in pairs], 0)


def _distance(made, truth, counted, problem: str):
    if not counted.any():
        raise ValueError(problem + ": there is nothing to measure")
    return np.linalg.norm(made - truth, axis=-1)[:, counted].mean(-1)


def npss(made: Float[np.ndarray, "N T D"], truth: Float[np.ndarray, "N T D"]) -> float:
    """Normalised power spectrum similarity (NPSS) of two sets of motions; 0 means equal spectra.

    For each motion and column, the two power spectra are scaled to sum 1 and compared by the earth
    mover's distance (in frequency bins). The spectra have both halves, as in the authors' code, so
    the mean position counts once and every wave twice. The mean is weighted by the truth's power.
    Notebook: 15
    """
    moved, weight = npss_parts(made, truth)
    return float(moved.sum() / weight.sum())


def npss_parts(
    made: Float[np.ndarray, "N T D"], truth: Float[np.ndarray, "N T D"]
) -> tuple[Float[np.ndarray, "N"], Float[np.ndarray, "N"]]:
    """For each motion the sum of its weighted distances, and the sum of its weights.

    `npss` is the ratio of the two, summed over motions.
    """
    power = [np.abs(np.fft.fft(x, axis=1)) ** 2 for x in (made, truth)]
    cumulated = [np.cumsum(p / np.maximum(p.sum(1, keepdims=True), 1e-12), axis=1) for p in power]
    moved = np.abs(cumulated[0] - cumulated[1]).sum(1)
    weight = power[1].sum(1)
    return (moved * weight).sum(-1), weight.sum(-1)


def seams(known: Bool[np.ndarray, "T J"]) -> Int[np.ndarray, "K"]:
    """The frames before and after each change of `known`, without the clip's first and last."""
    change = np.flatnonzero((known[1:] != known[:-1]).any(-1))
    frames = np.unique(np.concatenate([change, change + 1]))
    return frames[(frames > 0) & (frames < len(known) - 1)]


def seam_jump(
    made: Motions, known: Bool[np.ndarray, "T J"], fps: float = 20.0
) -> Float[np.ndarray, "N"]:
    """How much velocities change at the seams, in m/s.

    Mean over seams and joints of |v[t] - v[t - 1]|.

    The data are not at 0 either: compare with their value at the same frames. NaN without a seam.
    Notebook: 15
    """
    at = seams(known)
    if not len(at):
        return np.full(len(made), np.nan)
    jump = fps * (made[:, at + 1] - 2 * made[:, at] + made[:, at - 1])
    return np.linalg.norm(jump, axis=-1).mean((1, 2))
