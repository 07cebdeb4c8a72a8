"""A Gaussian mixture fitted to short windows of motion: all its conditionals are known exactly.

    x = m + W z + e,   z ~ sum_k w_k N(mu_k, C_k),   e ~ N(0, rest I) across W
W are the first principal axes of the windows; the mixture in them is fitted by expectation
maximisation (EM). It is a crude model of walking. That does not matter, because samplers are
compared with *it*, not with walking.
Source: EM after Dempster, Laird and Rubin (1977); principal axes with isotropic noise after Tipping
and Bishop (1999).
"""

from dataclasses import dataclass
from functools import cached_property

import torch
from jaxtyping import Float
from sklearn.mixture import GaussianMixture
from torch import Tensor

from ..ddpm import Denoiser, Schedule, at
from ..exact import Mixture, along_axes, mixture, part_log_densities, posterior_mean


def responsibilities(given: Mixture, x: Float[Tensor, "N D"]) -> Float[Tensor, "N K"]:
    """The probability of each part given each point: w_k N(x; m_k, C_k), scaled to sum to 1."""
    off = along_axes(given, x.double()[:, None] - given.means)
    return part_log_densities(given.weights, off, given.variances).softmax(1)


def fit_mixture(
    x: Float[Tensor, "N D"],
    K: int,
    *,
    ridge: float = 1e-3,
    rounds: int = 200,
    generator: torch.Generator | None = None,
) -> Mixture:
    """Fit K Gaussians by scikit-learn's EM, starting from the clusters of k-means.

    Every covariance gets `ridge` on its diagonal. Raises ValueError for fewer different points than
    parts.
    """
    x = x.double()
    different = len(x.unique(dim=0))
    if different < K:
        raise ValueError(f"{K} parts need at least {K} different points, not {different}")
    seed = int(torch.randint(2**31 - 1, (1,), generator=generator))
    fitted = GaussianMixture(K, reg_covar=ridge, max_iter=rounds, random_state=seed).fit(x.numpy())
    parts = fitted.weights_, fitted.means_, fitted.covariances_
    return mixture(*(torch.from_numpy(part) for part in parts))


@dataclass(frozen=True, eq=False)
class WindowMixture:
    """A mixture in a few principal axes, with the same small variance across all others.

    The axes are the columns of `basis`.
    """

    inside: Mixture
    mean: Float[Tensor, "D"]
    basis: Float[Tensor, "D r"]
    rest: float

    @cached_property
    def whole(self) -> Mixture:
        """The same mixture in all D dimensions."""
        D, r = self.basis.shape
        across = torch.linalg.qr(self.basis, mode="complete").Q[:, r:]
        axes = torch.cat(
            [self.basis @ self.inside.axes, across.expand(len(self.inside.weights), -1, -1)], dim=2
        )
        variances = torch.nn.functional.pad(self.inside.variances, (0, D - r), value=self.rest)
        return Mixture(
            self.inside.weights, self.mean + self.inside.means @ self.basis.T, axes, variances
        )

    def denoiser(self, schedule: Schedule) -> Denoiser:
        """The exact denoiser, eps_hat = E[eps | x_s].

        It equals `exact_denoiser(whole)`, but computes only in the principal axes.
        """

        def denoise(x_s: Tensor, s: Tensor) -> Tensor:
            x = x_s.double()
            alpha_bar = at(schedule.alpha_bar, s, x, first=1)
            a, off = alpha_bar.sqrt(), x - alpha_bar.sqrt() * self.mean
            z = off @ self.basis
            found = posterior_mean(self.inside, z, s, schedule)
            gain = a * self.rest / (alpha_bar * self.rest + 1 - alpha_bar)
            x0_hat = self.mean + gain * off + (found - gain * z) @ self.basis.T
            return ((x - a * x0_hat) / (1 - alpha_bar).sqrt()).to(x_s.dtype)

        return denoise


def fit_windows(
    x: Float[Tensor, "N D"], K: int = 5, axes: int = 30, *, generator: torch.Generator | None = None
) -> WindowMixture:
    """Fit K Gaussians in the first principal axes of standardised windows.

    The remaining variance is spread evenly over the other axes. No covariance is narrower than
    that. Raises ValueError for more axes than windows or columns.
    """
    N, D = x.shape
    if not axes < min(N, D):
        raise ValueError(f"{axes} axes need more windows and columns than {N} and {D}")
    x, mean = x.double(), x.double().mean(0)
    size, directions = torch.linalg.eigh((x - mean).T @ (x - mean) / N)  # the smallest first
    rest, basis = float(size[:-axes].clamp(min=0).mean()), directions[:, -axes:]
    return WindowMixture(
        fit_mixture((x - mean) @ basis, K, ridge=rest, generator=generator), mean, basis, rest
    )
