"""An ear: from a song's Mel frames to tokens that know the beat, the bar and the genre.

    Mel -> MusicEncoder -> [attention between tokens] x blocks -> tokens -> what they say

The encoder sees a second to either side. Attention between tokens lets the whole piece agree on one
tempo and one count. Its training is `recipes/ear.py`; dancers then keep it as it is.
Ours; see `beyond.hearing`.  Notebook: 12
"""

import copy
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import torch
from jaxtyping import Bool, Float
from torch import Tensor, nn

from ..cross_modal_attention import angles_of
from ..mofusion import CrossAttentionBlock, MusicEncoder
from ..motion.scaler import Scaler

GENRES = ("house", "hiphop", "pop", "latin", "waltz")  # in the order of `EarOutput.genre`
# tokens (7 s) that all see each other, as many as the longest piece of training (`recipes/ear.py`)
# has: a longer piece is heard in parts, since over more tokens than that an ear loses the bar
LONGEST = 112
BESIDE = LONGEST // 4  # tokens to either side of a part of LONGEST / 2 tokens


@dataclass(frozen=True)
class EarConfig:
    """Sizes of an ear; `slowest` and `fastest` are those of its position code, in Hz."""

    C: int = 80
    width: int = 96
    heads: int = 4
    music_layers: int = 4
    blocks: int = 4
    slowest: float = 0.05
    fastest: float = 8.0
    target: str = "beats"  # every card names what its network predicts

    def __post_init__(self):
        """Raise ValueError for impossible sizes."""
        if min(self.C, self.heads, self.blocks) < 1 or self.music_layers < 0:
            raise ValueError("C, heads and blocks of an ear must be at least 1")
        if self.width < 1 or self.width % (2 * self.heads):
            raise ValueError(
                f"the width must be a multiple of 2 x {self.heads} heads, not {self.width}"
            )


@dataclass(frozen=True, eq=False)
class EarOutput:
    """What an ear says of each token: cosine and sine of places, and logits."""

    beat: Float[Tensor, "B M 2"]
    bar: Float[Tensor, "B M 2"]
    sounds: Float[Tensor, "B M"]  # whether there is a beat
    genre: Float[Tensor, "B M G"]


class Ear(nn.Module):
    """Tokens of a piece of music, 15.6 a second, and what they say."""

    def __init__(self, config: EarConfig = EarConfig()):
        super().__init__()
        self.config = config
        width = config.width
        self.music = MusicEncoder(config.C, width, config.music_layers)
        self.blocks = nn.ModuleList(
            CrossAttentionBlock(width, config.heads, width) for _ in range(config.blocks)
        )
        self.norm = nn.LayerNorm(width)
        self.heads = nn.Linear(width, 2 + 2 + 1 + len(GENRES))

    @property
    def stride(self) -> int:
        """How many Mel frames a token stands for."""
        return 2 if self.config.music_layers else 1

    def forward(
        self,
        mel: Float[Tensor, "B M C"],
        times: Float[Tensor, "M"],
        mask: Bool[Tensor, "B M"] | None = None,
    ) -> Float[Tensor, "B M2 W"]:
        """Tokens of standardised Mel frames at these times (seconds).

        mask  True where there is music, for pieces of several lengths in one batch
        """
        present = mel.new_ones(1, mel.shape[1], 1) if mask is None else mask[..., None].to(mel)
        tokens = self.music(mel, present)
        seen = None if mask is None else mask[:, :: self.stride]
        config = self.config
        angles = angles_of(
            times[:: self.stride], config.width // config.heads, config.slowest, config.fastest
        )
        blocks: Iterable[Any] = self.blocks  # torch's stubs say of a list that it holds Modules
        for block in blocks:
            tokens = in_parts(block, tokens, angles, seen)
        return self.norm(tokens)

    def read(self, tokens: Float[Tensor, "B M W"]) -> EarOutput:
        """What tokens of `forward` say."""
        beat, bar, sounds, genre = self.heads(tokens).split([2, 2, 1, len(GENRES)], -1)
        return EarOutput(beat, bar, sounds[..., 0], genre)


def in_parts(
    block: CrossAttentionBlock,
    tokens: Float[Tensor, "B M W"],
    angles: Float[Tensor, "M w"],
    seen: Bool[Tensor, "B M"] | None,
) -> Float[Tensor, "B M W"]:
    """A block of attention between tokens; in a long piece each part sees LONGEST tokens around it.

    So it hears as much at a time as in training, and memory grows with the length of the piece, not
    with its square. A short piece that is padded beyond LONGEST is heard in parts as well.
    """
    M = tokens.shape[1]
    size = M if M <= LONGEST else LONGEST // 2
    made = []
    for first in range(0, M, size):
        own = slice(first, first + size)
        start = max(0, min(first - BESIDE, M - LONGEST))
        around = slice(start, start + LONGEST)
        bias = None
        if seen is not None and not bool(seen.all()):
            count = tokens[:, own].shape[1]
            bias = torch.where(seen[:, None, None, around], 0.0, -1e4).expand(-1, -1, count, -1)
        context = block.norm(tokens[:, around])
        made.append(block(tokens[:, own], context, bias, (angles[own], angles[around])))
    return torch.cat(made, 1)


def rescale_ear(ear: Ear, own: Scaler, other: Scaler) -> Ear:
    """An ear made for Mel frames standardised by `own` as one for frames standardised by `other`.

    Both hear the same: its first layer is linear, and so is the change of units.
    """
    other_ear = copy.deepcopy(ear)
    first = other_ear.music.project
    with torch.no_grad():
        first.bias.add_(first.weight @ ((other.mean - own.mean) / own.std))
        first.weight.mul_(other.std / own.std)
    return other_ear
