"""Guidance and blending: wrappers that make a denoiser respect the given entries.

They take a denoiser and return one, for `inbetweening.inpaint_steps`.

    blended(guided(denoise, schedule, given, known), schedule, given, known, fade=10)
A trained network's guess x0_hat can differ from the given entries, and then the motion jumps where
they meet. Guidance moves the guess by the network's own gradient; blending moves it through the
given entries. Both change x0_hat, and return the eps_hat that belongs to it.
Gain: docs/RESULTS_ALL.md (`inbetween-departures.no-guidance.*`, `.no-blending.*`).
Source: guidance after Ho and others (2022) and Song and others (2023); blending is ours; motion
graphs join clips in the same way.  Notebook: 15
"""

from collections.abc import Callable

import torch
from jaxtyping import Bool, Float
from torch import Tensor

from ..ddpm import Denoiser, Schedule
from ..motion.known import Fade, between_known
from ..prediction import eps_from_x0, x0_from_eps

X = Float[Tensor, "B *shape"]
Mask = Bool[Tensor, "B *shape"]


def guided(
    denoise: Denoiser,
    schedule: Schedule,
    given: X,
    known: Mask,
    weight: float = 1.0,
    moves: int = 1,
) -> Denoiser:
    """The denoiser with `guided_guess` for its x0_hat; each move costs about as much as a call.

    `denoise` must be differentiable.  Notebook: 15
    """

    def steered(x_s: Tensor, s: Tensor) -> Tensor:
        x0_hat = guided_guess(denoise, x_s, s, schedule, given, known, weight, moves)
        return eps_from_x0(x_s, s, x0_hat, schedule)

    return steered


def blended(
    denoise: Denoiser,
    schedule: Schedule,
    given: Float[Tensor, "B T D"],
    known: Bool[Tensor, "B T D"],
    fade: Fade,
) -> Denoiser:
    """The denoiser with `blended_guess` for its x0_hat.

    Notebook: 15
    """
    return with_guess(denoise, schedule, lambda x0: blended_guess(x0, given, known, fade))


def with_guess(
    denoise: Denoiser, schedule: Schedule, change: Callable[[Tensor], Tensor]
) -> Denoiser:
    """A denoiser whose x0_hat is `change(x0_hat)`; it returns the eps_hat that belongs to it."""

    def changed(x_s: Tensor, s: Tensor) -> Tensor:
        x0_hat = change(x0_from_eps(x_s, s, denoise(x_s, s), schedule))
        return eps_from_x0(x_s, s, x0_hat, schedule)

    return changed


def guided_guess(
    denoise: Denoiser,
    x_s: X,
    s: Tensor,
    schedule: Schedule,
    given: X,
    known: Mask,
    weight: float,
    moves: int = 1,
) -> X:
    """x0_hat, moved along the gradient of its error at the given entries, `moves` times.

        x0_hat + weight * sum of length * direction
        direction = J^T error,   error = (given - moved x0_hat)[known],   J = d x0_hat / d x_s
    J is, up to a factor, the covariance of x0 given x_s (Tweedie), so entries that are correlated
    with the given ones move along. `length`, for each sample, minimises the remaining error at the
    given entries; so redundant entries do not count twice. (The sources have a constant there, and
    one move.) More moves bring more of the given entries near, and not only the easiest; J stays
    that of x_s. Where a move would lead away from the given entries its length is 0.
    Source: Ho and others, Video diffusion models (2022); Song and others, Pseudoinverse-guided
    diffusion (2023).
    """
    with torch.enable_grad():
        x = x_s.detach().requires_grad_()
        x0_hat = x0_from_eps(x, s, denoise(x, s), schedule)
        error, total = (given - x0_hat).detach().where(known, 0.0), torch.zeros_like(x_s)
        for move in range(moves):
            again = move + 1 < moves
            (direction,) = torch.autograd.grad(x0_hat, x, error, retain_graph=again)
            at_known = direction.where(known, 0.0)
            fit = (error * at_known).flatten(1).sum(1)
            length = fit / at_known.square().flatten(1).sum(1).clamp(min=1e-12)
            length = length.clamp(min=0).view(-1, *[1] * (x.ndim - 1))
            total, error = total + length * direction, error - length * at_known
    return x0_hat.detach() + weight * total


def blended_guess(
    x0_hat: Float[Tensor, "B T D"],
    given: Float[Tensor, "B T D"],
    known: Bool[Tensor, "B T D"],
    fade: Fade,
) -> Float[Tensor, "B T D"]:
    """x0_hat, corrected so that it goes through the given entries.

    The correction at the given frames is interpolated to the frames between them, and fades before
    the first and after the last (`motion.known.between_known`).
    """
    return torch.where(known, given, x0_hat + between_known(given - x0_hat, known, fade))
