"""A progress bar for what takes longer than a moment: `with bar(100, "walking") as step: ...`."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from tqdm.auto import tqdm

DELAY = 1.0  # seconds before it appears: what is done sooner shows none


@contextmanager
def bar(total: int, what: str, shown: bool = True) -> Iterator[Callable[[], object]]:
    """Yields a function to be called after each of `total` steps; the bar goes when all is done."""
    with tqdm(
        total=total, desc=what, delay=DELAY, mininterval=0.5, leave=False, disable=not shown
    ) as progress:
        yield progress.update
