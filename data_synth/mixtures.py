"""Small Gaussian mixtures whose density is known exactly: the examples of notebooks 02 to 04."""

import math

import torch
from jaxtyping import Float, Int
from torch import Tensor

from motiondiff_edu.exact import Mixture, along_axes, mixture, part_log_densities, sample_mixture

__all__ = [
    "gaussian",
    "two_hills",
    "three_hills",
    "ring",
    "crossed_bars",
    "sample_mixture",
    "nearest_part",
]


def gaussian(mean: float = 0.0, std: float = 1.0) -> Mixture:
    """One Gaussian on a line."""
    return _on_a_line([1.0], [mean], [std])


def two_hills(left: float = 0.3, std: float = 0.3) -> Mixture:
    """Two hills on a line, at -1 and +1; the left one holds the share `left` of the mass."""
    return _on_a_line([left, 1 - left], [-1.0, 1.0], [std, std])


def three_hills() -> Mixture:
    """Three hills on a line, of different height, width and distance."""
    return _on_a_line([0.5, 0.2, 0.3], [-1.3, 0.1, 1.5], [0.25, 0.12, 0.4])


def ring(parts: int = 6, radius: float = 1.5, std: float = 0.2) -> Mixture:
    """Equal round hills on a circle in the plane."""
    angle = torch.arange(parts, dtype=torch.float64) * (2 * math.pi / parts)
    means = radius * torch.stack([angle.cos(), angle.sin()], 1)
    return mixture(
        torch.ones(parts), means, std**2 * torch.eye(2, dtype=torch.float64).expand(parts, 2, 2)
    )


def crossed_bars(length: float = 1.0, width: float = 0.15) -> Mixture:
    """Two long hills in the plane that lean towards each other, so that x and y depend."""
    bar = torch.tensor([[length**2 + width**2, length**2 - width**2]], dtype=torch.float64) / 2
    rising = torch.stack([bar[0], bar[0].flip(0)])
    falling = rising * torch.tensor([[1.0, -1.0], [-1.0, 1.0]], dtype=torch.float64)
    means = torch.tensor([[-1.2, 0.0], [1.2, 0.0]])
    return mixture(torch.tensor([0.4, 0.6]), means, torch.stack([rising, falling]))


def nearest_part(given: Mixture, x: Float[Tensor, "B D"]) -> Int[Tensor, "B"]:
    """The part that most likely produced each point: the mode to which it belongs."""
    off = along_axes(given, x.double()[:, None] - given.means)
    return part_log_densities(given.weights, off, given.variances).argmax(1)


def _on_a_line(weights: list[float], means: list[float], stds: list[float]) -> Mixture:
    variances = torch.tensor(stds, dtype=torch.float64) ** 2
    return mixture(
        torch.tensor(weights, dtype=torch.float64),
        torch.tensor(means, dtype=torch.float64)[:, None],
        variances[:, None, None],
    )
