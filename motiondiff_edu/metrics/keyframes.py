"""Measures of what is filled in: in-betweens, repairs, and the seams of both.

In-betweens: are the given frames kept, how far are the others from the truth, is there a jump where
they meet? Distances are in metres, for positions (N, T, J, 3) of N motions and `known` (T, J).

Repairs: how far are the reconstructed joints from the truth, how well do they join the rest, do
they move? Results are in centimetres. `known` is True for each joint of each frame that was given.
Several repairs of the same past share it; they have a leading axis, (n, ..., T, J, 3).

Seams: does a motion jump where generated frames begin?
Source: CondMDI and GMD for the kept frames and the error, with every frame counted once; NPSS:
Gopalakrishnan and others, 2019; MoDiff IV-B (its RMSE_re is of bones; the distance to the truth is
ours, because here the truth is known); the measures of the seam are ours.
Notebook: 10, 15
"""

from itertools import combinations

import numpy as np
from jaxtyping import Bool, Float, Int

from ..motion.skeleton import BONE_LENGTHS, BONES
from .bodies import CM_PER_METRE, bone_lengths

# ---- in-betweens ---------------------------------------------------------------------------------
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


# ---- repairs -------------------------------------------------------------------------------------
Poses = Float[np.ndarray, "*N T J 3"]
Known = Bool[np.ndarray, "*B T J"]


def missing_error(made: Poses, truth: Float[np.ndarray, "*B T J 3"], known: Known) -> float:
    """Mean distance of the missing joints from the truth, in cm.

    The mean of several repairs always scores at least as well as they do on average:
    |mean_i x_i - truth| <= mean_i |x_i - truth|.
    Raises ValueError when nothing is missing.  Notebook: 10
    """
    distance = np.linalg.norm(np.asarray(made, np.float64) - truth, axis=-1)
    return float(CM_PER_METRE * _where(~known, distance).mean())


def joined_bones(made: Poses, known: Known) -> float:
    """RMS error of the length of bones with a missing end, in cm.

    The paper does not say whether its RMSE_re also counts the other bones, whose length is given;
    `bone_rmse` counts all.
    Raises ValueError when nothing is missing.  Source: MoDiff Table II.  Notebook: 10
    """
    parents, children = np.array(BONES).T
    off = bone_lengths(made) - BONE_LENGTHS
    return float(
        CM_PER_METRE
        * np.sqrt((_where(~(known[..., parents] & known[..., children]), off) ** 2).mean())
    )


def missing_step(made: Poses, known: Known) -> float:
    """Mean movement of a joint from one frame to the next where either is missing, in cm.

    A mean of several motions moves too little: compare with the truth's own value.
    Raises ValueError when nothing is missing.  Notebook: 10
    """
    step = np.linalg.norm(np.diff(np.asarray(made, np.float64), axis=-3), axis=-1)
    return float(CM_PER_METRE * _where(~(known[..., 1:, :] & known[..., :-1, :]), step).mean())


def missing_spread(samples: Float[np.ndarray, "n *B T J 3"], known: Known) -> float:
    """RMS distance of n repairs of the same past from their mean, in cm, with n - 1.

    Calibrated repairs spread about as far as the truth is from their mean.
    Raises ValueError for fewer than two repairs, and when nothing is missing.  Notebook: 10
    """
    if len(samples) < 2:
        raise ValueError("a spread needs at least 2 repairs of the same past, got 1")
    variance = np.asarray(samples, np.float64).var(axis=0, ddof=1).sum(-1)
    return float(CM_PER_METRE * np.sqrt(_where(~known, variance).mean()))


def _where(
    counted: Bool[np.ndarray, "..."], values: Float[np.ndarray, "..."]
) -> Float[np.ndarray, "K"]:
    """The values where `counted` is True; one mask serves all repairs of a motion."""
    if not counted.any():
        raise ValueError("nothing is missing: there is no repair to measure")
    return values[np.broadcast_to(counted, values.shape)]


# ---- seams ---------------------------------------------------------------------------------------
AROUND = 1.0  # seconds, before and after the seam


def seam_over_past(
    positions: Float[np.ndarray, "T J 3"], seam: int, fps: float | int = 20.0
) -> float:
    """The speed of the fastest joint at the seam over the fastest within the second before it.

    As `seam_over_motion`, but what was generated cannot excuse a jump by being fast itself.
    """
    speeds = _fastest(positions, seam)
    before = speeds[max(0, seam - 1 - round(AROUND * fps)) : seam - 1]
    return float(speeds[seam - 1] / max(before.max(), 1e-9))


def seam_over_motion(
    positions: Float[np.ndarray, "T J 3"], seam: int, fps: float | int = 20.0
) -> float:
    """The speed of the fastest joint at the seam over the fastest within a second around it.

    `seam` is the first generated frame (world, metres). 1 or less: no joint is faster there than
    elsewhere. Raises ValueError for a seam without two frames before it and one after it.
    """
    speeds = _fastest(positions, seam)
    n = round(AROUND * fps)
    around = np.r_[speeds[max(0, seam - 1 - n) : seam - 1], speeds[seam : seam + n]]
    return float(speeds[seam - 1] / max(around.max(), 1e-9))


def seam_step(positions: Float[np.ndarray, "T J 3"], seam: int) -> float:
    """How much farther a joint goes at the seam than in the two frames before and after it, metres.

    The largest over joints. A hand that jumps while a foot swings is seen here, and not by
    `seam_over_motion`. Raises ValueError as `seam_over_motion` does.
    """
    steps = _steps(positions, seam)
    beside = np.concatenate([steps[max(0, seam - 3) : seam - 1], steps[seam : seam + 2]])
    return float((steps[seam - 1] - beside.max(0)).max())


def _fastest(positions, seam: int) -> Float[np.ndarray, "n"]:
    """The fastest joint from each frame to the next, in metres a frame."""
    return _steps(positions, seam).max(-1)


def _steps(positions, seam: int) -> Float[np.ndarray, "n J"]:
    """How far each joint goes from each frame to the next, metres."""
    if not 2 <= seam < len(positions) - 1:
        raise ValueError(f"the seam must be from 2 to {len(positions) - 2}, not {seam}")
    return np.linalg.norm(np.diff(positions, axis=0), axis=-1)
