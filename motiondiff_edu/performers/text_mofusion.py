"""MoFusion from text: the U-Net of the dancers, whose keys and values come from a text.

Words have no times, so their keys are not rotated; a query still knows its own time. The tokens are
those of its own word encoder, or as in the paper those of CLIP.
Source: MoFusion 3.3.
"""

from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

from jaxtyping import Float, Int
from torch import Tensor, nn

from ..conditions import clip as clips
from ..conditions.clip import ClipEncoder, ClipTokens
from ..conditions.text import MOST_WORDS
from ..conditions.word_encoder import WordEncoder
from ..mofusion import Memory, MoFusion, MoFusionConfig, Music
from ..motion import moving_frame
from .networks import register

# ids of words (`word_encoder.ids_of`), or tokens of CLIP (`Clip.tokens`)
Texts = Int[Tensor, "B M"] | ClipTokens


@dataclass(frozen=True)
class TextMoFusionConfig(MoFusionConfig):
    """MoFusion's sizes, and those of the text: `C` is the width of a token.

    It reads `words` of its own, or with `clip` what the CLIP of this name makes of a text.
    """

    D: int = moving_frame.D
    C: int = 96
    music_layers: int = 0
    words: tuple[str, ...] = ()
    word_layers: int = 2
    longest: int = MOST_WORDS
    clip: str = ""
    clip_width: int = clips.WIDTH  # of a token of that CLIP
    target: str = "x0"
    skip: bool = False

    def __post_init__(self):
        """Raise ValueError for impossible sizes, and for words beside a CLIP."""
        super().__post_init__()
        if self.clip_width < 1:
            raise ValueError(f"clip_width = {self.clip_width} must be at least 1")
        if self.clip and self.words:
            raise ValueError(f"a network reads words of its own or {self.clip}, not both")


@runtime_checkable
class TextEncoder(Protocol):
    """What makes tokens of texts, and says where there is one; a module."""

    def tokens_of(self, texts: Any, /) -> tuple[Tensor, Tensor]: ...


class TextMoFusion(nn.Module):
    """eps_hat (or x0_hat) = net(x_s, s, text), for motions of any length.

    words  what makes tokens of a text; default: that of the configuration
    """

    def __init__(self, config: TextMoFusionConfig, words: TextEncoder | None = None):
        super().__init__()
        self.config = config
        self.words: TextEncoder = words or encoder_of(config)
        self.unet = MoFusion(config)

    def listen(self, texts: Texts) -> Music:
        """The context of texts."""
        tokens, mask = self.words.tokens_of(texts)
        return self.unet.listen(tokens, tokens.new_zeros(tokens.shape[1]), mask)

    def forward(
        self, x_s: Float[Tensor, "B T D"], s: Int[Tensor, "B"], context: Music
    ) -> Float[Tensor, "B T D"]:
        return self.decode(x_s, s, self.encode(context, x_s.shape[1]))

    def encode(self, context: Music, frames: int) -> Memory:
        """What all steps have in common, as MoFusion.encode."""
        return self.unet.encode(context, frames)

    def decode(
        self, x_s: Float[Tensor, "B T D"], s: Int[Tensor, "B"], memory: Memory
    ) -> Float[Tensor, "B T D"]:
        return self.unet.decode(x_s, s, memory)


def encoder_of(config: TextMoFusionConfig) -> TextEncoder:
    """The part of the network that makes tokens of a text."""
    if config.clip:
        return ClipEncoder(config.clip_width, config.C)
    sizes = (config.C, config.word_layers, config.heads, config.longest)
    return WordEncoder(len(config.words), *sizes)


register("mover", TextMoFusion, TextMoFusionConfig)
