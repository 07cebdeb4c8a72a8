"""A progress bar around a loop: `for step in bar("dancing", 50)(loop): ...`."""

from collections.abc import Callable, Iterable, Iterator
from functools import partial
from typing import TypeVar

from tqdm.auto import tqdm

DELAY = 1.0  # seconds before it appears: a shorter computation shows no bar
Record = TypeVar("Record")


def bar(
    what: str, total: int | None = None, shown: bool = True
) -> Callable[[Iterable[Record]], Iterator[Record]]:
    """A function that gives a loop a bar with these words; the bar disappears at the end.

    `total`: the number of the loop's records. No bar is shown when the output is not a terminal.
    """
    return partial(
        tqdm,
        desc=what,
        total=total,
        delay=DELAY,
        mininterval=0.5,
        leave=False,
        disable=None if shown else True,
    )
