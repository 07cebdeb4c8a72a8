"""Wrong answers to the exercises of notebook 15."""

import math

import torch


def _seen(given, alpha_bar, noise):
    return math.sqrt(alpha_bar) * given + math.sqrt(1 - alpha_bar) * noise


def _with_mask(value):
    """Puts a wrong value where something is known."""
    return lambda x_s, given, known, alpha_bar, noise: torch.where(
        known, value(x_s, given, alpha_bar, noise), x_s
    )


def by_product(x_s, given, known, alpha_bar, noise):
    """Multiplies by the mask: where nothing is known, 0 times NaN is NaN."""
    return known * _seen(given, alpha_bar, noise) + ~known * x_s


def _sampled(put, leap, x, visited, after_leap=None):
    """The loop, with a given change before every leap, and after it."""
    for s, after in zip(visited, [*visited[1:], 0], strict=True):
        x = leap(put(x, s, after), s, after)
        x = x if after_leap is None else after_leap(x, s, after)
    return x


def inverted(leap, snapshot, x, visited, given, known):
    """Replaces the unknown entries and samples the known ones."""
    x = _sampled(lambda x, s, after: torch.where(known, x, snapshot(s)), leap, x, visited)
    return torch.where(known, x, given)


def clean(leap, snapshot, x, visited, given, known):
    """Puts clean entries among noisy ones, which the network never saw in training."""
    x = _sampled(lambda x, s, after: torch.where(known, given, x), leap, x, visited)
    return torch.where(known, given, x)


def one_snapshot(leap, snapshot, x, visited, given, known):
    """Uses the first step's noise at all steps: the given entries look like noise to the end."""
    kept = snapshot(visited[0])
    x = _sampled(lambda x, s, after: torch.where(known, kept, x), leap, x, visited)
    return torch.where(known, given, x)


def of_the_step_after(leap, snapshot, x, visited, given, known):
    """Adds too little noise for the step that the network gets."""
    x = _sampled(lambda x, s, after: torch.where(known, snapshot(after), x), leap, x, visited)
    return torch.where(known, given, x)


def after_the_leap(leap, snapshot, x, visited, given, known):
    """The network sees pure noise first, and then the snapshot of the step before."""
    x = _sampled(
        lambda x, s, after: x,
        leap,
        x,
        visited,
        lambda x, s, after: torch.where(known, snapshot(s), x),
    )
    return torch.where(known, given, x)


def after_the_leap_for_the_next(leap, snapshot, x, visited, given, known):
    """This is nearly right: the network sees pure noise only at the first step."""
    x = _sampled(
        lambda x, s, after: x,
        leap,
        x,
        visited,
        lambda x, s, after: torch.where(known, snapshot(after), x),
    )
    return torch.where(known, given, x)


def not_put_back(leap, snapshot, x, visited, given, known):
    """The last leap moves the given entries a little."""
    return _sampled(lambda x, s, after: torch.where(known, snapshot(s), x), leap, x, visited)


def right(leap, snapshot, x, visited, given, known):
    """The right answer, among the wrong ones of the bug zoo."""
    x = _sampled(lambda x, s, after: torch.where(known, snapshot(s), x), leap, x, visited)
    return torch.where(known, given, x)


def at_the_end_only(leap, snapshot, x, visited, given, known):
    """Samples without the given entries, and pastes them over the result."""
    return torch.where(known, given, _sampled(lambda x, s, after: x, leap, x, visited))


def last_step_missing(leap, snapshot, x, visited, given, known):
    """Stops at the last visited step, at which noise is left."""
    for s, after in zip(visited[:-1], visited[1:], strict=True):
        x = leap(torch.where(known, snapshot(s), x), s, after)
    return torch.where(known, given, x)


def _back(signal, share):
    return lambda x, now, then, noise: signal(now, then) * x + share(now, then) * noise


def _root(now, then):
    return math.sqrt(then / now)


# the bug zoo of the notebook, whose letters do not tell
CAGES = {"A": at_the_end_only, "B": inverted, "C": right, "D": one_snapshot}
ZOO = {
    "snapshot": {
        "mask inverted": lambda x, given, known, ab, noise: torch.where(
            known, x, _seen(given, ab, noise)
        ),
        "clean": _with_mask(lambda x, given, ab, noise: given),
        "no roots": _with_mask(lambda x, given, ab, noise: ab * given + (1 - ab) * noise),
        "signal and noise exchanged": _with_mask(
            lambda x, given, ab, noise: _seen(given, 1 - ab, noise)
        ),
        "no noise": _with_mask(lambda x, given, ab, noise: math.sqrt(ab) * given),
        "signal not shrunk": _with_mask(
            lambda x, given, ab, noise: given + math.sqrt(1 - ab) * noise
        ),
        "x_s noised again": _with_mask(lambda x, given, ab, noise: _seen(x, ab, noise)),
        "everything replaced": lambda x, given, known, ab, noise: _seen(given, ab, noise),
        "multiplied": by_product,
    },
    "masked": {
        "mask inverted": inverted,
        "clean snapshot": clean,
        "one snapshot for all steps": one_snapshot,
        "snapshot of the step after": of_the_step_after,
        "after the leap": after_the_leap,
        "after the leap, for the next": after_the_leap_for_the_next,
        "not put back": not_put_back,
        "put in at the end only": at_the_end_only,
        "last step missing": last_step_missing,
    },
    "way_back": {
        "as if clean": _back(
            lambda now, then: math.sqrt(then), lambda now, then: math.sqrt(1 - then)
        ),
        "no roots": _back(lambda now, then: then / now, lambda now, then: 1 - then / now),
        "root of the noise only": _back(
            lambda now, then: then / now, lambda now, then: math.sqrt(1 - then / now)
        ),
        "does not shrink": _back(
            lambda now, then: 1.0, lambda now, then: math.sqrt(1 - then / now)
        ),
        "too much noise": _back(_root, lambda now, then: math.sqrt(1 - then)),
        "difference of deviations": _back(
            _root, lambda now, then: math.sqrt(1 - then) - math.sqrt(1 - now)
        ),
        "difference of variances": _back(_root, lambda now, then: math.sqrt(now - then)),
        "no noise": _back(_root, lambda now, then: 0.0),
    },
}
