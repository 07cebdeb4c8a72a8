"""Inputs of the checks that are drawn: normal numbers, and noise schedules."""

import numpy as np
import torch


def tensors(rng: np.random.Generator, *shape: int) -> torch.Tensor:
    """Normal numbers, as float64."""
    return torch.from_numpy(rng.normal(size=shape))


def schedule(rng: np.random.Generator, S: int) -> torch.Tensor:
    """S + 1 falling shares of the signal, the first of them 1."""
    return torch.from_numpy(np.cumprod([1.0, *rng.uniform(0.5, 0.9, size=S)]))


def betas_of(alpha_bar: torch.Tensor) -> torch.Tensor:
    """The betas of a schedule; beta of step 0, which does nothing, is 0."""
    return torch.cat([torch.zeros(1), 1 - alpha_bar[1:] / alpha_bar[:-1]])
