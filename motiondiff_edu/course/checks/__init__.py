"""Checks of the exercises.

A reader calls `checks.q_sample(my_q_sample)` in the cell of the function.

The check says that nothing was attempted, names the likely mistake, or says that the answer is
right. `checks.progress()` lists what is done. There is one file of checks for each notebook:
nb02.py and so on. _report.py says how to write one.
"""

import importlib
import pkgutil

from ._progress import progress
from ._report import REGISTRY, Check, CheckFailed, check, expect

__all__ = ["REGISTRY", "Check", "CheckFailed", "check", "expect", "load_all", "progress"]


def load_all() -> dict[str, Check]:
    """Import every nbXX.py of this folder and return all checks by name."""
    for module in pkgutil.iter_modules(__path__):
        if module.name.startswith("nb"):
            importlib.import_module(f"{__name__}.{module.name}")
    return REGISTRY


def __getattr__(name: str) -> Check:
    """`checks.q_sample`: the files of checks are imported when the first check is used."""
    if name.startswith("_") or name in ("zoo",):
        raise AttributeError(name)
    known = load_all()
    if name in known:
        return known[name]
    raise AttributeError(
        f"there is no check called {name!r}; there are: {', '.join(sorted(known)) or 'none'}"
    )


def __dir__() -> list[str]:
    return sorted([*__all__, *load_all()])
