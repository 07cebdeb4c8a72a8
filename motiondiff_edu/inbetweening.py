"""Some entries of a motion are given, the others are to be found: seeds, keyframes, parts of the
body.

    at every step s:  x_s = known ? noised snapshot of the given : x_s
                      then one step of sampling as ever

at the end the given entries are put back as they were. A trained denoiser is enough: nothing is
trained for it. Masking alone is not the conditional distribution (notebook 15): `resample` goes
there and back at every step. Nor does a trained network's guess agree with what is given: `blend`
and `guidance`. In metres: `editing.inbetween.inbetween`.
Source: MoFusion 4.4; resampling after RePaint (Lugmayr and others, 2022).  Notebook: 15
"""

import math
from collections.abc import Callable, Iterator

import torch
from jaxtyping import Bool, Float
from torch import Tensor

from .ddpm import Denoiser, Schedule, Step, draw, q_sample

X = Float[Tensor, "B *shape"]
Blend = Callable[[X, X, X], X]  # (x0_hat, given, known) -> x0_hat


@torch.no_grad()
def inpaint_steps(
    denoise: Denoiser,
    start: X,
    schedule: Schedule,
    given: X,
    known: Bool[Tensor, "B *shape"],
    *,
    steps: int = 50,
    eta: float = 1.0,
    resample: int = 1,
    blend: Blend | None = None,
    guidance: float = 0.0,
    generator: torch.Generator | None = None,
) -> Iterator[Step]:
    """DDIM with `steps` steps from `start` (x_S) on which the known entries of x_s are given's,
    noised; yields `Step`s.

    `given` counts where `known` is True. Fresh noise is drawn for the snapshots at every step, and
    none where nothing is known: then the same generator gives the same sample as `ddim_steps`. With
    `resample` = R all leaps but the last are made R times: there, back by as much noise, and there,
    so that unknown entries can agree with known ones. `blend`, say `beyond.guidance.blended`, has
    every x0_hat agree with the given. With `guidance` (1, say) they are `guided` before: dearer,
    and `denoise` must be differentiable. The last record has the given entries themselves.
    Raises ValueError for resample under 1, steps outside 1..S, or guidance through what cannot be
    differentiated.
    Source: MoFusion 4.4; RePaint's resampling.  Notebook: 15
    """
    if resample < 1:
        raise ValueError(f"every step is made once at least, not resample = {resample}")
    if not 1 <= steps <= schedule.S:
        raise ValueError(f"can take between 1 and {schedule.S} steps, not {steps}")
    alpha_bar, some = schedule.alpha_bar.tolist(), bool(known.any())
    given = torch.where(known, given, torch.zeros_like(given))  # what is not known may be NaN
    visited, x = [schedule.S - (i * schedule.S) // steps for i in range(steps)], start
    for s, after in zip(visited, [*visited[1:], 0], strict=True):
        turns = resample if some and after else 1
        for turn in range(turns):
            if some:
                x = torch.where(known, q_sample(given, s, schedule, draw(x, generator)), x)
            if some and guidance:
                x0_hat = guided(denoise, x, s, alpha_bar[s], given, known, guidance)
            else:
                x0_hat = _x0_hat(denoise, x, s, alpha_bar[s])
            if some and blend:
                x0_hat = blend(x0_hat, given, known)
            eps_hat = (x - math.sqrt(alpha_bar[s]) * x0_hat) / math.sqrt(1 - alpha_bar[s])
            if not turn:
                yield Step(s, x, x0_hat, eps_hat)
            x = _leap(x0_hat, eps_hat, alpha_bar[s], alpha_bar[after], eta, generator)
            if turn + 1 < turns:
                x = _back(x, alpha_bar[after], alpha_bar[s], generator)
    x = torch.where(known, given, x)
    yield Step(0, x, x, torch.zeros_like(x))


def guided(
    denoise: Denoiser,
    x: X,
    s: int,
    alpha_bar: float,
    given: X,
    known: Bool[Tensor, "B *shape"],
    weight: float,
) -> X:
    """x0_hat, with what is wrong at the given entries traced back to x_s, and from there to all
    others.

        x0_hat + weight * length * pull
        pull = J^T (given - x0_hat)[known],   J = d x0_hat / d x_s

    J is, up to a factor, the covariance of what x_s leaves open (Tweedie): whatever goes with the
    given is moved along. `length`, for each sample, leaves least wrong at the given entries of this
    guess: entries that say the same must not pull twice. (The sources have a constant there.)
    Notebook: 15
    Source: Ho and others, Video diffusion models (2022); Song and others, Pseudoinverse-guided
    diffusion (2023).
    """
    with torch.enable_grad():
        x = x.detach().requires_grad_()
        x0_hat = _x0_hat(denoise, x, s, alpha_bar)
        wrong = (given - x0_hat).detach().where(known, 0.0)
        (pull,) = torch.autograd.grad(x0_hat, x, wrong)
    at_known = pull.where(known, 0.0).flatten(1)
    length = (wrong.flatten(1) * at_known).sum(1) / at_known.square().sum(1).clamp(min=1e-12)
    return x0_hat.detach() + weight * length.clamp(min=0).view(-1, *[1] * (x.ndim - 1)) * pull


def _x0_hat(denoise: Denoiser, x: X, s: int, alpha_bar: float) -> X:
    return (
        x - math.sqrt(1 - alpha_bar) * denoise(x, torch.full((len(x),), s, device=x.device))
    ) / math.sqrt(alpha_bar)


def _leap(
    x0_hat: X, eps_hat: X, now: float, then: float, eta: float, generator: torch.Generator | None
) -> X:
    """DDIM's step to less noise: sqrt(then) x0_hat + sqrt(1 - then - sigma^2) eps_hat + sigma
    noise."""
    sigma = eta * math.sqrt((1 - then) / (1 - now) * (1 - now / then))
    x = math.sqrt(then) * x0_hat + math.sqrt(max(1 - then - sigma**2, 0.0)) * eps_hat
    return x + sigma * draw(x, generator) if sigma else x


def _back(x: X, now: float, then: float, generator: torch.Generator | None) -> X:
    """The forward process from alpha_bar = now to a smaller one: as much noise as the leap took
    away."""
    return math.sqrt(then / now) * x + math.sqrt(1 - then / now) * draw(x, generator)
