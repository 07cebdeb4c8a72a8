"""Checks of notebook 03: taking noise away."""

import math

import torch

from ._report import check, expect_close


@check
def best_guess(mine):
    """The expected values come from Bayes' rule, sample by sample, in plain Python."""
    x_s = torch.tensor([[0.3, -0.2, 0.5], [-0.8, 0.1, 0.9]], dtype=torch.float64)
    data = torch.tensor(
        [[-1, 0, 0.4], [1, 0.5, -1], [0.2, -0.6, 1], [0, 1, 1.2]], dtype=torch.float64
    )
    alpha_bar = torch.tensor([0.36, 0.81], dtype=torch.float64)

    def answer(
        scale=lambda a: math.sqrt(a), spread=lambda a: 2 * (1 - a), order=(0, 1), over_data=True
    ):
        table = []
        for x, i in zip(x_s, order, strict=True):
            a = float(alpha_bar[i])
            w = [
                math.exp(
                    -sum((float(p) - scale(a) * float(q)) ** 2 for p, q in zip(x, d, strict=True))
                    / spread(a)
                )
                for d in data
            ]
            table.append(w)
        weight = torch.tensor(table, dtype=torch.float64)
        return weight / weight.sum(int(over_data), keepdim=True) @ data

    expect_close(
        mine(x_s, alpha_bar, data),
        answer(),
        "E[x0 | x_s]",
        mistakes={
            "the candidates must be shrunk by sqrt(alpha_bar) before they are compared": answer(
                scale=lambda a: 1.0
            ),
            "alpha_bar scales variances; the candidates are scaled by its square root": answer(
                scale=lambda a: a
            ),
            "a Gaussian's exponent is divided by TWICE the variance": answer(
                spread=lambda a: 1 - a
            ),
            "the noise in x_s has variance 1 - alpha_bar; that is missing in the exponent": answer(
                spread=lambda a: 2.0
            ),
            "the exponent is divided by a standard deviation, not by the variance": answer(
                spread=lambda a: 2 * math.sqrt(1 - a)
            ),
            "the weights add up to 1 over the samples; over the candidates they should": answer(
                over_data=False
            ),
            "both samples use the alpha_bar of the first": answer(order=(0, 0)),
            "that is the plain mean of the data: the candidates have no weights": data.mean(
                0
            ).expand(2, 3),
        },
    )
    return "The best guess is no row of the data: it is a mean, and a mean need not be a sample."


@check
def step_back(mine):
    """Check mine(x_s, s, eps_hat, beta, alpha_bar, z).

    At s = 2 the square roots of the tables are round numbers.
    """
    beta = torch.tensor([0.0, 0.4375, 0.36])
    alpha_bar = torch.tensor([1.0, 0.5625, 0.36])
    x = torch.tensor([[1.0, -2.0, 0.5]])
    eps = torch.tensor([[0.4, 1.0, -1.0]])
    z = torch.tensor([[10.0, -10.0, 5.0]])
    mean = (x - 0.36 / 0.8 * eps) / 0.8
    expect_close(
        mine(x, 2, eps, beta, alpha_bar, z),
        mean + 0.6 * z,
        "x_1",
        mistakes={
            "the noise is multiplied by the variance; take the standard deviation": mean + 0.36 * z,
            "no noise was added; only the last step, s = 1, adds none": mean,
            "the re-scaling by 1 / sqrt(alpha_s) is missing": x - 0.36 / 0.8 * eps + 0.6 * z,
            "all the noise was removed; one step removes beta_s / sqrt(1 - alpha_bar_s) of it": (
                x - 0.8 * eps
            )
            / 0.8
            + 0.6 * z,
            "divide by the root of 1 - alpha_bar_s, not by 1 - alpha_bar_s": (x - 0.36 / 0.64 * eps)
            / 0.8
            + 0.6 * z,
            "this divides by the root of alpha_bar_s; take that of alpha_s": (x - 0.36 / 0.8 * eps)
            / 0.6
            + 0.6 * z,
            "the predicted noise was added; subtract it": (x + 0.36 / 0.8 * eps) / 0.8 + 0.6 * z,
        },
    )
    last = (x - 0.4375**0.5 * eps) / 0.75
    expect_close(
        mine(x, 1, eps, beta, alpha_bar, z),
        last,
        "x_0",
        mistakes={"the last step adds no noise; otherwise samples tremble": last + 0.4375**0.5 * z},
    )
    return "At s = 1 the step lands on x0_hat itself."


@check
def leap(mine):
    """Check mine(x_s, eps_hat, alpha_bar_s, alpha_bar_r, eta, z).

    The check takes one DDIM step whose square roots are round numbers.
    """
    now = 0.36
    then = 0.64
    eta = 0.5
    x = torch.tensor([[1.0, -2.0, 0.5]])
    eps = torch.tensor([[0.4, 1.0, -1.0]])
    z = torch.tensor([[2.0, -1.0, 3.0]])
    x0 = (x - 0.8 * eps) / 0.6
    sure = 0.8 * x0 + 0.6 * eps
    expect_close(
        mine(x, eps, now, then, 0.0, z),
        sure,
        "x_r for eta = 0",
        mistakes={
            "x0_hat is x - sqrt(1 - alpha_bar) eps_hat, divided by sqrt(alpha_bar)": 0.8
            * (x - 0.8 * eps)
            + 0.6 * eps,
            "the predicted noise keeps the size it had at s; at r it is smaller": 0.8 * x0
            + 0.8 * eps,
            "the predicted noise is missing; at r there is still some": 0.8 * x0,
            "square roots are missing: alpha_bar is a variance": 0.64 * (x - 0.64 * eps) / 0.36
            + 0.36 * eps,
        },
    )
    variance = 0.25 * 0.36 / 0.64 * (1 - 0.36 / 0.64)
    expect_close(
        mine(x, eps, now, then, eta, z),
        0.8 * x0 + (0.36 - variance) ** 0.5 * eps + variance**0.5 * z,
        "x_r for eta = 0.5",
        mistakes={
            "fresh noise adds variance: the predicted noise must have less of it": sure
            + variance**0.5 * z,
            "the fresh noise is multiplied by its variance; take the standard deviation": 0.8 * x0
            + (0.36 - variance) ** 0.5 * eps
            + variance * z,
            "eta is squared in the variance": 0.8 * x0
            + (0.36 - 2 * variance) ** 0.5 * eps
            + (2 * variance) ** 0.5 * z,
            "no fresh noise was added": 0.8 * x0 + (0.36 - variance) ** 0.5 * eps,
        },
    )
    everything = mine(x, eps, now, 1.0, 0.0, z)
    expect_close(everything, x0, "a leap to the end (alpha_bar = 1)")
    return "A leap to the very end gives x0_hat: one-step DDIM shows an average."
