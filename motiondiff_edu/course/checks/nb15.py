"""Checks of notebook 15.

The snapshot, the loop of masked sampling, and the way back to more noise.
"""

import math

import torch

from ._report import check, expect, expect_close


def _numbers(*shape: int, seed: int = 0) -> torch.Tensor:
    return torch.randn(*shape, generator=torch.Generator().manual_seed(seed))


@check
def snapshot(mine):
    """mine(x_s, given, known, alpha_bar, noise) against a loop over the entries."""
    x_s = _numbers(2, 5, 3)
    given = _numbers(2, 5, 3, seed=1)
    noise = _numbers(2, 5, 3, seed=2)
    known = torch.zeros(2, 5, 3, dtype=torch.bool)
    known[0, :2], known[1, 3, 1:] = True, True
    for alpha_bar in (0.36, 0.9):
        a, b = math.sqrt(alpha_bar), math.sqrt(1 - alpha_bar)

        def put(values, mask=known):
            return torch.where(mask, values, x_s)

        seen = a * given + b * noise
        wanted = x_s.clone()
        for place in known.nonzero().tolist():
            wanted[tuple(place)] = a * given[tuple(place)] + b * noise[tuple(place)]
        mistakes = {
            "the mask is inverted: True is what is given": put(seen, ~known),
            (
                "these are the clean given entries; the network expects them as noisy as all others"
            ): put(given),
            "take the root of alpha_bar, and of 1 - alpha_bar": put(
                alpha_bar * given + (1 - alpha_bar) * noise
            ),
            "signal and noise are swapped: alpha_bar is what is left of the signal": put(
                b * given + a * noise
            ),
            "where is the noise?": put(a * given),
            "noise is added, but the signal keeps its size; it must be scaled as well": put(
                given + b * noise
            ),
            "add noise to the given values, not to the values of x_s": put(a * x_s + b * noise),
            "everything was replaced: unknown entries stay as in x_s": seen,
            "where nothing is known, x_s stays as it is: add no noise there": torch.where(
                known, seen, a * x_s + b * noise
            ),
            "the given entries were not put in": x_s,
        }
        expect_close(
            mine(x_s.clone(), given, known, alpha_bar, noise),
            wanted,
            f"x_s for alpha_bar = {alpha_bar}",
            mistakes,
        )
    holes = torch.where(known, given, torch.full_like(given, float("nan")))
    expect(
        torch.isfinite(torch.as_tensor(mine(x_s, holes, known, 0.36, noise))).all(),
        (
            "unknown entries may be NaN, and 0 times NaN is NaN: "
            "choose with torch.where instead of multiplying"
        ),
    )
    return "The network sees the given entries with as much noise as all others."


class _Recorder:
    """A leap and a snapshot that record their calls.

    Each is simple enough to follow by hand.
    """

    def __init__(self, given: torch.Tensor):
        self.given = given
        self.seen = []
        self.drawn = []

    def snapshot(self, s):
        self.drawn.append(int(s))
        return self.given / (1 + s) + 0.01 * s + 0.1 * len(self.drawn)

    def leap(self, x, s, after):
        self.seen.append((int(s), int(after), x.clone()))
        return 0.7 * x + 0.2 * x.mean() + 0.03 * s + 0.01 * after


@check
def masked(mine):
    """Check mine(leap, snapshot, x, visited, given, known).

    In the leap of this check, each entry depends on all entries.
    """
    x = _numbers(2, 5)
    given = _numbers(2, 5, seed=1)
    visited = [9, 6, 4, 1]
    known = torch.tensor([[True, False, True, False, False], [False, True, False, False, True]])

    def by(order):
        record = _Recorder(given)
        return order(record, x.clone()), record

    def each(record, x, put, after_leap=None):
        for s, after in zip(visited, [*visited[1:], 0], strict=True):
            x = record.leap(put(record, x, s, after), s, after)
            x = x if after_leap is None else after_leap(record, x, s, after)
        return x

    def here(record, x, s, after):
        return torch.where(known, record.snapshot(s), x)

    def ended(x):
        return torch.where(known, given, x)

    def once(record, x):
        kept = record.snapshot(visited[0])
        return ended(each(record, x, lambda t, x, s, a: torch.where(known, kept, x)))

    def short(record, x, put):
        for s, after in zip(visited[:-1], visited[1:], strict=True):
            x = record.leap(put(record, x, s, after), s, after)
        return x

    wrong = {
        "the mask is inverted: replace the known entries, and sample the others": lambda t, x: (
            torch.where(
                known,
                x * 0 + given,
                each(t, x, lambda t, x, s, a: torch.where(known, x, t.snapshot(s))),
            )
        ),
        "the mask is inverted, at the end as well": lambda t, x: torch.where(
            known, each(t, x, lambda t, x, s, a: torch.where(known, x, t.snapshot(s))), given
        ),
        (
            "the network saw clean given entries: take a snapshot, as noisy as x is at this step"
        ): lambda t, x: ended(each(t, x, lambda t, x, s, a: torch.where(known, given, x))),
        "one snapshot was used for all steps: draw a new one at each step": once,
        (
            "the snapshot is of the step after; x has the noise of s when the network sees it"
        ): lambda t, x: ended(each(t, x, lambda t, x, s, a: torch.where(known, t.snapshot(a), x))),
        (
            "the known entries are put in after the leap: the network must see them before"
        ): lambda t, x: ended(
            each(
                t,
                x,
                lambda t, x, s, a: x,
                lambda t, x, s, a: torch.where(known, t.snapshot(s), x),
            )
        ),
        (
            "the network sees pure noise first: put the known entries in before the leap"
        ): lambda t, x: ended(
            each(
                t,
                x,
                lambda t, x, s, a: x,
                lambda t, x, s, a: torch.where(known, t.snapshot(a), x),
            )
        ),
        "at the end the given entries must be put back: the last leap changed them": lambda t, x: (
            each(t, x, here)
        ),
        "the known entries were put in at the end only: the network never saw them": lambda t, x: (
            ended(each(t, x, lambda t, x, s, a: x))
        ),
        "the last step, from the last visited to 0, is missing": lambda t, x: ended(
            short(t, x, here)
        ),
        "everything was put in at the end: unknown entries stay as sampled": lambda t, x: (
            given + 0 * each(t, x, here)
        ),
    }

    wanted, right = by(lambda t, x: ended(each(t, x, here)))
    record = _Recorder(given)
    got = mine(record.leap, record.snapshot, x.clone(), list(visited), given, known)
    steps = [(s, after) for s, after, _ in record.seen]
    named = {hint: by(order)[0] for hint, order in wrong.items()}
    expect(steps, "no leap was made")
    if len(steps) == len(visited):
        expect(
            steps == [(s, after) for s, after, _ in right.seen],
            (
                "leaps lead from each visited step to the next, and from the last to 0; "
                f"yours: {steps}"
            ),
        )
    expect_close(got, wanted, "the end of four steps", named)
    return f"You took {len(right.drawn)} snapshots, one for each step, each with its own noise."


@check
def way_back(mine):
    """mine(x, now, then, noise): the shares of signal and noise in the result."""
    x, noise = _numbers(3, 5), _numbers(3, 5, seed=1)
    for now, then in ((0.9, 0.4), (0.5, 0.45)):
        ratio = then / now
        wanted = math.sqrt(ratio) * x + math.sqrt(1 - ratio) * noise
        mistakes = {
            (
                "this noises x as if it were clean: "
                "it has noise already, and alpha_bar falls from `now` to `then`"
            ): (math.sqrt(then) * x + math.sqrt(1 - then) * noise),
            "the ratio is right; take its root, and the root of 1 minus the ratio": ratio * x
            + (1 - ratio) * noise,
            "the signal is scaled by the root of then / now, not by then / now": (
                ratio * x + math.sqrt(1 - ratio) * noise
            ),
            "noise is added, but x is not scaled: its variance would grow every time": (
                x + math.sqrt(1 - ratio) * noise
            ),
            "this adds too much noise: x already has some": (
                math.sqrt(ratio) * x + math.sqrt(1 - then) * noise
            ),
            "variances add up, standard deviations do not: add a variance of 1 - then / now": (
                math.sqrt(ratio) * x + (math.sqrt(1 - then) - math.sqrt(1 - now)) * noise
            ),
            (
                "the new noise is the difference of the noise levels; "
                "but when x is scaled, its noise is scaled, too"
            ): (math.sqrt(ratio) * x + math.sqrt(now - then) * noise),
            "no noise was added": math.sqrt(ratio) * x,
        }
        expect_close(
            mine(x, now, then, noise), wanted, f"x, from alpha_bar = {now} back to {then}", mistakes
        )
    return "This is one step of notebook 02's forward process, even if it replaces several."
