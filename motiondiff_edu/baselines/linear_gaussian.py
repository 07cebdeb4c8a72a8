"""A walker with no network.

The next pose is a linear function of past and control, plus Gaussian noise.

    next = W [past T_h poses, T_h rows of control, 1] + L z,   z ~ N(0, I)
W is ridge regression, L L^T the covariance of what it leaves over: a vector autoregression with
input. It is what every network here has to beat. It has a walker's form, so `rollout.generate` lets
it walk.
Source: MoDiff III-C (the rollout); the model is ours.  Notebook: 07
"""

from dataclasses import dataclass
from types import SimpleNamespace

import torch
from jaxtyping import Float
from torch import Tensor

from ..motion.scaler import Scaler
from ..performers.windows import Windows
from ..rollout import WindowSampler


@dataclass(frozen=True, eq=False)
class LinearGaussian:
    """The fitted numbers, in standardised units; one pose is predicted at a time (T_p = 1)."""

    weight: Float[Tensor, "F D"]
    spread: Float[Tensor, "D D"]  # L, lower triangular
    T_h: int
    pose_scaler: Scaler
    control_scaler: Scaler

    @property
    def config(self) -> SimpleNamespace:
        """The sizes that `rollout.generate` asks for."""
        return SimpleNamespace(
            T_h=self.T_h, T_p=1, D=self.weight.shape[1], C=len(self.control_scaler.mean)
        )

    def mean(
        self, past: Float[Tensor, "B T_h D"], control: Float[Tensor, "B T C"]
    ) -> Float[Tensor, "B D"]:
        """The expected next pose; of the control, the rows beside the past are used.   Notebook:
        07"""
        return regressors(past, control[:, : self.T_h]) @ self.weight

    def window_sampler(self, steps: int | None = None, spread: float = 1.0) -> WindowSampler:
        """Draw the next pose; `spread` scales the noise (0: the mean).

        Without diffusion, `steps` changes nothing.

        Notebook: 07
        """

        def sample(past: Tensor, control: Tensor, generator: torch.Generator) -> Tensor:
            noise = torch.randn(len(past), self.weight.shape[1], generator=generator)
            return (self.mean(past, control) + spread * noise @ self.spread.T)[:, None]

        return sample

    def growth(self) -> float:
        """The factor by which the longest-lived error changes in a frame.

        Above 1 it grows for ever.

        The largest |eigenvalue| of the companion matrix, which moves T_h poses one frame on.
        Notebook: 07
        """
        D, size = self.weight.shape[1], self.T_h * self.weight.shape[1]
        companion = torch.zeros(size, size, dtype=torch.float64)
        companion[:-D, D:] = torch.eye(size - D, dtype=torch.float64)
        companion[-D:] = self.weight[:size].T.double()
        return float(torch.linalg.eigvals(companion).abs().max())


def regressors(
    past: Float[Tensor, "B T_h D"], control: Float[Tensor, "B T_h C"]
) -> Float[Tensor, "B F"]:
    """One row for each window: all its past poses, the control beside them, and 1.

    Notebook: 07
    """
    return torch.cat(
        [past.flatten(1), control.flatten(1), torch.ones(len(past), 1).to(past)], dim=1
    )


def design(windows: Windows) -> tuple[Float[Tensor, "K F"], Float[Tensor, "K D"]]:
    """All windows as least squares sees them: a row of regressors each, and the pose that follows.

    Raises ValueError unless the windows predict one pose (T_p = 1).  Notebook: 09
    """
    if windows.T_p != 1:
        raise ValueError(
            "this model predicts one pose at a time; "
            f"make the windows with T_p=1, not {windows.T_p}"
        )
    rows = windows.starts[:, None] + torch.arange(windows.T_h + 1)
    poses, control = windows.poses.double()[rows], windows.control.double()[rows[:, :-1]]
    return regressors(poses[:, :-1], control), poses[:, -1]


def fit(windows: Windows, ridge: float = 1e-3) -> LinearGaussian:
    """Least squares over all windows: W = (X^T X + ridge K I)^-1 X^T Y, K windows.

    L from the residuals' covariance.

    Raises ValueError unless the windows predict one pose (T_p = 1).  Notebook: 07
    """
    X, Y = design(windows)
    penalty = ridge * len(X) * torch.eye(X.shape[1], dtype=torch.float64)
    weight = torch.linalg.solve(X.T @ X + penalty, X.T @ Y)
    left = Y - X @ weight
    return fitted(windows, weight, left.T @ left / len(left))


def fitted(
    windows: Windows, weight: Float[Tensor, "F D"], covariance: Float[Tensor, "D D"]
) -> LinearGaussian:
    """The walker with these weights, whose noise has this covariance.  Notebook: 09"""
    spread = torch.linalg.cholesky(
        covariance + 1e-12 * torch.eye(len(covariance), dtype=torch.float64)
    )
    return LinearGaussian(
        weight.float(), spread.float(), windows.T_h, windows.pose_scaler, windows.control_scaler
    )
