"""A Gaussian mixture fitted to short windows of motion.

Motion whose every conditional is known exactly.

    x = m + W z + e,   z ~ sum_k w_k N(mu_k, C_k),   e ~ N(0, rest I) across W
W are the first principal axes of the windows, the mixture in them is fitted by expectation and
maximisation (EM). It is a crude model of walking, and that does not matter: samplers are judged
against *it*, not against walking.
Source: EM after Dempster, Laird and Rubin (1977); principal axes with an even rest after Tipping
and Bishop (1999).
Notebook: 15
"""

from dataclasses import dataclass
from functools import cached_property

import torch
from jaxtyping import Float
from torch import Tensor

from ..ddpm import Denoiser, Schedule, at
from ..exact import Mixture, along_axes, mixture, part_log_densities, posterior_mean


def responsibilities(given: Mixture, x: Float[Tensor, "N D"]) -> Float[Tensor, "N K"]:
    """The probability that each part made each point: w_k N(x; m_k, C_k), scaled to sum to 1.
    Notebook: 15"""
    off = along_axes(given, x.double()[:, None] - given.means)
    return part_log_densities(given.weights, off, given.variances).softmax(1)


def fit_mixture(
    x: Float[Tensor, "N D"],
    K: int,
    *,
    ridge: float = 1e-3,
    rounds: int = 50,
    generator: torch.Generator | None = None,
) -> Mixture:
    """Fit K Gaussians by EM, from K of the points drawn far apart.

    Every covariance gets `ridge` on its diagonal.

    Expectation: r_nk = share of part k in x_n. Maximisation: w_k = mean r_nk; m_k and C_k, means
    weighed by r_nk. A part that loses its points keeps a point's weight and stays where it was, so
    that none vanishes.
    Raises ValueError for fewer points than parts.  Notebook: 15
    """
    x, N = x.double(), len(x)
    if N < K:
        raise ValueError(f"{K} parts need as many points at least, not {N}")
    means = _far_apart(x, K, generator)
    share = torch.nn.functional.one_hot(torch.cdist(x, means).argmin(1), K).double()
    even = ridge * torch.eye(x.shape[1], dtype=torch.float64)
    for _ in range(rounds):
        mass = share.sum(0).clamp(min=1.0)
        missing = mass - share.sum(
            0
        )  # what a part lacks to a point's weight lies where the part is
        means = (share.T @ x + missing[:, None] * means) / mass[:, None]
        off = x - means[:, None]
        covariances = (share.T[..., None] * off).mT @ off / mass[:, None, None]
        fitted = mixture(mass, means, covariances + even)
        share = responsibilities(fitted, x)
    return fitted


def _far_apart(
    x: Float[Tensor, "N D"], K: int, generator: torch.Generator | None
) -> Float[Tensor, "K D"]:
    """Points drawn far apart from one another (k-means++).

    A point's chance grows with its squared distance from those already drawn.
    """
    chosen = x[torch.randint(len(x), (1,), generator=generator)]
    while len(chosen) < K:
        away = torch.cdist(x, chosen).min(1).values.square() + 1e-12
        chosen = torch.cat([chosen, x[torch.multinomial(away, 1, generator=generator)]])
    return chosen


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

        `exact_denoiser` of the whole, at the cost of the axes alone.
        """

        def denoise(x_s: Tensor, s: Tensor) -> Tensor:
            x = x_s.double()
            alpha_bar = at(schedule.alpha_bar, s, x)
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

    What is left over is spread evenly.

    No covariance is narrower than that rest.  Raises ValueError for more axes than windows or
    columns.   Notebook: 15
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
