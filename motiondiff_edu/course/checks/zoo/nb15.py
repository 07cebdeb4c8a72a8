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


def x_in_place(x_s, given, known, alpha_bar, noise):
    """Right numbers, written into x_s."""
    x_s[known] = _seen(given, alpha_bar, noise)[known]
    return x_s


def _sampled(put, leap, x, visited, after_leap=None):
    """The loop, with a given change before every leap, and after it."""
    for s, after in zip(visited, [*visited[1:], 0], strict=True):
        x = leap(put(x, s, after), s, after)
        x = x if after_leap is None else after_leap(x, s, after)
    return x


def _as_it_is(x, s, after):
    return x


def inverted(leap, snapshot, x, visited, given, known):
    """Replaces the unknown entries and samples the known ones."""
    x = _sampled(lambda x, s, after: torch.where(known, x, snapshot(s)), leap, x, visited)
    return torch.where(known, x, given)


def inverted_inside(leap, snapshot, x, visited, given, known):
    """Replaces the unknown entries on the way, and puts back the known ones at the end."""
    x = _sampled(lambda x, s, after: torch.where(known, x, snapshot(s)), leap, x, visited)
    return torch.where(known, given, x)


def clean(leap, snapshot, x, visited, given, known):
    """Puts clean entries among noisy ones, which the network never saw in training."""
    x = _sampled(lambda x, s, after: torch.where(known, given, x), leap, x, visited)
    return torch.where(known, given, x)


def one_snapshot(leap, snapshot, x, visited, given, known):
    """Uses the first step's noise at all steps: the given entries look like noise to the end."""
    kept = snapshot(visited[0])
    x = _sampled(lambda x, s, after: torch.where(known, kept, x), leap, x, visited)
    return torch.where(known, given, x)


def first_step_only(leap, snapshot, x, visited, given, known):
    """Draws at each step, but always for the first one."""
    put = lambda x, s, after: torch.where(known, snapshot(visited[0]), x)  # noqa: E731
    return torch.where(known, given, _sampled(put, leap, x, visited))


def of_the_step_after(leap, snapshot, x, visited, given, known):
    """Adds too little noise for the step that the network gets."""
    x = _sampled(lambda x, s, after: torch.where(known, snapshot(after), x), leap, x, visited)
    return torch.where(known, given, x)


def _after_the_leap(which, last=True):
    """Puts the known entries in after each leap, of step s or of the one after."""

    def answer(leap, snapshot, x, visited, given, known):
        put = lambda x, s, after: torch.where(known, snapshot(which(s, after)), x)  # noqa: E731
        x = _sampled(_as_it_is, leap, x, visited, put)
        return torch.where(known, given, x) if last else x

    return answer


def not_put_back(leap, snapshot, x, visited, given, known):
    """The last leap moves the given entries a little."""
    return _sampled(lambda x, s, after: torch.where(known, snapshot(s), x), leap, x, visited)


def put_back_by_snapshot(leap, snapshot, x, visited, given, known):
    """Puts a snapshot of step 0 in at the end, not what was given."""
    x = not_put_back(leap, snapshot, x, visited, given, known)
    return torch.where(known, snapshot(0), x)


def right(leap, snapshot, x, visited, given, known):
    """The right answer, among the wrong ones of the bug zoo."""
    return torch.where(known, given, not_put_back(leap, snapshot, x, visited, given, known))


def at_the_end_only(leap, snapshot, x, visited, given, known):
    """Samples without the given entries, and pastes them over the result."""
    return torch.where(known, given, _sampled(_as_it_is, leap, x, visited))


def everything_at_the_end(leap, snapshot, x, visited, given, known):
    """What was sampled is lost."""
    not_put_back(leap, snapshot, x, visited, given, known)
    return given.clone()


def last_step_missing(leap, snapshot, x, visited, given, known):
    """Stops at the last visited step, at which noise is left."""
    for s, after in zip(visited[:-1], visited[1:], strict=True):
        x = leap(torch.where(known, snapshot(s), x), s, after)
    return torch.where(known, given, x)


def _back(signal, share):
    return lambda x, now, then, noise: signal(now, then) * x + share(now, then) * noise


def _root(now, then):
    return math.sqrt(then / now)


def _rest(now, then):
    return math.sqrt(1 - then / now)


# the bug zoo of the notebook, whose letters do not tell
CAGES = {"A": at_the_end_only, "B": inverted, "C": right, "D": one_snapshot}
MISTAKES = {
    "snapshot": {
        "the mask is inverted: True is what is given": lambda x, given, known, ab, noise: (
            torch.where(known, x, _seen(given, ab, noise))
        ),
        "these are the clean given entries; the network expects them as noisy as all others": (
            _with_mask(lambda x, given, ab, noise: given)
        ),
        "take the root of alpha_bar, and of 1 - alpha_bar": _with_mask(
            lambda x, given, ab, noise: ab * given + (1 - ab) * noise
        ),
        "the root of alpha_bar is missing": _with_mask(
            lambda x, given, ab, noise: ab * given + math.sqrt(1 - ab) * noise
        ),
        "the root of 1 - alpha_bar is missing": _with_mask(
            lambda x, given, ab, noise: math.sqrt(ab) * given + (1 - ab) * noise
        ),
        "signal and noise are swapped: alpha_bar is what is left of the signal": _with_mask(
            lambda x, given, ab, noise: _seen(given, 1 - ab, noise)
        ),
        "where is the noise?": _with_mask(lambda x, given, ab, noise: math.sqrt(ab) * given),
        "noise is added, but the signal keeps its size; it must be scaled as well": _with_mask(
            lambda x, given, ab, noise: given + math.sqrt(1 - ab) * noise
        ),
        "you subtracted the noise; add it": _with_mask(
            lambda x, given, ab, noise: _seen(given, ab, -noise)
        ),
        "add noise to the given values, not to the values of x_s": _with_mask(
            lambda x, given, ab, noise: _seen(x, ab, noise)
        ),
        "this is noise alone": _with_mask(lambda x, given, ab, noise: noise),
        "everything was replaced: unknown entries stay as in x_s": (
            lambda x, given, known, ab, noise: _seen(given, ab, noise)
        ),
        "where nothing is known, x_s stays as it is: add no noise there": (
            lambda x, given, known, ab, noise: torch.where(
                known, _seen(given, ab, noise), _seen(x, ab, noise)
            )
        ),
        "the given entries were not put in": lambda x, given, known, ab, noise: x.clone(),
        "0 times NaN is NaN: choose with torch.where instead of multiplying": by_product,
        "where nothing is known, x_s stays as it is; it is not 0": (
            lambda x, given, known, ab, noise: torch.where(known, _seen(given, ab, noise), 0.0)
        ),
    },
    "masked": {
        "the mask is inverted: replace the known entries, and sample the others": inverted_inside,
        "the mask is inverted, at the end as well": inverted,
        "the network saw clean given entries: take a snapshot, as noisy as x is at this step": (
            clean
        ),
        "one snapshot was used for all steps: draw a new one at each step": one_snapshot,
        "each step has its own noise: the snapshot is of step s, not of the first": first_step_only,
        "the snapshot is of the step after; x has the noise of s when the network sees it": (
            of_the_step_after
        ),
        "the known entries are put in after the leap: the network must see them before": (
            _after_the_leap(lambda s, after: s)
        ),
        "the network sees pure noise first: put the known entries in before the leap": (
            _after_the_leap(lambda s, after: after)
        ),
        "at the end the given entries must be put back: the last leap changed them": not_put_back,
        "at the end put back what was given; a snapshot of step 0 is another thing": (
            put_back_by_snapshot
        ),
        "the known entries were put in at the end only: the network never saw them": (
            at_the_end_only
        ),
        "the last step, from the last visited to 0, is missing": last_step_missing,
        "everything was put in at the end: unknown entries stay as sampled": everything_at_the_end,
    },
    "way_back": {
        "this noises x as if it were clean: it has noise already, and alpha_bar falls from `now` "
        "to `then`": _back(
            lambda now, then: math.sqrt(then), lambda now, then: math.sqrt(1 - then)
        ),
        "the ratio is right; take its root, and the root of 1 minus the ratio": _back(
            lambda now, then: then / now, lambda now, then: 1 - then / now
        ),
        "the signal is scaled by the root of then / now, not by then / now": _back(
            lambda now, then: then / now, _rest
        ),
        "the noise has the root of 1 - then / now": _back(_root, lambda now, then: 1 - then / now),
        "noise is added, but x is not scaled: its variance would grow every time": _back(
            lambda now, then: 1.0, _rest
        ),
        "this adds too much noise: x already has some": _back(
            _root, lambda now, then: math.sqrt(1 - then)
        ),
        "variances add up, standard deviations do not: add a variance of 1 - then / now": _back(
            _root, lambda now, then: math.sqrt(1 - then) - math.sqrt(1 - now)
        ),
        "the new noise is the difference of the noise levels; but when x is scaled, its noise is "
        "scaled, too": _back(_root, lambda now, then: math.sqrt(now - then)),
        "no noise was added": _back(_root, lambda now, then: 0.0),
        "you subtracted the noise; add it": _back(_root, lambda now, then: -_rest(now, then)),
        "signal and noise are swapped": _back(_rest, _root),
    },
}
OTHERS = {
    "snapshot": {"in place": x_in_place},
    "way_back": {
        "now and then exchanged": lambda x, now, then, noise: (
            (now / then) ** 0.5 * x + (1 - now / then) ** 0.5 * noise
        )
    },
}
