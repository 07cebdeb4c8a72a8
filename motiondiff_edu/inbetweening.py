"""Some entries of a motion are given, the others are to be found.

Given may be seeds, keyframes, parts of the body.

    at every step s:  x_s = known ? noised snapshot of the given : x_s
                      then one step of sampling as ever

at the end the given entries are put back as they were. A trained denoiser is enough: nothing is
trained for it. Masking alone is not the conditional distribution (notebook 15): `resampled` goes
there and back at every step. Nor does a trained network's guess agree with what is given: hand over
a denoiser that does (`beyond/guidance.py`). In metres: `editing.inbetween.inbetween`.
Source: MoFusion 4.4; resampling after RePaint (Lugmayr and others, 2022).  Notebook: 15
"""

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise

import torch
from jaxtyping import Bool, Float
from torch import Tensor

from .ddpm import Denoiser, Schedule, Step, ddim_sigma, ddim_step, draw, q_sample, timesteps
from .prediction import x0_from_eps

X = Float[Tensor, "B *shape"]


@torch.no_grad()
def inpaint_steps(
    denoise: Denoiser,
    start: X,
    schedule: Schedule,
    given: X,
    known: Bool[Tensor, "B *shape"],
    *,
    steps: int | Sequence[int] = 50,
    eta: float = 1.0,
    generator: torch.Generator | None = None,
) -> Iterator[Step]:
    """DDIM from `start` (x_S) on which the known entries of x_s are given's, noised.

    Yields a `Step` for each call of the denoiser.

    `given` counts where `known` is True. Fresh noise is drawn for the snapshots at every step, and
    none where nothing is known: then the same generator gives the same sample as `ddim_steps`.
    `steps` is their number, or a list of the steps to visit; where the list rises, noise is added
    (`resampled`). The last record has the given entries themselves.
    Raises ValueError for steps outside 1..S.  Source: MoFusion 4.4; RePaint's resampling.
    Notebook: 15
    """
    some, x = bool(known.any()), start
    visited = timesteps(schedule.S, steps) if isinstance(steps, int) else list(steps)
    if not visited or not 1 <= min(visited) <= max(visited) <= schedule.S:
        raise ValueError(f"steps must lie between 1 and {schedule.S}; these are {visited}")
    if not some:  # what is made has nothing to agree with: no way back is needed
        visited = sorted(set(visited), reverse=True)
    given = torch.where(known, given, torch.zeros_like(given))  # what is not known may be NaN
    for s, after in pairwise([*visited, 0]):
        if after > s:
            x = _noised(x, s, after, schedule, generator)
            continue
        if some:
            x = torch.where(known, q_sample(given, s, schedule, draw(x, generator)), x)
        eps_hat = denoise(x, torch.full((len(x),), s, device=x.device))
        x0_hat = x0_from_eps(x, s, eps_hat, schedule)
        yield Step(s, x, x0_hat, eps_hat)
        sigma = ddim_sigma(s, after, schedule, eta)
        noise = draw(x, generator) if sigma else None
        x = ddim_step(x0_hat, eps_hat, after, schedule, sigma, noise)
    x = torch.where(known, given, x)
    yield Step(0, x, x, torch.zeros_like(x))


def resampled(visited: Sequence[int], R: int) -> list[int]:
    """Make every leap but the last R times: there, back by as much noise, and there.

    So unknown entries can come to agree with known ones. resampled([30, 20, 10], 2) = [30, 20, 30,
    20, 10, 20, 10].
    Raises ValueError for R under 1.  Source: RePaint (Lugmayr and others, 2022).
    """
    if R < 1:
        raise ValueError(f"every step is made once at least, not R = {R}")
    leaps = [(s, after) * R for s, after in pairwise(visited)]
    return [s for leap in leaps for s in leap[:-1]] + list(visited[-1:])


def _noised(x: X, now: int, then: int, schedule: Schedule, generator: torch.Generator | None) -> X:
    """The forward process from step `now` to a later one: as much noise as the leap took away."""
    left = float(schedule.alpha_bar[then]) / float(schedule.alpha_bar[now])
    return math.sqrt(left) * x + math.sqrt(1 - left) * draw(x, generator)
