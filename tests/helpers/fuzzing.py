"""Limits of time and memory for what reads a stranger's file, and changes of a good file."""

import resource
import signal
from collections.abc import Iterator
from contextlib import contextmanager

import pytest
from hypothesis import strategies as st

SECONDS = 20  # of CPU time; a machine may be slow, a hang lasts longer
MEMORY = 2_000_000_000  # bytes beyond what the process has


@contextmanager
def bounded() -> Iterator[None]:
    """Fail after SECONDS of CPU time; MemoryError beyond MEMORY (where the system can say so)."""
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    with open("/proc/self/statm") as file:
        now = int(file.read().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (now + MEMORY, hard))
    signal.signal(signal.SIGPROF, lambda *_: pytest.fail("the reader hangs"))
    signal.setitimer(signal.ITIMER_PROF, SECONDS)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))


@st.composite
def damaged(draw: st.DrawFn, good: bytes, scraps: tuple[bytes, ...] = ()) -> bytes:
    """A good file with one to six changes: cut out, put in, overwritten, doubled, broken off."""
    content = good
    pieces = st.binary(max_size=12) | st.sampled_from((b"\0", b"\xff" * 4, *scraps))
    for _ in range(draw(st.integers(1, 6))):
        at = draw(st.integers(0, len(content)))
        end = min(len(content), at + draw(st.integers(0, 40)))
        change = draw(st.sampled_from(("put in", "over", "cut", "double", "end")))
        if change == "end":
            content = content[:at] or good[:1]
        elif change == "double":
            content = content[:end] + content[at:end] * draw(st.integers(1, 50)) + content[end:]
        else:
            piece = b"" if change == "cut" else draw(pieces)
            content = content[:at] + piece + content[at if change == "put in" else end :]
    return content
