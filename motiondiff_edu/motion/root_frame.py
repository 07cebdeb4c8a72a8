"""World <-> root frame and control: poses relative to the figure's root, and the velocities that
move the root.

The root is the point on the ground under the figure. control[t] = (forward m/s, left m/s, yaw
rad/s) takes root[t] to root[t+1]. It is expressed in the heading halfway between the two, so
mirroring and time reversal are exact sign changes. Heading psi is counter-clockwise seen from
above: forward = (sin psi, cos psi), left = (cos psi, -sin psi) in (x, z).
Source: MoDiff IV-A (control in R^3).  Notebook: 01
"""

import numpy as np
import scipy
from jaxtyping import Float

from .skeleton import HIPS, joint_index

FPS = 20.0
# standard deviations in seconds; shorter ones leak the gait into the control
ROOT_SMOOTHING, HEADING_SMOOTHING = 0.25, 0.33


def forward_left(
    heading: Float[np.ndarray, "*T"],
) -> tuple[Float[np.ndarray, "*T 2"], Float[np.ndarray, "*T 2"]]:
    """Unit vectors (x, z) ahead of and to the left of a figure with this heading (radians)."""
    sin, cos = np.sin(heading), np.cos(heading)
    return np.stack([sin, cos], -1), np.stack([cos, -sin], -1)


def root_path(
    control: Float[np.ndarray, "T 3"],
    start: tuple[float, float, float] = (0.0, 0.0, 0.0),
    fps: float = FPS,
) -> tuple[Float[np.ndarray, "T 2"], Float[np.ndarray, "T"]]:
    """Integrate the control: root (x, z) in metres and heading in radians at every frame.

    heading[t+1] = heading[t] + yaw[t]/fps;  root[t+1] = root[t] + (v_f forward + v_l left)/fps at
    the halfway heading. `start` is (x, z, heading) at frame 0; the last row of control is not used.
    Notebook: 01
    """
    step = np.asarray(control, dtype=np.float64) / fps
    heading = start[2] + np.concatenate([[0.0], np.cumsum(step[:-1, 2])])
    forward, left = forward_left(heading + step[:, 2] / 2)
    moves = step[:, :1] * forward + step[:, 1:2] * left
    return np.array(start[:2]) + np.concatenate(
        [np.zeros((1, 2)), np.cumsum(moves[:-1], 0)]
    ), heading


def control_from_path(
    root_xz: Float[np.ndarray, "T 2"], heading: Float[np.ndarray, "T"], fps: float = FPS
) -> Float[np.ndarray, "T 3"]:
    """The control that carries the root along this path (the inverse of `root_path`).

    The last row repeats.

    Raises ValueError for fewer than two frames.
    """
    if len(root_xz) < 2:
        raise ValueError(
            f"a path needs at least 2 frames to have a velocity; this one has {len(root_xz)}"
        )
    yaw = np.diff(heading)
    forward, left = forward_left(heading[:-1] + yaw / 2)
    move = np.diff(root_xz, axis=0)
    control = np.stack([(move * forward).sum(-1), (move * left).sum(-1), yaw], -1) * fps
    return np.concatenate([control, control[-1:]])


def to_world(
    poses: Float[np.ndarray, "T J 3"],
    control: Float[np.ndarray, "T 3"],
    start: tuple[float, float, float] = (0.0, 0.0, 0.0),
    fps: float = FPS,
) -> Float[np.ndarray, "T J 3"]:
    """Place root-frame poses in the world, on the path that the control gives from `start`.

    Raises ValueError unless there is a row of control for each pose.  Notebook: 01
    """
    if len(poses) != len(control):
        raise ValueError(
            f"{len(poses)} poses but {len(control)} rows of control; each pose needs one row"
        )
    root_xz, heading = root_path(control, start, fps)
    forward, left = (v[:, None] for v in forward_left(heading))
    ground = root_xz[:, None] + poses[..., :1] * left + poses[..., 2:] * forward
    return np.stack([ground[..., 0], np.asarray(poses[..., 1], np.float64), ground[..., 1]], -1)


def to_root_frame(
    world: Float[np.ndarray, "T J 3"],
    root_xz: Float[np.ndarray, "T 2"],
    heading: Float[np.ndarray, "T"],
    fps: float = FPS,
) -> tuple[Float[np.ndarray, "T J 3"], Float[np.ndarray, "T 3"]]:
    """Root-frame poses and control of world positions along a root path (inverse of `to_world`)."""
    ground = world[..., [0, 2]] - root_xz[:, None]
    forward, left = (v[:, None] for v in forward_left(heading))
    x, z = (ground * left).sum(-1), (ground * forward).sum(-1)
    return np.stack([x, world[..., 1], z], -1), control_from_path(root_xz, heading, fps)


def body_heading(world: Float[np.ndarray, "T 21 3"]) -> Float[np.ndarray, "T"]:
    """The direction that hips and shoulders together face, in radians, -pi to pi.

    `dance_frame.facing` uses the hips alone.
    """
    left, right = (
        world[:, [joint_index(s + "UpLeg"), joint_index(s + "Arm")]].sum(1)
        for s in ("Left", "Right")
    )
    across = left - right
    return np.arctan2(-across[:, 2], across[:, 0])


def estimate_root(
    world: Float[np.ndarray, "T 21 3"], fps: float = FPS
) -> tuple[Float[np.ndarray, "T 2"], Float[np.ndarray, "T"]]:
    """Root path and heading of a real clip.

    That is the pelvis on the ground, and the direction of hips and shoulders, smoothed by Gaussians
    of 0.25 s and 0.33 s; shorter ones leak the gait into the control. Beyond its ends the clip is
    continued by point reflection, so that a walking figure does not seem to slow down there.
    """
    return smoothed_root(world[:, HIPS][:, [0, 2]], body_heading(world), fps)


def smoothed_root(
    pelvis: Float[np.ndarray, "T 2"], heading: Float[np.ndarray, "T"], fps: float = FPS
) -> tuple[Float[np.ndarray, "T 2"], Float[np.ndarray, "T"]]:
    """Root path and heading from the pelvis' (x, z) and the direction of the body (radians).

    The Gaussians are those of `estimate_root`.
    """
    return (
        _smooth(pelvis, ROOT_SMOOTHING * fps),
        _smooth(np.unwrap(heading), HEADING_SMOOTHING * fps),
    )


def _smooth(x: np.ndarray, sigma: float) -> np.ndarray:
    """Smooth along time by a Gaussian.

    Before the first and after the last frame x is continued by point reflection, 2 x[0] - x[t]. A
    clip shorter than the Gaussian is reflected repeatedly, so that it continues at its own speed.
    """
    reach = int(4 * sigma) + 1
    width = [(reach, reach)] + [(0, 0)] * (x.ndim - 1)
    return scipy.ndimage.gaussian_filter1d(
        np.pad(x, width, "reflect", reflect_type="odd"), sigma, axis=0
    )[reach : reach + len(x)]
