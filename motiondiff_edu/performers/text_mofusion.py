"""MoFusion from text: the U-Net of the dancers, whose keys and values come from words.

Words have no times, so their keys are not rotated; a query still knows its own time. The lowest
levels also attend to the motion itself (`beyond/self_attention.py`). The same network takes tokens
from its own word encoder or from elsewhere.
Source: MoFusion 3.3.
"""

from dataclasses import dataclass

import torch
from jaxtyping import Float, Int
from torch import Tensor, nn

from ..beyond.self_attention import SelfAttendingMoFusion
from ..conditions.text import LONGEST
from ..conditions.word_encoder import WordEncoder, present
from ..mofusion import MoFusionConfig, Music
from ..motion import moving_frame
from .networks import register


@dataclass(frozen=True)
class TextMoFusionConfig(MoFusionConfig):
    """MoFusion's sizes, and those of the words: `C` is the width of a token."""

    D: int = moving_frame.D
    C: int = 96
    music_layers: int = 0
    words: tuple[str, ...] = ()
    word_layers: int = 2
    longest: int = LONGEST
    target: str = "x0"
    skip: bool = False


class TextMoFusion(nn.Module):
    """eps_hat (or x0_hat) = net(x_s, s, words), for motions of any length."""

    def __init__(self, config: TextMoFusionConfig):
        super().__init__()
        self.config = config
        sizes = (config.C, config.word_layers, config.heads, config.longest)
        self.words = WordEncoder(len(config.words), *sizes)
        self.unet = SelfAttendingMoFusion(config)

    def listen(self, ids: Int[Tensor, "B M"]) -> Music:
        """The context of texts (`word_encoder.ids_of`)."""
        return self.unet.listen(self.words(ids), torch.zeros(ids.shape[1]), present(ids))

    def forward(
        self, x_s: Float[Tensor, "B T D"], s: Int[Tensor, "B"], context: Music
    ) -> Float[Tensor, "B T D"]:
        return self.unet(x_s, s, context)


register("mover", TextMoFusion, TextMoFusionConfig)
