"""One encoding for several noises.

A window's past and control are encoded once and denoised at several diffusion steps.

Encoding dominates the cost of a training step of MoDiff, and does not depend on s. So `repeated`
takes every window several times, and `SharedEncoding` encodes it once: the same loss, for about
half the time at two noises. Ours: in Algorithm 1 each window has one step.
Notebook: 07
"""

from dataclasses import dataclass

import torch
from jaxtyping import Float, Int
from torch import Tensor, nn


def repeated(batch: tuple[Tensor, ...], noises: int) -> tuple[Tensor, ...]:
    """Every window of the batch `noises` times, one copy after the other.

    Notebook: 07
    """
    return tuple(part.repeat_interleave(noises, dim=0) for part in batch)


@dataclass(frozen=True, eq=False)
class SharedEncoding:
    """A MoDiff for `repeated` batches, which encodes only the first of each window's copies.

    Not together with diffusion dropout: it makes the copies of a past unlike.  Notebook: 07
    """

    model: nn.Module
    noises: int

    @property
    def config(self):
        return self.model.config

    def encode(self, *inputs: Float[Tensor, "B ..."]):
        """The memory of the repeated batch.  Raises ValueError where copies of a window differ."""
        distinct = [part[:: self.noises] for part in inputs]
        for part, again in zip(inputs, repeated(tuple(distinct), self.noises), strict=True):
            if not torch.equal(part, again):
                raise ValueError(
                    f"windows are encoded once for {self.noises} noises, but their copies differ: "
                    "repeat the batch with `repeated`, and use no diffusion dropout"
                )
        return self.model.encode(*distinct).repeat_interleave(self.noises, dim=0)

    def decode(self, x_s, s, memory) -> Float[Tensor, "B T_p D"]:
        return self.model.decode(x_s, s, memory)

    def __call__(
        self,
        x_s: Float[Tensor, "B T_p D"],
        s: Int[Tensor, "B"],
        past: Float[Tensor, "B T_h D"],
        control: Float[Tensor, "B T C"],
    ) -> Float[Tensor, "B T_p D"]:
        return self.decode(x_s, s, self.encode(past, control))
