"""An in-betweener: a network that is shown what is known of a motion, and fills in the rest.

    known entries -> lines through them -> remainder around the lines, by diffusion
The network is MoFusion's U-Net. Beside the noised remainder it sees the lines, how far a motion
usually is from them, and the mask; so it was trained with masks. It predicts v: at low noise x0_hat
is x_s with little changed, and details that a small network would smooth away stay.
`editing.inbetween` also corrects bones and feet; `md.inbetween` takes and gives a Motion.
Source: MoFusion 3.3, Fig. 3, and 4.4; the further inputs after CondMDI (Cohan and others, 2024).
Notebook: 15
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, fields, replace

import numpy as np
import torch
from jaxtyping import Bool, Float, Int
from torch import Tensor, nn

from ..beyond.activity import USED_AT_MOST, with_activity
from ..beyond.around_lines import GivenLines, lines_round
from ..ddpm import Denoiser, Generators, draw, final
from ..inbetweening import inpaint_steps
from ..mofusion import MoFusion, MoFusionConfig
from ..motion.known import checked_given, given_features, with_given
from ..motion.scaler import Scaler
from .networks import register
from .performer import STEPS, Performer, Watch, float32


@dataclass(frozen=True)
class KeyframeConfig(MoFusionConfig):
    """The sizes of the network; `D` counts the columns of a motion, without the further inputs.

    `activity`: remainders are in units that grow with how much the figure moves
    (`beyond.activity`).
    """

    C: int = 0
    target: str = "v"
    skip: bool = False
    activity: bool = False

    def inner(self) -> MoFusionConfig:
        """The configuration of the U-Net, whose input is r_s, lines, scale and mask."""
        sizes = {field.name: getattr(self, field.name) for field in fields(MoFusionConfig)}
        return MoFusionConfig(**sizes | {"D": 4 * self.D})


class KeyframeMoFusion(nn.Module):
    """net(r_s, s, lines): the target of the remainder around the lines (`beyond.around_lines`)."""

    def __init__(self, config: KeyframeConfig):
        super().__init__()
        self.config = config
        self.unet = MoFusion(config.inner())

    def lines(
        self,
        given: Float[Tensor, "B T D"],
        known: Bool[Tensor, "B T D"],
        activity_at_most: float = math.inf,
    ) -> GivenLines:
        """What this network is shown of a standardised motion.

        Unknown entries of `given` can be anything.
        """
        plain = GivenLines.of(given, known)
        return with_activity(plain, activity_at_most) if self.config.activity else plain

    def forward(
        self, r_s: Float[Tensor, "B T D"], s: Int[Tensor, "B"], lines: GivenLines
    ) -> Float[Tensor, "B T D"]:
        inputs = [r_s, lines.lines, lines.scale, lines.known.to(r_s)]
        return self.unet(torch.cat(inputs, -1), s)[..., : self.config.D]


register("inbetweener", KeyframeMoFusion, KeyframeConfig)


@dataclass(frozen=True, eq=False, repr=False)
class Inbetweener(Performer):
    """A network, and the scaler that converts metres to its units and back.

    Source: MoFusion 4.4.
    """

    model: KeyframeMoFusion
    motion_scaler: Scaler
    card: dict = field(default_factory=dict)

    def denoiser(self, lines: GivenLines) -> Denoiser:
        """`denoise(r_s, s) -> eps_hat` for remainders around these lines."""
        return self._denoiser(self.model, lines)

    @float32()
    def fill(
        self,
        positions: Float[np.ndarray, "T 21 3"],
        known: Bool[np.ndarray, "T 21"],
        *,
        samples: int = 1,
        steps: int | Sequence[int] = STEPS,
        remainder: float = 1.0,
        generator: Generators | None = None,
        watch: Watch = iter,
    ) -> Float[np.ndarray, "samples T 21 3"]:
        """Generate what is not known of a motion (metres, 20 frames/s), `samples` times.

        Known entries come back bit by bit as they were given; the others may be NaN. The rest is
        the network's own: bones can stretch, and feet can slide. If nothing is known, it is a whole
        motion. The motion may be anywhere and face anywhere: the network sees it from its first
        known pose.

        steps     of DDIM: how many, or which to visit (`inbetweening.resampling_steps`)
        remainder factor on what the network adds to the lines; with 0 the result is the lines
        generator without one, the seed is 0
        watch     gets the sampling loop, and shows how far it is
        Raises ValueError where a joint is given without the pelvis, or is given but NaN or
        infinite, and for shapes that do not fit.
        Source: MoFusion 4.4.  Notebook: 15
        """
        positions, known = checked_given(positions, known)
        generator = generator or torch.Generator().manual_seed(0)
        place, features, columns = given_features(positions, known)
        device = self.motion_scaler.mean.device
        given = self.motion_scaler.transform(features.to(device)).expand(samples, -1, -1)
        columns = columns.to(device).expand(samples, -1, -1)
        r_S = draw(given, generator)
        lines = self.model.lines(given, columns, activity_at_most=USED_AT_MOST)
        turning = self.motion_scaler.transform(lines_round(features, known).to(device))
        # a column that is given nowhere has the mean, which is 0 in these units and not in metres
        lines = replace(lines, lines=turning.where(columns.any(1, keepdim=True), 0.0))
        known_remainder = torch.zeros_like(given)
        loop = inpaint_steps(
            self.denoiser(lines), r_S, self.schedule, known_remainder, columns, steps=steps,
            generator=generator,
        )  # fmt: skip
        x0 = lines.whole(remainder * final(watch(loop)).x_s)
        return with_given(place, self.motion_scaler.inverse(x0), positions, known)
