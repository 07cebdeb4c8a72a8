"""In-betweening: some entries of a motion are given, and a trained denoiser generates the others.

The first frames (the paper's "seed"), keyframes or a part of the body can be given.

    at every step s:  x_s = known ? noised snapshot of the given : x_s
                      then one normal step of sampling

At the end the given entries are restored exactly. No extra training is needed. But masking alone
does not sample the conditional distribution (notebook 15): `resampling_steps` goes there and back
at every step. A trained network's guess can also disagree with the given entries: pass a denoiser
that respects them (`beyond/guidance.py`). `editing.inpaint.inpaint` does all this in metres.
Source: MoFusion 4.4; resampling after RePaint (Lugmayr and others, 2022).  Notebook: 15
"""

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from numbers import Integral

import torch
from jaxtyping import Bool, Float
from torch import Tensor

from .ddpm import (
    Denoiser,
    Generators,
    Schedule,
    Step,
    ddim_sigma,
    ddim_step,
    draw,
    q_sample,
    timesteps,
)

X = Float[Tensor, "B *shape"]


def inpaint_steps(
    denoise: Denoiser,
    start: X,
    schedule: Schedule,
    given: X,
    known: Bool[Tensor, "B *shape"],
    *,
    steps: int | Sequence[int] = 50,
    eta: float = 1.0,
    generator: Generators | None = None,
) -> Iterator[Step]:
    """DDIM from `start` (x_S); noised snapshots of `given` replace the known entries of each x_s.

    Yields a `Step` for each call of the denoiser; the last one has the given entries themselves.

    `given` is used where `known` is True. The snapshots get new noise at every step. If nothing is
    known in the whole batch, no such noise is drawn, and the same generator gives the same sample
    as `ddim_steps`.
    `steps` is their number, or a list of the steps to visit; where the list rises, noise is added
    (`resampling_steps`).
    Raises ValueError for steps outside 1..S, and for one that follows itself.
    Source: MoFusion 4.4; RePaint's resampling.  Notebook: 15
    """
    some, x = bool(known.any()), start
    if isinstance(steps, int | Integral):
        visited = timesteps(schedule.S, int(steps))
    else:
        visited = list(steps)
    if not visited or not 1 <= min(visited) <= max(visited) <= schedule.S:
        raise ValueError(f"steps must be between 1 and {schedule.S}; these are {visited}")
    if any(s == after for s, after in pairwise(visited)):
        raise ValueError(f"steps must fall or rise, not stay; these are {visited}")
    if not some:  # no given entries, so resampling is not needed
        visited = sorted(set(visited), reverse=True)
    given = torch.where(known, given, torch.zeros_like(given))  # unknown entries can be NaN
    for s, after in pairwise([*visited, 0]):
        if after > s:
            x = _noised(x, s, after, schedule, generator)
            continue
        if some:
            x = torch.where(known, q_sample(given, s, schedule, draw(x, generator)), x)
        with torch.no_grad():
            eps_hat = denoise(x, torch.full((len(x),), s, device=x.device))
        step = Step(s, x, eps_hat, schedule)
        yield step
        sigma = ddim_sigma(s, after, schedule, eta)
        noise = draw(x, generator) if sigma else None
        x = ddim_step(step.x0_hat, eps_hat, after, schedule, sigma, noise)
    x = torch.where(known, given, x)
    yield Step(0, x, torch.zeros_like(x), schedule)


def resampling_steps(visited: Sequence[int], R: int) -> list[int]:
    """Take every leap but the last R times: forth, back by adding noise, and forth again.

    This lets unknown entries adapt to known ones. resampling_steps([30, 20, 10], 2) = [30, 20, 30,
    20, 10, 20, 10].
    Raises ValueError for R under 1.  Source: RePaint (Lugmayr and others, 2022).
    """
    if R < 1:
        raise ValueError(f"R must be at least 1, not {R}")
    leaps = [(s, after) * R for s, after in pairwise(visited)]
    return [s for leap in leaps for s in leap[:-1]] + list(visited[-1:])


def _noised(x: X, now: int, then: int, schedule: Schedule, generator: Generators | None) -> X:
    """The forward process from step `now` to a later one; it adds the noise that a leap removed."""
    left = float(schedule.alpha_bar[then]) / float(schedule.alpha_bar[now])
    return math.sqrt(left) * x + math.sqrt(1 - left) * draw(x, generator)
