"""One encoding for several noises.

A window's past and control are encoded once and denoised at several diffusion steps.

Encoding dominates the cost of a training step of MoDiff, and does not depend on s. So `repeated`
takes every window several times, and `SharedEncoding` encodes it once. The loss is the same; with
two noises a step takes about seven tenths of the time of one on twice as many windows.
Gain: docs/RESULTS_ALL.md (`bench.shared_encoding_over_apart`).
Ours: in Algorithm 1 each window has one step.
"""

from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

import torch
from jaxtyping import Float, Int
from torch import Tensor

from ..diffusion_dropout import changed_samples


def repeated(batch: tuple[Tensor, ...], noises: int) -> tuple[Tensor, ...]:
    """Every window of the batch, `noises` times in a row."""
    return tuple(part.repeat_interleave(noises, dim=0) for part in batch)


@runtime_checkable
class Encoding(Protocol):
    """A network like MoDiff, whose memory has `rows` as `modiff.Memory` has."""

    @property
    def config(self) -> Any: ...

    def encode(self, *inputs: Any) -> Any: ...

    def decode(self, x_s: Tensor, s: Tensor, memory: Any, /) -> Tensor: ...


@dataclass(frozen=True, eq=False)
class SharedEncoding:
    """A MoDiff for `repeated` batches: it encodes equal copies of a window once.

    Diffusion dropout makes some copies of a past different from the first; they are encoded, too.
    """

    model: Encoding
    noises: int

    @property
    def config(self) -> Any:
        return self.model.config

    def encode(self, *inputs: Float[Tensor, "B ..."]) -> Any:
        """The memory of the repeated batch, in its order."""
        B = len(inputs[0])
        if B % self.noises:
            raise ValueError(
                f"a batch of {B} cannot be {self.noises} copies of each window: make it with "
                f"`repeated(batch, {self.noises})`"
            )
        first = torch.arange(0, B, self.noises)  # the first copy of each window
        unlike = torch.zeros(B, dtype=torch.bool)
        for part in inputs:
            again = part[first].repeat_interleave(self.noises, dim=0)
            unlike |= changed_samples(again, part).cpu()
        others = unlike.nonzero()[:, 0]
        row = torch.arange(B) // self.noises  # row of the memory for each copy
        row[others] = len(first) + torch.arange(len(others))
        rows = torch.cat([first, others])
        memory = self.model.encode(*(part[rows] for part in inputs))
        return memory.rows(row.to(inputs[0].device))

    def decode(self, x_s: Tensor, s: Tensor, memory: Any) -> Float[Tensor, "B T_p D"]:
        return self.model.decode(x_s, s, memory)

    def __call__(
        self,
        x_s: Float[Tensor, "B T_p D"],
        s: Int[Tensor, "B"],
        past: Float[Tensor, "B T_h D"],
        control: Float[Tensor, "B T C"],
    ) -> Float[Tensor, "B T_p D"]:
        return self.decode(x_s, s, self.encode(past, control))
