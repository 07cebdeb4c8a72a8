"""The features of a dance: the place of the pelvis, and the other joints relative to it.

Columns 0:3 are the pelvis (x, y, z), which starts at x = z = 0, facing z. Then come x, y, z of each
of the 20 other joints minus the pelvis, in metres. The axes do not turn with the figure.
Source: MoFusion 3 (root-relative joints and the root's path).   Notebook: 12
"""

from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Bool, Float
from torch import Tensor

from ..kinematic_loss import Body
from .scaler import Scaler
from .skeleton import BONE_PAIRS, BONES, HIPS, MIRROR, TOES, J, check_joints, joint_index

GROUND = np.array([1.0, 0.0, 1.0])  # projects a point onto the floor
PATH = [3 * HIPS, 3 * HIPS + 2]  # the columns of the pelvis' path over the ground
HIP_LEFT = joint_index("LeftUpLeg")
HIP_RIGHT = joint_index("RightUpLeg")


def facing(positions: Float[np.ndarray, "*B 21 3"]) -> Float[np.ndarray, "*B"]:
    """The direction that the pelvis faces: radians, counter-clockwise from above, 0 along z."""
    return heading(positions[..., HIP_LEFT, :] - positions[..., HIP_RIGHT, :])


def heading(across: Float[np.ndarray, "*B 3"]) -> Float[np.ndarray, "*B"]:
    """The direction that a figure faces, from the line of its hips or shoulders, right to left."""
    return np.asarray(np.arctan2(-across[..., 2], across[..., 0]))


def headings_between(
    across: Float[np.ndarray, "T 3"], there: Bool[np.ndarray, " T"]
) -> Float[np.ndarray, " T"]:
    """The heading in every frame (radians), from these lines where they are `there`, and evenly
    between.

    It goes the short way round, and stays before the first and after the last. One must be there.
    """
    frames = np.arange(len(across))
    return np.interp(frames, frames[there], np.unwrap(heading(across[there])))


@dataclass(frozen=True, eq=False)
class Place:
    """Where a figure stands and which way it faces.

    `enter` transforms positions from the world to this frame, `leave` transforms them back.
    """

    ground: Float[np.ndarray, "*B 3"]  # below the pelvis: x, 0, z
    heading: Float[np.ndarray, "*B"]

    @classmethod
    def of(cls, pose: Float[np.ndarray, "*B 21 3"]) -> "Place":
        return cls(pose[..., HIPS, :] * GROUND, facing(pose[..., None, :, :])[..., 0])

    def enter(self, positions: Float[np.ndarray, "*B T J 3"]) -> Float[np.ndarray, "*B T J 3"]:
        """World positions in this frame."""
        return _turned(positions - self.ground[..., None, None, :], self.heading)

    def leave(self, positions: Float[np.ndarray, "*B T J 3"]) -> Float[np.ndarray, "*B T J 3"]:
        """Positions in this frame, back in the world."""
        return _turned(positions, self.heading, back=True) + self.ground[..., None, None, :]


def _turned(
    positions: Float[np.ndarray, "*B T J 3"], heading: Float[np.ndarray, "*#B"], back: bool = False
) -> Float[np.ndarray, "*B T J 3"]:
    """Rotate so that the direction `heading` becomes z; `back` rotates the other way."""
    sin = np.sin(heading)[..., None, None]
    cos = np.cos(heading)[..., None, None]
    sin = -sin if back else sin
    x, y, z = np.moveaxis(positions, -1, 0)
    return np.stack([x * cos - z * sin, y, x * sin + z * cos], -1)


def at_origin(positions: Float[np.ndarray, "*B T 21 3"]) -> Float[np.ndarray, "*B T 21 3"]:
    """The same motion, moved and turned so that its first pelvis is over x = z = 0, facing z."""
    return Place.of(positions[..., 0, :, :]).enter(positions)


def to_features(positions: Float[np.ndarray, "*B T J 3"]) -> Float[np.ndarray, "*B T 63"]:
    """World positions as the network's 63 features.  Raises ValueError for another skeleton."""
    check_joints(positions)
    return placed_features(at_origin(positions))


def placed_features(placed: Float[np.ndarray, "*B T J 3"]) -> Float[np.ndarray, "*B T 63"]:
    """The 63 features of a motion that starts at the origin already."""
    about = placed[..., HIPS + 1 :, :] - placed[..., HIPS : HIPS + 1, :]
    whole = np.concatenate([placed[..., HIPS : HIPS + 1, :], about], axis=-2)
    return whole.reshape(*whole.shape[:-2], 3 * J)


def to_positions(features: Float[Tensor, "*B T 63"]) -> Float[Tensor, "*B T 21 3"]:
    """The network's 63 features as world positions, differentiable for the losses.

    Notebook: 12, 13
    """
    joints = features.unflatten(-1, (J, 3))
    pelvis = joints[..., :1, :]
    return torch.cat([pelvis, joints[..., 1:, :] + pelvis], dim=-2)


def moves(features: Float[Tensor, "*B T 63"]) -> Float[Tensor, "*B T2 21 3"]:
    """How far each joint moves from frame to frame, in metres; linear in the features."""
    return to_positions(features).diff(dim=-3)


def body_of(scaler: Scaler) -> Body:
    """The course's figure, for kinematic losses of motions that `scaler` standardised.

    Notebook: 13
    """
    return Body(lambda x: to_positions(scaler.inverse(x)), BONES, BONE_PAIRS, TOES)


def mirror(positions: Float[np.ndarray, "*B T 21 3"]) -> Float[np.ndarray, "*B T 21 3"]:
    """The same dance in a mirror: left and right are exchanged."""
    return positions[..., MIRROR, :] * np.array([-1.0, 1.0, 1.0])
