"""In-betweens seen by the figure itself: in a heading that turns with it, and with its steps.

A figure that turns round between two keyframes would shrink to a post if its joints went straight:
they would all pass its axis. Seen in a frame that turns evenly from one given heading to the next,
joints go round, and every walk goes forward, whichever way it goes in the room. The heading is
taken from given hips or shoulders alone, so that it is known before anything is generated.

    pose columns        turned by the heading of their frame, before lines are drawn through them
    path of the pelvis  lines as before; what is generated around them is turned
    steps               how fast each toe must go over the ground from where it is given to where it
                        is given next: 0 for a foot that stands. The network sees it as well
Gain: docs/RESULTS.md, *On recordings* (`inbetween-budget.turning.*`): one in-between is a thirtieth
nearer.
Ours.
"""

from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Bool, Float
from torch import Tensor

from ..motion.dance_frame import PATH, headings_between
from ..motion.directions import ARMS, UPLEGS
from ..motion.known import between_known
from ..motion.skeleton import TOES, J

SPAN = 5  # frames before and after, over which the speed of a line is taken
STEP = 0.3  # m: a step of so much in 2 SPAN frames counts as 1


@dataclass(frozen=True, eq=False)
class TurningFrame:
    """What the given poses tell of a figure: its headings (radians), and its toes' steps."""

    turned: Float[Tensor, "B T"]
    steps: Float[Tensor, "B T 6"]

    @classmethod
    def of(cls, features: Float[Tensor, "B T 63"], known: Bool[Tensor, "B T 21"]) -> "TurningFrame":
        """From features in metres (`motion.dance_frame`); unknown entries can be anything."""
        turned = headings(features, known)
        return cls(turned, steps_of(features, known, turned))

    @classmethod
    def none(cls, features: Float[Tensor, "B T D"]) -> "TurningFrame":
        """Heading 0, and no steps."""
        return cls(
            features.new_zeros(features.shape[:2]), features.new_zeros(*features.shape[:2], 6)
        )

    def expand(self, samples: int) -> "TurningFrame":
        """The same for several samples of one motion."""
        return TurningFrame(self.turned.expand(samples, -1), self.steps.expand(samples, -1, -1))

    def to(self, device) -> "TurningFrame":
        return TurningFrame(self.turned.to(device), self.steps.to(device))

    def enter(self, features: Float[Tensor, "B T 63"]) -> Float[Tensor, "B T 63"]:
        """The features (metres), with the poses of each frame turned so that they face z."""
        return _poses_turned(features, self.turned)

    def leave(self, features: Float[Tensor, "B T 63"]) -> Float[Tensor, "B T 63"]:
        """Undo `enter`."""
        return _poses_turned(features, -self.turned)


def headings(
    features: Float[Tensor, "B T 63"], known: Bool[Tensor, "B T 21"]
) -> Float[Tensor, "B T"]:
    """The heading in every frame (radians): as given, and turning evenly between.

    Of hips and shoulders, the pair counts that is given in more frames; hips, if in as many. The
    other one does not count at all, for a twisted trunk would make the heading jump. Before the
    first and after the last heading it stays. It is 0 where none is given. Between two of them a
    figure turns by less than a half circle.
    """
    joints = features.detach().cpu().double().numpy().reshape(*features.shape[:2], J, 3)
    masks = known.cpu().numpy()
    found = np.zeros(features.shape[:2])
    for row, pose, mask in zip(found, joints, masks, strict=True):
        left, right = max((UPLEGS, ARMS), key=lambda pair: mask[:, pair].all(1).sum())
        there = mask[:, left] & mask[:, right]
        if there.any():
            across = np.where(there[:, None], pose[:, left] - pose[:, right], 0.0)
            row[:] = headings_between(across, there)
    return torch.from_numpy(found).to(features)


def steps_of(
    features: Float[Tensor, "B T 63"], known: Bool[Tensor, "B T 21"], turned: Float[Tensor, "B T"]
) -> Float[Tensor, "B T 6"]:
    """How far the lines through each toe's given places go around a frame, seen in the heading."""
    pelvis, found = features[..., :3], []
    for toe in TOES:
        given = known[..., toe, None].expand(-1, -1, 3)
        place = features[..., 3 * toe : 3 * toe + 3] + pelvis
        x, y, z = (changes_around(between_known(place, given)) / STEP).unbind(-1)
        across, along = _rotated(x, z, turned)
        found += [across, y, along]
    return torch.stack(found, -1)


def path_turned(
    features: Float[Tensor, "B T D"], turned: Float[Tensor, "B T"]
) -> Float[Tensor, "B T D"]:
    """The features, with the columns of the pelvis' path turned; both have the same unit."""
    whole = features.clone()
    x, z = features[..., PATH].unbind(-1)
    whole[..., PATH] = torch.stack(_rotated(x, z, turned), -1)
    return whole


def speeds_for_path(
    lines: Float[Tensor, "B T D"], turned: Float[Tensor, "B T"]
) -> Float[Tensor, "B T D"]:
    """The lines, with the path's columns replaced by their change around each frame, turned.

    Forward and to the side; where the path is, tells a network nothing.
    """
    whole = lines.clone()
    whole[..., PATH] = changes_around(lines[..., PATH])
    return path_turned(whole, turned)


def changes_around(lines: Float[Tensor, "B T D"]) -> Float[Tensor, "B T D"]:
    """The change in the 2 SPAN frames around each frame; near the ends, of as many as there are."""
    frames = torch.arange(lines.shape[1], device=lines.device)
    ahead, behind = (frames + SPAN).clamp(max=len(frames) - 1), (frames - SPAN).clamp(min=0)
    share = (2 * SPAN / (ahead - behind).clamp(min=1))[:, None]
    return share * (lines[:, ahead] - lines[:, behind])


def _poses_turned(features: Tensor, turned: Tensor) -> Tensor:
    x, y, z = features.unflatten(-1, (J, 3)).unbind(-1)
    across, along = _rotated(x, z, turned[..., None])
    poses = torch.stack([across, y, along], -1).flatten(-2)
    return torch.cat([features[..., :3], poses[..., 3:]], -1)


def _rotated(x: Tensor, z: Tensor, turned: Tensor) -> tuple[Tensor, Tensor]:
    """Rotated about the vertical, so that what faces `turned` faces z."""
    sin, cos = turned.sin(), turned.cos()
    return x * cos - z * sin, x * sin + z * cos
