"""Activity: people who move more between keyframes are also farther from the lines between them.

    scale of a remainder = scale by the distance to what is given * activity
A person who stands is a centimetre from the lines, one who dances is several times as far as usual.
Where only the distance counts (`around_lines`), one network has to generate both sizes, and moves
calm people too much. `activity` is how far a motion goes in a second, as far as the given entries
tell: pose and path of the pelvis alike, averaged over about a second around each frame and over all
columns that are given. It has no jumps, and is 1 where nothing near is given. The path has an
activity of its own. A person who waves does not sway, and among 63 columns the two of the path
would count for nothing.

So the sizes of remainders differ less, over walks, dances and performed sentences with a keyframe
a second (`tests/beyond/test_activity.py`). It does not know the ends of a motion: there, and with
keyframes close to each other, it is up to a tenth smaller.
Gain: docs/RESULTS.md, *On recordings* (`inbetween-budget.ours.*`): the worst tenth of single
in-betweens is at least 1.2 times as far off as interpolation, 1.5 without.
Ours.
"""

import math
from dataclasses import replace

import torch
from jaxtyping import Bool, Float
from torch import Tensor
from torch.nn.functional import conv1d

from ..motion.dance_frame import PATH
from .around_lines import GivenLines, frames_since

SPAN = 20  # frames, a second; with 10, sizes of motions differ a little more
BLUR = 10.0  # frames, standard deviation of the average; with 20, sizes of single gaps differ more
USUAL = 0.001  # weight of activity 1 beside what is given; a motionless figure has about 0.03
USED_AT_MOST = 1.0  # in use: lively people of recordings would be moved too far


def with_activity(plain: GivenLines, at_most: float = math.inf) -> GivenLines:
    """The same lines, with a scale that is multiplied by the activity.

    With more activity than `at_most`, the network sees what it has seen in training, and its
    remainders count less, as if the activity were `at_most`.
    """
    lively = activity(plain.lines, plain.known)
    return replace(plain, scale=plain.scale * lively, less=(at_most / lively).clamp(max=1.0))


def activity(lines: Float[Tensor, "B T D"], known: Bool[Tensor, "B T D"]) -> Float[Tensor, "B T D"]:
    """`activity_of` all columns; for the two of the path, of these alone."""
    path = torch.zeros(lines.shape[-1], dtype=torch.bool, device=lines.device)
    path[PATH] = True
    of_path = activity_of(lines[..., PATH], known[..., PATH])
    return torch.where(path, of_path, activity_of(lines, known))


def activity_of(
    lines: Float[Tensor, "B T D"], known: Bool[Tensor, "B T D"]
) -> Float[Tensor, "B T 1"]:
    """How much a figure moves around each frame, over how much motions usually do.

        activity^2 = (mean of way^2 + USUAL) / (mean share of the second + USUAL)
    `way` is how far a motion goes in the second around a frame, in standard deviations: as the
    lines do, or farther, where they go to and fro or between entries more than a second apart; for
    the way of a random walk grows with the root of the time. A part of that second before the first
    or after the last given entry of a column is no evidence. Both means are over frames (`blurred`)
    and columns. 1 if nothing is given, or one frame alone.
    """
    if lines.shape[1] == 1:
        return torch.ones_like(lines[..., :1])
    ahead, behind = half_second_around(lines.shape[1], lines.device)

    def in_a_second(sums: Float[Tensor, "B T *D"]) -> Float[Tensor, "B T *D"]:
        return sums[:, ahead] - sums[:, behind]

    way = torch.maximum(in_a_second(lines).square(), in_a_second(walked(lines, known)))
    share = in_a_second(steps_between_given(known)) / SPAN
    lively = (blurred(way.mean(-1)) + USUAL) / (blurred(share) + USUAL)
    return lively.sqrt()[..., None]


def walked(lines: Float[Tensor, "B T D"], known: Bool[Tensor, "B T D"]) -> Float[Tensor, "B T D"]:
    """The squared distances between given entries, added up from the first frame to each frame.

    It grows evenly between two entries: by change^2 * frames in a step, as change = distance /
    frames.
    """
    until = frames_since(known.flip(1)).flip(1)
    frames = frames_since(known)[:, :-1] + 1 + until[:, 1:]
    steps = lines.diff(dim=1).square() * frames.where(frames.isfinite(), 0.0)
    return torch.cat([torch.zeros_like(lines[:, :1]), steps.cumsum(1)], 1)


def half_second_around(T: int, device: torch.device) -> tuple[Tensor, Tensor]:
    """For each of T frames, the frame half a second later and earlier, within the motion."""
    frames = torch.arange(T, device=device)
    return (frames + SPAN // 2).clamp(max=T - 1), (frames - SPAN // 2).clamp(min=0)


def steps_between_given(known: Bool[Tensor, "B T D"]) -> Float[Tensor, "B T"]:
    """How many steps up to each frame are between the first and the last given entry of a column.

    The mean over columns.
    """
    since, until = known.cummax(1).values, known.flip(1).cummax(1).values.flip(1)
    between = (since[:, :-1] & until[:, 1:]).float().mean(-1)
    return torch.cat([torch.zeros_like(between[:, :1]), between.cumsum(1)], 1)


def blurred(values: Float[Tensor, "B T"]) -> Float[Tensor, "B T"]:
    """The sum over frames with the weights of a normal distribution, which add up to 1.

    Beyond the ends values are 0.
    """
    far = int(4 * BLUR)  # its weight is next to nothing there
    frames = torch.arange(-far, far + 1, device=values.device)
    weights = torch.softmax(-0.5 * (frames / BLUR).square(), 0).to(values)
    return conv1d(values[:, None], weights[None, None], padding=far)[:, 0]
