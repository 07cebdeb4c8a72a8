"""Standardisation: zero mean and unit standard deviation for every feature, and back.

Poses and control have one scaler each. A missing input is zero *after* standardisation, which is
the average pose.
Source: MoDiff IV-A leaves it open; its corpus uses per-column z-scores.
"""

from dataclasses import dataclass

import torch
from jaxtyping import Float
from torch import Tensor

_STILL = 1e-4  # m, m/s or rad/s: a column that varies less is constant up to rounding


@dataclass(frozen=True, eq=False)
class Scaler:
    """x -> (x - mean) / std, column by column."""

    mean: Float[Tensor, "D"]
    std: Float[Tensor, "D"]

    @classmethod
    def fit(cls, x: Float[Tensor, "*N D"]) -> "Scaler":
        """Mean and (population) standard deviation of data.

        Raises ValueError on NaN, infinity, or no rows.

        A constant column gets std 1 and keeps its unit. Otherwise a value unseen in training, such
        as the first step to the side, would become thousands of standard deviations.
        """
        flat = x.reshape(-1, x.shape[-1]).double()
        if not len(flat):
            raise ValueError("there are no rows to compute mean and standard deviation from")
        if not torch.isfinite(flat).all():
            bad = int((~torch.isfinite(flat)).any(-1).nonzero()[0])
            raise ValueError(f"row {bad} of the data is not finite; clean the data first")
        std = flat.std(0, correction=0)
        return cls(flat.mean(0).float(), std.where(std > _STILL, 1.0).float())

    @classmethod
    def nothing(cls, D: int) -> "Scaler":
        """The scaler that leaves D columns unchanged."""
        return cls(torch.zeros(D), torch.ones(D))

    def part(self, columns: slice) -> "Scaler":
        """The scaler of some of the columns."""
        return Scaler(self.mean[columns], self.std[columns])

    def to(self, device) -> "Scaler":
        """The same scaler on another device."""
        return Scaler(self.mean.to(device), self.std.to(device))

    def transform(self, x: Float[Tensor, "*N D"]) -> Float[Tensor, "*N D"]:
        """Standardise: from metres (or m/s, rad/s) to the network's units."""
        return (x - self.mean) / self.std

    def inverse(self, x: Float[Tensor, "*N D"]) -> Float[Tensor, "*N D"]:
        """Undo `transform`: from the network's units back to metres (or m/s, rad/s)."""
        return x * self.std + self.mean
