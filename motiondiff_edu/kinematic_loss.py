"""Kinematic losses: what is asked of the clean motion that the network has in mind, and how much at
which step.

    L = L_da + lambda(s) L_k,   L_k = w_s L_s + w_a L_a + w_m L_m (+ w_f L_f)
L_da is the squared error of the target (to which `performers.dance_windows.dance_loss` may add).
L_k looks at x0_hat, the guess of the clean motion, in metres.
Source: MoFusion 3.2, eq. 4-7.  Notebook: 13
"""

from dataclasses import dataclass

import torch
from jaxtyping import Bool, Float
from torch import Tensor

from .ddpm import Schedule, Table

Bones = tuple[tuple[int, int], ...]
SNR_LIMIT = 5.0  # of the signal-to-noise weight: without a limit it is infinite at s = 0


@dataclass(frozen=True)
class KinematicWeights:
    """How much each loss counts; all must be said: MoFusion gives no numbers.

    `skeleton` is per m^2 (a bone that varies by 1 cm has L_s = 1e-4 m^2), `asymmetry` and `slide`
    per metre, `motion` per squared standard deviation.  Source: MoFusion 3.2 (lambda_a, lambda_m;
    the others are ours)
    """

    skeleton: float
    asymmetry: float
    motion: float
    slide: float
    over_time: str  # a name of OVER_TIME


def bone_lengths(positions: Float[Tensor, "B T J 3"], bones: Bones) -> Float[Tensor, "B T K"]:
    """The length of each bone (parent, child) in each frame, metres.  Source: MoFusion eq. 6 (l_n).
    Notebook: 13"""
    parents, children = zip(*bones, strict=True)
    gap = positions[:, :, list(children)] - positions[:, :, list(parents)]
    return gap.square().sum(-1).clamp_min(1e-12).sqrt()  # a root has no slope at 0


def skeleton_loss(
    lengths: Float[Tensor, "B T K"], present: Bool[Tensor, "B T"] | None = None
) -> Float[Tensor, "B"]:
    """L_s: the variance of each bone's length over time, averaged over the bones; m^2.

    mean_b sum_n (l_nb - mean_n l_nb)^2 / (N - 1)
    Source: MoFusion eq. 6, whose n is both index and count, and which does not say how bones are
    put together.
    Notebook: 13
    """
    here = _share(present, lengths)
    count = here.sum(1, keepdim=True).clamp_min(1)
    mean = (lengths * here).sum(1, keepdim=True) / count
    return ((lengths - mean).square() * here).sum(1).div((count[:, 0] - 1).clamp_min(1)).mean(-1)


def asymmetry_loss(
    lengths: Float[Tensor, "B T K"], pairs: Bones, present: Bool[Tensor, "B T"] | None = None
) -> Float[Tensor, "B"]:
    """L_a: how far a left bone's length is from its right partner's, on average; m. `pairs` are
    indices of bones.

    Source: MoFusion 3.2 names it without a formula; this one is ours.  Notebook: 13
    """
    left, right = zip(*pairs, strict=True)
    apart = (lengths[:, :, list(left)] - lengths[:, :, list(right)]).abs().mean(-1)
    return _mean(apart, present)


def motion_loss(
    x0_hat: Float[Tensor, "B T D"],
    x0: Float[Tensor, "B T D"],
    present: Bool[Tensor, "B T"] | None = None,
) -> Float[Tensor, "B"]:
    """L_m: mean squared distance of the guess from the true motion, in the network's own
    (standardised) units.

    Source: MoFusion eq. 7, squared.  Notebook: 13
    """
    return _mean((x0_hat - x0).square().mean(-1), present)


def slide_loss(
    positions: Float[Tensor, "B T J 3"],
    planted: Bool[Tensor, "B T 2"],
    toes: tuple[int, int],
    present: Bool[Tensor, "B T"] | None = None,
) -> Float[Tensor, "B"]:
    """L_f: how far a toe moves along the floor from a frame to the next where it should stand, on
    average; m.

    Source: MoFusion 3.2 invites such a loss; this one is ours.
    """
    step = positions[:, 1:, list(toes)] - positions[:, :-1, list(toes)]
    moved = step[..., [0, 2]].square().sum(-1).clamp_min(1e-12).sqrt()
    stands = (planted[:, 1:] & planted[:, :-1]).to(moved.dtype)
    if present is not None:
        stands = stands * (present[:, 1:] & present[:, :-1])[..., None]
    return (moved * stands).sum((1, 2)) / stands.sum((1, 2)).clamp_min(1)


def _share(present: Bool[Tensor, "B T"] | None, like: Tensor) -> Tensor:
    return torch.ones_like(like[..., :1]) if present is None else present[..., None].to(like.dtype)


def _mean(x: Float[Tensor, "B T"], present: Bool[Tensor, "B T"] | None) -> Float[Tensor, "B"]:
    here = _share(present, x[..., None])[..., 0].expand_as(x)
    return (x * here).sum(1) / here.sum(1).clamp_min(1)


def over_time(schedule: Schedule, kind: str) -> Table:
    """lambda(s): how much L_k counts at each step, by a name of OVER_TIME.

    "alpha_bar" is the paper's. It is the share of the signal's power, and hardly anything where x_s
    is mostly noise. What that does to each loss, notebook 13 measures: for L_m it is no smaller
    weight at all, since alpha_bar |x0_hat - x0|^2 = (1 - alpha_bar) |eps_hat - eps|^2.
    Raises ValueError for another name.  Source: MoFusion 3.2 (lambda_k).  Notebook: 13
    """
    if kind not in OVER_TIME:
        raise ValueError(f"the weight over time is one of {', '.join(OVER_TIME)}, not {kind!r}")
    return OVER_TIME[kind](schedule.alpha_bar)


OVER_TIME = {
    "none": torch.zeros_like,  # no kinematic losses
    "constant": torch.ones_like,
    "alpha_bar": lambda alpha_bar: alpha_bar.clone(),
    "snr": lambda alpha_bar: (alpha_bar / (1 - alpha_bar).clamp_min(1e-9)).clamp_max(SNR_LIMIT),
}
