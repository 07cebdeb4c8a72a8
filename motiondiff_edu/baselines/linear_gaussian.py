"""A walker without a network: the next pose is linear in past and control, plus Gaussian noise.

    next = W [past T_h poses, T_h rows of control, 1] + L z,   z ~ N(0, I)
W comes from ridge regression, and L L^T is the covariance of the residuals: a vector autoregression
with input. Every network here has to beat it. It has the interface of a walker, so
`rollout.generate` works with it.
Source: MoDiff III-C (the rollout); the model is ours.  Notebook: 07
"""

from dataclasses import dataclass
from types import SimpleNamespace

import torch
from jaxtyping import Float
from torch import Tensor

from ..ddpm import Generators, draw
from ..motion.scaler import Scaler
from ..performers.windows import Windows
from ..rollout import WindowSampler


@dataclass(frozen=True, eq=False)
class LinearGaussian:
    """The fitted weights, in standardised units; one pose is predicted at a time (T_p = 1)."""

    weight: Float[Tensor, "F D"]
    noise_factor: Float[Tensor, "D D"]  # L, lower triangular; L L^T is the noise's covariance
    T_h: int
    pose_scaler: Scaler
    control_scaler: Scaler

    @property
    def config(self) -> SimpleNamespace:
        """The sizes that `rollout.generate` needs."""
        return SimpleNamespace(
            T_h=self.T_h, T_p=1, D=self.weight.shape[1], C=len(self.control_scaler.mean)
        )

    def mean(
        self, past: Float[Tensor, "B T_h D"], control: Float[Tensor, "B T C"]
    ) -> Float[Tensor, "B D"]:
        """The expected next pose; it uses only the rows of control that belong to the past.

        Notebook: 07
        """
        return regressors(past, control[:, : self.T_h]) @ self.weight

    def window_sampler(self, steps: int | None = None, noise_scale: float = 1.0) -> WindowSampler:
        """A function that draws the next pose; `noise_scale` scales the noise (0 gives the mean).

        There is no diffusion, so `steps` has no effect.

        Notebook: 07
        """

        def sample(past: Tensor, control: Tensor, generator: Generators) -> Tensor:
            noise = draw(past.new_empty(len(past), self.weight.shape[1]), generator)
            return (self.mean(past, control) + noise_scale * noise @ self.noise_factor.T)[:, None]

        return sample

    def growth(self) -> float:
        """The factor by which the most persistent error grows per frame; above 1 it grows forever.

        It is the largest |eigenvalue| of the companion matrix, which moves T_h poses on by a frame.
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
    """One row for each window: all its past poses, their control, and 1.

    Notebook: 07
    """
    return torch.cat(
        [past.flatten(1), control.flatten(1), torch.ones(len(past), 1).to(past)], dim=1
    )


def design(windows: Windows) -> tuple[Float[Tensor, "K F"], Float[Tensor, "K D"]]:
    """All windows for least squares: a row of regressors for each, and the pose that follows.

    Raises ValueError unless the windows predict one pose (T_p = 1).  Notebook: 09
    """
    if windows.T_p != 1:
        raise ValueError(
            "this model predicts one pose at a time: "
            f"make the windows with T_p=1, not {windows.T_p}"
        )
    rows = windows.starts[:, None] + torch.arange(windows.T_h + 1)
    poses, control = windows.poses.double()[rows], windows.control.double()[rows[:, :-1]]
    return regressors(poses[:, :-1], control), poses[:, -1]


def fit(windows: Windows, ridge: float = 1e-3) -> LinearGaussian:
    """Least squares over all K windows: W = (X^T X + ridge K I)^-1 X^T Y.

    L comes from the covariance of the residuals.

    Raises ValueError unless the windows predict one pose (T_p = 1).  Notebook: 07
    """
    X, Y = design(windows)
    penalty = ridge * len(X) * torch.eye(X.shape[1], dtype=torch.float64)
    weight = torch.linalg.solve(X.T @ X + penalty, X.T @ Y)
    left = Y - X @ weight
    return walker_of(windows, weight, left.T @ left / len(left))


def walker_of(
    windows: Windows, weight: Float[Tensor, "F D"], covariance: Float[Tensor, "D D"]
) -> LinearGaussian:
    """The walker with these weights and this covariance of its noise."""
    noise_factor = torch.linalg.cholesky(
        covariance + 1e-12 * torch.eye(len(covariance), dtype=torch.float64)
    )
    return LinearGaussian(
        weight.float(),
        noise_factor.float(),
        windows.T_h,
        windows.pose_scaler,
        windows.control_scaler,
    )
