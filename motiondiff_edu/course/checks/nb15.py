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
    """mine(x_s, given, known, alpha_bar, noise), entry by entry by hand."""
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
                "these are the given entries clean, "
                "and the network expects them as noisy as all else"
            ): put(given),
            "take the root of alpha_bar, and of 1 - alpha_bar": put(
                alpha_bar * given + (1 - alpha_bar) * noise
            ),
            "signal and noise are exchanged: alpha_bar is what is left of the signal": put(
                b * given + a * noise
            ),
            "where is the noise?": put(a * given),
            "noise is added to what keeps its whole size; the signal shrinks as well": put(
                given + b * noise
            ),
            "it is the given that is noised, and not what was there": put(a * x_s + b * noise),
            "everything was replaced: what is not known stays x_s": seen,
            "x_s itself is to be left alone where nothing is known, noise included": torch.where(
                known, seen, a * x_s + b * noise
            ),
            "nothing was put in": x_s,
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
            "what is not known may be NaN, and 0 times NaN is NaN: "
            "choose with torch.where instead of multiplying"
        ),
    )
    return "What is given is seen through as much noise as everything else."


class _Told:
    """A leap and a snapshot that write down what happens.

    Each is simple enough to be followed by hand.
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

    Everything in the leap depends on everything.
    """
    x = _numbers(2, 5)
    given = _numbers(2, 5, seed=1)
    visited = [9, 6, 4, 1]
    known = torch.tensor([[True, False, True, False, False], [False, True, False, False, True]])

    def by(order):
        told = _Told(given)
        return order(told, x.clone()), told

    def each(told, x, put, after_leap=None):
        for s, after in zip(visited, [*visited[1:], 0], strict=True):
            x = told.leap(put(told, x, s, after), s, after)
            x = x if after_leap is None else after_leap(told, x, s, after)
        return x

    def here(told, x, s, after):
        return torch.where(known, told.snapshot(s), x)

    def ended(x):
        return torch.where(known, given, x)

    def once(told, x):
        kept = told.snapshot(visited[0])
        return ended(each(told, x, lambda t, x, s, a: torch.where(known, kept, x)))

    def short(told, x, put):
        for s, after in zip(visited[:-1], visited[1:], strict=True):
            x = told.leap(put(told, x, s, after), s, after)
        return x

    wrong = {
        "the mask is inverted: what is known is replaced, the rest is sampled": lambda t, x: (
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
            "the network was shown the given clean: take a snapshot, as noisy as x is at this step"
        ): lambda t, x: ended(each(t, x, lambda t, x, s, a: torch.where(known, given, x))),
        "one snapshot was used for all steps: at each step draw one for that step": once,
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
            "put in after the leap, the network's first look is at pure noise: put them in before"
        ): lambda t, x: ended(
            each(
                t,
                x,
                lambda t, x, s, a: x,
                lambda t, x, s, a: torch.where(known, t.snapshot(a), x),
            )
        ),
        "at the end the given must be put back: the last leap changed it": lambda t, x: each(
            t, x, here
        ),
        "they were put in at the end only, so that the network never saw them": lambda t, x: ended(
            each(t, x, lambda t, x, s, a: x)
        ),
        "the last step, from the last visited to 0, is missing": lambda t, x: ended(
            short(t, x, here)
        ),
        "everything was put in at the end: the unknown is what was sampled": lambda t, x: (
            given + 0 * each(t, x, here)
        ),
    }

    wanted, right = by(lambda t, x: ended(each(t, x, here)))
    told = _Told(given)
    got = mine(told.leap, told.snapshot, x.clone(), list(visited), given, known)
    steps = [(s, after) for s, after, _ in told.seen]
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
    return f"{len(right.drawn)} snapshots, one for each step, each with noise of its own."


@check
def way_back(mine):
    """mine(x, now, then, noise): where a clean signal and its noise must be afterwards."""
    x, noise = _numbers(3, 5), _numbers(3, 5, seed=1)
    for now, then in ((0.9, 0.4), (0.5, 0.45)):
        ratio = then / now
        wanted = math.sqrt(ratio) * x + math.sqrt(1 - ratio) * noise
        mistakes = {
            (
                "this noises x as if it were clean: "
                "it has noise already, and alpha_bar falls from `now` to `then`"
            ): (math.sqrt(then) * x + math.sqrt(1 - then) * noise),
            "the share is right; take its root, and the root of what is missing to 1": ratio * x
            + (1 - ratio) * noise,
            "the signal shrinks by the root of then / now, and not by the number itself": (
                ratio * x + math.sqrt(1 - ratio) * noise
            ),
            "noise comes in, and x does not shrink: its variance would grow at every turn": (
                x + math.sqrt(1 - ratio) * noise
            ),
            "the new noise is too much: some of it is there already": (
                math.sqrt(ratio) * x + math.sqrt(1 - then) * noise
            ),
            "variances add up, deviations do not: the noise needed is 1 - then / now in variance": (
                math.sqrt(ratio) * x + (math.sqrt(1 - then) - math.sqrt(1 - now)) * noise
            ),
            (
                "the new noise is the difference of the noise levels, but x shrinks, "
                "and the noise in it as well"
            ): (math.sqrt(ratio) * x + math.sqrt(now - then) * noise),
            "no noise was added": math.sqrt(ratio) * x,
        }
        expect_close(
            mine(x, now, then, noise), wanted, f"x, from alpha_bar = {now} back to {then}", mistakes
        )
    return "One step of notebook 02's forward process, however many steps it stands for."
