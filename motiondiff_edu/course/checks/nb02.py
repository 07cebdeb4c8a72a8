"""Checks of notebook 02: noise."""

import torch

from ._report import check, expect, expect_close


@check
def q_sample(mine):
    """mine(x0, s, alpha_bar, noise) at two steps whose square roots are round numbers."""
    x0 = torch.arange(30.0).reshape(2, 5, 3) / 10 - 1
    noise = torch.linspace(2, -1, 30).reshape(2, 5, 3)
    s, alpha_bar = torch.tensor([2, 1]), torch.tensor([1.0, 0.64, 0.36])

    def mix(signal, sigma):  # the two samples of the batch with factors written out by hand
        return torch.stack([signal[i] * x0[i] + sigma[i] * noise[i] for i in range(2)])

    expect_close(
        mine(x0, s, alpha_bar, noise),
        mix([0.6, 0.8], [0.8, 0.6]),
        "x_s, alpha_bar .36 and .64",
        mistakes={
            "alpha_bar is a variance: amplitudes need its square root": mix(
                [0.36, 0.64], [0.64, 0.36]
            ),
            "the signal has its square root, but the noise has none": mix([0.6, 0.8], [0.64, 0.36]),
            "the square root of the signal is missing": mix([0.36, 0.64], [0.8, 0.6]),
            "signal and noise are swapped": mix([0.8, 0.6], [0.6, 0.8]),
            "both samples use the step of the first one": mix([0.6, 0.6], [0.8, 0.8]),
            "the table was read one row too low: alpha_bar[0] belongs to clean data": mix(
                [0.8, 1.0], [0.6, 0.0]
            ),
        },
    )
    return (
        "Sample 0 keeps 60 % of its amplitude and gets 80 % of the noise's: "
        "as variances, 0.36 + 0.64 = 1."
    )


@check
def posterior(mine):
    """The expected values come from Bayes' rule on a grid, not from a formula."""
    alpha_bar = torch.tensor([1.0, 0.9, 0.7, 0.4], dtype=torch.float64)
    s = 3
    x0 = 0.8
    x_s = -0.6
    before, alpha = 0.7, 0.4 / 0.7
    grid = torch.linspace(-8, 8, 160_001, dtype=torch.float64)
    from_x0 = (grid - before**0.5 * x0) ** 2 / (1 - before)
    from_x_s = (x_s - alpha**0.5 * grid) ** 2 / (1 - alpha)
    weight = (-(from_x0 + from_x_s) / 2).softmax(0)
    mean = (weight * grid).sum()
    variance = (weight * (grid - mean) ** 2).sum()
    answer = mine(x0, x_s, s, alpha_bar)
    expect(
        isinstance(answer, tuple | list) and len(answer) == 2,
        "return two things: the mean and the variance",
    )
    expect_close(
        answer[1],
        variance,
        "the variance of x_2",
        mistakes={
            "that is beta_s, the variance of one step; knowing x0 makes it smaller": 1 - alpha,
            (
                "x0 enters with the noise of step s; "
                "it must describe x_{s-1}, so use alpha_bar[s - 1]"
            ): 1 / (1 / 0.6 + alpha / (1 - alpha)),
            (
                "x_s measures sqrt(alpha_s) x_{s-1}: "
                "divide it by sqrt(alpha_s), and its variance by alpha_s"
            ): 1 / (1 / (1 - before) + 1 / (1 - alpha)),
            "that is the standard deviation": variance**0.5,
            "that is the precision, 1 / variance": 1 / variance,
        },
    )
    late = variance * (0.4**0.5 * x0 / 0.6 + x_s / alpha**0.5 * alpha / (1 - alpha))
    unscaled = variance * (before**0.5 * x0 / (1 - before) + x_s / (1 - alpha))
    mistakes = {
        (
            "x0 enters with the noise of step s; it must describe x_{s-1}, so use alpha_bar[s - 1]"
        ): late,
        (
            "x_s measures sqrt(alpha_s) x_{s-1}: "
            "divide it by sqrt(alpha_s), and its variance by alpha_s"
        ): unscaled,
    }
    expect_close(answer[0], mean, "the mean of x_2", mistakes)
    return f"Knowing x0 narrows x_2 from +- {(1 - alpha) ** 0.5:.2f} to +- {variance**0.5:.2f}."


@check
def constant_beta(mine):
    """mine(S, left) -> beta: S steps of it must leave that share of the amplitude."""
    for S, left in ((10, 0.1), (100, 0.05)):
        beta = float(mine(S, left))
        expect(
            0 < beta < 1,
            f"beta must lie between 0 and 1; for S = {S} and left = {left} yours is {beta:g}",
        )
        amplitude = 1.0
        for _ in range(S):
            amplitude *= (1 - beta) ** 0.5
        expect(
            abs(amplitude - left**0.5) > 1e-6,
            (
                f"with S = {S} your beta leaves {left:g} of the variance; "
                "the question is about the amplitude"
            ),
        )
        expect(
            abs(amplitude - left) < 1e-6,
            f"with S = {S} your beta leaves {amplitude:.4g} of the amplitude, not {left:g}",
        )
    return "Ten times as many steps need about a tenth of the beta, because noise adds up."
