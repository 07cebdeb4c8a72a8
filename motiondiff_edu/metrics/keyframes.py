"""Measures of in-betweens.

Are the given frames kept, how far are the others from the truth, is there a jump where they meet?

All in metres; positions (N, T, J, 3) of N motions, `known` (T, J).  Source: CondMDI and GMD for the
first two, with every frame counted once; NPSS: Gopalakrishnan and others, 2019; the seam is ours.
Notebook: 15
"""

import numpy as np
from jaxtyping import Bool, Float, Int

Motions = Float[np.ndarray, "N T J 3"]


def keyframe_error(
    made: Motions, truth: Motions, known: Bool[np.ndarray, "T J"]
) -> Float[np.ndarray, "N"]:
    """Mean distance of the given joints from where they were given; 0 for whoever keeps them.

    Raises ValueError when nothing was given.  Notebook: 15
    """
    return _distance(made, truth, known, "nothing was given")


def unknown_error(
    made: Motions, truth: Motions, known: Bool[np.ndarray, "T J"]
) -> Float[np.ndarray, "N"]:
    """Mean distance of all other joints from the truth. A mean of samples beats every sample here.

    Raises ValueError when everything was given.  Notebook: 15
    """
    return _distance(made, truth, ~known, "everything was given")


def _distance(made, truth, counted, complaint: str):
    if not counted.any():
        raise ValueError(complaint + ": there is nothing to measure")
    return np.linalg.norm(made - truth, axis=-1)[:, counted].mean(-1)


def npss(made: Float[np.ndarray, "N T D"], truth: Float[np.ndarray, "N T D"]) -> float:
    """Normalised power spectrum similarity.

    How differently two sets of motions spread over frequencies; 0 is alike.

    For each motion and column the power spectra, scaled to sum to 1, are compared by the earth
    mover's distance (in frequency bins); the mean is weighted by the power of the truth.
    Notebook: 15
    """
    moved, weight = npss_parts(made, truth)
    return float(moved.sum() / weight.sum())


def npss_parts(
    made: Float[np.ndarray, "N T D"], truth: Float[np.ndarray, "N T D"]
) -> tuple[Float[np.ndarray, "N"], Float[np.ndarray, "N"]]:
    """Of each motion the sum of its weighted distances, and of the weights.

    `npss` is the one over the other.
    """
    power = [np.abs(np.fft.rfft(x, axis=1)) ** 2 for x in (made, truth)]
    spread = [np.cumsum(p / np.maximum(p.sum(1, keepdims=True), 1e-12), axis=1) for p in power]
    moved = np.abs(spread[0] - spread[1]).sum(1)
    weight = power[1].sum(1)
    return (moved * weight).sum(-1), weight.sum(-1)


def seams(known: Bool[np.ndarray, "T J"]) -> Int[np.ndarray, "K"]:
    """The inner frames on either side of which (or at which) it changes what is given.

    t and t + 1 of each change.
    """
    change = np.flatnonzero((known[1:] != known[:-1]).any(-1))
    frames = np.unique(np.concatenate([change, change + 1]))
    return frames[(frames > 0) & (frames < len(known) - 1)]


def seam_jump(
    made: Motions, known: Bool[np.ndarray, "T J"], fps: float = 20.0
) -> Float[np.ndarray, "N"]:
    """How much velocities change at the seams, m/s.

    Mean over seams and joints of |v[t] - v[t - 1]|.

    The data have some as well: set theirs at the same frames beside it. NaN where there is no seam.
    Notebook: 15
    """
    at = seams(known)
    if not len(at):
        return np.full(len(made), np.nan)
    jump = fps * (made[:, at + 1] - 2 * made[:, at] + made[:, at - 1])
    return np.linalg.norm(jump, axis=-1).mean((1, 2))
