"""Wrap a performer: each evaluation of its network advances a progress bar."""

import copy
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TypeVar

from ..motion.progress import bar

Performer = TypeVar("Performer")  # what has a `denoiser` that its samplers ask for


@contextmanager
def with_bar(
    performer: Performer, evaluations: int, what: str, shown: bool = True
) -> Iterator[Performer]:
    """The same performer, whose network moves a bar on by one each time it is evaluated."""
    with bar(evaluations, what, shown) as step:
        twin = copy.copy(performer)

        def denoiser(*condition, fast: bool = True):  # past and control, mel and frames, texts
            denoise = performer.denoiser(*condition, fast=fast)

            def stepping(x_s, s):
                answer = denoise(x_s, s)
                step()
                return answer

            return stepping

        vars(twin)["denoiser"] = denoiser  # the record is frozen; its twin lives as long as the bar
        yield twin
