"""Checks of notebook 04: where the loss comes from."""

import math

import torch
from torch.distributions import Normal, kl_divergence

from ._report import check, expect, expect_close


@check
def prior_term(mine):
    """The expected values come from torch's own KL divergence."""
    x0 = torch.linspace(-2, 1.5, 30, dtype=torch.float64).reshape(2, 5, 3)
    alpha_bar = torch.tensor(0.36).double()
    each = kl_divergence(Normal(0.6 * x0, torch.full_like(x0, 0.8)), Normal(0.0, 1.0))
    half_means = (0.36 * x0**2).sum((1, 2)) / 2
    wrong_mean = each - 0.18 * x0**2 + (0.36 * x0) ** 2 / 2
    expect_close(
        mine(x0, alpha_bar),
        each.sum((1, 2)),
        "the prior's term",
        mistakes={
            "that is the sum over the whole batch; keep one number for each sample": each.sum(),
            "the entries of one sample are added up; you took their mean": each.mean((1, 2)),
            "return one number for each sample: sum over frames AND features": each.sum(2),
            "the factor one half is missing": 2 * each.sum((1, 2)),
            "the variance of q is not 1: its term and its logarithm are missing": half_means,
            "the logarithm is missing": half_means - 15 * 0.36 / 2,
            "the logarithm has the wrong sign": (each + math.log(0.64)).sum((1, 2)),
            "the mean of q(x_S | x0) is sqrt(alpha_bar) x0": wrong_mean.sum((1, 2)),
            "that is KL(prior || q); the two are swapped": kl_divergence(
                Normal(torch.zeros_like(x0), 1.0), Normal(0.6 * x0, 0.8)
            ).sum((1, 2)),
        },
    )
    return "This term has no eps_hat in it: training cannot change it, only the schedule can."


@check
def x0_weight(mine):
    """Check mine(beta, alpha_bar).

    The expected values are squared distances of two posterior means, for a unit error in x0, over
    2 beta.
    """
    beta = torch.tensor([0.0, 0.1, 0.2, 0.4, 0.5], dtype=torch.float64)
    alpha_bar = torch.tensor([1.0, 0.9, 0.72, 0.432, 0.216], dtype=torch.float64)
    moved = alpha_bar[:-1].sqrt() * beta[1:] / (1 - alpha_bar[1:])  # eq. 7: the factor of x0
    right = moved.square() / (2 * beta[1:])
    b, a = beta[1:], alpha_bar[1:]
    of_eps = b / (2 * (1 - b) * (1 - a))
    got = mine(beta, alpha_bar)
    expect(
        got is None or len(got) != 5,
        "you return S + 1 numbers; s = 0 is clean data and has no step",
    )
    expect_close(
        got,
        right,
        "u_1 ... u_4",
        mistakes={
            "that is the weight of eps errors; an x0 error of 1 is not an eps error of 1": of_eps,
            (
                "an eps error is sqrt(alpha_bar / (1 - alpha_bar)) times the x0 error, "
                "and it enters squared"
            ): of_eps * (a / (1 - a)).sqrt(),
            "the factor is inverted: at high noise a large x0 error is a small eps error": of_eps
            * (1 - a)
            / a,
        },
    )
    return (
        f"u_1 is {float(right[0] / right[-1]):.0f} times u_4 here: "
        "for errors of x0, the bound weights the last step most."
    )


@check
def tighter_bound(mine):
    """Two paths of known probability; then numbers whose exp is zero in the computer."""
    ratio = torch.tensor([[0.1, 0.6], [0.6, 0.6], [0.2, 0.3]], dtype=torch.float64)
    expect_close(
        mine(ratio.log()),
        [math.log(0.3), math.log(0.5)],
        "log of the mean ratio",
        mistakes={
            "that is the mean of the logs, the bound itself": ratio.log().mean(0),
            "that is the log of the SUM; the mean divides by K": ratio.sum(0).log(),
            "that is the mean over the samples; take it over the paths, the first axis": ratio.mean(
                1
            ).log(),
            "that is the mean ratio; take its logarithm": ratio.mean(0),
        },
    )
    far = torch.tensor([2000.0, 10.0], dtype=torch.float64)
    deep = mine(ratio.log() - far)
    expect(
        torch.isfinite(torch.as_tensor(deep)).all(),
        "at -2000 your answer is not finite: exp gives zero there. "
        "Subtract the largest of each column before exp, or use torch's own function",
    )
    expect_close(
        deep,
        [math.log(0.3) - 2000, math.log(0.5) - 10],
        "log of the mean ratio near -2000 and -10",
        rtol=1e-9,
    )
    return "With K = 1 it is the bound; as K grows, it approaches log p(x0)."
