"""Self-attention at the lowest levels of MoFusion's U-Net: frames far apart see each other.

With a condition the paper's network has no attention from frame to frame, only convolutions, and
they reach about three seconds. A dance repeats its moves with the music, which is everywhere. But
"kicks three times" says nothing about when: the network has to know how many kicks there are
already, and how much time is left. So these levels also get the seconds since the first frame and
until the last one, and the middle, at an eighth of the frames, has a few layers that look at the
motion and at the words by turns. With so few frames they cost little.
Gain: docs/RESULTS_ALL.md. No gain is shown: in trainings of half the width, which have a timeline,
`words-budget.no-self-attention.*` differs from `words-budget.shallow.*` by less than a tenth, or
with an interval that holds 0. The further layers have no fair row: `words-budget.ours.*` saw older
clips. The shipped mover has both.
Ours; without a condition the paper has self-attention, too (MoFusion 3.3).
"""

import torch
from jaxtyping import Float
from torch import Tensor, nn

from ..cross_modal_attention import KeysValues
from ..mofusion import CrossAttentionBlock, Level, Memory, MoFusion, MoFusionConfig, Music

LEVELS = 2  # the middle, and the level above it on both sides
DEPTH = 4  # further layers in the middle
SLOWEST, FASTEST = 0.02, 1.0  # Hz, of the code of a time
CURVES = 8


class SelfAttendingMoFusion(MoFusion):
    """MoFusion whose lowest blocks end with self-attention, after that to the condition."""

    def __init__(self, config: MoFusionConfig, levels: int = LEVELS, depth: int = DEPTH):
        super().__init__(config)
        above = levels - 1
        beside = [*self.down[len(self.down) - above :], *self.up[:above]]
        for block in (self.middle, *beside):
            (width,) = block["ask"].norm.normalized_shape
            block["own"] = CrossAttentionBlock(width, config.heads, width)
            block["when"] = nn.Linear(4 * CURVES, width)
        self.middle["deep"] = nn.ModuleList(self._layer(config) for _ in range(depth))

    def _layer(self, config: MoFusionConfig) -> nn.ModuleDict:
        """A layer of the middle: attention to the condition, then to the motion."""
        *_, width = config.widths
        context = config.context_width if self.music else width
        ask = CrossAttentionBlock(width, config.heads, context)
        return nn.ModuleDict({"ask": ask, "own": CrossAttentionBlock(width, config.heads, width)})

    def _hear(self, block, music: Music, level: Level) -> dict[nn.Module, KeysValues]:
        heard = super()._hear(block, music, level)
        for layer in block["deep"] if "deep" in block else ():
            heard |= super()._hear(layer, music, level)
        return heard

    def _block(
        self, block, h: Float[Tensor, "B T W"], step: Float[Tensor, "B E"], level: Level,
        memory: Memory,
    ) -> Float[Tensor, "B T W2"]:  # fmt: skip
        h = super()._block(block, h, step, level, memory)
        if "own" not in block:
            return h
        h = h + block["when"](from_both_ends(level))
        times, _ = level.angles_of(block["own"])
        bias = None
        if not level.mask.all():  # padding is not seen
            bias = (1e4 * (level.mask - 1)).mT[:, None].expand(-1, -1, h.shape[1], -1)
        h = block["own"](h, None, bias, (times, times))
        for layer in block["deep"] if "deep" in block else ():
            h = memory.read(layer["ask"], h, level)
            h = layer["own"](h, None, bias, (times, times))
        return h


def from_both_ends(level: Level) -> Float[Tensor, "#B T 32"]:
    """Sines and cosines of the seconds since the first frame, and until the last one."""
    since = level.times.expand(level.mask.shape[:2])
    last = (since * level.mask[..., 0]).amax(1, keepdim=True)
    pace = torch.logspace(0, 1, CURVES, FASTEST / SLOWEST, device=since.device) * SLOWEST
    angles = 2 * torch.pi * torch.stack([since, last - since], -1)[..., None] * pace
    return torch.cat([angles.sin(), angles.cos()], -1).flatten(2)
