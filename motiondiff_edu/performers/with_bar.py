"""Wrap a performer: each evaluation of its denoisers advances a progress bar."""

import copy
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TypeVar

from ..ddpm import Denoiser
from ..motion.progress import bar

Performer = TypeVar("Performer")  # what has a `denoiser` that its samplers ask for


@contextmanager
def with_bar(
    performer: Performer, evaluations: int, what: str, shown: bool = True
) -> Iterator[Performer]:
    """The same performer, whose denoisers move a bar on by one each time they are evaluated.

    A guided denoiser evaluates its network twice, and counts once.
    """
    with bar(evaluations, what, shown) as step:
        twin = copy.copy(performer)

        def stepping(denoise: Denoiser) -> Denoiser:
            def stepped(x_s, s):
                answer = denoise(x_s, s)
                step()
                return answer

            return stepped

        def with_steps(make: Callable[..., Denoiser]) -> Callable[..., Denoiser]:
            # past and control, mel and frames, texts
            return lambda *condition, fast=True: stepping(make(*condition, fast=fast))

        for name in ("denoiser", "plan_denoiser"):
            if hasattr(performer, name):
                # the record is frozen; its twin lives as long as the bar
                vars(twin)[name] = with_steps(getattr(performer, name))
        yield twin
