"""The exact denoiser of a known distribution: sampling without training, and a right answer.

A Gaussian mixture plus Gaussian noise is again a Gaussian mixture. So the density of x_s and the
mean of x0 given x_s have formulas. A finite data set is a mixture whose parts have no width.
"""

from collections.abc import Callable
from dataclasses import dataclass

import torch
from jaxtyping import Bool, Float, Int
from torch import Tensor

from .ddpm import Denoiser, Schedule, at, checked_step


@dataclass(frozen=True, eq=False)
class Mixture:
    """A mixture of K Gaussians in D dimensions, kept in float64.

    Covariances are stored as their axes and variances.
    """

    weights: Float[Tensor, "K"]
    means: Float[Tensor, "K D"]
    axes: Float[Tensor, "K D D"]
    variances: Float[Tensor, "K D"]

    def mean(self) -> Float[Tensor, "D"]:
        return self.weights @ self.means

    def covariance(self) -> Float[Tensor, "D D"]:
        """The covariance within the parts plus the covariance of their means."""
        inside = torch.einsum(
            "k,kia,ka,kja->ij", self.weights, self.axes, self.variances, self.axes
        )
        off = self.means - self.mean()
        return inside + torch.einsum("k,ki,kj->ij", self.weights, off, off)


def mixture(
    weights: Float[Tensor, "K"], means: Float[Tensor, "K D"], covariances: Float[Tensor, "K D D"]
) -> Mixture:
    """Make a mixture from its weights (scaled to sum to 1), means and covariance matrices.

    Raises ValueError for a weight that is not positive or a matrix that is not a covariance.
    """
    variances, axes = torch.linalg.eigh(covariances.double())
    for k, (weight, least) in enumerate(zip(weights, variances.amin(-1), strict=True)):
        if not torch.allclose(covariances[k], covariances[k].mT):
            raise ValueError(f"the covariance of part {k} of the mixture is not symmetric")
        if not weight > 0 or not least >= -1e-9:
            what = f"has weight {weight:g}" if not weight > 0 else f"has a variance of {least:g}"
            raise ValueError(f"part {k} of the mixture {what}; make it positive")
    weights = weights.double()
    return Mixture(weights / weights.sum(), means.double(), axes, variances.clamp(min=0))


def sample_mixture(
    given: Mixture, n: int, generator: torch.Generator | None = None
) -> Float[Tensor, "n D"]:
    """Draw n points: for each, first a part and then a point of it."""
    k = torch.multinomial(given.weights, n, replacement=True, generator=generator)
    z = torch.randn(n, given.means.shape[1], generator=generator, dtype=torch.float64)
    return given.means[k] + torch.einsum("nij,nj->ni", given.axes[k], given.variances[k].sqrt() * z)


def noised_mixture(given: Mixture, s: int, schedule: Schedule) -> Mixture:
    """The mixture q(x_s).

    Means become sqrt(alpha_bar_s) mean, variances alpha_bar_s var + 1 - alpha_bar_s.
    """
    alpha_bar = schedule.alpha_bar[checked_step(s, schedule.S)]
    return Mixture(
        given.weights,
        alpha_bar.sqrt() * given.means,
        given.axes,
        alpha_bar * given.variances + 1 - alpha_bar,
    )


def log_density(given: Mixture, x: Float[Tensor, "B D"]) -> Float[Tensor, "B"]:
    """The exact log-density, in nats: log sum_k w_k N(x; m_k, C_k).

    Raises ValueError for a part without width.  Notebook: 03, 04
    """
    _check_width(given.variances)
    off = along_axes(given, x.double()[:, None] - given.means)
    return part_log_densities(given.weights, off, given.variances).logsumexp(1)


def _check_width(variances: Float[Tensor, "K D"]) -> None:
    """A part without width is a point: it has no density."""
    flat = (variances <= 0).any(-1).nonzero()
    if len(flat):
        raise ValueError(
            f"part {int(flat[0])} of the mixture has no width: add noise (`noised_mixture`)"
        )


def _on(device: torch.device, given: Mixture) -> Mixture:
    return Mixture(
        *(part.to(device) for part in (given.weights, given.means, given.axes, given.variances))
    )


def along_axes(given: Mixture, off: Float[Tensor, "B K D"]) -> Float[Tensor, "B K D"]:
    """Coordinates of each offset along the axes in which its part has a diagonal covariance."""
    return torch.einsum("kij,bki->bkj", given.axes, off)


def part_log_densities(
    weights: Float[Tensor, "K"], off: Float[Tensor, "B K D"], variances: Float[Tensor, "*B K D"]
) -> Float[Tensor, "B K"]:
    """log w_k N(x; m_k, C_k) for every part k, from the offsets x - m_k along the axes."""
    return weights.log() - (off.square() / variances + (2 * torch.pi * variances).log()).sum(-1) / 2


def posterior_mean(
    given: Mixture, x_s: Float[Tensor, "B D"], s: Int[Tensor, "B"], schedule: Schedule
) -> Float[Tensor, "B D"]:
    """E[x0 | x_s] of a mixture: the parts' means, weighted by their probabilities given x_s.

    For one part it is m + a C (a^2 C + (1 - a^2) I)^-1 (x_s - a m), with a = sqrt(alpha_bar_s).
    Raises ValueError for a part without width at step 0, where x_s is x0.
    Notebook: 03.
    """
    if not given.variances.all() and bool((s == 0).any()):
        _check_width(given.variances)
    given, x = _on(x_s.device, given), x_s.double()[:, None]
    alpha_bar = at(schedule.alpha_bar, s, x)
    off = along_axes(given, x - alpha_bar.sqrt() * given.means)
    variances = alpha_bar * given.variances + 1 - alpha_bar
    share = part_log_densities(given.weights, off, variances).softmax(1)
    gain = alpha_bar.sqrt() * given.variances / variances
    return torch.einsum(
        "bk,bki->bi", share, given.means + torch.einsum("kij,bkj->bki", given.axes, gain * off)
    )


def conditional(given: Mixture, values: Float[Tensor, "D"], known: Bool[Tensor, "D"]) -> Mixture:
    """The distribution of the unknown entries given the values of the known ones: again a mixture.

    Part k becomes N(m_u + G (x_k - m_k), C_uu - G C_ku) with G = C_uk C_kk^-1, and its weight is
    proportional to w_k N(x_k; m_k, C_kk).
    Raises ValueError if nothing or everything is known, or a part has no width.
    """
    if not known.any() or known.all():
        raise ValueError("at least one entry must be known, and at least one unknown")
    _check_width(given.variances)
    seen, gain, left = conditional_parts(given, known)
    value = values.double()[known]
    off = along_axes(seen, (value - seen.means)[None])
    shares = part_log_densities(seen.weights, off, seen.variances)[0].softmax(0)
    means = given.means[:, ~known] + torch.einsum("kui,ki->ku", gain, value - seen.means)
    return mixture(shares.clamp(min=1e-300), means, left)


def conditional_parts(
    given: Mixture, known: Bool[Tensor, "D"]
) -> tuple[Mixture, Float[Tensor, "K U V"], Float[Tensor, "K U U"]]:
    """What a conditional needs, whatever the values are (U entries are unknown, V known).

    The mixture of the known entries; the gain G of each part; and the covariance of its unknown
    entries once the known ones are given.
    """
    covariances = torch.einsum("kia,ka,kja->kij", given.axes, given.variances, given.axes)
    inside, across = covariances[:, known][:, :, known], covariances[:, ~known][:, :, known]
    gain = torch.linalg.solve(inside, across.mT).mT
    left = covariances[:, ~known][:, :, ~known] - gain @ across.mT
    return mixture(given.weights, given.means[:, known], inside), gain, (left + left.mT) / 2


def dataset_mean(
    data: Float[Tensor, "N D"], x_s: Float[Tensor, "B D"], s: Int[Tensor, "B"], schedule: Schedule
) -> Float[Tensor, "B D"]:
    """E[x0 | x_s] when x0 is one of N known samples: their mean, weighted by p(x_n | x_s).

    weights = softmax(-||x_s - a x_n||^2 / (2 (1 - a^2))), with a = sqrt(alpha_bar_s).
    Raises IndexError for step 0, where x_s is x0.  Notebook: 03.
    """
    x, data = x_s.double(), data.to(x_s.device).double()
    alpha_bar = at(schedule.alpha_bar, s, x, first=1)
    closeness = alpha_bar.sqrt() * x @ data.T - alpha_bar * data.square().sum(1) / 2
    return (closeness / (1 - alpha_bar)).softmax(1) @ data


def exact_denoiser(given: Mixture, schedule: Schedule) -> Denoiser:
    """The optimal denoiser for a mixture, eps_hat = E[eps | x_s].

    x_s has D entries per sample, in any shape.

    Notebook: 03.
    """
    return _denoiser(lambda x_s, s: posterior_mean(given, x_s, s, schedule), schedule)


def dataset_denoiser(data: Float[Tensor, "N *shape"], schedule: Schedule) -> Denoiser:
    """The optimal denoiser for a finite data set; it can only reproduce its samples.

    Notebook: 03.
    """
    return _denoiser(lambda x_s, s: dataset_mean(data.flatten(1), x_s, s, schedule), schedule)


def _denoiser(mean_of_x0: Callable[[Tensor, Tensor], Tensor], schedule: Schedule) -> Denoiser:
    """eps_hat = (x_s - a E[x0 | x_s]) / sqrt(1 - a^2), computed in float64.

    The result has the caller's shape and dtype. It raises IndexError for step 0, where x_s has no
    noise.
    """

    def denoise(x_s: Tensor, s: Tensor) -> Tensor:
        x = x_s.flatten(1).double()
        alpha_bar = at(schedule.alpha_bar, s, x, first=1)
        eps_hat = (x - alpha_bar.sqrt() * mean_of_x0(x, s)) / (1 - alpha_bar).sqrt()
        return eps_hat.reshape(x_s.shape).to(x_s.dtype)

    return denoise
