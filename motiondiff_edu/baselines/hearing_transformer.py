"""The transformer of `transformer.py` with an ear, as the regression has it.

Ours; see `performers/hearing_mofusion.py`.
"""

from dataclasses import dataclass

from ..performers.hearing_mofusion import EarSizes, WithEar
from ..performers.networks import register
from .transformer import DanceTransformer, TransformerConfig


@dataclass(frozen=True)
class HearingTransformerConfig(EarSizes, TransformerConfig):
    """The transformer's sizes, and those of its ear."""

    ear_width: int = 96
    ear_blocks: int = 4


class HearingTransformer(WithEar, DanceTransformer):
    """The transformer with an ear."""

    def __init__(self, config: HearingTransformerConfig):
        super().__init__(config)
        self.with_ear(config.ear, config.width)


register("dancer", HearingTransformer, HearingTransformerConfig)
