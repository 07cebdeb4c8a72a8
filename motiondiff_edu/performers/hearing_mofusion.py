"""MoFusion with an ear, and what any network with an ear has (`baselines/transformer.py`).

Their music is that of their own encoder, plus a linear layer of the ear's tokens. The ear does not
change while they learn to dance.
Ours; see `beyond.hearing`.
"""

from dataclasses import dataclass, replace

import torch
from jaxtyping import Bool, Float
from torch import Tensor, nn

from ..mofusion import MoFusion, MoFusionConfig, Music
from .ear import Ear, EarConfig
from .networks import register


class EarSizes:
    """The ear that belongs to a network's configuration."""

    C: int
    music_layers: int
    ear_width: int
    ear_blocks: int

    def check_ear(self) -> None:
        """Raise ValueError for a network that does not halve its music, as the ear does."""
        if not self.music_layers:
            raise ValueError("music_layers must be 1 or more: the ear halves the music, too")

    @property
    def ear(self) -> EarConfig:
        return EarConfig(C=self.C, width=self.ear_width, blocks=self.ear_blocks)


@dataclass(frozen=True)
class HearingConfig(EarSizes, MoFusionConfig):
    """MoFusion's sizes, and those of its ear."""

    ear_width: int = 96
    ear_blocks: int = 4

    def __post_init__(self):
        super().__post_init__()
        self.check_ear()


class WithEar:
    """An ear that is not trained, and the layer through which a network hears its tokens."""

    ear: Ear
    from_ear: nn.Linear

    def with_ear(self, config: EarConfig, width: int) -> None:
        self.ear = Ear(config).requires_grad_(False)
        self.from_ear = nn.Linear(config.width, width)

    def listen(
        self,
        mel: Float[Tensor, "B M C"],
        times: Float[Tensor, "M"],
        mask: Bool[Tensor, "B M"] | None = None,
    ) -> Music:
        """The network's own tokens of a piece of music, with those of the ear added."""
        # of the network that this class stands before
        music: Music = super().listen(mel, times, mask)  # type: ignore[misc]
        with torch.no_grad():
            tokens = self.ear(mel, times, mask)
        return replace(music, tokens=music.tokens + self.from_ear(tokens))


class HearingMoFusion(WithEar, MoFusion):
    """MoFusion with an ear."""

    def __init__(self, config: HearingConfig):
        super().__init__(config)
        self.with_ear(config.ear, config.context_width)


register("dancer", HearingMoFusion, HearingConfig)
