"""In-betweens around lines: the network is shown what is given, and generates the rest.

    remainder = (x0 - lines) / scale      x0_hat = lines + scale * remainder_hat
Lines go straight from each given entry to the next. `scale` is how far a motion usually is from
them there: nothing at a given entry, a standard deviation far from all. So the noise is about as
large as what is to be generated, near a keyframe and far from one; and the result goes through the
given entries without a jump. (The pelvis' path has no such bound: seconds after the last given
frame it is many units away from its line.) A result that fails can be drawn nearer to the lines. If
nothing is given, the lines are 0 and the scale is 1: the same network samples whole motions.
`activity` can make the scale smaller for people who hardly move, and larger for lively ones.
In use, lines go round where a figure turns (`lines_round`). The training has straight ones alone.
Gain: docs/RESULTS_ALL.md, `inbetween-budget.not-shown.*`: of recordings, a network that is guided
instead makes one in-between in ten three times as far off as interpolation. On synthetic walks and
dances there is no gain (`inbetween-departures.not-shown.*`): there that network is the nearer one.
Source: masks in training after CondMDI (Cohan and others, 2024); lines and scale are ours.
"""

import math
from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Bool, Float
from torch import Tensor

from ..motion.dance_frame import Place, headings_between
from ..motion.directions import ARMS, UPLEGS
from ..motion.known import between_known
from ..motion.skeleton import J

HALF = 3.0  # frames at 20 frames/s; with it, scales are those of walks, dances and recordings


@dataclass(frozen=True, eq=False)
class GivenLines:
    """What the network is shown beside r_s and s: lines, scale, and which entries are given.

    `less` makes a remainder smaller than the scale that the network sees says (`activity`).
    """

    lines: Float[Tensor, "B T D"]
    scale: Float[Tensor, "B T D"]
    known: Bool[Tensor, "B T D"]
    less: Float[Tensor, "B T D"] | float = 1.0

    @classmethod
    def of(cls, given: Float[Tensor, "B T D"], known: Bool[Tensor, "B T D"]) -> "GivenLines":
        """The lines through the given entries; unknown entries of `given` can be anything."""
        return cls(between_known(given, known), scale_around(known), known)

    def remainder(self, x0: Float[Tensor, "B T D"]) -> Float[Tensor, "B T D"]:
        """What the network generates for a motion; 0 where the motion is given."""
        return ((x0 - self.lines) / (self.less * self.scale)).where(~self.known, 0.0)

    def whole(self, remainder: Float[Tensor, "B T D"]) -> Float[Tensor, "B T D"]:
        """The motion with this remainder; given entries come back up to rounding."""
        return self.lines + self.less * self.scale * remainder


def lines_round(
    features: Float[Tensor, "T 63"], known: Bool[np.ndarray, "T 21"]
) -> Float[Tensor, "T 63"]:
    """Lines through what is given of a motion (`motion.dance_frame`, metres) that turn with it.

    In half a turn between two frames, straight lines pass the figure's axis, and it folds flat. So
    each frame is seen in the heading that is given or lies evenly between given ones, lines are
    drawn there, and turned back. The pelvis goes straight. The heading is that of hips or
    shoulders, whichever are given in more frames; without any, all lines are straight.
    """
    columns = torch.from_numpy(known).repeat_interleave(3, dim=-1)[None]
    straight = between_known(features[None], columns)[0]
    left, right = max((UPLEGS, ARMS), key=lambda pair: known[:, pair].all(1).sum())
    there = known[:, left] & known[:, right]
    if not there.any():
        return straight
    joints = features.double().numpy().reshape(-1, 1, J, 3)
    across = np.where(there[:, None], joints[:, 0, left] - joints[:, 0, right], 0.0)
    frame = Place(np.zeros((len(joints), 3)), headings_between(across, there))
    seen = torch.from_numpy(frame.enter(joints)).flatten(1)[None]
    lines = between_known(seen, columns).unflatten(-1, (1, J, 3))[0]
    found = torch.from_numpy(frame.leave(lines.numpy())).flatten(1).to(features)
    return torch.cat([straight[:, :3], found[:, 3:]], -1)


def scale_around(known: Bool[Tensor, "B T D"]) -> Float[Tensor, "B T D"]:
    """How far from the lines a motion usually is, in standard deviations.

    1 / (1 + HALF (1 / before + 1 / after)), with the frames since the last and until the next
    given entry of the column; infinitely many where there is none.
    """
    after = frames_since(known.flip(1)).flip(1)
    return 1 / (1 + HALF * (1 / frames_since(known) + 1 / after))


def frames_since(known: Bool[Tensor, "B T D"]) -> Float[Tensor, "B T D"]:
    """How many frames ago the last given entry of a column was; infinity if there was none."""
    frames = torch.arange(known.shape[1], device=known.device, dtype=torch.float)[:, None]
    last = torch.where(known, frames, -math.inf).cummax(1).values
    return frames - last
