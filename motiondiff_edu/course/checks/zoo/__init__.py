"""The bug zoo: wrong answers that one can expect.

There is one file for each notebook. The check must refuse every wrong answer.

nb02.py holds `ZOO = {"q_sample": {"forgot the square root": wrong_q_sample, ...}}`: name of the
check, then what is wrong in a few words, then the wrong answer itself. Each check has at least two.
"""

import importlib
import pkgutil
from collections.abc import Callable


def load_all() -> dict[str, dict[str, Callable]]:
    """All wrong answers: {check: {what is wrong: answer}}.

    Raises ValueError when two files claim one check.
    """
    zoo: dict[str, dict[str, Callable]] = {}
    for module in pkgutil.iter_modules(__path__):
        for name, wrong in importlib.import_module(f"{__name__}.{module.name}").ZOO.items():
            if name in zoo:
                raise ValueError(
                    f"checks.{name} has wrong answers in two files; the second is {module.name}"
                )
            zoo[name] = wrong
    return zoo
