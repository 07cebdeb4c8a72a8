"""Wrong answers to the exercises of notebook 04."""

import math

import torch


def _each(x0, alpha_bar, signal=lambda a, x: a * x**2, log=1.0, variance=1.0):
    """KL of each entry, but for what is given."""
    left = 1 - alpha_bar
    return (signal(alpha_bar, x0) + variance * (left - 1) - log * torch.log(left)) / 2


def _summed(signal=lambda a, x: a * x**2, log=1.0, variance=1.0):
    return lambda x0, alpha_bar: _each(x0, alpha_bar, signal, log, variance).sum((1, 2))


def directions_swapped(x0, alpha_bar):
    """Computes KL(prior || last step) instead of KL(last step || prior)."""
    left = 1 - alpha_bar
    return ((alpha_bar * x0**2 + 1) / left - 1 + torch.log(left)).sum((1, 2)) / 2


def other_logarithm(x0, alpha_bar):
    """Takes the logarithm of the signal's share."""
    off = torch.log(1 - alpha_bar) - torch.log(alpha_bar)
    return (_each(x0, alpha_bar) + off / 2).sum((1, 2))


def once_a_sample(x0, alpha_bar):
    """Adds what does not depend on x0 once, and not for each entry."""
    rest = _each(0 * x0, alpha_bar)
    return (alpha_bar * x0**2 / 2).sum((1, 2)) + rest[:, 0, 0]


def _weight(beta, alpha_bar, of_x0):
    b, a = beta[1:], alpha_bar[1:]
    return b / (2 * (1 - b) * (1 - a)) * of_x0(a / (1 - a))


def _weighted(of_x0):
    return lambda beta, alpha_bar: _weight(beta, alpha_bar, of_x0)


def zero_first(beta, alpha_bar):
    """Has an entry for s = 0, which is no step."""
    return torch.cat([torch.zeros(1), _weight(beta, alpha_bar, lambda ratio: ratio)])


def from_zero(beta, alpha_bar):
    """Computes s = 0 as well: 0 / 0."""
    return beta / (2 * (1 - beta) * (1 - alpha_bar)) * alpha_bar / (1 - alpha_bar)


def factor_two_dropped(beta, alpha_bar):
    """The bound's step is a squared distance over twice the variance."""
    return 2 * _weight(beta, alpha_bar, lambda ratio: ratio)


def alpha_dropped(beta, alpha_bar):
    """The posterior's mean divides by the root of alpha."""
    return (1 - beta[1:]) * _weight(beta, alpha_bar, lambda ratio: ratio)


def row_too_low(beta, alpha_bar):
    """Takes alpha_bar of the step before where that of s belongs."""
    b, a = beta[1:], alpha_bar[1:]
    return b / (2 * (1 - b) * (1 - a)) * alpha_bar[:-1] / (1 - a)


MISTAKES = {
    "prior_term": {
        "that is the sum over the whole batch; keep one number for each sample": (
            lambda x0, alpha_bar: _each(x0, alpha_bar).sum()
        ),
        "the entries of one sample are added up; you took their mean": (
            lambda x0, alpha_bar: _each(x0, alpha_bar).mean((1, 2)),
            lambda x0, alpha_bar: _each(x0, alpha_bar).mean(),
        ),
        "return one number for each sample: sum over frames AND features": (
            lambda x0, alpha_bar: _each(x0, alpha_bar).sum(2),
            lambda x0, alpha_bar: _each(x0, alpha_bar).sum(1),
            _each,
        ),
        "the factor one half is missing": lambda x0, alpha_bar: (
            2 * _each(x0, alpha_bar).sum((1, 2))
        ),
        "the variance of q is not 1: its term and its logarithm are missing": _summed(
            log=0.0, variance=0.0
        ),
        "the logarithm is missing": _summed(log=0.0),
        "the term of the variance is missing: variance - 1": _summed(variance=0.0),
        "the logarithm has the wrong sign": _summed(log=-1.0),
        "a term is missing: subtract 1 for each entry": lambda x0, alpha_bar: (
            _each(x0, alpha_bar) + 0.5
        ).sum((1, 2)),
        "the logarithm is that of the variance, 1 - alpha_bar, not of alpha_bar": other_logarithm,
        "every entry has a variance and its logarithm, not every sample": once_a_sample,
        "the mean of q(x_S | x0) is sqrt(alpha_bar) x0": (
            _summed(signal=lambda a, x: (a * x) ** 2),
            _summed(signal=lambda a, x: x**2),
        ),
        "the mean must be squared": _summed(signal=lambda a, x: a**0.5 * x),
        "the variance has no root: the logarithm of 1 - alpha_bar, halved with the rest": _summed(
            log=0.5
        ),
        "that is in bits; the question asks for nats, the natural logarithm": _summed(
            log=1 / math.log(2)
        ),
        "that is KL(prior || q); the two are swapped": directions_swapped,
    },
    "x0_weight": {
        "that is the weight of eps errors; an x0 error of 1 is not an eps error of 1": _weighted(
            lambda ratio: 1.0
        ),
        "an eps error is sqrt(alpha_bar / (1 - alpha_bar)) times the x0 error, and it enters "
        "squared": (_weighted(lambda ratio: ratio**0.5), _weighted(lambda ratio: ratio**2)),
        "the factor is inverted: at high noise a large x0 error is a small eps error": _weighted(
            lambda ratio: 1 / ratio
        ),
        "you return S + 1 numbers; s = 0 is clean data and has no step": (zero_first, from_zero),
        "the bound divides by TWICE the variance": factor_two_dropped,
        "a factor 1 / alpha_s is missing: the posterior's mean divides by its root": alpha_dropped,
        "alpha_bar in the factor is that of s, not of s - 1": row_too_low,
    },
    "tighter_bound": {
        "that is the mean of the logs, the bound itself": lambda log_ratio: log_ratio.mean(0),
        "that is the log of the SUM; the mean divides by K": lambda log_ratio: log_ratio.logsumexp(
            0
        ),
        "that is the mean over the samples; take it over the paths, the first axis": (
            lambda log_ratio: log_ratio.logsumexp(1) - math.log(log_ratio.shape[1])
        ),
        "the mean divides by K, the number of paths, not by that of the samples": (
            lambda log_ratio: log_ratio.logsumexp(0) - math.log(log_ratio.shape[1])
        ),
        "that is the mean ratio; take its logarithm": lambda log_ratio: log_ratio.exp().mean(0),
        "exp gives zero at -2000, and its logarithm is minus infinity: subtract the largest of "
        "each column before exp, or use torch's own function": (
            lambda log_ratio: log_ratio.exp().mean(0).log(),
            lambda log_ratio: (log_ratio - log_ratio.max()).exp().mean(0).log() + log_ratio.max(),
        ),
        "the largest was subtracted before exp; add it again after the logarithm": (
            lambda log_ratio: (log_ratio - log_ratio.max(0).values).exp().mean(0).log()
        ),
        "log K is subtracted, not multiplied or divided": lambda log_ratio: (
            log_ratio.logsumexp(0) / len(log_ratio)
        ),
    },
}
OTHERS: dict = {}
