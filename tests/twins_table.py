"""Which step-by-step function of a notebook (in cells tagged `twin`) must agree with which function of the library.

TWINS = {"02": {"name in the notebook": Twin(library function, arguments)}}; `arguments` is a function without
parameters that returns the tuple both are called with. Where the two take different arguments, give lambdas:


    "q_sample_loop": Twin(ddpm.q_sample, lambda: (x0, 7, schedule, noise)),
    "attention_loop": Twin(lambda q, k, v: attend(q, k, v)[0], lambda: (q, k, v), atol=1e-5),

Sizes pairwise different, numbers from an own generator. Every notebook with twin cells needs an entry here.
"""

from collections.abc import Callable
from typing import Any, NamedTuple


class Twin(NamedTuple):
    """A function of the library, what to call both with, and how closely they must agree."""

    library: Callable
    arguments: Callable[[], tuple[Any, ...]]
    atol: float = 1e-6
    rtol: float = 1e-5


TWINS: dict[str, dict[str, Twin]] = {}
