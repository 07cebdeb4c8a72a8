"""Standardisation: zero mean and unit spread for every feature, and back.

Poses and control have a scaler each. A missing input is zero *after* standardisation: the average
pose.
Source: MoDiff IV-A leaves it open; per-column z-scores are the corpus' own habit.
"""

from dataclasses import dataclass

import torch
from jaxtyping import Float
from torch import Tensor

_STILL = 1e-4  # m, m/s or rad/s: a column that moves less, moves by rounding only


@dataclass(frozen=True, eq=False)
class Scaler:
    """x -> (x - mean) / std, column by column."""

    mean: Float[Tensor, "D"]
    std: Float[Tensor, "D"]

    @classmethod
    def fit(cls, x: Float[Tensor, "*N D"]) -> "Scaler":
        """Mean and (population) standard deviation of data.

        Raises ValueError on NaN, infinity, or no rows.

        A column that never moves gets std 1: it stays in its own unit, so that a value unseen in
        training (the first step to the side) arrives as itself and not as thousands of standard
        deviations.
        """
        flat = x.reshape(-1, x.shape[-1]).double()
        if not len(flat):
            raise ValueError("there are no rows to take mean and deviation of")
        if not torch.isfinite(flat).all():
            bad = int((~torch.isfinite(flat)).any(-1).nonzero()[0])
            raise ValueError(f"row {bad} of the data to be scaled is not finite; clean it first")
        std = flat.std(0, correction=0)
        return cls(flat.mean(0).float(), std.where(std > _STILL, 1.0).float())

    @classmethod
    def nothing(cls, D: int) -> "Scaler":
        """The scaler that leaves D columns as they are."""
        return cls(torch.zeros(D), torch.ones(D))

    def to(self, device) -> "Scaler":
        """The same scaler on another device."""
        return Scaler(self.mean.to(device), self.std.to(device))

    def transform(self, x: Float[Tensor, "*N D"]) -> Float[Tensor, "*N D"]:
        """To the network's units."""
        return (x - self.mean) / self.std

    def inverse(self, x: Float[Tensor, "*N D"]) -> Float[Tensor, "*N D"]:
        """Back to metres (or m/s, rad/s)."""
        return x * self.std + self.mean
