"""The features of a described motion: poses seen from the root, and the velocities of the root.

Columns 0:63 are x, y, z of the 21 joints in the root frame, in metres; columns 63:66 are the
control: forward and left velocity in m/s, and yaw in rad/s (`motion/root_frame.py`). So a step
looks the same wherever the figure is and whichever way it faces. In the features of a dance
(`motion/dance_frame.py`) it has another place and direction each time.
Source: the idea of HumanML3D's 263 numbers (Guo and others, 2022), with ours for the numbers.
Notebook: 16
"""

import numpy as np
import torch
from jaxtyping import Float
from torch import Tensor

from ..kinematic_loss import Body
from .root_frame import FPS, estimate_root, to_root_frame
from .scaler import Scaler
from .skeleton import BONE_PAIRS, BONES, MIRROR, TOES, J, check_joints

D = 3 * J + 3  # 66


def to_features(positions: Float[np.ndarray, "T J 3"]) -> Float[np.ndarray, "T 66"]:
    """World positions (metres) as the network's 66 features.

    Raises ValueError for another skeleton.
    """
    check_joints(positions)
    poses, control = to_root_frame(positions, *estimate_root(positions))
    return np.concatenate([poses.reshape(len(poses), 3 * J), control], axis=-1)


def to_positions(features: Float[Tensor, "*B T 66"]) -> Float[Tensor, "*B T 21 3"]:
    """The 66 features as world positions, differentiable for the losses.

    The root begins at x = z = 0, facing z. The numbers are those of `root_frame.to_world`.
    """
    poses = features[..., : 3 * J].unflatten(-1, (J, 3))
    step = features[..., 3 * J :] / FPS
    forward, left, yaw = step.unbind(-1)
    heading = _before(yaw)
    halfway = heading + yaw / 2
    x = _before(forward * halfway.sin() + left * halfway.cos())
    z = _before(forward * halfway.cos() - left * halfway.sin())
    aside, up, ahead = poses.unbind(-1)
    sin, cos = heading.sin()[..., None], heading.cos()[..., None]
    return torch.stack(
        [x[..., None] + ahead * sin + aside * cos, up, z[..., None] + ahead * cos - aside * sin], -1
    )


def _before(x: Float[Tensor, "*B T"]) -> Float[Tensor, "*B T"]:
    """The sum of all frames before each one."""
    return x.cumsum(-1) - x


def moves(features: Float[Tensor, "*B T 66"]) -> Float[Tensor, "*B T2 21 3"]:
    """How far each joint moves from frame to frame, in the axes of the root, metres.

    It is linear in the features, and exact while the figure does not turn.
    """
    poses = features[..., : 3 * J].unflatten(-1, (J, 3))
    forward, left, _ = (features[..., :-1, 3 * J :] / FPS).unbind(-1)
    root = torch.stack([left, torch.zeros_like(left), forward], -1)
    return poses.diff(dim=-3) + root[..., None, :]


def mirror_features(features: Float[Tensor, "*B T 66"]) -> Float[Tensor, "*B T 66"]:
    """The features of the mirrored motion: left and right are exchanged."""
    poses = features[..., : 3 * J].unflatten(-1, (J, 3))[..., list(MIRROR), :]
    poses = poses * poses.new_tensor([-1.0, 1.0, 1.0])
    control = features[..., 3 * J :] * features.new_tensor([1.0, -1.0, -1.0])
    return torch.cat([poses.flatten(-2), control], -1)


def body_of(scaler: Scaler) -> Body:
    """The course's figure, for kinematic losses of motions that `scaler` standardised.

    Columns behind the 66 (`beyond/timeline.py`) are no part of the figure.
    """
    return Body(lambda x: to_positions(scaler.inverse(x)[..., :D]), BONES, BONE_PAIRS, TOES)
