"""The bug zoo: wrong answers that one can expect.

There is one file for each notebook. It holds

    MISTAKES = {"q_sample": {"alpha_bar is a variance: ... its square root": without_roots, ...}}
    OTHERS = {"q_sample": {"nothing is returned": returns_nothing, ...}}

MISTAKES has the hint that a reader gets, and the wrong answer, or several, for which it is true:
the check compares with these functions (`_compare.py`). OTHERS are refused, too, by a message of
the machinery. A test runs each check on all of them.
"""

import importlib
import pkgutil
from collections.abc import Callable

Wrong = dict[str, Callable | tuple[Callable, ...]]


def load_all() -> tuple[dict[str, Wrong], dict[str, Wrong]]:
    """MISTAKES and OTHERS of all files. Raises ValueError when two files claim one check."""
    tables: tuple[dict, dict] = ({}, {})
    for module in pkgutil.iter_modules(__path__):
        loaded = importlib.import_module(f"{__name__}.{module.name}")
        for table, more in zip(tables, (loaded.MISTAKES, loaded.OTHERS), strict=True):
            if table.keys() & more.keys():
                raise ValueError(
                    f"wrong answers to {', '.join(sorted(table.keys() & more.keys()))} are in two "
                    f"files; the second is {module.name}"
                )
            table |= more
    return tables


def several(wrong: Callable | tuple[Callable, ...]) -> tuple[Callable, ...]:
    """The functions behind one hint."""
    return wrong if isinstance(wrong, tuple) else (wrong,)
