"""Each loss at each diffusion step, and the size of its gradient.

They show what a loss weight really does. x_s is computed from known x0 and eps;
`predict(x_s, s, eps)` returns eps_hat, and x0_hat follows.
`predict` is a network, the exact denoiser, or the true noise with a given error.
Source: MoFusion 3.2, eq. 4-7.  Notebook: 13
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import torch
from jaxtyping import Bool, Float
from torch import Tensor

from ...ddpm import Denoiser, Schedule, draw, q_sample
from ...kinematic_loss import Body, kinematic_parts, weight_by_step
from ...prediction import target_of, to_x0, x0_from_eps

Predictor = Callable[[Tensor, Tensor, Tensor], Tensor]  # (x_s, s, eps) -> eps_hat


@dataclass(frozen=True, eq=False)
class LossOverTime:
    """Losses at the diffusion steps `steps`, means over a batch.

    The keys are the names of `kinematic_parts` and "data", the squared error of the network's own
    target (L_da). `gradient[name]` is the norm of the loss's gradient with respect to the network's
    output, for one motion: it decides what training does.
    """

    steps: tuple[int, ...]
    value: Mapping[str, Float[Tensor, "N"]]
    gradient: Mapping[str, Float[Tensor, "N"]]

    def weighted(self, schedule: Schedule, kind: str) -> "LossOverTime":
        """The same losses times lambda(s), except for the data term.

        Raises ValueError for an unknown weight.
        Notebook: 13
        """
        weight = weight_by_step(schedule, kind)[list(self.steps)]
        parts = [
            {k: v if k == "data" else weight.to(v) * v for k, v in x.items()}
            for x in (self.value, self.gradient)
        ]
        return LossOverTime(self.steps, *parts)


def noisy_predictor(error: float, seed: int = 0) -> Predictor:
    """A predictor with a given error: eps_hat = eps + error N(0, I); 0.05 is 5 %.

    The error comes from `seed` in each call, so it is the same at every step.
    Notebook: 13
    """
    return lambda x_s, s, eps: eps + error * draw(eps, torch.Generator().manual_seed(seed))


def predictor_of(denoise: Denoiser) -> Predictor:
    """A denoiser as a Predictor; it does not use eps.

    Notebook: 13
    """
    return lambda x_s, s, eps: denoise(x_s, s)


def clean_guess(
    predict: Predictor,
    x0: Float[Tensor, "B T D"],
    eps: Float[Tensor, "B T D"],
    s: int,
    schedule: Schedule,
) -> Float[Tensor, "B T D"]:
    """x0_hat at step s, computed from eps_hat.

    Source: MoFusion eq. 5.  Notebook: 13
    """
    return x0_from_eps(*_predicted(predict, x0, eps, s, schedule), schedule)


def losses_over_time(
    predict: Predictor,
    x0: Float[Tensor, "B T D"],
    eps: Float[Tensor, "B T D"],
    planted: Bool[Tensor, "B T 2"],
    body: Body,
    schedule: Schedule,
    steps: Sequence[int],
    target: str = "eps",
) -> LossOverTime:
    """All losses of x0_hat at each of `steps`, unweighted, and the norms of their gradients.

    The gradients are with respect to the output of a network that predicts `target`.

    Raises IndexError for a step outside the schedule, ValueError for an unknown target.
    Source: MoFusion eq. 4-7.  Notebook: 13
    """
    rows = [_at_step(predict, x0, eps, planted, body, schedule, s, target) for s in steps]
    value, gradient = (
        {name: torch.stack([row[k][name] for row in rows]) for name in rows[0][k]} for k in (0, 1)
    )
    return LossOverTime(tuple(steps), value, gradient)


def _predicted(
    predict: Predictor, x0: Tensor, eps: Tensor, s: int, schedule: Schedule
) -> tuple[Tensor, int, Tensor]:
    x_s = q_sample(x0, s, schedule, eps)
    with torch.no_grad():
        return x_s, s, predict(x_s, torch.full((len(x0),), s, device=x0.device), eps)


def _at_step(predict, x0, eps, planted, body, schedule, s, target) -> tuple[dict, dict]:
    x_s, s, eps_hat = _predicted(predict, x0, eps, s, schedule)
    x0_hat = x0_from_eps(x_s, s, eps_hat, schedule)
    output = target_of(x0_hat, eps_hat, s, schedule, target).detach().requires_grad_()
    with torch.enable_grad():
        parts = {"data": (output - target_of(x0, eps, s, schedule, target)).square().mean((1, 2))}
        parts |= kinematic_parts(to_x0(output, x_s, s, schedule, target), x0, body, planted)
        gradients = {
            k: torch.autograd.grad(v.sum(), output, retain_graph=True)[0] for k, v in parts.items()
        }
    return (
        {k: v.detach().mean() for k, v in parts.items()},
        {k: g.flatten(1).norm(dim=1).mean() for k, g in gradients.items()},
    )
