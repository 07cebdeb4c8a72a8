"""An answer beside the right one, on several inputs; and what can be said of a wrong one.

A mistake is a *function* here, not a number: an answer is told its mistake only if it gives the
same as that mistake on every input. So a hint is not given because two numbers happen to be equal.
Where no mistake fits, the message says what differs (`_differences.py`), and does not guess why.
"""

import copy
import warnings
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager

import numpy as np
import torch

from ._differences import told
from ._report import CheckFailed, as_array, expect
from .zoo import Wrong, several

Answer = Callable
Inputs = Callable[[np.random.Generator], Iterable[tuple]]
_SEED = [0]  # of the inputs that are drawn


@contextmanager
def other_inputs(seed: int) -> Iterator[None]:
    """Within it, checks draw other inputs: a hint that is true must stay the same."""
    before = _SEED[0]
    _SEED[0] = seed
    try:
        yield
    finally:
        _SEED[0] = before


def compare(
    mine: Answer,
    right: Answer,
    inputs: Inputs,
    what: str | tuple[str, ...],
    mistakes: Wrong | None = None,
    rtol: float = 1e-4,
    atol: float = 1e-5,
) -> None:
    """Fail unless `mine` gives what `right` gives, for each of the inputs.

    `inputs(rng)` yields the arguments of each call. Some are fixed (round numbers, limits), others
    come from `rng`. `what` names the result, or each part of it. `mistakes` are wrong answers:
    {hint: function, or several}.
    """
    names = (what,) if isinstance(what, str) else what
    given = list(inputs(np.random.default_rng(_SEED[0])))

    def of(answer: Answer, case: tuple) -> list:
        return _parts(answer(*copy.deepcopy(case)), names)

    def same(one: np.ndarray, other: np.ndarray) -> bool:
        return one.shape == other.shape and np.allclose(one, other, rtol, atol, equal_nan=True)

    mines, rights = [of(mine, case) for case in given], [of(right, case) for case in given]
    again = of(mine, given[0])
    expect(
        all(same(one, two) for one, two in zip(mines[0], again, strict=True)),
        "what you return differs from call to call; all that is random is given, so draw nothing",
    )
    numbers = len(names) > 1 and not any(part.ndim for part in mines[0])
    expect(
        not (numbers and all(part.ndim for part in rights[0])),
        f"return {len(names)} arrays: {' and '.join(names)}; yours are {len(names)} numbers",
    )
    for part, name in enumerate(names):
        answers, wanted = [case[part] for case in mines], [case[part] for case in rights]
        if all(map(_right, answers, wanted, [(rtol, atol)] * len(given))):
            continue
        # a mistake that explains all parts goes before one that explains this part alone
        for parts in ([*range(len(names))], [part]):
            for hint, wrong in (mistakes or {}).items():
                if any(_is(one, parts, mines, given, of, same) for one in several(wrong)):
                    raise CheckFailed(f"{name}: {hint}")
        raise CheckFailed(told(name, answers, wanted, rtol, atol, given))


def _right(answer: np.ndarray, wanted: np.ndarray, tolerance: tuple[float, float]) -> bool:
    return answer.shape == wanted.shape and np.allclose(answer, wanted, *tolerance)


def _is(mistake, parts, mines, given, of, same) -> bool:
    """Whether these parts of the answers are the mistake's, on every input."""
    try:
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of an empty mean, for example
            for answer, case in zip(mines, given, strict=True):
                wrong = of(mistake, case)
                if not all(same(answer[part], wrong[part]) for part in parts):
                    return False
            return True
    except Exception:  # a mistake need not be able to answer everything
        return False


def _parts(got, names: tuple[str, ...]) -> list[np.ndarray]:
    """The parts of a result as arrays, however they are wrapped."""
    expect(got is not None, "your answer returns nothing; is a `return` missing?")
    if len(names) == 1:
        return [_array(got, names[0])]
    array = isinstance(got, torch.Tensor | np.ndarray) and got.ndim > 0
    count = len(got) if array or isinstance(got, tuple | list) else 1
    yours = "is one array" if array else "is one" if count == 1 else f"are {count}"
    expect(count == len(names), f"return {len(names)} things: {' and '.join(names)}; yours {yours}")
    return [_array(part, name) for part, name in zip(got, names, strict=True)]


def _array(value, name: str) -> np.ndarray:
    if isinstance(value, tuple | list):
        loose = any(isinstance(one, torch.Tensor) and one.ndim for one in value)
        expect(
            not loose, f"{name} is a list of {len(value)} tensors; torch.stack makes one of them"
        )
    return as_array(value)
