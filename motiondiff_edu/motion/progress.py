"""A progress bar for long computations: `with bar(100, "walking") as step: ...`."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from tqdm.auto import tqdm

DELAY = 1.0  # seconds before it appears: a shorter computation shows no bar


@contextmanager
def bar(total: int, what: str, shown: bool = True) -> Iterator[Callable[[], object]]:
    """Yield a function to call after each of `total` steps; the bar disappears at the end.

    No bar is shown when the output is not a terminal.
    """
    with tqdm(
        total=total,
        desc=what,
        delay=DELAY,
        mininterval=0.5,
        leave=False,
        disable=None if shown else True,
    ) as progress:
        yield progress.update
