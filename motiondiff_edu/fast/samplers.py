"""Samplers with almost no cost of their own: DDPM and DDIM as in `ddpm`, up to rounding (tested).

Every sampler here is one rule, x_next = a * x0_hat + b * x_s + c * eps_hat + sigma * noise, with
four numbers for each step. They are Python floats, computed before the loop: with a small network
the arithmetic of the scheduler itself takes much of the time.
"""

import math
from collections.abc import Iterator, Sequence

import torch
from jaxtyping import Float
from torch import Tensor

from ..ddpm import (
    Denoiser,
    Generators,
    Schedule,
    ddim_sigma,
    draw,
    falling,
    p_variance,
    starting_noise,
)


class FastStep:
    """One step of sampling, like `ddpm.Step`; x0_hat and eps_hat are computed on use."""

    __slots__ = ("s", "x_s", "_output", "_alpha_bar", "_clip")

    def __init__(self, s: int, x_s: Tensor, output: Tensor, alpha_bar: float, clip: float | None):
        self.s, self.x_s = s, x_s
        self._output = output
        self._alpha_bar, self._clip = alpha_bar, clip

    @property
    def x0_hat(self) -> Tensor:
        """(x_s - sqrt(1 - alpha_bar_s) eps_hat) / sqrt(alpha_bar_s), clamped to +-clip."""
        signal, noise = math.sqrt(self._alpha_bar), math.sqrt(1 - self._alpha_bar)
        x0_hat = (self.x_s - noise * self._output) / signal
        return x0_hat if self._clip is None else x0_hat.clamp(-self._clip, self._clip)

    @property
    def eps_hat(self) -> Tensor:
        """The denoiser's output, or the eps_hat that belongs to a clamped x0_hat."""
        if self._clip is None or not self.s:
            return self._output
        signal, noise = math.sqrt(self._alpha_bar), math.sqrt(1 - self._alpha_bar)
        return (self.x_s - signal * self.x0_hat) / noise


def ddpm_steps(
    denoise: Denoiser,
    start: Tensor | tuple[int, ...],
    schedule: Schedule,
    *,
    generator: Generators | None = None,
    noise: Float[Tensor, "S *any"] | None = None,
    variance: str = "beta",
    clip: float | None = None,
) -> Iterator[FastStep]:
    """`ddpm.sample_steps`, faster: the same records for the same noise, up to rounding.

    A generator is left in another state: no noise is drawn for the last step, which adds none.

    Source: MoDiff Alg. 2.  Notebook: 03
    """
    beta, alpha_bar = schedule.beta.tolist(), schedule.alpha_bar.tolist()
    sigma = p_variance(schedule, variance).sqrt().tolist()
    plan = []
    for s in range(schedule.S, 0, -1):
        to_x0 = math.sqrt(alpha_bar[s - 1]) * beta[s] / (1 - alpha_bar[s])
        to_x = math.sqrt(1 - beta[s]) * (1 - alpha_bar[s - 1]) / (1 - alpha_bar[s])
        plan.append((s, to_x0, to_x, 0.0, sigma[s] if s > 1 else 0.0))
    return _walk(denoise, start, alpha_bar, plan, generator, noise, clip)


def ddim_steps(
    denoise: Denoiser,
    start: Tensor | tuple[int, ...],
    schedule: Schedule,
    steps: int | Sequence[int] = 10,
    eta: float = 0.0,
    *,
    generator: Generators | None = None,
    noise: Float[Tensor, "S *any"] | None = None,
    clip: float | None = None,
) -> Iterator[FastStep]:
    """`ddpm.ddim_steps`, faster: the same records for the same noise, up to rounding.

    Raises ValueError for steps that do not decrease or are outside 1..S, and for eta outside 0..1.
    Notebook: 12
    """
    visited, alpha_bar = falling(steps, schedule.S), schedule.alpha_bar.tolist()
    plan = []
    for s, after in zip(visited, [*visited[1:], 0], strict=True):
        then, sigma = alpha_bar[after], ddim_sigma(s, after, schedule, eta)
        plan.append((s, math.sqrt(then), 0.0, math.sqrt(max(1 - then - sigma**2, 0.0)), sigma))
    return _walk(denoise, start, alpha_bar, plan, generator, noise, clip)


@torch.no_grad()
def _walk(
    denoise: Denoiser,
    start: Tensor | tuple[int, ...],
    alpha_bar: list[float],
    plan: list[tuple],
    generator: Generators | None,
    noise: Tensor | None,
    clip: float | None,
) -> Iterator[FastStep]:
    """Follow a plan of (s, weight of x0_hat, weight of x_s, weight of eps_hat, sigma)."""
    x = starting_noise(start, generator)
    labels = (
        torch.tensor([p[0] for p in plan], device=x.device)[:, None].repeat(1, len(x)).unbind(0)
    )
    for label, (s, to_x0, to_x, to_eps, sigma) in zip(labels, plan, strict=True):
        a, b = math.sqrt(alpha_bar[s]), math.sqrt(1 - alpha_bar[s])
        eps_hat = denoise(x, label)
        step = FastStep(s, x, eps_hat, alpha_bar[s], clip)
        yield step
        if clip is None:
            x = torch.add(x * (to_x + to_x0 / a), eps_hat, alpha=to_eps - to_x0 * b / a)
        else:
            x = to_x0 * step.x0_hat + to_x * x + to_eps * step.eps_hat
        if sigma:
            x.add_(draw(x, generator) if noise is None else noise[s - 1], alpha=sigma)
    yield FastStep(0, x, torch.zeros_like(x), 1.0, clip)
