"""Filling holes without a network: the expected missing values under one Gaussian.

    E[x_m | x_k] = mean_m + C_mk (C_kk + ridge I)^-1 (x_k - mean_k)
One mean and one covariance C are enough for every mask. For each mask it is the ridge regression of
the missing columns on the known ones, in closed form. The result is a mean, so it does not show
which other values are possible.
Source: this baseline is ours; the papers have none.  Notebook: 10
"""

from dataclasses import dataclass

import torch
from jaxtyping import Bool, Float
from torch import Tensor

from ..motion.scaler import Scaler
from ..performers.windows import Windows


@dataclass(frozen=True, eq=False)
class ConditionalMean:
    """Mean and covariance of rows (float64), and the ridge that stabilises the regression."""

    mean: Float[Tensor, "F"]
    covariance: Float[Tensor, "F F"]
    ridge: float = 1e-2

    def fill(self, x: Float[Tensor, "B F"], known: Bool[Tensor, "B F"]) -> Float[Tensor, "B F"]:
        """The rows with unknown entries replaced by their expected values.

        Known entries stay exactly. If nothing is known, the result is the mean. The values of `x`
        in a hole are ignored and can be NaN.
        """
        filled, masks = x.clone(), known.unique(dim=0, return_inverse=True)
        for have, rows in ((mask, masks[1] == k) for k, mask in enumerate(masks[0])):
            lack = ~have
            visible = self.covariance[have][:, have]
            visible = visible + self.ridge * torch.eye(len(visible)).double()
            weights = torch.linalg.solve(visible, self.covariance[have][:, lack])
            away = x[rows][:, have].double() - self.mean[have]
            guess = torch.where(have, x[rows], x.new_zeros(()))
            guess[:, lack] = (self.mean[lack] + away @ weights).to(x)
            filled[rows] = guess
        return filled


def fit(rows: Float[Tensor, "K F"], ridge: float = 1e-2) -> ConditionalMean:
    """Mean and covariance (divided by K) of training rows.

    The rows must be in units in which one `ridge` suits all columns.

    Raises ValueError for fewer than two rows or a ridge that is not above 0.
    """
    if len(rows) < 2 or ridge <= 0:
        raise ValueError(
            "a covariance needs two rows and a ridge above 0, "
            f"not {len(rows)} rows and ridge {ridge:g}"
        )
    mean = rows.double().mean(0)
    centred = rows.double() - mean
    return ConditionalMean(mean, centred.T @ centred / len(rows), ridge)


@dataclass(frozen=True, eq=False)
class WindowRidge:
    """ConditionalMean for windows of a walk: T_h poses with holes, and the control of all frames.

    The control is never missing.
    """

    inner: ConditionalMean
    pose_scaler: Scaler
    control_scaler: Scaler

    def reconstruct(
        self,
        past: Float[Tensor, "B T_h D"],
        known: Bool[Tensor, "B T_h D"],
        control: Float[Tensor, "B T C"],
    ) -> Float[Tensor, "B T_h D"]:
        """The past (metres) with its holes filled by their expected values.

        Notebook: 10
        """
        rows = _rows(self.pose_scaler.transform(past), self.control_scaler.transform(control))
        given = torch.ones(len(rows), rows.shape[1] - known[0].numel(), dtype=torch.bool)
        filled = self.inner.fill(rows, torch.cat([known.flatten(1), given], dim=1))
        poses = self.pose_scaler.inverse(filled[:, : known[0].numel()].unflatten(1, past.shape[1:]))
        return torch.where(known, past, poses)


def fit_windows(windows: Windows, ridge: float = 1e-2, every: int = 3) -> WindowRidge:
    """Fit on every third window of training data, because neighbours are nearly equal.

    Notebook: 10
    """
    rows = windows.starts[::every, None] + torch.arange(windows.T_h + windows.T_p)
    together = _rows(windows.poses[rows[:, : windows.T_h]], windows.control[rows])
    return WindowRidge(fit(together, ridge), windows.pose_scaler, windows.control_scaler)


def _rows(poses: Float[Tensor, "B T_h D"], control: Float[Tensor, "B T C"]) -> Float[Tensor, "B F"]:
    return torch.cat([poses.flatten(1), control.flatten(1)], dim=1)
