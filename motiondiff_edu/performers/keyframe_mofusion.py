"""MoFusion's U-Net for in-betweens: it sees lines, scale and mask of what is given, too.

Called without them, it denoises whole motions. It predicts v: at low noise x0_hat is x_s with
little changed, and details that a small network would smooth away stay.
Source: MoFusion 3.3, Fig. 3; the further inputs after CondMDI (Cohan and others, 2024).
"""

import math
from dataclasses import dataclass, fields

import torch
from jaxtyping import Bool, Float, Int
from torch import Tensor, nn

from ..beyond.activity import with_activity
from ..beyond.around_lines import Shown
from ..beyond.turning_frame import View
from ..mofusion import MoFusion, MoFusionConfig
from .networks import register


@dataclass(frozen=True)
class KeyframeConfig(MoFusionConfig):
    """The sizes of the network; `D` counts the columns of a motion, without the further inputs.

    `activity`: remainders are in units that grow with how much the figure moves
    (`beyond.activity`).
    `turning`: poses are seen in headings that turn with the figure (`beyond.turning_frame`).
    """

    C: int = 0
    target: str = "v"
    skip: bool = False
    activity: bool = False
    turning: bool = False

    def inner(self) -> MoFusionConfig:
        """The configuration of the U-Net, whose input is x_s, lines, scale, mask, and steps."""
        sizes = {field.name: getattr(self, field.name) for field in fields(MoFusionConfig)}
        return MoFusionConfig(**sizes | {"D": 4 * self.D + 6 * self.turning})


class KeyframeMoFusion(nn.Module):
    """net(r_s, s, shown): the target of the remainder around the lines (`beyond.around_lines`)."""

    def __init__(self, config: KeyframeConfig):
        super().__init__()
        self.config = config
        self.unet = MoFusion(config.inner())

    def view(self, features: Float[Tensor, "B T 63"], known: Bool[Tensor, "B T 21"]) -> View:
        """How this network sees motions (features in metres) of which this is given."""
        return View.of(features, known) if self.config.turning else View.none(features)

    def shown(
        self,
        given: Float[Tensor, "B T D"],
        known: Bool[Tensor, "B T D"],
        view: View | None = None,
        activity_at_most: float = math.inf,
    ) -> Shown:
        """What this network is shown of a motion; unknown entries of `given` can be anything.

        `given` is seen in this view already.
        """
        plain = Shown.of(given, known, view)
        return with_activity(plain, activity_at_most) if self.config.activity else plain

    def forward(
        self, r_s: Float[Tensor, "B T D"], s: Int[Tensor, "B"], shown: Shown | None = None
    ) -> Float[Tensor, "B T D"]:
        """Without `shown`, nothing is given, and r_s is the whole motion with its noise."""
        if shown is None:
            shown = self.shown(r_s, torch.zeros_like(r_s, dtype=torch.bool))
        lines = shown.lines
        if self.config.turning:
            lines = shown.speeds(shown.view or View.none(lines))
        inputs = [r_s, lines, shown.scale, shown.known.to(r_s)]
        return self.unet(torch.cat(inputs, -1), s)[..., : self.config.D]


register("dancer", KeyframeMoFusion, KeyframeConfig)
