"""Samplers with almost no cost of their own: DDPM as in the core, DDIM, few steps, a warm start.

Every sampler here is one rule, x_next = keep * x_s + turn * eps_hat + sigma * noise, with three
numbers for each step. They are Python floats made before the loop: around a small network it is a
scheduler's own arithmetic that takes time.
"""

import math
from collections.abc import Iterator, Sequence

import torch
from jaxtyping import Float
from torch import Tensor

from ..ddpm import Denoiser, Schedule, draw, p_variance, q_sample


class FastStep:
    """One moment of sampling, like `ddpm.Step`; x0_hat is computed only when somebody looks at
    it."""

    __slots__ = ("s", "x_s", "eps_hat", "_alpha_bar", "_clip")

    def __init__(self, s: int, x_s: Tensor, eps_hat: Tensor, alpha_bar: float, clip: float | None):
        self.s = s
        self.x_s = x_s
        self.eps_hat = eps_hat
        self._alpha_bar = alpha_bar
        self._clip = clip

    @property
    def x0_hat(self) -> Tensor:
        """(x_s - sqrt(1 - alpha_bar_s) eps_hat) / sqrt(alpha_bar_s)"""
        x0_hat = (self.x_s - math.sqrt(1 - self._alpha_bar) * self.eps_hat) / math.sqrt(
            self._alpha_bar
        )
        return x0_hat if self._clip is None else x0_hat.clamp(-self._clip, self._clip)


def timesteps(S: int, steps: int) -> list[int]:
    """Choose `steps` of the S diffusion steps, evenly spaced, S first: timesteps(100, 4) = [100,
    75, 50, 25]."""
    if not 1 <= steps <= S:
        raise ValueError(f"can take between 1 and {S} steps, not {steps}")
    return [S - (i * S) // steps for i in range(steps)]


def warm_start(
    guess: Float[Tensor, "B *shape"],
    s: int,
    schedule: Schedule,
    *,
    generator: torch.Generator | None = None,
) -> Float[Tensor, "B *shape"]:
    """Start from a guess of x0 instead of pure noise: noise it to step s, then walk on with
    steps=timesteps(s, n).

    A low s is fast and stays close to the guess; what the guess gets wrong is mended only as far as
    step s can reach.
    """
    return q_sample(guess, s, schedule, draw(guess, generator))


def ddpm_steps(
    denoise: Denoiser,
    start: Tensor | tuple[int, ...],
    schedule: Schedule,
    *,
    generator: torch.Generator | None = None,
    noise: Float[Tensor, "S *any"] | None = None,
    variance: str = "beta",
    clip: float | None = None,
) -> Iterator[FastStep]:
    """`ddpm.sample_steps`, faster: the same records for the same noise. Source: MoDiff Alg. 2.
    Notebook: 03."""
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
    generator: torch.Generator | None = None,
    noise: Float[Tensor, "S *any"] | None = None,
    clip: float | None = None,
) -> Iterator[FastStep]:
    """Leap from step to step: x_next = sqrt(ab_next) x0_hat + sqrt(1 - ab_next - sigma^2) eps_hat +
    sigma noise.

    sigma^2 = eta^2 (1 - ab_next) / (1 - ab_s) (1 - ab_s / ab_next). With eta = 0 no noise is drawn.
    Few steps with eta = 0 give samples that lie too close together (notebook 03): DDIM is not DDPM,
    only faster.
    Raises ValueError for steps that do not fall, or lie outside 1..S, and for an eta outside 0..1.
    """
    visited = timesteps(schedule.S, steps) if isinstance(steps, int) else list(steps)
    if (
        not visited
        or visited != sorted(set(visited), reverse=True)
        or not 1 <= visited[-1] <= visited[0] <= schedule.S
    ):
        raise ValueError(
            f"steps must fall, from {schedule.S} at most to 1 at least; these are {visited}"
        )
    if not 0 <= eta <= 1:
        raise ValueError(f"eta must lie between 0 (no noise) and 1 (DDPM's), not {eta}")
    alpha_bar = schedule.alpha_bar.tolist()
    plan = []
    for s, after in zip(visited, [*visited[1:], 0], strict=True):
        now, then = alpha_bar[s], alpha_bar[after]
        sigma = eta * math.sqrt((1 - then) / (1 - now) * (1 - now / then))
        plan.append((s, math.sqrt(then), 0.0, math.sqrt(max(1 - then - sigma**2, 0.0)), sigma))
    return _walk(denoise, start, alpha_bar, plan, generator, noise, clip)


@torch.no_grad()
def _walk(
    denoise: Denoiser,
    start: Tensor | tuple[int, ...],
    alpha_bar: list[float],
    plan: list[tuple],
    generator: torch.Generator | None,
    noise: Tensor | None,
    clip: float | None,
) -> Iterator[FastStep]:
    """Follow a plan of (s, weight of x0_hat, weight of x_s, weight of eps_hat, sigma)."""
    home = generator.device if generator else None
    x = start if isinstance(start, Tensor) else torch.randn(start, generator=generator, device=home)
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
            x = to_x0 * step.x0_hat + to_x * x + to_eps * eps_hat
        if sigma:
            x.add_(draw(x, generator) if noise is None else noise[s - 1], alpha=sigma)
    yield FastStep(0, x, torch.zeros_like(x), 1.0, clip)
