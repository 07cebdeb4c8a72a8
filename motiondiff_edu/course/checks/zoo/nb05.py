"""Wrong answers to the exercises of notebook 05."""


def _to_x0(output, x_s, a, b, target):
    return {"eps": (x_s - b * output) / a, "x0": output, "v": a * x_s - b * output}[target]


def _shares(a, b):
    """Other amplitudes of signal and noise, as functions of alpha_bar."""
    return lambda output, x_s, alpha_bar, target: _to_x0(
        output, x_s, a(alpha_bar), b(alpha_bar), target
    )


def _root(alpha_bar):
    return alpha_bar**0.5


def _rest(alpha_bar):
    return (1 - alpha_bar) ** 0.5


def _one_target(which, form):
    """Right for two targets, wrong for the third."""

    def answer(output, x_s, alpha_bar, target):
        a, b = _root(alpha_bar), _rest(alpha_bar)
        return form(output, x_s, a, b) if target == which else _to_x0(output, x_s, a, b, target)

    return answer


def not_divided(output, x_s, alpha_bar, target):
    """Removes the noise from x_s and does not scale x0 back up."""
    return x_s - _rest(alpha_bar) * output if target == "eps" else output


def changed_in_place(means, new, decay):
    """The numbers are right, but the given means are changed."""
    for m, n in zip(means, new, strict=True):
        m *= decay
        m += (1 - decay) * n
    return means


def new_changed_in_place(means, new, decay):
    """The numbers are right, but the network's own weights are changed."""
    for m, n in zip(means, new, strict=True):
        n *= 1 - decay
        n += decay * m
    return new


def _average(of_mean, of_new):
    return lambda means, new, decay: [
        of_mean(decay) * m + of_new(decay) * n for m, n in zip(means, new, strict=True)
    ]


MISTAKES = {
    "back_to_x0": {
        "a is the square root of alpha_bar, b that of 1 - alpha_bar": _shares(
            lambda alpha_bar: alpha_bar, lambda alpha_bar: 1 - alpha_bar
        ),
        "b is the square root of 1 - alpha_bar; the root is missing": _shares(
            _root, lambda alpha_bar: 1 - alpha_bar
        ),
        "a is the square root of alpha_bar; the root is missing": _shares(
            lambda alpha_bar: alpha_bar, _rest
        ),
        "b is the root of 1 - alpha_bar, not 1 minus a root": _shares(
            _root, lambda alpha_bar: 1 - alpha_bar**0.5
        ),
        "a and b are swapped": _shares(_rest, _root),
        "for v, check the sign: x_s = a x0 + b eps, v = a eps - b x0": (
            _one_target("v", lambda output, x_s, a, b: a * x_s + b * output),
            _one_target("v", lambda output, x_s, a, b: b * output - a * x_s),
        ),
        "for eps, check the sign: the noise was added, so it is subtracted": _one_target(
            "eps", lambda output, x_s, a, b: (x_s + b * output) / a
        ),
        "for v, this is the noise; return x0": _one_target(
            "v", lambda output, x_s, a, b: a * output + b * x_s
        ),
        "for eps, this is the noise that came in; return x0": _one_target(
            "eps", lambda output, x_s, a, b: output
        ),
        "for x0, the output is what is asked for; there is nothing to convert": (
            _one_target("x0", lambda output, x_s, a, b: (x_s - b * output) / a),
            _one_target("x0", lambda output, x_s, a, b: (x_s - a * output) / b),
            _one_target("x0", lambda output, x_s, a, b: x_s),
        ),
        "for eps, undo the mixing completely: divide by a": _one_target(
            "eps", lambda output, x_s, a, b: x_s - b * output
        ),
        "for eps, both x_s and the noise are divided by a": _one_target(
            "eps", lambda output, x_s, a, b: x_s / a - b * output
        ),
        "v has a form of its own; it is no noise": _one_target(
            "v", lambda output, x_s, a, b: (x_s - b * output) / a
        ),
    },
    "averaged_weights": {
        "the shares are swapped: with decay 0.9, nine tenths of the old average stay": _average(
            lambda decay: 1 - decay, lambda decay: decay
        ),
        "this adds the new weights in full; they get the share 1 - decay": _average(
            lambda decay: decay, lambda decay: 1.0
        ),
        "the old average keeps the share `decay` only": _average(
            lambda decay: 1.0, lambda decay: 1 - decay
        ),
        "this is the plain mean of the two": _average(lambda decay: 0.5, lambda decay: 0.5),
        "both get the share `decay`; the two shares sum to 1": _average(
            lambda decay: decay, lambda decay: decay
        ),
        "the new weights are not used": lambda means, new, decay: [m.copy() for m in means],
        "the old averages are not used": lambda means, new, decay: [n.copy() for n in new],
        "you subtracted the new weights; add them": _average(
            lambda decay: decay, lambda decay: decay - 1
        ),
    },
    "weight_between_losses": {
        "this is the error of eps over that of x0; take the inverse": lambda alpha_bar: (
            alpha_bar / (1 - alpha_bar)
        ),
        "the errors are squared, so the factor is squared, too": lambda alpha_bar: (
            ((1 - alpha_bar) / alpha_bar) ** 0.5
        ),
        "this is squared once too often: alpha_bar is already a square": lambda alpha_bar: (
            ((1 - alpha_bar) / alpha_bar) ** 2
        ),
        "the division by a is missing": lambda alpha_bar: 1 - alpha_bar,
        "the factor b of eps_hat - eps is missing": lambda alpha_bar: 1 / alpha_bar,
        "the share of the noise is 1 - alpha_bar, not 1 + alpha_bar": lambda alpha_bar: (
            (1 + alpha_bar) / alpha_bar
        ),
    },
}
OTHERS = {
    "back_to_x0": {"not divided, and v as x0": not_divided},
    "averaged_weights": {
        "changed in place": changed_in_place,
        "the new ones changed in place": new_changed_in_place,
        "only the first array": lambda means, new, decay: [decay * means[0] + (1 - decay) * new[0]],
    },
}
