"""What a network reads of CLIP: the tokens of a frozen transformer, through a trained MLP.

`conditions/clip.py` makes the tokens. Only the MLP belongs to the network, and is saved with it.
Source: MoFusion 3.3, "we project the token embeddings using an MLP"; its sizes are ours.
"""

from dataclasses import dataclass

import torch
from jaxtyping import Bool, Float
from torch import Tensor, nn


@dataclass(frozen=True, eq=False)
class ClipTokens:
    """Texts as CLIP's transformer leaves them, padded to the longest.

    `mask` is True where there is a token. CLIP puts a mark before and after a text, so the empty
    text has two.
    """

    hidden: Float[Tensor, "B M E"]
    mask: Bool[Tensor, "B M"]

    def __len__(self) -> int:
        return len(self.mask)

    def to(self, device: str | torch.device) -> "ClipTokens":
        """The same tokens on another device."""
        return ClipTokens(self.hidden.to(device), self.mask.to(device))


class ClipEncoder(nn.Module):
    """Tokens of CLIP (B, M, E) to tokens (B, M, C); each is projected by itself."""

    def __init__(self, clip_width: int, width: int):
        super().__init__()
        self.mlp = nn.Sequential(
            nn.Linear(clip_width, 2 * width), nn.GELU(), nn.Linear(2 * width, width)
        )

    def forward(self, texts: ClipTokens) -> Float[Tensor, "B M C"]:
        return self.mlp(texts.hidden)

    def tokens_of(self, texts: ClipTokens) -> tuple[Float[Tensor, "B M C"], Bool[Tensor, "B M"]]:
        """The tokens of texts, and where there is one."""
        return self(texts), texts.mask
