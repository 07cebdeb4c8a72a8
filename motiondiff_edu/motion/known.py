"""What is known of a motion: the mask is checked, and turned into what a network gets.

`known` is (T, J): True where a joint's position is given. A network has the pelvis in the world and
the other joints relative to it (`dance_frame`), so a joint can be given only where the pelvis is
given, too. It sees the motion from its first known pose, wherever that is in the world.
Source: MoFusion 4.4 (the mask delta).  Notebook: 15
"""

import math

import numpy as np
import torch
from jaxtyping import Bool, Float
from torch import Tensor

from .dance_frame import GROUND, Place, heading, placed_features, to_positions
from .directions import ARMS, UPLEGS
from .motion import Motion, MotionError
from .skeleton import COURSE, HIPS, JOINTS, J

Fade = float | Float[Tensor, "D"]  # frames
AHEAD, SOMEWHERE = 20, 0.5  # frames of the path that tell where it leads, if so far (metres)


def checked_known(motion: Motion, known) -> Bool[np.ndarray, "T J"]:
    """The mask, after a check that it fits a motion of the course's skeleton.

    Raises MotionError for another skeleton, another shape, values other than True and False, and a
    joint that is given but has no position.
    """
    if motion.skeleton != COURSE:
        raise MotionError(
            f"{motion.name} has {len(motion.skeleton)} joints; the course's networks know the {J} "
            f"of their own skeleton. Read the figure from a BVH file, which retargets it"
        )
    array = np.asarray(known)
    if array.dtype.kind in "UO":
        raise MotionError(
            f"known is a table of True and False, not {known!r:.60}. motion.all_but(['LeftArm']) "
            "leaves joints out, editing.masks.body_part(len(motion), 'lower body') keeps a part, "
            "md.keyframes(motion) keeps frames"
        )
    if array.shape != (len(motion), J) or array.dtype != bool:
        raise MotionError(
            f"known is {array.dtype} {array.shape}; it must be bool ({len(motion)}, {J}): a row "
            f"for each frame, True where a joint is given. md.keyframes(motion) makes one"
        )
    wrong = np.argwhere(array & ~motion.known)
    if len(wrong):
        frame, joint = wrong[0]
        raise MotionError(
            f"{JOINTS[joint]} in frame {frame} is given but has no position (NaN): pass "
            f"known & motion.known, which leaves out such joints"
        )
    return array


def checked_given(positions, known) -> tuple[Float[np.ndarray, "T 21 3"], Bool[np.ndarray, "T 21"]]:
    """Both as arrays of numpy.

    Raises ValueError unless they fit and all that is known is finite.
    """
    positions, known = np.asarray(positions), np.asarray(known)
    if positions.shape[1:] != (J, 3) or known.shape != positions.shape[:2] or known.dtype != bool:
        raise ValueError(
            f"it takes positions (T, {J}, 3) and a mask (T, {J}) of True and False, "
            f"not {positions.shape} and {known.shape} of {known.dtype}"
        )
    wrong = np.argwhere(known & ~np.isfinite(positions).all(-1))
    if len(wrong):
        frame, joint = wrong[0]
        raise ValueError(
            f"{JOINTS[joint]} in frame {frame} is given but not finite: "
            "correct it, or set known to False there"
        )
    return positions, known


def known_columns(known: Bool[np.ndarray, "*B T J"]) -> Bool[np.ndarray, "*B T 63"]:
    """The mask over the network's 63 features.

    Raises ValueError where a joint is given without the pelvis: no feature is then known.
    """
    loose = known.any(-1) & ~known[..., HIPS]
    if loose.any():
        frame = int(np.argwhere(loose)[0][-1])
        name = JOINTS[int(np.argmax(known[tuple(np.argwhere(loose)[0])]))]
        raise ValueError(
            f"frame {frame} gives {name} without the pelvis ({JOINTS[HIPS]}); give the pelvis too"
        )
    return np.repeat(known, 3, axis=-1)


def first_place(positions: Float[np.ndarray, "T 21 3"], known: Bool[np.ndarray, "T 21"]) -> Place:
    """The place and the heading of the first known pose; the network's motions start near it.

    The first frame with pelvis and hips decides, or else with pelvis and shoulders, or else the
    path of the pelvis, which is taken to go forward (along z if it does not move at first). If
    nothing is known, it is the world's origin.
    """
    for left, right in (UPLEGS, ARMS):
        whole = known[:, [HIPS, left, right]].all(-1)
        if whole.any():
            pose = positions[whole.argmax()]
            return Place(pose[HIPS] * GROUND, heading(pose[left] - pose[right]))
    path = positions[known[:, HIPS], HIPS]
    if not len(path):
        return Place(np.zeros(3), np.zeros(()))
    ahead = path[min(AHEAD, len(path) - 1)] - path[0]
    goes = np.hypot(ahead[0], ahead[2]) > SOMEWHERE
    return Place(path[0] * GROUND, np.array(np.arctan2(ahead[0], ahead[2]) if goes else 0.0))


def given_features(
    positions: Float[np.ndarray, "T 21 3"], known: Bool[np.ndarray, "T 21"]
) -> tuple[Place, Float[Tensor, "T 63"], Bool[Tensor, "T 63"]]:
    """The features (metres) of what is known, as seen from that place, and which they are.

    Raises ValueError as `checked_given` and `known_columns` do.
    """
    positions, known = checked_given(positions, known)
    columns, place = known_columns(known), first_place(positions, known)
    placed = np.where(known[..., None], place.enter(np.nan_to_num(positions)), 0.0)
    return place, torch.from_numpy(placed_features(placed)).float(), torch.from_numpy(columns)


def with_given(
    place: Place,
    features: Float[Tensor, "samples T 63"],
    positions: Float[np.ndarray, "T 21 3"],
    known: Bool[np.ndarray, "T 21"],
) -> Float[np.ndarray, "samples T 21 3"]:
    """Generated features (metres), back in the world. What is known stays as given, bit by bit."""
    made = place.leave(to_positions(features).double().cpu().numpy())
    return np.where(known[..., None], positions, made)


def between_known(
    values: Float[Tensor, "B T D"], known: Bool[Tensor, "B T D"], fade: Fade = math.inf
) -> Float[Tensor, "B T D"]:
    """Straight lines from each known entry of a column to the next; unknown values can be anything.

    Before the first and after the last known entry they fade to zero within `fade` frames: one
    number, or one for each column; with infinity they stay. A column without a known entry is 0.
    """
    T = values.shape[1]
    frames = torch.arange(T, device=values.device).view(1, T, 1).expand(known.shape)
    # the last known frame up to each frame, -1 for none; the next from each frame on, T for none
    before = torch.where(known, frames, -1).cummax(1).values
    after = torch.where(known, frames, T).flip(1).cummin(1).values.flip(1)
    values = values.where(known, 0.0)
    behind = values.gather(1, before.clamp(min=0))
    ahead = values.gather(1, after.clamp(max=T - 1))
    share = (frames - before) / (after - before).clamp(min=1)
    away = torch.where(before < 0, after - frames, frames - before)
    alone, nothing = (1 - away / (fade + 1)).clamp(min=0), torch.zeros_like(share)
    behind = behind * torch.where(after < T, 1 - share, alone).where(before >= 0, nothing)
    ahead = ahead * torch.where(before >= 0, share, alone).where(after < T, nothing)
    return torch.where(known, values, behind + ahead)
