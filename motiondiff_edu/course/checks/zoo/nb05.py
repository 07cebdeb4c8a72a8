"""Wrong answers to the exercises of notebook 05."""


def _to_x0(output, x_s, a, b, target):
    return {"eps": (x_s - b * output) / a, "x0": output, "v": a * x_s - b * output}[target]


def roots_dropped(output, x_s, alpha_bar, target):
    """Weights signal and noise by their shares of the variance, not by the square roots."""
    return _to_x0(output, x_s, alpha_bar, 1 - alpha_bar, target)


def signal_and_noise_swapped(output, x_s, alpha_bar, target):
    """Swaps the two weights; at alpha_bar = 0.5 this makes no difference."""
    return _to_x0(output, x_s, (1 - alpha_bar) ** 0.5, alpha_bar**0.5, target)


def sign_of_v(output, x_s, alpha_bar, target):
    """Uses the wrong sign of v; eps and x0 come out right."""
    output = -output if target == "v" else output
    return _to_x0(output, x_s, alpha_bar**0.5, (1 - alpha_bar) ** 0.5, target)


def not_divided(output, x_s, alpha_bar, target):
    """Removes the noise from x_s and does not scale x0 back up."""
    return x_s - (1 - alpha_bar) ** 0.5 * output if target == "eps" else output


def shares_swapped(means, new, decay):
    """With a decay of 0.999 the mean is almost the newest weights, so it smooths nothing."""
    return [(1 - decay) * m + decay * n for m, n in zip(means, new, strict=True)]


def changed_in_place(means, new, decay):
    """The numbers are right, but the given means are changed."""
    for m, n in zip(means, new, strict=True):
        m *= decay
        m += (1 - decay) * n
    return means


def only_the_first(means, new, decay):
    """A network has more than one array of weights."""
    return [decay * means[0] + (1 - decay) * new[0]]


def new_ones_in_full(means, new, decay):
    """The shares do not add up to one, so that the mean grows to many times the weights."""
    return [decay * m + n for m, n in zip(means, new, strict=True)]


ZOO = {
    "back_to_x0": {
        "square roots dropped": roots_dropped,
        "a and b swapped": signal_and_noise_swapped,
        "sign of v": sign_of_v,
        "not divided by a": not_divided,
    },
    "averaged_weights": {
        "shares swapped": shares_swapped,
        "changed in place": changed_in_place,
        "only the first array": only_the_first,
        "new weights in full": new_ones_in_full,
    },
    "weight_between_losses": {
        "the other way round": lambda alpha_bar: alpha_bar / (1 - alpha_bar),
        "not squared": lambda alpha_bar: ((1 - alpha_bar) / alpha_bar) ** 0.5,
        "without the denominator": lambda alpha_bar: 1 - alpha_bar,
    },
}
