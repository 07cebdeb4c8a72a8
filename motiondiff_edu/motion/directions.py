"""The pose of another skeleton on the course's bones.

The bones keep their directions and get the course's lengths. Hips and chest are rigid blocks,
because every dialect places its spine joints elsewhere.
"""

import numpy as np
import scipy
from jaxtyping import Bool, Float

from .kinematics import rot_x
from .skeleton import BONE_LENGTHS, BONES, HEELS, OFFSETS, PARENTS, TOES, joint_index

HIPS, SPINE, SPINE1, NECK, HEAD = (
    joint_index(name) for name in ("Hips", "Spine", "Spine1", "Neck1", "Head")
)
UPLEGS, ARMS = (1, 5), (13, 17)
UP = np.array([0.0, 1.0, 0.0])
# downward pitch of the course's foot, from ankle to toe, while it stands on the floor
FLAT_PITCH = float(np.arctan2(-OFFSETS[4, 1], OFFSETS[4, 2]))


def unit(vector: Float[np.ndarray, "... 3"]) -> Float[np.ndarray, "... 3"]:
    """Vectors of length one."""
    return vector / np.maximum(np.linalg.norm(vector, axis=-1, keepdims=True), 1e-12)


def frame_of(
    left: Float[np.ndarray, "T 3"], up: Float[np.ndarray, "T 3"]
) -> Float[np.ndarray, "T 3 3"]:
    """Rotation matrices whose columns are left (kept), up (made perpendicular) and ahead."""
    x = unit(left)
    z = unit(np.cross(x, up))
    return np.stack([x, np.cross(z, x), z], axis=-1)


def calibrate(
    direction: Float[np.ndarray, "T 3"],
    frame: Float[np.ndarray, "T 3 3"],
    target: Float[np.ndarray, "3"],
) -> Float[np.ndarray, "T 3"]:
    """Directions turned by one constant rotation in a body frame, so that their mean is `target`.

    The rotation removes where a dialect places a joint and keeps how the person moves it.
    """
    local = np.einsum("tji,tj->ti", frame, unit(direction))
    turn = rotation_between(unit(local.mean(0)), unit(target))
    return np.einsum("tij,tj->ti", frame, local @ turn.T)


def rotation_between(
    start: Float[np.ndarray, "3"], end: Float[np.ndarray, "3"]
) -> Float[np.ndarray, "3 3"]:
    """The smallest rotation that takes one direction to another (`least_turn`)."""
    return least_turn(start[None], end[None])[0]


def least_turn(
    start: Float[np.ndarray, "T 3"], end: Float[np.ndarray, "T 3"]
) -> Float[np.ndarray, "T 3 3"]:
    """The smallest rotation from one direction to another, frame by frame.

    Between opposite directions there are many: it is a half turn about some axis across them.
    """
    axis = np.cross(start, end)
    sine = np.linalg.norm(axis, axis=-1, keepdims=True)
    cosine = (start * end).sum(-1)
    opposite = (sine[:, 0] <= 1e-12 * np.abs(cosine)) & (cosine < 0)
    if opposite.any():
        thin = np.eye(3)[np.abs(start[opposite]).argmin(-1)]  # not along the direction
        axis[opposite] = np.cross(start[opposite], thin)
        sine = np.linalg.norm(axis, axis=-1, keepdims=True)
    angle = np.where(opposite, np.pi, np.arctan2(sine[:, 0], cosine))
    return scipy.spatial.transform.Rotation.from_rotvec(
        axis / np.maximum(sine, 1e-15) * angle[:, None]
    ).as_matrix()


def complete(points: Float[np.ndarray, "T 21 3"]) -> Float[np.ndarray, "T 21 3"]:
    """Fill joints that a file lacks.

    Neck and spine go on the lines between hips, shoulders and head; hand tips extend the forearm.
    """
    points = points.copy()
    hips, shoulders = points[:, UPLEGS].mean(1), points[:, ARMS].mean(1)
    made_up = {
        NECK: shoulders + 0.25 * (points[:, HEAD] - shoulders),
        SPINE: hips + 0.3 * (shoulders - hips),
        SPINE1: hips + 0.55 * (shoulders - hips),
        16: points[:, 15] + 0.3 * (points[:, 15] - points[:, 14]),
        20: points[:, 19] + 0.3 * (points[:, 19] - points[:, 18]),
    }
    for joint, place in made_up.items():
        if np.isnan(points[:, joint]).any():
            points[:, joint] = place
    return points


def has_our_bones(points: Float[np.ndarray, "T 21 3"]) -> bool:
    """True when every bone has the course's length within 2 %, as in the course's own files."""
    bones = np.linalg.norm(points[:, 1:] - points[:, PARENTS[1:]], axis=-1)
    lengths = np.median(bones, axis=0)
    return bool(np.all(np.abs(lengths / BONE_LENGTHS - 1) < 0.02))


def plain_directions(points: Float[np.ndarray, "T 21 3"]) -> Float[np.ndarray, "T 21 3"]:
    """Unit vector along every bone, from parent to child (row 0 is zero)."""
    directions = np.zeros_like(points)
    directions[:, 1:] = unit(points[:, 1:] - points[:, PARENTS[1:]])
    return directions


def bone_directions(
    points: Float[np.ndarray, "T 21 3"], standing: Bool[np.ndarray, "T 2"], lean: float = 0.0
) -> Float[np.ndarray, "T 21 3"]:
    """Unit direction of every bone (row 0 unused) for our figure, from another figure's joints.

    `standing` is true where a foot lies flat, which defines the pitch of a flat foot. `lean`
    (radians, backwards) is the slope of the trunk, from hip joints to shoulders, when the figure
    stands upright.
    """
    directions = plain_directions(points)
    pelvis, chest = trunk_frames(points, lean)
    for joint in (*UPLEGS, SPINE):
        directions[:, joint] = pelvis @ unit(OFFSETS[joint])
    directions[:, SPINE1] = unit(pelvis[..., 1] + chest[..., 1])
    directions[:, NECK] = chest[..., 1]
    for joint in (HEAD, *ARMS):
        directions[:, joint] = calibrate(points[:, joint] - points[:, NECK], chest, OFFSETS[joint])
    for side, (heel, toe) in enumerate(zip(HEELS, TOES, strict=True)):
        shank = points[:, heel - 1] - points[:, heel]
        directions[:, toe] = foot_direction(
            points[:, toe] - points[:, heel], shank, pelvis, standing[:, side]
        )
    return directions


def rest_lean(rest: Float[np.ndarray, "21 3"]) -> float:
    """How far the trunk slopes backwards in a rest pose (radians).

    The slope comes from the placement of the joints, not from posture. It is 0 when the rest pose
    does not stand, or slopes more than a standing figure does.
    """
    across = unit(rest[UPLEGS[0]] - rest[UPLEGS[1]])
    trunk = rest[list(ARMS)].mean(0) - rest[list(UPLEGS)].mean(0)
    ahead = unit(np.cross(across, UP))
    lean = float(np.arctan2(-trunk @ ahead, trunk[1]))
    return lean if abs(lean) < np.radians(25) else 0.0


def trunk_frames(points: Float[np.ndarray, "T 21 3"], lean: float) -> tuple[np.ndarray, np.ndarray]:
    """Frames of pelvis and chest.

    Their left axes are the lines of the hips and shoulders, their up axes the lower and the upper
    trunk. The trunk bends where the file has a spine joint near its middle. Its mean shape is
    straightened.
    """
    hips, shoulders = points[:, UPLEGS].mean(1), points[:, ARMS].mean(1)
    across_hips = points[:, UPLEGS[0]] - points[:, UPLEGS[1]]
    across_chest = points[:, ARMS[0]] - points[:, ARMS[1]]
    trunk = shoulders - hips
    middle = mid_trunk(points, hips, trunk)
    up = rot_x(lean)[:, 1]
    lower = calibrate(middle - hips, frame_of(across_hips, trunk), up)
    upper = calibrate(shoulders - middle, frame_of(across_chest, trunk), up)
    return frame_of(across_hips, lower), frame_of(across_chest, upper)


def mid_trunk(
    points: Float[np.ndarray, "T 21 3"],
    hips: Float[np.ndarray, "T 3"],
    trunk: Float[np.ndarray, "T 3"],
) -> Float[np.ndarray, "T 3"]:
    """The spine joint nearest to the middle of the trunk, or the middle itself if none is near."""
    height = np.einsum("tji,ti->tj", points[:, [SPINE, SPINE1, NECK]] - hips[:, None], trunk)
    fraction = np.median(height / (trunk**2).sum(-1)[:, None], axis=0)
    best = int(np.abs(fraction - 0.5).argmin())
    return (
        points[:, [SPINE, SPINE1, NECK][best]]
        if abs(fraction[best] - 0.5) < 0.25
        else hips + trunk / 2
    )


def foot_direction(
    foot: Float[np.ndarray, "T 3"],
    shank: Float[np.ndarray, "T 3"],
    pelvis: Float[np.ndarray, "T 3 3"],
    standing: Bool[np.ndarray, " T"],
) -> Float[np.ndarray, "T 3"]:
    """Direction from ankle to toe, pitched by a constant so that a flat foot fits our ankle height.

    A foot that is missing, or points straight along the shank, becomes a flat foot at right angles
    to the shank.
    """
    lengthwise = np.abs(np.einsum("ti,ti->t", unit(foot), unit(shank)))
    if np.isnan(foot).any() or np.median(lengthwise) > 0.9:
        return frame_of(pelvis[..., 0], shank) @ unit(OFFSETS[TOES[0]])
    foot = unit(foot)
    pitch = -np.arcsin(np.clip(foot[:, 1], -1, 1))
    # a low percentile, because the figure can kneel on its toes in other frames
    flat = np.percentile(pitch[standing] if standing.sum() > 3 else pitch, 20)
    across = unit(np.cross(shank, foot))
    return scipy.spatial.transform.Rotation.from_rotvec(across * (FLAT_PITCH - flat)).apply(foot)


def positions_from(
    hips: Float[np.ndarray, "T 3"],
    directions: Float[np.ndarray, "T 21 3"],
    lengths: Float[np.ndarray, "20 *T"] = BONE_LENGTHS,
) -> Float[np.ndarray, "T 21 3"]:
    """Positions of a figure from the place of its hips, its bone directions and their lengths."""
    world = np.empty_like(directions)
    world[:, HIPS] = hips
    for (parent, child), length in zip(BONES, lengths, strict=True):
        world[:, child] = world[:, parent] + length[..., None] * directions[:, child]
    return world
