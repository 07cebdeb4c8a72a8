"""Kinematic losses of the clean motion x0_hat, and their weight over diffusion steps.

    L = L_da + lambda(s) L_k,   L_k = w_s L_s + w_a L_a + w_m L_m (+ w_f L_f)
L_da is the squared error of the network's target. L_k is computed from x0_hat, in metres.
All motions of a batch have one length: there is no padding.
Source: MoFusion 3.2, eq. 4-7.  Notebook: 13
"""

from collections.abc import Callable
from dataclasses import dataclass

import torch
from jaxtyping import Bool, Float, Int
from torch import Tensor

from .ddpm import Schedule, Table, at, draw, q_sample, squared_error
from .prediction import target_of, to_x0

Motion = Float[Tensor, "B T D"]
Bones = tuple[tuple[int, int], ...]
SNR_LIMIT = 5.0  # limit of the signal-to-noise weight, which is otherwise infinite at s = 0


@dataclass(frozen=True)
class KinematicWeights:
    """The weight of each loss. No defaults: MoFusion publishes none.

    skeleton          per m^2; a bone that varies by 1 cm has L_s = 1e-4 m^2
    asymmetry, slide  per metre
    motion            per squared standard deviation
    Source: MoFusion 3.2 (lambda_a, lambda_m; the others are ours)
    """

    skeleton: float
    asymmetry: float
    motion: float
    slide: float
    over_time: str  # lambda(s): a name of OVER_TIME

    def total(self, parts: dict[str, Float[Tensor, "B"]]) -> Float[Tensor, "B"]:
        """L_k from the result of `kinematic_parts`.

        Source: MoFusion 3.2
        """
        return sum(getattr(self, name) * loss for name, loss in parts.items())

    def loss_for(
        self, body: "Body", planted: Bool[Tensor, "B T 2"]
    ) -> Callable[[Motion, Motion], Float[Tensor, "B"]]:
        """L_k of motions of these bodies, as `training_loss` takes it (`kinematic_parts`)."""
        return lambda x0_hat, x0: self.total(kinematic_parts(x0_hat, x0, body, planted))


@dataclass(frozen=True, eq=False)
class Body:
    """The facts about a figure that the losses need.

    to_positions  from the network's (standardised) features to joints in metres
    bones         (parent, child) joints
    pairs         (left, right) indices of bones
    toes          two joints
    """

    to_positions: Callable[[Motion], Float[Tensor, "B T J 3"]]
    bones: Bones
    pairs: Bones
    toes: tuple[int, int]


def training_loss(
    model: Callable[..., Motion],
    batch: tuple,
    schedule: Schedule,
    generator: torch.Generator,
    *,
    kinematic: Callable[[Motion, Motion], Float[Tensor, "B"]] | None = None,
    lambda_k: Table | None = None,
    loss: Callable[[Motion, Int[Tensor, "B"]], Float[Tensor, ""]] = squared_error,
) -> Float[Tensor, ""]:
    """MoFusion's whole loss, for one batch (x0, context): L_da + lambda_k(s) L_k.

    context    the model's input beside x_s and s: `mofusion.Music`, or None
    kinematic  `kinematic(x0_hat, x0)` is L_k of each sample (`kinematic_parts`, weighted); None
               leaves it out
    lambda_k   a weight for each step (`weight_by_step`); default: the paper's alpha_bar
    loss       the loss of the target's error; others are in `beyond.loss_terms` (ours)
    The network can predict x0 or v instead of eps (`model.config.target`), which is ours, too.
    Source: MoFusion eq. 4.  Notebook: 13
    """
    x0, context = batch
    s = torch.randint(1, schedule.S + 1, (len(x0),), generator=generator).to(x0.device)
    eps = draw(x0, generator)
    x_s = q_sample(x0, s, schedule, eps)  # eq. 1-2
    output = model(x_s, s, context)
    target = model.config.target  # type: ignore[attr-defined]  # a network has its configuration
    L_da = loss(target_of(x0, eps, s, schedule, target) - output, s)
    if kinematic is None:
        return L_da
    x0_hat = to_x0(output, x_s, s, schedule, target)  # eq. 5
    L_k = kinematic(x0_hat, x0)
    lambda_k = schedule.alpha_bar if lambda_k is None else lambda_k
    return L_da + (at(lambda_k, s, L_k) * L_k).mean()  # eq. 4


def kinematic_parts(
    x0_hat: Motion, x0: Motion, body: Body, planted: Bool[Tensor, "B T 2"]
) -> dict[str, Float[Tensor, "B"]]:
    """L_s, L_a, L_m and the foot-slide loss of each sample, by the names of KinematicWeights.

    `planted` says which feet are planted in x0.  Source: MoFusion 3.2.  Notebook: 13
    """
    positions = body.to_positions(x0_hat)
    lengths = bone_lengths(positions, body.bones)
    return {
        "skeleton": skeleton_loss(lengths),
        "asymmetry": asymmetry_loss(lengths, body.pairs),
        "motion": motion_loss(x0_hat, x0),
        "slide": slide_loss(positions, planted, body.toes),
    }


def bone_lengths(positions: Float[Tensor, "B T J 3"], bones: Bones) -> Float[Tensor, "B T K"]:
    """The length of each bone (parent, child) in each frame, in metres.

    Source: MoFusion eq. 6 (l_n).  Notebook: 13
    """
    parents, children = zip(*bones, strict=True)
    gap = positions[:, :, list(children)] - positions[:, :, list(parents)]
    return gap.square().sum(-1).clamp_min(1e-12).sqrt()  # sqrt has no finite gradient at 0


def skeleton_loss(lengths: Float[Tensor, "B T K"]) -> Float[Tensor, "B"]:
    """L_s: the variance of each bone's length over time, averaged over the bones; m^2.

    mean_b sum_n (l_nb - mean_n l_nb)^2 / (N - 1)
    Source: MoFusion eq. 6, in which n is both index and count; it does not say how to combine the
    bones.
    Notebook: 13
    """
    mean = lengths.mean(1, keepdim=True)
    return (lengths - mean).square().sum(1).div(max(lengths.shape[1] - 1, 1)).mean(-1)


def asymmetry_loss(lengths: Float[Tensor, "B T K"], pairs: Bones) -> Float[Tensor, "B"]:
    """L_a: the mean difference in length between a left bone and its right partner; m.

    `pairs` are indices of bones.

    Source: MoFusion 3.2 names it without a formula; this one is ours.  Notebook: 13
    """
    left, right = zip(*pairs, strict=True)
    return (lengths[:, :, list(left)] - lengths[:, :, list(right)]).abs().mean((1, 2))


def motion_loss(x0_hat: Motion, x0: Motion) -> Float[Tensor, "B"]:
    """L_m: mean squared distance of the guess from the true motion.

    It is in the network's own (standardised) units.

    Source: MoFusion eq. 7, squared.  Notebook: 13
    """
    return (x0_hat - x0).square().mean((1, 2))


def slide_loss(
    positions: Float[Tensor, "B T J 3"], planted: Bool[Tensor, "B T 2"], toes: tuple[int, int]
) -> Float[Tensor, "B"]:
    """L_f: how far a toe moves along the floor while it should be planted; m.

    It is the mean over steps from one frame to the next.

    Source: MoFusion 3.2 invites such a loss; this one is ours.
    """
    step = positions[:, 1:, list(toes)] - positions[:, :-1, list(toes)]
    moved = step[..., [0, 2]].square().sum(-1).clamp_min(1e-12).sqrt()
    stands = (planted[:, 1:] & planted[:, :-1]).to(moved.dtype)
    return (moved * stands).sum((1, 2)) / stands.sum((1, 2)).clamp_min(1)


def weight_by_step(schedule: Schedule, kind: str) -> Table:
    """lambda(s): the weight of L_k at each step, by a name of OVER_TIME.

    "alpha_bar" is the paper's weight: the fraction of the signal's power, which is almost 0 where
    x_s is mostly noise. Notebook 13 measures its effect on each loss. For L_m it is not a smaller
    weight, since alpha_bar |x0_hat - x0|^2 = (1 - alpha_bar) |eps_hat - eps|^2.
    Raises ValueError for another name.  Source: MoFusion 3.2 (lambda_k).  Notebook: 13
    """
    if kind not in OVER_TIME:
        raise ValueError(f"over_time must be one of {', '.join(OVER_TIME)}, not {kind!r}")
    return OVER_TIME[kind](schedule.alpha_bar)


OVER_TIME = {
    "none": torch.zeros_like,  # no kinematic losses
    "constant": torch.ones_like,
    "alpha_bar": lambda alpha_bar: alpha_bar.clone(),
    "snr": lambda alpha_bar: (alpha_bar / (1 - alpha_bar).clamp_min(1e-9)).clamp_max(SNR_LIMIT),
}
