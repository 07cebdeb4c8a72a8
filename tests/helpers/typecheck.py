"""The type checker of the tests: beartype, with the shapes that jaxtyping reads.

It takes an int where a float is asked for, as Python's own rules do.

A dance calls its small functions a hundred thousand times, and to check each call takes as long as
the calls. So in each test a function is checked in its first calls, and then now and then.
"""

import functools
from collections.abc import Callable
from dataclasses import is_dataclass
from types import FunctionType

from beartype import BeartypeConf, beartype

checked = beartype(conf=BeartypeConf(is_pep484_tower=True))

FIRST = 2  # calls of a function in a test that are all checked
EVERY = 200  # after them, one of so many

called_in_test: list[Callable[[], None]] = []  # of each function, what begins its count again


def now_and_then(jaxtyped: Callable) -> Callable:
    """`jaxtyping.jaxtyped`, for some calls of a function, and some of making a dataclass.

    What checks a function is made at its first call, as most functions of the package are not
    called in one process of the tests.
    """

    def decorated(one=None, *, typechecker):
        if one is None:
            return functools.partial(decorated, typechecker=typechecker)
        if isinstance(one, FunctionType):
            if not one.__annotations__:
                return one
            return _at_times(one, lambda: jaxtyped(one, typechecker=typechecker))
        plain = getattr(one, "__init__", None)
        typed = jaxtyped(one, typechecker=typechecker)
        if is_dataclass(typed) and typed.__init__ is not plain:
            checked_init = typed.__init__
            typed.__init__ = _at_times(plain, lambda: checked_init)
        return typed

    return decorated


def _at_times(plain: Callable, checked_version: Callable[[], Callable]) -> Callable:
    """`plain`, checked in the first calls of a test and then now and then."""
    full = None
    checks = 0  # in this test
    unchecked = 0  # so many calls follow before the next check

    def begin() -> None:
        nonlocal checks, unchecked
        checks = unchecked = 0

    @functools.wraps(plain)
    def called(*args, **kwargs):
        nonlocal full, checks, unchecked
        if unchecked:  # all that most calls cost
            unchecked -= 1
            return plain(*args, **kwargs)
        if not checks:
            called_in_test.append(begin)
        checks += 1
        unchecked = 0 if checks < FIRST else EVERY - 1
        full = full or checked_version()
        return full(*args, **kwargs)

    return called


def begin_test() -> None:
    """From here on the first calls of a function are checked again."""
    while called_in_test:
        called_in_test.pop()()
