"""Wrong answers to the exercises of notebook 02."""

import torch


def _shaped(alpha_bar, s):
    return alpha_bar[s][:, None, None]


def root_dropped(x0, s, alpha_bar, noise):
    """Uses the shares of the variance as amplitudes.

    Variances add up to one, and amplitudes do not: x_s becomes too small.
    """
    kept = _shaped(alpha_bar, s)
    return kept * x0 + (1 - kept) * noise


def root_dropped_from_the_noise(x0, s, alpha_bar, noise):
    """Adds too little noise to the right signal: the variance of x_s is no longer one."""
    kept = _shaped(alpha_bar, s)
    return kept**0.5 * x0 + (1 - kept) * noise


def one_step_for_all(x0, s, alpha_bar, noise):
    """Reads the table for the first example only; a batch of one does not show it."""
    kept = alpha_bar[s[0]]
    return kept**0.5 * x0 + (1 - kept) ** 0.5 * noise


def row_too_low(x0, s, alpha_bar, noise):
    """Reads the table as if it began at s = 1, so that every sample is one step too clean."""
    kept = _shaped(alpha_bar, s - 1)
    return kept**0.5 * x0 + (1 - kept) ** 0.5 * noise


def signal_and_noise_swapped(x0, s, alpha_bar, noise):
    """The first step is almost pure noise and the last one almost clean."""
    kept = _shaped(alpha_bar, s)
    return (1 - kept) ** 0.5 * x0 + kept**0.5 * noise


def returns_nothing(x0, s, alpha_bar, noise):
    """Computes something and returns nothing."""
    _shaped(alpha_bar, s) * x0


def _product(mean_1, variance_1, mean_2, variance_2):
    variance = 1 / (1 / variance_1 + 1 / variance_2)
    return variance * (mean_1 / variance_1 + mean_2 / variance_2), variance


def step_variance(x0, x_s, s, alpha_bar):
    """Uses the variance of the forward step for the step back.

    That is too much when x0 is known.
    """
    alpha = alpha_bar[s] / alpha_bar[s - 1]
    mean, _ = _product(
        alpha_bar[s - 1] ** 0.5 * x0, 1 - alpha_bar[s - 1], x_s / alpha**0.5, (1 - alpha) / alpha
    )
    return mean, 1 - alpha


def wrong_row_for_x0(x0, x_s, s, alpha_bar):
    """Multiplies by the density of x_s given x0, instead of that of x_{s-1} given x0."""
    alpha = alpha_bar[s] / alpha_bar[s - 1]
    return _product(
        alpha_bar[s] ** 0.5 * x0, 1 - alpha_bar[s], x_s / alpha**0.5, (1 - alpha) / alpha
    )


def last_step_not_undone(x0, x_s, s, alpha_bar):
    """Uses x_s as a measurement of x_{s-1} without undoing the step's scaling."""
    alpha = alpha_bar[s] / alpha_bar[s - 1]
    return _product(alpha_bar[s - 1] ** 0.5 * x0, 1 - alpha_bar[s - 1], x_s, 1 - alpha)


def deviation_for_variance(x0, x_s, s, alpha_bar):
    """The mean is right; the second number is the square root of the variance."""
    alpha = alpha_bar[s] / alpha_bar[s - 1]
    mean, var = _product(
        alpha_bar[s - 1] ** 0.5 * x0, 1 - alpha_bar[s - 1], x_s / alpha**0.5, (1 - alpha) / alpha
    )
    return mean, torch.as_tensor(var) ** 0.5


def mean_only(x0, x_s, s, alpha_bar):
    """This is half of the answer: a Gaussian has a variance, too."""
    return step_variance(x0, x_s, s, alpha_bar)[0]


ZOO = {
    "q_sample": {
        "square roots dropped": root_dropped,
        "square root dropped from the noise": root_dropped_from_the_noise,
        "one step for the whole batch": one_step_for_all,
        "table read one row too low": row_too_low,
        "signal and noise swapped": signal_and_noise_swapped,
        "return forgotten": returns_nothing,
    },
    "posterior": {
        "beta taken for the variance": step_variance,
        "x0 noised to s instead of s - 1": wrong_row_for_x0,
        "x_s not divided by sqrt(alpha)": last_step_not_undone,
        "standard deviation for variance": deviation_for_variance,
        "only the mean": mean_only,
    },
    "constant_beta": {
        "variance for amplitude": lambda S, left: 1 - left ** (1 / S),
        "noise shared out evenly": lambda S, left: (1 - left) / S,
        "alpha for beta": lambda S, left: left ** (2 / S),
        "only one step": lambda S, left: 1 - left**2,
    },
}
