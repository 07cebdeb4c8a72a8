"""Wrong answers to the exercises of notebook 03."""

import torch


def _guess(x_s, alpha_bar, data, shrink=0.5, spread=None):
    a = alpha_bar[:, None, None]
    distance = (x_s[:, None] - a**shrink * data).square().sum(-1)
    spread = 2 * (1 - alpha_bar[:, None]) if spread is None else spread
    return torch.softmax(-distance / spread, dim=1) @ data


def not_shrunk(x_s, alpha_bar, data):
    """Compares x_s with the clean data, although what lies in x_s has shrunk."""
    return _guess(x_s, alpha_bar, data, shrink=0)


def root_dropped(x_s, alpha_bar, data):
    """Shrinks the data by alpha_bar instead of its square root.

    It therefore measures from the wrong places.
    """
    return _guess(x_s, alpha_bar, data, shrink=1)


def factor_two_dropped(x_s, alpha_bar, data):
    """The exponent is twice as large as a Gaussian's, and the guess too sure of itself."""
    return _guess(x_s, alpha_bar, data, spread=1 - alpha_bar[:, None])


def noise_ignored(x_s, alpha_bar, data):
    """Doubts at every step as under pure noise: too much where little noise is left."""
    return _guess(x_s, alpha_bar, data, spread=2.0)


def wrong_axis(x_s, alpha_bar, data):
    """The shares of one example depend on who else is in the batch."""
    distance = (x_s[:, None] - alpha_bar[:, None, None] ** 0.5 * data).square().sum(-1)
    return torch.softmax(-distance / (2 * (1 - alpha_bar[:, None])), dim=0) @ data


def nearest_only(x_s, alpha_bar, data):
    """Jumps from sample to sample instead of weighing them.

    Even under much noise it is sure of one.
    """
    return data[(x_s[:, None] - alpha_bar[:, None, None] ** 0.5 * data).square().sum(-1).argmin(1)]


def plain_mean(x_s, alpha_bar, data):
    """The best guess when x_s is not looked at."""
    return data.mean(0).expand(x_s.shape)


def _step(x_s, s, eps_hat, beta, alpha_bar, z, scale=None, shake=None):
    take = beta[s] / (1 - alpha_bar[s]) ** 0.5
    mean = (x_s - take * eps_hat) / ((1 - beta[s]) ** 0.5 if scale is None else scale)
    return mean + (beta[s] ** 0.5 * z if shake is None else shake * z)


def noise_at_the_last_step(x_s, s, eps_hat, beta, alpha_bar, z):
    """The sample is shaken once more after it was finished, which is seen as trembling."""
    return _step(x_s, s, eps_hat, beta, alpha_bar, z)


def never_shaken(x_s, s, eps_hat, beta, alpha_bar, z):
    """Without fresh noise the samples come out too alike."""
    return _step(x_s, s, eps_hat, beta, alpha_bar, z, shake=0.0)


def variance_for_deviation(x_s, s, eps_hat, beta, alpha_bar, z):
    """Shakes by beta, far less than its square root."""
    return _step(x_s, s, eps_hat, beta, alpha_bar, z, shake=0.0 if s == 1 else beta[s])


def not_rescaled(x_s, s, eps_hat, beta, alpha_bar, z):
    """Takes the noise away but does not undo the shrinking of each step.

    The samples come out too small.
    """
    return _step(x_s, s, eps_hat, beta, alpha_bar, z, scale=1.0, shake=0.0 if s == 1 else None)


def all_noise_taken(x_s, s, eps_hat, beta, alpha_bar, z):
    """Takes all noise at once where one step's share of it was asked for."""
    mean = (x_s - (1 - alpha_bar[s]) ** 0.5 * eps_hat) / (1 - beta[s]) ** 0.5
    return mean if s == 1 else mean + beta[s] ** 0.5 * z


def noise_added_instead(x_s, s, eps_hat, beta, alpha_bar, z):
    """Walks away from the data, further with each step."""
    return _step(x_s, s, -eps_hat, beta, alpha_bar, z, shake=0.0 if s == 1 else None)


def _leap(x, eps_hat, now, then, variance, z, kept=None):
    x0_hat = (x - (1 - now) ** 0.5 * eps_hat) / now**0.5
    kept = (1 - then - variance) ** 0.5 if kept is None else kept
    return then**0.5 * x0_hat + kept * eps_hat + variance**0.5 * z


def _variance(now, then, eta):
    return eta**2 * (1 - then) / (1 - now) * (1 - now / then)


def noise_kept_at_its_old_size(x, eps_hat, now, then, eta, z):
    """Lands at the new step's signal under the old step's noise."""
    return _leap(x, eps_hat, now, then, _variance(now, then, eta), z, kept=(1 - now) ** 0.5)


def too_much_variance(x, eps_hat, now, then, eta, z):
    """Adds fresh noise without taking as much of the old away."""
    return _leap(x, eps_hat, now, then, _variance(now, then, eta), z, kept=(1 - then) ** 0.5)


def eta_not_squared(x, eps_hat, now, then, eta, z):
    """Right at eta = 0 and eta = 1, where a square does not show, and wrong in between."""
    return _leap(x, eps_hat, now, then, _variance(now, then, eta**0.5), z)


def x0_not_rescaled(x, eps_hat, now, then, eta, z):
    """Takes what is left of x0 for x0 itself, so that each leap shrinks the sample."""
    variance = _variance(now, then, eta)
    x0_hat = x - (1 - now) ** 0.5 * eps_hat
    return then**0.5 * x0_hat + (1 - then - variance) ** 0.5 * eps_hat + variance**0.5 * z


def eta_ignored(x, eps_hat, now, then, eta, z):
    """Always deterministic, whatever eta says."""
    return _leap(x, eps_hat, now, then, 0.0, z)


ZOO = {
    "best_guess": {
        "data not shrunk": not_shrunk,
        "square root dropped": root_dropped,
        "factor two dropped": factor_two_dropped,
        "size of the noise ignored": noise_ignored,
        "shares summed over the batch": wrong_axis,
        "nearest sample instead of a mean": nearest_only,
        "plain mean of the data": plain_mean,
    },
    "step_back": {
        "noise at the last step": noise_at_the_last_step,
        "no noise at all": never_shaken,
        "variance for standard deviation": variance_for_deviation,
        "not re-scaled": not_rescaled,
        "all of the noise taken at once": all_noise_taken,
        "noise added instead of taken": noise_added_instead,
    },
    "leap": {
        "noise kept at its old size": noise_kept_at_its_old_size,
        "fresh noise on top of the old": too_much_variance,
        "eta not squared": eta_not_squared,
        "x0_hat not re-scaled": x0_not_rescaled,
        "eta ignored": eta_ignored,
    },
}
