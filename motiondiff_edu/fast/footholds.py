"""The network with footholds for use: where the feet would stay is worked out once a frame, too.

The same numbers as the plain one, to 1e-5 (tested).  Notebook: 07
"""

from dataclasses import dataclass

import torch
from jaxtyping import Float, Int
from torch import Tensor

from ..beyond.footholds import FootholdMoDiff, blend, openness
from .modiff import Context, FastMoDiff


@dataclass(frozen=True, eq=False)
class StandingContext(Context):
    """The memory as the layers ask it, and where the feet would stay."""

    held: Float[Tensor, "B T_p K"]


class FastFoothold(FastMoDiff):
    """A trained network with footholds, read once; `encode` and `denoise` as in FastMoDiff."""

    model: FootholdMoDiff

    @torch.inference_mode()
    def encode(
        self, past: Float[Tensor, "B T_h D"], control: Float[Tensor, "B T C"]
    ) -> StandingContext:
        standing = self.model.encode(past, control)
        return StandingContext(self.context_of(standing.memory).layers, standing.held)

    @torch.inference_mode()
    def denoise(
        self, x_s: Float[Tensor, "B T_p D"], s: Int[Tensor, "B"] | int, context: StandingContext
    ) -> Float[Tensor, "B T_p D"]:
        x = self.attend(self.embed(x_s, s), context)
        return blend(self.head(x), openness(self.model.gate(x)), context.held)
