"""The type checker of the tests: beartype, with the shapes that jaxtyping reads.

It takes an int where a float is asked for, as Python's own rules do.

A dance calls its small functions a hundred thousand times, and to check each call takes as long as
the calls. So in each test a function is checked in its first calls, and then now and then.
"""

import functools
from collections import Counter
from collections.abc import Callable
from types import FunctionType

from beartype import BeartypeConf, beartype

checked = beartype(conf=BeartypeConf(is_pep484_tower=True))

FIRST = 10  # calls of a function in a test that are all checked
EVERY = 50  # after them, one of so many

calls: Counter[Callable] = Counter()  # of this test


def now_and_then(jaxtyped: Callable) -> Callable:
    """`jaxtyping.jaxtyped`, for some calls of a function; classes are checked as ever.

    What checks a function is made at its first call, as most functions of the package are not
    called in one process of the tests.
    """

    def decorated(one=None, *, typechecker):
        if one is None:
            return functools.partial(decorated, typechecker=typechecker)
        if not isinstance(one, FunctionType):
            return jaxtyped(one, typechecker=typechecker)
        full = None

        @functools.wraps(one)
        def called(*args, **kwargs):
            nonlocal full
            calls[called] += 1
            if calls[called] > FIRST and calls[called] % EVERY:
                return one(*args, **kwargs)
            full = full or jaxtyped(one, typechecker=typechecker)
            return full(*args, **kwargs)

        return called

    return decorated
