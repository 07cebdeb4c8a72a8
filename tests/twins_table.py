"""Which step-by-step function of a notebook (in cells tagged `twin`) must agree with which function of the library.

TWINS = {"02": {"name in the notebook": Twin(library function, arguments)}}; `arguments` is a function without
parameters that returns the tuple both are called with. Where the two take different arguments, give lambdas:


    "q_sample_loop": Twin(ddpm.q_sample, lambda: (x0, 7, schedule, noise)),
    "attention_loop": Twin(lambda q, k, v: attend(q, k, v)[0], lambda: (q, k, v), atol=1e-5),

Sizes pairwise different, numbers from an own generator. Every notebook with twin cells needs an entry here.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import torch

from motiondiff_edu import ddpm


class Twin(NamedTuple):
    """A function of the library, what to call both with, and how closely they must agree."""

    library: Callable
    arguments: Callable[[], tuple[Any, ...]]
    atol: float = 1e-6
    rtol: float = 1e-5


TWINS: dict[str, dict[str, Twin]] = {}


LINEAR = ddpm.linear_schedule(100)


def _normal(*shape: int, seed: int = 0) -> torch.Tensor:
    return torch.randn(*shape, generator=torch.Generator().manual_seed(seed), dtype=torch.float64)


def _product_on_a_grid(mean_1, variance_1, mean_2, variance_2) -> tuple[torch.Tensor, torch.Tensor]:
    """Mean and variance of the product of two Gaussian densities, by sums."""
    grid = torch.linspace(-9, 9, 20_001, dtype=torch.float64)
    weight = (-((grid - mean_1) ** 2 / variance_1 + (grid - mean_2) ** 2 / variance_2) / 2).softmax(0)
    mean = (weight * grid).sum()
    return mean, (weight * (grid - mean) ** 2).sum()


def _two_steps(x0, s, beta, noises) -> torch.Tensor:
    return ddpm.q_step(ddpm.q_step(x0, 1, LINEAR, noises[1]), 2, LINEAR, noises[2])


def _kl(*four) -> torch.Tensor:
    return ddpm.gaussian_kl(*(value[:, None] for value in four))


TWINS["02"] = {
    "step_by_step": Twin(_two_steps, lambda: (_normal(2, 5), 2, LINEAR.beta, _normal(3, 2, 5, seed=1))),
    "at_once": Twin(
        lambda x0, s, beta, noise: ddpm.q_sample(x0, s, LINEAR, noise),
        lambda: (_normal(2, 5), 60, LINEAR.beta, _normal(2, 5, seed=1)),
    ),
    "product": Twin(_product_on_a_grid, lambda: (0.3, 0.5, -0.4, 0.2)),
    "between": Twin(ddpm.q_posterior, lambda: (_normal(2, 5), _normal(2, 5, seed=1), 20, LINEAR)),
    "kl": Twin(_kl, lambda: (_normal(7), _normal(7, seed=1).exp(), _normal(7, seed=2), _normal(7, seed=3).exp())),
}
