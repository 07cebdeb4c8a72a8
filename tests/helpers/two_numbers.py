"""One Gaussian in the plane, and its first number given: tasks of masked sampling."""

import torch

from motiondiff_edu.exact import Mixture, mixture


def correlated(rho: float = 0.9) -> Mixture:
    """One Gaussian in the plane whose coordinates agree.

    The second is rho times the first, and some noise.
    """
    covariance = torch.tensor([[[1.0, rho], [rho, 1.0]]], dtype=torch.float64)
    return mixture(torch.ones(1), torch.tensor([[0.3, -0.2]]), covariance)


def given_first(value: float, n: int) -> tuple[torch.Tensor, torch.Tensor]:
    """n samples of which the first number is given, and the mask."""
    known = torch.tensor([True, False]).expand(n, 2)
    return torch.tensor([value, float("nan")]).expand(n, 2), known
