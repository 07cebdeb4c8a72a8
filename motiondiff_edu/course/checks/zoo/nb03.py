"""Wrong answers to the exercises of notebook 03."""

import torch


def _guess(x_s, alpha_bar, data, shrink=0.5, spread=lambda a: 2 * (1 - a), axis=1):
    a = alpha_bar[:, None, None]
    distance = (x_s[:, None] - a**shrink * data).square().sum(-1)
    return torch.softmax(-distance / spread(alpha_bar[:, None]), dim=axis) @ data


def _wrong(shrink=0.5, spread=lambda a: 2 * (1 - a), axis=1):
    return lambda x_s, alpha_bar, data: _guess(x_s, alpha_bar, data, shrink, spread, axis)


def nearest_only(x_s, alpha_bar, data):
    """Jumps from sample to sample: even under much noise it is sure of one."""
    return data[(x_s[:, None] - alpha_bar[:, None, None] ** 0.5 * data).square().sum(-1).argmin(1)]


def _weights(x_s, alpha_bar, data):
    """The weights of the candidates, which sum to 1 only after they are divided by their sum."""
    distance = (x_s[:, None] - alpha_bar[:, None, None] ** 0.5 * data).square().sum(-1)
    return torch.exp(-distance / (2 * (1 - alpha_bar[:, None])))


def naive_softmax(x_s, alpha_bar, data):
    """Far from all candidates, every exp is 0: 0 / 0."""
    weight = _weights(x_s, alpha_bar, data)
    return weight / weight.sum(1, keepdim=True) @ data


def mean_distance(x_s, alpha_bar, data):
    """Divides the distance by D: the noise seems to be larger than it is."""
    a = alpha_bar[:, None, None]
    distance = (x_s[:, None] - a**0.5 * data).square().mean(-1)
    return torch.softmax(-distance / (2 * (1 - alpha_bar[:, None])), dim=1) @ data


def distance_not_squared(x_s, alpha_bar, data):
    """A Gaussian's exponent has the square of the distance."""
    distance = (x_s[:, None] - alpha_bar[:, None, None] ** 0.5 * data).square().sum(-1).sqrt()
    return torch.softmax(-distance / (2 * (1 - alpha_bar[:, None])), dim=1) @ data


def scaled_up(x_s, alpha_bar, data):
    """Undoes the scaling of x_s, but leaves its noise as it was."""
    grown = x_s / alpha_bar[:, None] ** 0.5
    distance = (grown[:, None] - data).square().sum(-1)
    return torch.softmax(-distance / (2 * (1 - alpha_bar[:, None])), dim=1) @ data


def _misstep(
    take=lambda b, a: b / (1 - a) ** 0.5,
    scale=lambda b, a: (1 - b) ** 0.5,
    shake=lambda s, beta, alpha_bar: beta[s] ** 0.5,
    last=0.0,
):
    """The right step, but for what is given; `last` is the share of noise at s = 1."""

    def answer(x_s, s, eps_hat, beta, alpha_bar, z):
        mean = (x_s - take(beta[s], alpha_bar[s]) * eps_hat) / scale(beta[s], alpha_bar[s])
        return mean + (last if s == 1 else 1.0) * shake(s, beta, alpha_bar) * z

    return answer


def _leap(x, eps_hat, now, then, variance, z, kept=None, guess=None):
    """The right leap, but for what is given."""
    x0_hat = (x - (1 - now) ** 0.5 * eps_hat) / now**0.5
    x0_hat = x0_hat if guess is None else guess(x, eps_hat, now)
    kept = (1 - then - variance) ** 0.5 if kept is None else kept(now, then, variance)
    return then**0.5 * x0_hat + kept * eps_hat + variance**0.5 * z


def _variance(now, then, eta):
    return eta**2 * (1 - then) / (1 - now) * (1 - now / then)


def _misleap(variance=_variance, kept=None, guess=None):
    return lambda x, eps_hat, now, then, eta, z: _leap(
        x, eps_hat, now, then, variance(now, then, eta), z, kept, guess
    )


def variance_for_deviation(x, eps_hat, now, then, eta, z):
    """Multiplies the fresh noise by its variance."""
    variance = _variance(now, then, eta)
    return _leap(x, eps_hat, now, then, variance, variance**0.5 * z)


def no_fresh_noise(x, eps_hat, now, then, eta, z):
    """Takes noise away and puts none in its place."""
    return _leap(x, eps_hat, now, then, _variance(now, then, eta), 0 * z)


def roots_dropped(x, eps_hat, now, then, eta, z):
    """Takes variances for amplitudes."""
    variance = _variance(now, then, eta)
    x0_hat = (x - (1 - now) * eps_hat) / now
    return then * x0_hat + (1 - then - variance) * eps_hat + variance**0.5 * z


def x_alone_rescaled(x_s, s, eps_hat, beta, alpha_bar, z):
    """Divides x_s, and then subtracts the noise at its old size."""
    removed = beta[s] / (1 - alpha_bar[s]) ** 0.5 * eps_hat
    shaken = beta[s] ** 0.5 * z if s > 1 else 0.0
    return x_s / (1 - beta[s]) ** 0.5 - removed + shaken


def straight_to_x0(x_s, s, eps_hat, beta, alpha_bar, z):
    """Removes all the noise at once."""
    return (x_s - (1 - alpha_bar[s]) ** 0.5 * eps_hat) / alpha_bar[s] ** 0.5


def _signal(of):
    """The right leap with another first term: of(x, x0_hat, now, then)."""

    def answer(x, eps_hat, now, then, eta, z):
        x0_hat = (x - (1 - now) ** 0.5 * eps_hat) / now**0.5
        rest = _leap(x, eps_hat, now, then, _variance(now, then, eta), z) - then**0.5 * x0_hat
        return of(x, x0_hat, now, then) + rest

    return answer


MISTAKES = {
    "best_guess": {
        "the exponent is negative: the nearest candidate has the largest weight": _wrong(
            spread=lambda a: -2 * (1 - a)
        ),
        "the weights must sum to 1: divide them by their sum": (
            lambda x_s, alpha_bar, data: _weights(x_s, alpha_bar, data) @ data
        ),
        "these are the weights; the best guess is the mean of the candidates with them": (
            lambda x_s, alpha_bar, data: torch.softmax(_weights(x_s, alpha_bar, data).log(), 1)
        ),
        "the candidates must be shrunk by sqrt(alpha_bar) before they are compared": _wrong(
            shrink=0
        ),
        "alpha_bar scales variances; the candidates are scaled by its square root": _wrong(
            shrink=1
        ),
        "a Gaussian's exponent is divided by TWICE the variance": _wrong(spread=lambda a: 1 - a),
        "the noise in x_s has variance 1 - alpha_bar; that is missing in the exponent": (
            _wrong(spread=lambda a: 2.0),
            _wrong(spread=lambda a: 1.0),
        ),
        "the exponent is divided by a standard deviation, not by the variance": _wrong(
            spread=lambda a: 2 * (1 - a) ** 0.5
        ),
        "the variance of the noise is 1 - alpha_bar, without a square": _wrong(
            spread=lambda a: 2 * (1 - a) ** 2
        ),
        "1 - alpha_bar is the noise's share; alpha_bar is the signal's": _wrong(
            spread=lambda a: 2 * a
        ),
        "the weights sum to 1 over the samples; they must sum to 1 over the candidates": _wrong(
            axis=0
        ),
        "each sample has its own alpha_bar; this uses the first one's for all": (
            lambda x_s, alpha_bar, data: _guess(x_s, alpha_bar[:1].expand(len(x_s)), data)
        ),
        "that is the plain mean of the data: the candidates have no weights": (
            lambda x_s, alpha_bar, data: data.mean(0).expand(x_s.shape)
        ),
        "that is the nearest candidate; the best guess is a mean of all, with weights": (
            nearest_only
        ),
        "far from all candidates every exp is 0, and 0 / 0 is NaN: subtract the largest exponent "
        "first, or use torch.softmax": naive_softmax,
        "the squared distance is a sum over D, not a mean": mean_distance,
        "square the distance in the exponent": distance_not_squared,
        "dividing x_s by sqrt(alpha_bar) makes its noise larger, too: the variance is "
        "(1 - alpha_bar) / alpha_bar": scaled_up,
    },
    "step_back": {
        "the noise is multiplied by the variance; take the standard deviation": _misstep(
            shake=lambda s, beta, alpha_bar: beta[s]
        ),
        "no noise was added; only the last step, s = 1, adds none": _misstep(
            shake=lambda s, beta, alpha_bar: 0.0
        ),
        "the root re-scales the whole bracket, not x_s alone": x_alone_rescaled,
        "that is the guess of x0; one step only goes to s - 1": straight_to_x0,
        "every step adds noise but the last one, s = 1; here it is the other way round": _misstep(
            shake=lambda s, beta, alpha_bar: beta[s] ** 0.5 if s == 1 else 0.0, last=1.0
        ),
        "divide by the root of alpha_s; this multiplies by it": _misstep(
            scale=lambda b, a: (1 - b) ** -0.5
        ),
        "the re-scaling by 1 / sqrt(alpha_s) is missing": _misstep(scale=lambda b, a: 1.0),
        "re-scale by the root of alpha_s = 1 - beta_s; the root is missing": _misstep(
            scale=lambda b, a: 1 - b
        ),
        "this divides by the root of alpha_bar_s; take that of alpha_s": _misstep(
            scale=lambda b, a: a**0.5
        ),
        "all the noise was removed; one step removes beta_s / sqrt(1 - alpha_bar_s) of it": (
            _misstep(take=lambda b, a: (1 - a) ** 0.5),
            _misstep(take=lambda b, a: 1.0),
        ),
        "divide by the root of 1 - alpha_bar_s, not by 1 - alpha_bar_s": _misstep(
            take=lambda b, a: b / (1 - a)
        ),
        "beta_s, not its root, is divided by the root of 1 - alpha_bar_s": _misstep(
            take=lambda b, a: (b / (1 - a)) ** 0.5
        ),
        "divide by the root of 1 - alpha_bar_s, not by that of alpha_bar_s": _misstep(
            take=lambda b, a: b / a**0.5
        ),
        "the predicted noise was added; subtract it": _misstep(
            take=lambda b, a: -b / (1 - a) ** 0.5
        ),
        "the last step adds no noise; otherwise samples tremble": _misstep(last=1.0),
        "this adds the noise of the posterior; equation 11 takes the variance beta_s": _misstep(
            shake=lambda s, beta, alpha_bar: (
                ((1 - alpha_bar[s - 1]) / (1 - alpha_bar[s]) * beta[s]) ** 0.5
            ),
            last=1.0,
        ),
        "you re-scaled the fresh noise, too; add it after the re-scaling": _misstep(
            shake=lambda s, beta, alpha_bar: (beta[s] / (1 - beta[s])) ** 0.5
        ),
        "you subtracted the fresh noise; add it": _misstep(
            shake=lambda s, beta, alpha_bar: -(beta[s] ** 0.5)
        ),
    },
    "leap": {
        "x0_hat is x - sqrt(1 - alpha_bar) eps_hat, divided by sqrt(alpha_bar)": _misleap(
            guess=lambda x, eps_hat, now: x - (1 - now) ** 0.5 * eps_hat
        ),
        "x0_hat is divided by the root of alpha_bar; the root is missing": _misleap(
            guess=lambda x, eps_hat, now: (x - (1 - now) ** 0.5 * eps_hat) / now
        ),
        "you added the predicted noise in x0_hat; subtract it": _misleap(
            guess=lambda x, eps_hat, now: (x + (1 - now) ** 0.5 * eps_hat) / now**0.5
        ),
        "the predicted noise keeps the size it had at s; at r it is smaller": _misleap(
            kept=lambda now, then, variance: (1 - now) ** 0.5
        ),
        "the predicted noise is missing; at r there is still some": _misleap(
            kept=lambda now, then, variance: 0.0
        ),
        "the signal shrinks to its share at r, the root of `then`, not of `now`": _signal(
            lambda x, x0_hat, now, then: now**0.5 * x0_hat
        ),
        "x0_hat is scaled by the root of `then`; the root is missing": _signal(
            lambda x, x0_hat, now, then: then * x0_hat
        ),
        "x0_hat goes on to r, not x, which has its noise still": _signal(
            lambda x, x0_hat, now, then: then**0.5 * x
        ),
        "x0_hat must be scaled down to its share at r": _signal(
            lambda x, x0_hat, now, then: x0_hat
        ),
        "square roots are missing: alpha_bar is a variance": roots_dropped,
        "fresh noise adds variance: the predicted noise must have less of it": _misleap(
            kept=lambda now, then, variance: (1 - then) ** 0.5
        ),
        "variances subtract, standard deviations do not: the root of 1 - then - sigma^2": (
            _misleap(kept=lambda now, then, variance: (1 - then) ** 0.5 - variance**0.5)
        ),
        "the fresh noise is multiplied by its variance; take the standard deviation": (
            variance_for_deviation
        ),
        "square eta in the variance": _misleap(
            lambda now, then, eta: _variance(now, then, eta**0.5)
        ),
        "no fresh noise was added": no_fresh_noise,
        "eta is not used": _misleap(lambda now, then, eta: 0.0),
        "eta is not used; as written this is always eta = 1": _misleap(
            lambda now, then, eta: _variance(now, then, 1.0)
        ),
    },
}
OTHERS = {
    "leap": {
        "sigma not squared": _misleap(
            kept=lambda now, then, variance: (1 - then - variance**0.5) ** 0.5
        ),
        "the first ratio the wrong way round": _misleap(
            lambda now, then, eta: (
                eta**2 * (1 - now) / (1 - then) * (1 - now / then) if then < 1 else 0.0
            )
        ),
        "now and then exchanged": lambda x, eps_hat, now, then, eta, z: _leap(
            x, eps_hat, then, now, _variance(then, now, eta) if then < 1 else 0.0, z
        ),
    }
}
