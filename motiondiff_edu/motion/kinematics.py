"""Forward kinematics: from joint rotations to joint positions, and the rotation matrices it needs.

Source: textbook rigid-body kinematics; MoDiff itself works on positions (IV-A).  Notebook: 01
"""

from functools import reduce
from itertools import pairwise

import numpy as np
from jaxtyping import Float, Int


def rot_x(angle: Float[np.ndarray, "*N"] | float) -> Float[np.ndarray, "*N 3 3"]:
    """Rotation about x by `angle` radians (right-handed)."""
    return _axis_rotation(angle, 1, 2)


def rot_y(angle: Float[np.ndarray, "*N"] | float) -> Float[np.ndarray, "*N 3 3"]:
    """Rotation about y by `angle` radians: turns z towards x, counter-clockwise from above."""
    return _axis_rotation(angle, 2, 0)


def rot_z(angle: Float[np.ndarray, "*N"] | float) -> Float[np.ndarray, "*N 3 3"]:
    """Rotation about z by `angle` radians (right-handed)."""
    return _axis_rotation(angle, 0, 1)


def _axis_rotation(angle, first: int, second: int) -> np.ndarray:
    """Turn axis `first` towards axis `second`."""
    angle = np.asarray(angle, dtype=np.float64)
    matrix = np.zeros((*angle.shape, 3, 3))
    matrix[..., range(3), range(3)] = 1.0
    matrix[..., first, first] = np.cos(angle)
    matrix[..., second, second] = np.cos(angle)
    matrix[..., second, first] = np.sin(angle)
    matrix[..., first, second] = -np.sin(angle)
    return matrix


def euler_to_matrix(angles: Float[np.ndarray, "*N K"], order: str) -> Float[np.ndarray, "*N 3 3"]:
    """Intrinsic Euler angles (radians) to matrices.

    Order "ZXY" means R = Rz @ Rx @ Ry, as BVH files mean it.

    Raises ValueError when the order has a letter other than X, Y, Z, repeats a letter in a row, or
    does not fit the number of angles.  Notebook: 01
    """
    twice = any(a == b for a, b in pairwise(order))
    if not 1 <= len(order) == angles.shape[-1] <= 3 or set(order) - set("XYZ") or twice:
        raise ValueError(
            f"rotation order {order!r} does not fit {angles.shape[-1]} angles; use letters X, Y, Z"
        )
    about = {"X": rot_x, "Y": rot_y, "Z": rot_z}  # scipy's from_euler takes ten times as long
    return reduce(np.matmul, (about[axis](angles[..., k]) for k, axis in enumerate(order)))


def forward_kinematics(
    local_rotations: Float[np.ndarray, "T J 3 3"],
    root_position: Float[np.ndarray, "T 3"],
    offsets: Float[np.ndarray, "J 3"],
    parents: Int[np.ndarray, "J"],
) -> tuple[Float[np.ndarray, "T J 3"], Float[np.ndarray, "T J 3 3"]]:
    """World positions (the unit of `offsets`) and global rotations of every joint.

    G[j] = G[parent] L[j],   p[j] = p[parent] + G[parent] offset[j];   the root sits at
    `root_position`.
    Raises ValueError when a parent comes after its child.  Notebook: 01
    """
    if any(parent >= joint for joint, parent in enumerate(parents)):
        raise ValueError("every parent must come before its children in `parents`")
    positions = np.empty((*local_rotations.shape[:2], 3))
    rotations = np.empty_like(local_rotations)
    for joint, parent in enumerate(parents):
        if parent < 0:
            positions[:, joint], rotations[:, joint] = root_position, local_rotations[:, joint]
            continue
        rotations[:, joint] = rotations[:, parent] @ local_rotations[:, joint]
        positions[:, joint] = positions[:, parent] + rotations[:, parent] @ offsets[joint]
    return positions, rotations
