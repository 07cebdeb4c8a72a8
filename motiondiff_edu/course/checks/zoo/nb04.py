"""Wrong answers to the exercises of notebook 04."""

import math

import torch


def _each(x0, alpha_bar):
    left = 1 - alpha_bar
    return (alpha_bar * x0**2 + left - 1 - torch.log(left)) / 2


def variance_forgotten(x0, alpha_bar):
    """Counts the distance of the means, but not the difference of the widths."""
    return (alpha_bar * x0**2).sum((1, 2)) / 2


def logarithm_forgotten(x0, alpha_bar):
    """Without its logarithm a divergence can be negative."""
    return (alpha_bar * x0**2 - alpha_bar).sum((1, 2)) / 2


def root_dropped(x0, alpha_bar):
    """Squares alpha_bar with x0, although the mean has only its root."""
    left = 1 - alpha_bar
    return ((alpha_bar * x0) ** 2 + left - 1 - torch.log(left)).sum((1, 2)) / 2


def directions_swapped(x0, alpha_bar):
    """Computes KL(prior || last step) instead of KL(last step || prior)."""
    left = 1 - alpha_bar
    return ((alpha_bar * x0**2 + 1) / left - 1 + torch.log(left)).sum((1, 2)) / 2


def _of_eps(beta, alpha_bar):
    b, a = beta[1:], alpha_bar[1:]
    return b / (2 * (1 - b) * (1 - a)), a


def weight_of_eps(beta, alpha_bar):
    """This weight belongs to the error of eps; an error of x0 has another size."""
    return _of_eps(beta, alpha_bar)[0]


def not_squared(beta, alpha_bar):
    """Converts the error from eps to x0, but does not square the factor."""
    weight, a = _of_eps(beta, alpha_bar)
    return weight * (a / (1 - a)) ** 0.5


def upside_down(beta, alpha_bar):
    """Divides by the signal-to-noise ratio instead of multiplying by it."""
    weight, a = _of_eps(beta, alpha_bar)
    return weight * (1 - a) / a


def one_row_too_many(beta, alpha_bar):
    """Has an entry for s = 0, which is no step."""
    weight, a = _of_eps(beta, alpha_bar)
    return torch.cat([torch.zeros(1), weight * a / (1 - a)])


ZOO = {
    "prior_term": {
        "variance forgotten": variance_forgotten,
        "logarithm forgotten": logarithm_forgotten,
        "square root dropped": root_dropped,
        "directions swapped": directions_swapped,
        "mean over entries": lambda x0, alpha_bar: _each(x0, alpha_bar).mean((1, 2)),
        "summed over the batch": lambda x0, alpha_bar: _each(x0, alpha_bar).sum(),
        "factor one half dropped": lambda x0, alpha_bar: 2 * _each(x0, alpha_bar).sum((1, 2)),
    },
    "x0_weight": {
        "weight of eps": weight_of_eps,
        "factor not squared": not_squared,
        "factor upside down": upside_down,
        "a row for s = 0": one_row_too_many,
    },
    "tighter_bound": {
        "mean of the logs": lambda log_ratio: log_ratio.mean(0),
        "log of the sum": lambda log_ratio: log_ratio.logsumexp(0),
        "mean over the samples": lambda log_ratio: (
            log_ratio.logsumexp(1) - math.log(log_ratio.shape[1])
        ),
        "largest of all columns taken out": lambda log_ratio: (
            (log_ratio - log_ratio.max()).exp().mean(0).log() + log_ratio.max()
        ),
        "underflow": lambda log_ratio: log_ratio.exp().mean(0).log(),
    },
}
