"""What a check prints: "not attempted yet", the likely mistake, or one sentence about the result.

To write one, put a plain function of `mine` (the reader's answer) into checks/nbXX.py:

    from ._compare import compare
    from ._report import check
    from .zoo.nbXX import MISTAKES

    def _batches(rng):
        yield torch.tensor([[2.0, -1.0]]), 0.36, torch.tensor([[0.5, 3.0]])
        yield tensors(rng, 2, 5), float(rng.random()), tensors(rng, 2, 5)

    @check
    def q_sample(mine):
        compare(mine, noised, _batches, "x_s", MISTAKES["q_sample"])
        return "at alpha_bar = 0.36 six tenths of the signal are left."

* The expected value (`noised`) does not come from the solution: take plain loops, a closed form,
torch, or published numbers.
* `MISTAKES`, in checks/zoo/nbXX.py, maps a hint to the wrong answer of which it is true. The hint
names the operation, not the line of code.
* The returned sentence is printed when the answer is right. It says something worth knowing.
* The first inputs have round numbers, for the reader; then limits (silence, NaN, large scores);
then what the generator gives. Sizes are pairwise different (B=2, T=5, J=3), so that swapped axes
are found. A check takes less than 1 s.
* An answer that changes its input, returns nothing, or differs from call to call is refused here,
once for all checks.

A stub raises NotImplementedError. The check reports it and does not raise it, so that Run All does
not stop at empty stubs.
"""

import functools
import inspect
import reprlib
import traceback
import warnings
from collections.abc import Callable
from textwrap import fill
from typing import Any

import numpy as np
import torch

Check = Callable[[Any], None]
REGISTRY: dict[str, Check] = {}
FOUND: dict[str, bool] = {}  # of this kernel: whether the last answer to a check was right
NOT_ATTEMPTED = "not attempted yet"
WIDTH = 92  # characters that a page shows in one line
STUBS = ("your turn", "")  # messages of an exercise left as it is; torch raises with others


class CheckFailed(AssertionError):
    """An answer is not right yet; the message names the likely mistake."""

    def _render_traceback_(self) -> list[str]:
        """The lines that IPython shows instead of a traceback through the check.

        They are the message, and the reader's own lines.
        """
        lines = [f"{type(self).__name__}: {self}"]
        if self.__cause__ is not None:
            frames = traceback.extract_tb(self.__cause__.__traceback__)
            ours = (__package__.replace(".", "/"), "site-packages")
            own = [
                frame
                for frame in frames
                if not any(part in frame.filename.replace("\\", "/") for part in ours)
            ]
            lines += [f"  line {frame.lineno} of {frame.name}: {frame.line}" for frame in own[-3:]]
        return lines


def check(function: Callable[[Any], str | None]) -> Check:
    """Turn a plain function of `mine` into a check, and register it under its name.

    The check raises CheckFailed for a wrong answer, also when the answer itself raises.
    Raises ValueError when the name is taken.
    """
    name = function.__name__
    if name in REGISTRY and REGISTRY[name].__module__ != function.__module__:
        raise ValueError(
            f"two checks are called {name}: in {REGISTRY[name].__module__} and "
            f"{function.__module__}"
        )

    @functools.wraps(function)
    def run(mine: Any) -> None:
        if not callable(mine):
            raise CheckFailed(
                f"{name}: hand over the function itself, without (): checks.{name}(my_function)"
            )
        FOUND[name] = False
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # numpy's, of an empty mean, would help nobody
                content = function(_answering(mine))
        except CheckFailed as error:
            raise CheckFailed(f"{name}: {error}") from None
        except Exception as error:
            if type(error) is NotImplementedError and str(error) in STUBS:
                del FOUND[name]
                print(f"{name}: {NOT_ATTEMPTED}.")
                return
            notes = "".join(f" ({note})" for note in getattr(error, "__notes__", []))
            raise CheckFailed(
                f"{name}: your answer raised {type(error).__name__}: {error}{notes}"
            ) from error
        else:
            FOUND[name] = True
            print(fill(f"{name}: right. {content or ''}", WIDTH, subsequent_indent="  "))

    REGISTRY[name] = run
    return run


def _answering(mine: Any) -> Any:
    """`mine`, wrapped: an answer of None fails with the likely reason, and so do changed inputs."""

    @functools.wraps(mine)
    def answer(*args, **kwargs):
        given = [*args, *kwargs.values()]
        kept = [_copied(value) for value in given]
        try:
            got = mine(*args, **kwargs)
        except Exception as error:
            if given:
                error.add_note("it was given " + ", ".join(map(_shown, given)))
            raise
        changed = [i for i, pair in enumerate(zip(given, kept, strict=True)) if not _equal(*pair)]
        expect(
            not changed,
            f"your answer changes {_named(mine, changed)}, which it was given; work on a copy",
        )
        expect(got is not None, "your answer returns nothing; is a `return` missing?")
        return got

    return answer


def _shown(value: Any) -> str:
    """A short text for an argument."""
    if isinstance(value, torch.Tensor | np.ndarray) and value.ndim:
        return f"an array {tuple(value.shape)}"
    return reprlib.repr(value)


def _copied(value: Any) -> Any:
    """A copy of arrays, and of lists of them; anything else as it is."""
    if isinstance(value, torch.Tensor):
        return value.detach().clone()
    if isinstance(value, np.ndarray):
        return value.copy()
    if isinstance(value, list | tuple):
        return type(value)(_copied(one) for one in value)
    return value


def _equal(now: Any, before: Any) -> bool:
    """Whether an argument still is what it was; NaN is equal to NaN."""
    if isinstance(before, torch.Tensor):
        before, now = before.numpy(), now.detach().numpy()
    if isinstance(before, np.ndarray):
        now = np.asarray(now)  # of a list, one item may be replaced by a number
        inexact = np.issubdtype(before.dtype, np.inexact)
        return now.shape == before.shape and np.array_equal(now, before, equal_nan=inexact)
    if isinstance(before, list | tuple):
        return len(now) == len(before) and all(map(_equal, now, before))
    return now is before or bool(now == before)


def _named(mine: Callable, changed: list[int]) -> str:
    """The names of the changed arguments, as the reader wrote them."""
    try:
        names = list(inspect.signature(mine).parameters)
        return " and ".join(f"`{names[i]}`" for i in changed)
    except (ValueError, TypeError, IndexError):
        return "its input"


def expect(condition: Any, message: str) -> None:
    """Fail with `message` unless the condition holds."""
    if not bool(condition):
        raise CheckFailed(message)


def as_array(value: Any) -> np.ndarray:
    """A number, list, array or tensor as float64 array. Raises CheckFailed for anything else."""
    kind = type(value).__name__
    if isinstance(value, torch.Tensor):
        value = value.detach().cpu().numpy()
    try:
        value = np.asarray(value)
        expect(value.dtype.kind != "c", "your answer is complex: the root of a negative number?")
        return value.astype(np.float64)
    except (TypeError, ValueError):
        raise CheckFailed(f"expected numbers, got {kind}") from None
