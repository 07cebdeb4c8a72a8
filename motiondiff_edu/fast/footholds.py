"""The fast network with footholds: the footholds, too, are computed once per frame.

Its output equals that of the plain network to 1e-5 (tested).  Notebook: 07
"""

from dataclasses import dataclass

import torch
from jaxtyping import Float, Int
from torch import Tensor

from ..beyond.footholds import FootholdMoDiff
from .modiff import Context, FastMoDiff


@dataclass(frozen=True, eq=False)
class FootholdContext(Context):
    """The memory, prepared for the layers, and the positions of the footholds."""

    held: Float[Tensor, "B T_p K"]


class FastFoothold(FastMoDiff):
    """A trained network with footholds, read once; `encode` and `denoise` as in FastMoDiff."""

    model: FootholdMoDiff

    @torch.inference_mode()
    def encode(
        self, past: Float[Tensor, "B T_h D"], control: Float[Tensor, "B T C"]
    ) -> FootholdContext:
        encoded = self.model.encode(past, control)
        return FootholdContext(self.context_of(encoded.memory).layers, encoded.held)

    @torch.inference_mode()
    def denoise(
        self, x_s: Float[Tensor, "B T_p D"], s: Int[Tensor, "B"] | int, context: FootholdContext
    ) -> Float[Tensor, "B T_p D"]:
        x = self.attend(self.embed(x_s, s), context)
        return self.model.placed(self.head(x), self.model.gate(x), context.held)
