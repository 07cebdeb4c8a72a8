"""MoFusion from text in two steps: a timeline for the text, then a motion for text and timeline.

The first network is small and generates the timeline (`beyond/timeline.py`). The second is
`TextMoFusion`; it is given the finished timeline as further columns of its input, without noise.
Source: MoFusion 3.3, for each of the two. The two steps are ours.
"""

from dataclasses import dataclass, fields, replace

import torch
from jaxtyping import Float, Int
from torch import Tensor, nn

from ..beyond import timeline
from ..mofusion import Memory, Music
from ..motion import moving_frame
from .networks import register
from .text_mofusion import TextMoFusion, TextMoFusionConfig, Texts


@dataclass(frozen=True)
class PlannedConfig(TextMoFusionConfig):
    """The sizes of both networks. `D` counts the columns of motion and timeline together."""

    D: int = moving_frame.D + timeline.D
    plan_widths: tuple[int, ...] = (48, 48, 64)

    def of_one(self) -> TextMoFusionConfig:
        """The configuration of the network for motions."""
        names = [field.name for field in fields(TextMoFusionConfig)]
        return TextMoFusionConfig(**{name: getattr(self, name) for name in names})

    def of_the_plan(self) -> TextMoFusionConfig:
        """The configuration of the network for timelines."""
        return replace(self.of_one(), D=timeline.D, widths=self.plan_widths)


@dataclass(frozen=True, eq=False)
class Contexts:
    """A text as each of the two networks reads it."""

    plan: Music
    motion: Music


class PlannedMoFusion(nn.Module):
    """`planner(x_s, s, contexts.plan)` denoises timelines; called, the whole denoises motions."""

    def __init__(self, config: PlannedConfig):
        super().__init__()
        self.config = config
        self.planner = TextMoFusion(config.of_the_plan())
        self.performer = TextMoFusion(config.of_one())

    def listen(self, texts: Texts) -> Contexts:
        """The contexts of texts."""
        return Contexts(self.planner.listen(texts), self.performer.listen(texts))

    def forward(
        self,
        x_s: Float[Tensor, "B T 66"],
        s: Int[Tensor, "B"],
        contexts: Contexts,
        plan: Float[Tensor, "B T 24"],
    ) -> Float[Tensor, "B T 66"]:
        """x0_hat of motions that go with a plan, which has no noise."""
        return self.decode(x_s, s, self.encode(contexts, x_s.shape[1]), plan)

    def encode(self, contexts: Contexts, frames: int) -> Memory:
        """What all steps of the motion have in common; that of a timeline is `planner.encode`'s."""
        return self.performer.encode(contexts.motion, frames)

    def decode(
        self,
        x_s: Float[Tensor, "B T 66"],
        s: Int[Tensor, "B"],
        memory: Memory,
        plan: Float[Tensor, "B T 24"],
    ) -> Float[Tensor, "B T 66"]:
        both = torch.cat([x_s, plan], -1)
        return self.performer.decode(both, s, memory)[..., : moving_frame.D]


class Performing(nn.Module):
    """The network for motions with its plan: it is called as any network of MoFusion is."""

    def __init__(self, model: PlannedMoFusion, plan: Float[Tensor, "B T 24"]):
        super().__init__()
        self.model, self.plan = model, plan
        self.config = model.config

    def forward(
        self, x_s: Float[Tensor, "B T 66"], s: Int[Tensor, "B"], contexts: Contexts
    ) -> Float[Tensor, "B T 66"]:
        return self.model(x_s, s, contexts, self.plan)


register("mover", PlannedMoFusion, PlannedConfig)
