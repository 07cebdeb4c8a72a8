"""What a check prints: "not attempted yet", the likely mistake, or one sentence about the result.

To write one, put a plain function of `mine` (the reader's answer) into checks/nbXX.py:

    from ._report import check, expect, expect_close

    @check
    def q_sample(mine):
        x0, noise = torch.tensor([[2.0, -1.0]]), torch.tensor([[0.5, 3.0]])
        expect_close(mine(x0, 0.36, noise), [[1.6, 1.8]], "x_s for alpha_bar = 0.36",
                     mistakes={"take the square root of alpha_bar, too": 0.36 * x0 + 0.8 * noise})
        return "at alpha_bar = 0.36 six tenths of the signal are left."

* The expected value does not come from the solution: work it out by hand, or take a closed form,
torch, or published numbers.
* `mistakes` maps a hint to the value that this mistake gives. The hint names the operation, not the
line of code.
* The returned sentence is printed when the answer is right. It says something worth knowing.
* Sizes are pairwise different (B=2, T=5, J=3), so that swapped axes are found. Numbers are fixed,
or come from the check's own generator. A check takes less than 1 s.
* Wrong answers go to checks/zoo/nbXX.py. A test runs each check on the solution, the stub and the
wrong answers.

A stub raises NotImplementedError. The check reports it and does not raise it, so that Run All does
not stop at empty stubs.
"""

import functools
import reprlib
import traceback
from collections.abc import Callable, Mapping
from textwrap import fill
from typing import Any

import numpy as np
import torch

Check = Callable[[Any], None]
REGISTRY: dict[str, Check] = {}
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
            lines += [f"  line {frame.lineno} of {frame.name}: {frame.line}" for frame in own[:3]]
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
        try:
            content = function(_answering(mine))
        except CheckFailed as error:
            raise CheckFailed(f"{name}: {error}") from None
        except Exception as error:
            if type(error) is NotImplementedError and str(error) in STUBS:
                print(f"{name}: {NOT_ATTEMPTED}.")
                return
            notes = "".join(f" ({note})" for note in getattr(error, "__notes__", []))
            raise CheckFailed(
                f"{name}: your answer raised {type(error).__name__}: {error}{notes}"
            ) from error
        else:
            print(fill(f"{name}: right. {content or ''}", WIDTH, subsequent_indent="  "))

    REGISTRY[name] = run
    return run


def _answering(mine: Any) -> Any:
    """`mine`, wrapped so that an answer of None fails with the likely reason."""
    if not callable(mine):
        return mine

    @functools.wraps(mine)
    def answer(*args, **kwargs):
        try:
            got = mine(*args, **kwargs)
        except Exception as error:
            error.add_note("it was given " + ", ".join(map(_shown, [*args, *kwargs.values()])))
            raise
        expect(got is not None, "your answer returns nothing; is a `return` missing?")
        return got

    return answer


def _shown(value: Any) -> str:
    """A short text for an argument."""
    if isinstance(value, torch.Tensor | np.ndarray) and value.ndim:
        return f"an array {tuple(value.shape)}"
    return reprlib.repr(value)


def expect(condition: Any, message: str) -> None:
    """Fail with `message` unless the condition holds."""
    if not bool(condition):
        raise CheckFailed(message)


def expect_close(
    got: Any,
    wanted: Any,
    what: str,
    mistakes: Mapping[str, Any] | None = None,
    rtol: float = 1e-4,
    atol: float = 1e-5,
) -> None:
    """Fail unless `got` equals `wanted`.

    The message names the mistake that gives the same value, or else the entry with the largest
    error. Numbers, lists, arrays and tensors are accepted.
    """
    expect(got is not None, f"{what}: your answer returns nothing; is a `return` missing?")
    mine, right = as_array(got), as_array(wanted)
    close = functools.partial(np.allclose, rtol=rtol, atol=atol)
    if mine.shape == right.shape and close(mine, right):
        return
    for hint, value in (mistakes or {}).items():
        wrong = as_array(value)
        if wrong.shape == mine.shape and close(mine, wrong):
            raise CheckFailed(f"{what}: {hint}")
    expect(
        mine.shape == right.shape, f"{what} has shape {mine.shape}, and should have {right.shape}"
    )
    expect(np.isfinite(mine).all(), f"{what} contains NaN or infinity")
    difference = np.abs(mine - right)
    where = np.unravel_index(difference.argmax(), difference.shape)
    place = f" at {tuple(int(i) for i in where)}" if where else ""
    raise CheckFailed(f"{what} is {mine[where]:.6g}{place}, and should be {right[where]:.6g}")


def as_array(value: Any) -> np.ndarray:
    """A number, list, array or tensor as float64 array. Raises CheckFailed for anything else."""
    if isinstance(value, torch.Tensor):
        value = value.detach().cpu().numpy()
    try:
        return np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise CheckFailed(f"expected numbers, got {type(value).__name__}") from None
