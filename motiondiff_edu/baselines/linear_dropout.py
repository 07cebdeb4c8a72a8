"""Dropout of the past in least squares, in closed form: each kind is a ridge regression.

Least squares depends on a dropped past x~ only through two expectations:
    E[x~] = keep x,    E[x~ x~^T] = share * x x^T + floor I      (* entry by entry)
So the fit to infinitely many dropped pasts has a formula. With W the weights of the past and
V = keep W, its normal equations are those of clean pasts with a penalty:
(share / keep^2 - 1) * X^T X + floor / keep^2 I.
Source: MoDiff III-D (what is dropped); the algebra is ours.  Notebook: 09
"""

from collections.abc import Callable
from dataclasses import dataclass

import torch
from jaxtyping import Float
from torch import Tensor

from ..performers.windows import Windows
from .linear_gaussian import LinearGaussian, design, walker_of

Drop = Callable[
    [Tensor, torch.Generator | None], Tensor
]  # (past (B, T_h, D), generator) -> dropped past


@dataclass(frozen=True, eq=False)
class Moments:
    """The moments of a dropped past: E[x~] = keep x, E[x~ x~^T] = share * x x^T + floor I.

    The functions here that make them raise ValueError for a rate outside 0..1.  Notebook: 09
    """

    keep: float
    share: Float[Tensor, "*P"]  # a number, or one for each pair of entries
    floor: float = 0.0


@dataclass(frozen=True, eq=False)
class Products:
    """Everything that least squares needs: means over windows of x x^T, x y^T and y y^T.

    All are of standardised values.
    """

    xx: Float[Tensor, "F F"]
    xy: Float[Tensor, "F D"]
    yy: Float[Tensor, "D D"]
    windows: Windows

    @property
    def past(self) -> int:
        """How many of the F regressors belong to the past; these come first."""
        return self.windows.T_h * self.yy.shape[0]


def check_rate(rate: float) -> None:
    """Raise ValueError unless the rate is a probability."""
    if not 0 <= rate <= 1:
        raise ValueError(f"a rate must be between 0 and 1, not {rate:g}")


def noise_moments(rate: float, alpha_bar: Float[Tensor, "S"]) -> Moments:
    """Diffusion dropout with equally likely steps, given by their alpha_bar.

    In a noised past, keep is the mean of sqrt(alpha_bar), share that of alpha_bar, floor that of
    1 - alpha_bar; a clean past has 1, 1 and 0.
    """
    check_rate(rate)
    keep, share = 1 - rate + rate * alpha_bar.sqrt().mean(), 1 - rate + rate * alpha_bar.mean()
    return Moments(float(keep), share.double(), float(rate * (1 - alpha_bar).mean()))


def zero_moments(rate: float) -> Moments:
    """Whole pasts set to zero.

    The penalty is proportional to X^T X, so it shrinks all weights of the past by the same factor.
    """
    check_rate(rate)
    return Moments(1 - rate, torch.tensor(1 - rate, dtype=torch.float64))


def frames_zeroed(rate: float, T_h: int, D: int) -> Moments:
    """MoGlow's frame dropout.

    Two different frames are both kept with probability (1 - rate)^2, one frame with 1 - rate.
    """
    check_rate(rate)
    frame = torch.arange(T_h * D) // D
    alike = frame[:, None] == frame
    both = torch.tensor([1 - rate, (1 - rate) ** 2], dtype=torch.float64)
    return Moments(1 - rate, torch.where(alike, both[0], both[1]))


def entries_rescaled(rate: float, entries: int) -> Moments:
    """nn.Dropout on the past: entries become zero, the others are divided by 1 - rate.

    So the mean does not change.
    """
    check_rate(rate)
    if rate == 1:
        raise ValueError("nn.Dropout at rate 1 leaves nothing to rescale; use a rate below 1")
    share = torch.ones(entries, entries, dtype=torch.float64)
    return Moments(1.0, share + rate / (1 - rate) * torch.eye(entries, dtype=torch.float64))


def products(
    windows: Windows,
    drop: Drop | None = None,
    draws: int = 1,
    generator: torch.Generator | None = None,
) -> Products:
    """The products of all windows, with each past dropped `draws` times by `drop`.

    Raises ValueError unless the windows predict one pose (T_p = 1).  Notebook: 09
    """
    X, Y = design(windows)
    past, sums = windows.T_h * Y.shape[1], []
    for _ in range(draws):
        if drop:
            left = drop(X[:, :past].unflatten(1, (windows.T_h, -1)), generator)
            seen = torch.cat([left.flatten(1), X[:, past:]], dim=1)
        else:
            seen = X
        sums.append(torch.cat([seen.T @ seen, seen.T @ Y], dim=1))
    both = torch.stack(sums).mean(0) / len(X)
    return Products(both[:, : len(both)], both[:, len(both) :], Y.T @ Y / len(Y), windows)


def expected_products(clean: Products, moments: Moments) -> Products:
    """The limit of `products(windows, drop)` for many draws, from the products of clean pasts.

    Notebook: 09
    """
    P = clean.past
    xx = clean.xx.clone()
    xy = clean.xy.clone()
    xx[:P, :P] = moments.share * xx[:P, :P] + moments.floor * torch.eye(P, dtype=xx.dtype)
    xx[:P, P:] *= moments.keep
    xx[P:, :P] *= moments.keep
    xy[:P] *= moments.keep
    return Products(xx, xy, clean.yy, clean.windows)


def fit(dropped: Products, clean: Products | None = None, ridge: float = 1e-6) -> LinearGaussian:
    """Least squares on dropped pasts.

    The walker's noise is the residual on clean pasts, because it will be used with these. Without
    `clean`, `dropped` are the products of clean pasts: ordinary least squares.  Notebook: 09
    """
    clean = clean or dropped
    weight = torch.linalg.solve(
        dropped.xx + ridge * torch.eye(len(dropped.xx), dtype=torch.float64), dropped.xy
    )
    left = clean.yy - weight.T @ clean.xy - clean.xy.T @ weight + weight.T @ clean.xx @ weight
    return walker_of(clean.windows, weight, (left + left.T) / 2)


def contributions(walker: LinearGaussian, clean: Products) -> tuple[float, float]:
    """How much past and control contribute to the next pose: RMS of each part of the sum,
    in standard deviations.


    Notebook: 09
    """
    weight, P = walker.weight.double(), clean.past
    centred = clean.xx - torch.outer(
        clean.xx[-1], clean.xx[-1]
    )  # the last regressor is the constant 1
    parts = (slice(0, P), slice(P, len(weight) - 1))
    past, control = (
        ((weight[part].T @ centred[part, part]) * weight[part].T).sum(1).mean().sqrt()
        for part in parts
    )
    return float(past), float(control)
