"""A quick figure that walks, for tests of what draws motion.

Plausible to the eye, not the course's data.
"""

import numpy as np

from motiondiff_edu.motion.kinematics import forward_kinematics, rot_x, rot_y, rot_z
from motiondiff_edu.motion.skeleton import JOINTS, OFFSETS, PARENTS, TOES


def walk(
    frames: int = 80, fps: float = 20.0, speed: float = 1.2, turn: float = 0.0, phase: float = 0.0
):
    """A figure that sets out from the origin.

    World positions (frames, 21, 3) and contacts (frames, 2).
    """
    t = np.arange(frames) / fps
    cycle = 2 * np.pi * 0.9 * t + phase
    local = np.tile(np.eye(3), (frames, len(JOINTS), 1, 1))
    for side, shift, out in (("Left", 0.0, -1.25), ("Right", np.pi, 1.25)):
        swing = np.sin(cycle + shift)
        knee = 0.15 + 0.9 * np.clip(np.cos(cycle + shift), 0, None) ** 2
        local[:, JOINTS.index(f"{side}UpLeg")] = rot_x(-0.45 * swing - 0.1)
        local[:, JOINTS.index(f"{side}Leg")] = rot_x(knee)
        local[:, JOINTS.index(f"{side}Foot")] = rot_x(0.45 * swing - 0.6 * knee + 0.1)
        local[:, JOINTS.index(f"{side}Arm")] = rot_x(0.5 * swing) @ rot_z(np.full(frames, out))
        local[:, JOINTS.index(f"{side}ForeArm")] = rot_y(
            np.full(frames, -0.5 if side == "Left" else 0.5)
        )
    heading = turn * t
    local[:, 0] = rot_y(heading)
    root = np.cumsum(np.stack([np.sin(heading), 0 * t, np.cos(heading)], -1), 0) * speed / fps
    world, _ = forward_kinematics(local, root, OFFSETS, PARENTS)
    world[..., 1] -= world[..., list(TOES), 1].min(-1)[:, None]
    return world, world[:, list(TOES), 1] < 0.02
