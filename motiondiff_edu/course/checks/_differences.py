"""How a wrong result differs from the right one, in words, without a guess at the cause.

Each observation is true of every input that was tried. The first that holds is told.
"""

from collections.abc import Callable, Sequence
from itertools import permutations

import numpy as np

Arrays = list[np.ndarray]


def told(
    name: str,
    answers: Arrays,
    wanted: Arrays,
    rtol: float,
    atol: float,
    given: Sequence[tuple] = (),
) -> str:
    """One sentence: an observation, or the entry with the largest error of the first wrong case.

    `given` has the arguments of each case, which are told if they are a few plain numbers.
    """
    close = lambda one, other: np.allclose(one, other, rtol, atol)  # noqa: E731
    found = _of_numbers(answers, wanted, close) or order(answers, wanted, close)
    if found:
        return f"{name}: {found}"
    pairs = enumerate(zip(answers, wanted, strict=True))
    case, (mine, right) = next(
        (k, p) for k, p in pairs if p[0].shape != p[1].shape or not close(*p)
    )
    of = _plainly(given[case]) or _texts(given[case]) if given else ""
    if mine.shape != right.shape:
        return f"{name} has shape {mine.shape}, and should have {right.shape}{of}"
    if not np.isfinite(mine).all():
        return f"{name} contains NaN or infinity{_how_often(answers, wanted, close)}"
    difference = np.abs(mine - right)
    where = np.unravel_index(difference.argmax(), difference.shape)
    place = f" at {tuple(int(i) for i in where)}" if where else ""
    return (
        f"{name} is {mine[where]:.6g}{place}, and should be {right[where]:.6g}"
        f"{_how_much(mine, right, rtol, atol)}{of}{_how_often(answers, wanted, close)}"
    )


def _plainly(arguments: tuple) -> str:
    """The arguments of a call, if they are short and contain no array."""
    words = ", ".join(map(repr, arguments))
    plain = all(isinstance(one, int | float | str | list | tuple) for one in arguments)
    return f"; it was given {words}" if plain and len(words) < 120 else ""


def _texts(arguments: tuple) -> str:
    """The texts among the arguments of a call: a choice such as "eps"."""
    words = [repr(one) for one in arguments if isinstance(one, str)]
    return f", with {' and '.join(words)}" if words else ""


def _how_much(mine: np.ndarray, right: np.ndarray, rtol: float, atol: float) -> str:
    """Which entries are right, if some are: as a share, or as the rows of an axis."""
    good = np.isclose(mine, right, rtol, atol)
    if not good.any() or mine.ndim == 0:
        return ""
    for axis in range(mine.ndim):
        rows = good.all(axis=tuple(i for i in range(mine.ndim) if i != axis))
        wrong = np.flatnonzero(~rows)
        if mine.shape[axis] > 2 and len(wrong) <= max(1, mine.shape[axis] // 3):
            return f"; only {_places(wrong)} along axis {axis} {_be(len(wrong))} wrong"
    return f"; {good.sum()} of {good.size} entries are right"


def _how_often(answers: Arrays, wanted: Arrays, close: Callable) -> str:
    """In how many cases, if not in all."""
    good = sum(
        one.shape == two.shape and close(one, two) for one, two in zip(answers, wanted, strict=True)
    )
    return f" (other inputs come out right: {good} of {len(answers)})" if good else ""


def _places(wrong: np.ndarray) -> str:
    return ("index " if len(wrong) == 1 else "indices ") + ", ".join(map(str, wrong))


def _be(count: int) -> str:
    return "is" if count == 1 else "are"


def _of_numbers(answers: Arrays, wanted: Arrays, close: Callable) -> str:
    """What holds of all numbers of all inputs, if the shapes are right and there are several."""
    pairs = list(zip(answers, wanted, strict=True))
    if not all(one.shape == two.shape and np.isfinite(one).all() for one, two in pairs):
        return ""
    mine, right = (np.concatenate([one.ravel() for one in side]) for side in (answers, wanted))
    if len(mine) < 2:
        return ""
    found = (seen(mine, right, close) for seen in (factor, offset, power))
    return next(filter(None, found), "")


def factor(mine: np.ndarray, right: np.ndarray, close: Callable) -> str:
    """The same multiple of the right value everywhere."""
    place = np.abs(right).argmax()
    if abs(right[place]) < 1e-9:
        return ""
    ratio = mine[place] / right[place]
    if not close(mine, ratio * right) or abs(ratio - 1) < 1e-6:
        return ""
    if abs(ratio) < 1e-9:
        return "everything is 0"
    if abs(ratio + 1) < 1e-4:
        return "the sign is wrong everywhere; the numbers are right"
    return f"everywhere it is {ratio:.4g} times what it should be"


def offset(mine: np.ndarray, right: np.ndarray, close: Callable) -> str:
    """The same difference everywhere."""
    by = (mine - right)[0]
    if not close(mine, right + by) or close(mine, right):
        return ""
    return f"everywhere it is too {'large' if by > 0 else 'small'} by {abs(by):.4g}"


def power(mine: np.ndarray, right: np.ndarray, close: Callable) -> str:
    """Square, root, inverse, or another sign in places."""
    with np.errstate(all="ignore"):
        forms = {
            "it is the square of what it should be": right**2,
            "it is the root of what it should be": np.sqrt(right),
            "it is one divided by what it should be": 1 / right,
            "it is one minus what it should be": 1 - right,
            "it is the logarithm of what it should be": np.log(right),
            "its logarithm is what it should be": np.exp(right),
        }
        for words, form in forms.items():
            if np.isfinite(form).all() and close(mine, form):
                return words
    if close(np.abs(mine), np.abs(right)):
        return "all sizes are right, some signs are not"
    return ""


def order(answers: Arrays, wanted: Arrays, close: Callable) -> str:
    """Axes in another order, an axis that runs backwards, rows that come too late or too early."""
    first = wanted[0]
    if any(one.ndim != first.ndim for one in (*answers, *wanted)):
        return ""

    def all_are(change: Callable) -> bool:
        pairs = [(mine, change(right)) for mine, right in zip(answers, wanted, strict=True)]
        return all(mine.shape == form.shape and close(mine, form) for mine, form in pairs)

    if 1 < first.ndim <= 4:
        for axes in permutations(range(first.ndim)):
            if axes != tuple(range(first.ndim)) and all_are(lambda x, axes=axes: x.transpose(axes)):
                return (
                    "the numbers are right, but the axes should be in another order: shape "
                    f"{first.shape}"
                )
    for axis in range(first.ndim):
        if first.shape[axis] > 1 and all_are(lambda x, axis=axis: np.flip(x, axis)):
            return f"the numbers are right, but axis {axis} runs backwards"
    for axis in range(first.ndim):
        for by, words in ((1, "late"), (-1, "early")):
            if _moved(answers, wanted, axis, by, close):
                return f"along axis {axis} everything comes one place too {words}"
    return ""


def _moved(answers: Arrays, wanted: Arrays, axis: int, by: int, close: Callable) -> bool:
    for mine, right in zip(answers, wanted, strict=True):
        n = right.shape[axis]
        if mine.shape != right.shape or n < 4:
            return False
        late, soon = np.arange(1, n), np.arange(n - 1)
        at, of = (late, soon) if by > 0 else (soon, late)
        if not close(mine.take(at, axis), right.take(of, axis)):
            return False
    return True
