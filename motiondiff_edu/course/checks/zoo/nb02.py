"""Wrong answers to the exercises of notebook 02."""

import torch


def _kept(alpha_bar, s):
    return alpha_bar[s][:, None, None]


def _mixed(signal, sigma, row=lambda s: s):
    """x_s with wrong amplitudes, as functions of the share that is kept; or from a wrong row."""

    def answer(x0, s, alpha_bar, noise):
        kept = _kept(alpha_bar, row(s))
        return signal(kept) * x0 + sigma(kept) * noise

    return answer


def _root(kept):
    return kept**0.5


def _rest(kept):
    return (1 - kept) ** 0.5


def returns_nothing(x0, s, alpha_bar, noise):
    """Computes something and returns nothing."""
    _kept(alpha_bar, s) * x0


def _product(mean_1, variance_1, mean_2, variance_2):
    variance = 1 / (1 / variance_1 + 1 / variance_2)
    return variance * (mean_1 / variance_1 + mean_2 / variance_2), variance


def _of(x0, x_s, s, alpha_bar, alpha=None, beta=None, row=None):
    """The right answer, but for what is given."""
    alpha = alpha_bar[s] / alpha_bar[s - 1] if alpha is None else alpha
    beta = 1 - alpha if beta is None else beta
    known = alpha_bar[s - 1] if row is None else alpha_bar[row]
    return _product(known**0.5 * x0, 1 - known, x_s / alpha**0.5, beta / alpha)


def step_variance(x0, x_s, s, alpha_bar):
    """Uses the variance of the forward step for the step back: too much when x0 is known."""
    return _of(x0, x_s, s, alpha_bar)[0], 1 - alpha_bar[s] / alpha_bar[s - 1]


def wrong_row_for_x0(x0, x_s, s, alpha_bar):
    """Multiplies by the density of x_s given x0, instead of that of x_{s-1} given x0."""
    return _of(x0, x_s, s, alpha_bar, row=s)


def last_step_not_undone(x0, x_s, s, alpha_bar):
    """Uses x_s as a measurement of x_{s-1} without undoing the step's scaling."""
    beta = 1 - alpha_bar[s] / alpha_bar[s - 1]
    return _product(alpha_bar[s - 1] ** 0.5 * x0, 1 - alpha_bar[s - 1], x_s, beta)


def difference_for_beta(x0, x_s, s, alpha_bar):
    """Takes the difference of two shares for the noise of one step."""
    beta = alpha_bar[s - 1] - alpha_bar[s]
    return _of(x0, x_s, s, alpha_bar, alpha=1 - beta, beta=beta)


def product_for_alpha(x0, x_s, s, alpha_bar):
    """Takes the product of all steps' alphas for that of one step."""
    return _of(x0, x_s, s, alpha_bar, alpha=alpha_bar[s])


def ratio_inverted(x0, x_s, s, alpha_bar):
    """Divides the wrong way: alpha becomes larger than 1, and beta negative."""
    return _of(x0, x_s, s, alpha_bar, alpha=alpha_bar[s - 1] / alpha_bar[s])


def first_root_dropped(x0, x_s, s, alpha_bar):
    """The mean of x_{s-1} given x0 has the root of alpha_bar."""
    alpha, before = alpha_bar[s] / alpha_bar[s - 1], alpha_bar[s - 1]
    return _product(before * x0, 1 - before, x_s / alpha**0.5, (1 - alpha) / alpha)


def second_root_dropped(x0, x_s, s, alpha_bar):
    """x_s is divided by alpha instead of its root."""
    alpha, before = alpha_bar[s] / alpha_bar[s - 1], alpha_bar[s - 1]
    return _product(before**0.5 * x0, 1 - before, x_s / alpha, (1 - alpha) / alpha)


def variance_not_scaled(x0, x_s, s, alpha_bar):
    """x_s is divided by the root of alpha, but its variance stays."""
    alpha, before = alpha_bar[s] / alpha_bar[s - 1], alpha_bar[s - 1]
    return _product(before**0.5 * x0, 1 - before, x_s / alpha**0.5, 1 - alpha)


def mean_of_the_means(x0, x_s, s, alpha_bar):
    """Averages without weights."""
    alpha = alpha_bar[s] / alpha_bar[s - 1]
    return (alpha_bar[s - 1] ** 0.5 * x0 + x_s / alpha**0.5) / 2, _of(x0, x_s, s, alpha_bar)[1]


def deviations_multiplied(x0, x_s, s, alpha_bar):
    """Puts standard deviations where the product expects variances."""
    alpha, before = alpha_bar[s] / alpha_bar[s - 1], alpha_bar[s - 1]
    spread = (1 - before) ** 0.5, ((1 - alpha) / alpha) ** 0.5
    return _product(before**0.5 * x0, spread[0], x_s / alpha**0.5, spread[1])


def _changed_variance(change):
    def answer(x0, x_s, s, alpha_bar):
        mean, variance = _of(x0, x_s, s, alpha_bar)
        return mean, change(torch.as_tensor(variance))

    return answer


MISTAKES = {
    "q_sample": {
        "alpha_bar is a variance: amplitudes need its square root": _mixed(
            lambda a: a, lambda a: 1 - a
        ),
        "amplitudes need the square root, which is not half of it": _mixed(
            lambda a: a / 2, lambda a: (1 - a) / 2
        ),
        "alpha_bar is the product of all steps already; multiply no further": (
            lambda x0, s, alpha_bar, noise: _mixed(_root, _rest)(x0, s, alpha_bar.cumprod(0), noise)
        ),
        "the signal has its square root, but the noise has none": _mixed(_root, lambda a: 1 - a),
        "the square root of the signal is missing": _mixed(lambda a: a, _rest),
        "signal and noise are swapped": _mixed(_rest, _root),
        "every sample has its own step; this uses the first one's for all": _mixed(
            _root, _rest, lambda s: s[:1].expand(len(s))
        ),
        "the table was read one row too low: alpha_bar[0] belongs to clean data": _mixed(
            _root, _rest, lambda s: s - 1
        ),
        "you subtracted the noise; add it": _mixed(_root, lambda a: -_rest(a)),
        "the signal is not scaled: multiply it by the root of alpha_bar": _mixed(
            lambda a: 1.0, _rest
        ),
        "the noise is not scaled: multiply it by the root of 1 - alpha_bar": _mixed(
            _root, lambda a: 1.0
        ),
        "the noise is missing": _mixed(_root, lambda a: 0.0),
        "the root is of 1 - alpha_bar, not 1 minus a root": _mixed(_root, lambda a: 1 - _root(a)),
        "the amplitudes are squared: alpha_bar is a square already": _mixed(
            lambda a: a**2, lambda a: (1 - a) ** 2
        ),
    },
    "posterior": {
        "that is beta_s, the variance of one step; knowing x0 makes it smaller": step_variance,
        "x0 enters with the noise of step s; it must describe x_{s-1}, so use alpha_bar[s - 1]": (
            wrong_row_for_x0
        ),
        "x_s measures sqrt(alpha_s) x_{s-1}: divide it by sqrt(alpha_s), and its variance by "
        "alpha_s": (last_step_not_undone, variance_not_scaled),
        "`product` takes variances; these are standard deviations": deviations_multiplied,
        "the mean comes first, then the variance": lambda *given: _of(*given)[::-1],
        "that is the standard deviation": _changed_variance(lambda v: v**0.5),
        "that is the precision, 1 / variance": _changed_variance(lambda v: 1 / v),
        "beta_s is 1 - alpha_bar[s] / alpha_bar[s - 1], not a difference of two alpha_bars": (
            difference_for_beta
        ),
        "alpha_bar[s] is the product of all alphas; one step's alpha is a ratio of neighbours": (
            product_for_alpha
        ),
        "the ratio is the wrong way round: alpha_s is alpha_bar[s] / alpha_bar[s - 1]": (
            ratio_inverted
        ),
        "x0 is scaled by the root of alpha_bar[s - 1]; the root is missing": first_root_dropped,
        "x_s is divided by the root of alpha_s; the root is missing": second_root_dropped,
        "the two means are weighted by their precisions, not equally": mean_of_the_means,
    },
    "constant_beta": {
        "that leaves the share `left` of the variance; the question is about the amplitude": (
            lambda S, left: 1 - left ** (1 / S)
        ),
        "the noise is not shared out evenly: each step multiplies, so take the S-th root": (
            lambda S, left: (1 - left) / S,
            lambda S, left: (1 - left**2) / S,
        ),
        "that is alpha, the share of the variance that one step keeps; beta is 1 minus it": (
            lambda S, left: left ** (2 / S)
        ),
        "that leaves it after a single step; S steps follow one another": lambda S, left: (
            1 - left**2
        ),
        "the amplitude is the root of the variance, so square `left`, do not take its root": (
            lambda S, left: 1 - left ** (1 / (2 * S))
        ),
        "that is the amplitude that one step keeps": lambda S, left: left ** (1 / S),
    },
}
OTHERS = {
    "q_sample": {"return forgotten": returns_nothing},
    "posterior": {"only the mean": lambda *given: _of(*given)[0]},
}
