"""One motion of HumanML3D: 263 numbers a frame, or 22 joints, read as the course's 21 joints.

The numbers of a frame, at 20 frames/s, in metres, y up:
    0        half the angle by which the root turns until the next frame (radians, clockwise seen
             from above)
    1:3      how far the root moves until the next frame, to the left and ahead, as seen from the
             heading of the next frame
    3        the height of the root
    4:67     the 21 other joints, seen from the ground under the root, in its heading
    67:193   rotations: not read, because the bones they turn are not those of the positions
    193:259  how far each of the 22 joints moves until the next frame, in the heading of this one
    259:263  contacts of left ankle, left toe, right ankle, right toe: not read, because a foot at
             up to 0.9 m/s counts as planted
`humanml3d_folder.py` reads a folder of them with their captions.
Source: HumanML3D (Guo and others, 2022).
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

from ..._files import home
from .. import registry
from ..arguments import check_there
from ..motion import Motion, MotionError
from ..root_frame import FPS, forward_left
from ..skeleton import BONE_LENGTHS, J, Skeleton, joint_index
from .joints import check_header, mended_joints

NUMBERS = 263
# name and parent of each joint, in the order of SMPL
_TABLE = (
    ("pelvis", -1),
    ("left_hip", 0),
    ("right_hip", 0),
    ("spine1", 0),
    ("left_knee", 1),
    ("right_knee", 2),
    ("spine2", 3),
    ("left_ankle", 4),
    ("right_ankle", 5),
    ("spine3", 6),
    ("left_foot", 7),
    ("right_foot", 8),
    ("neck", 9),
    ("left_collar", 9),
    ("right_collar", 9),
    ("head", 12),
    ("left_shoulder", 13),
    ("right_shoulder", 14),
    ("left_elbow", 16),
    ("right_elbow", 17),
    ("left_wrist", 18),
    ("right_wrist", 19),
)
HUMANML = Skeleton(tuple(name for name, _ in _TABLE), tuple(parent for _, parent in _TABLE))
# the joints that both skeletons have: the course's name, theirs
SAME = {
    "Hips": "pelvis",
    "LeftUpLeg": "left_hip",
    "LeftLeg": "left_knee",
    "LeftFoot": "left_ankle",
    "LeftToeBase": "left_foot",
    "RightUpLeg": "right_hip",
    "RightLeg": "right_knee",
    "RightFoot": "right_ankle",
    "RightToeBase": "right_foot",
    "Spine": "spine1",
    "Spine1": "spine2",
    "Neck1": "neck",
    "Head": "head",
    "LeftArm": "left_shoulder",
    "LeftForeArm": "left_elbow",
    "LeftHand": "left_wrist",
    "RightArm": "right_shoulder",
    "RightForeArm": "right_elbow",
    "RightHand": "right_wrist",
}
_OURS = [joint_index(name) for name in SAME]
_THEIRS = [HUMANML.index(name) for name in SAME.values()]
# the bone from the wrist to the fingers, compared with the forearm, in the course's figure
FINGERS = float(BONE_LENGTHS[15] / BONE_LENGTHS[14])
CHEST = 0.2  # place of spine3 between spine2 and the neck: a guess

LEGS = ((1, 4), (2, 5), (4, 7), (5, 8))  # thighs and shanks
LEG_BONE = (0.2, 0.7)  # metres, child to giant
UNSTEADY = 0.3  # a bone that changes its length by this fraction is no bone
MOVES = 0.01  # metres a frame: the root moves, so that its two velocities can be compared
BATCH = "these are several motions; save each one by itself: numpy.save('one.npy', x[0])"
# a dictionary in a .npy, as motion diffusion models write it
RESULTS = (
    "it contains Python objects, which can run code. If you trust it, take a motion out of it: "
    "numpy.save('one.npy', numpy.load({name!r}, allow_pickle=True).item()['motion'][0])"
)
# bodies whose first 22 joints are these: HumanML3D, SMPL, SMPL-H, SMPL-X without and with landmarks
SMPL_JOINTS = {
    22: "22 joints",
    24: "SMPL",
    52: "SMPL-H",
    55: "SMPL-X",
    127: "SMPL-X",
    144: "SMPL-X",
}
# last axes of other arrays, and what they are
OTHERS = {
    (251,): "251 numbers a frame are a motion of KIT-ML, which has 21 joints and 12.5 frames/s",
    (34,): "34 normalised features a frame, without joints",
    (17, 3): "17 joints are COCO keypoints, as AIST++ has them",
    (21, 3): (
        "21 joints are those of KIT-ML or of the course. If they are the course's, in metres, save "
        "them with numpy.savez('walk.npz', positions=x, fps=20)"
    ),
    (66,): "66 numbers a frame may be 22 joints in one row: save x.reshape(-1, 22, 3)",
}


def to_course(joints: Float[np.ndarray, "T 22 3"]) -> Float[np.ndarray, "T 21 3"]:
    """The course's 21 joints of a figure with the 22 joints of HumanML3D.

    19 joints stay where they are, so the bones between them keep their lengths. Spine and Spine1
    are spine1 and spine2. The collars and spine3 are dropped: the course's arms begin at the neck.
    The hand tips are a guess: they extend the forearms by 0.36 of their length.
    """
    course = np.empty((len(joints), J, 3), joints.dtype)
    course[:, _OURS] = joints[:, _THEIRS]
    for side in ("Left", "Right"):
        tip, hand, elbow = (joint_index(side + n) for n in ("HandIndex1", "Hand", "ForeArm"))
        course[:, tip] = course[:, hand] + FINGERS * (course[:, hand] - course[:, elbow])
    return course


def from_course(positions: Float[np.ndarray, "T 21 3"]) -> Float[np.ndarray, "T 22 3"]:
    """The 22 joints of HumanML3D of a figure with the course's 21 joints.

    19 joints stay where they are; the hand tips are dropped. Three joints are a guess: spine3 is a
    fifth of the way from Spine1 to the neck, and a collar is the mean of spine3, neck and shoulder.
    """
    joints = np.empty((len(positions), len(HUMANML), 3), positions.dtype)
    joints[:, _THEIRS] = positions[:, _OURS]
    middle, chest, neck = (HUMANML.index(name) for name in ("spine2", "spine3", "neck"))
    joints[:, chest] = joints[:, middle] + CHEST * (joints[:, neck] - joints[:, middle])
    for side in ("left", "right"):
        collar, shoulder = (HUMANML.index(f"{side}_{name}") for name in ("collar", "shoulder"))
        joints[:, collar] = joints[:, [chest, neck, shoulder]].mean(1)
    return joints


def joints_of(
    vectors: Float[np.ndarray, "T 263"], name: str = "the array"
) -> Float[np.ndarray, "T 22 3"]:
    """World positions (metres) of the 22 joints; the root begins at x = z = 0, facing z.

    heading[t] = -2 (v[0] + ... + v[t-1]), where v is column 0. The root's moves are turned by the
    heading of the frame they lead to, and added up likewise.
    Raises MotionError as `check_vectors` does.
    """
    check_vectors(vectors, name)
    numbers = vectors.astype(np.float64)
    before = np.concatenate([np.zeros((1, 3)), numbers[:-1, :3]])  # the moves into each frame
    forward, left = forward_left(-2 * np.cumsum(before[:, 0]))
    place = np.cumsum(before[:, 1:2] * left + before[:, 2:3] * forward, axis=0)
    others = numbers[:, 4:67].reshape(-1, 21, 3)
    ground = others[..., :1] * left[:, None] + others[..., 2:] * forward[:, None] + place[:, None]
    joints = np.empty((len(numbers), len(HUMANML), 3))
    joints[:, 0] = np.stack([place[:, 0], numbers[:, 3], place[:, 1]], -1)
    joints[:, 1:] = np.stack([ground[..., 0], others[..., 1], ground[..., 1]], -1)
    return joints


@dataclass(frozen=True, eq=False)
class Statistics:
    """Mean and standard deviation of the 263 numbers.

    Two pairs are published. Mean.npy and Std.npy of the data set are for training. Those of the
    evaluator, the network behind the published measures, have deviations 25 times smaller for the
    root and the contacts. An array must be undone with the pair that it was made with.
    Raises MotionError for another shape, for NaN, and for a deviation that is not above 0.
    """

    mean: Float[np.ndarray, "263"]
    std: Float[np.ndarray, "263"]

    def __post_init__(self):
        for name in ("mean", "std"):
            array = _row(getattr(self, name), name)
            if not np.isfinite(array).all() or (name == "std" and not (array > 0).all()):
                raise MotionError(f"{name} contains NaN or, as a deviation, a number not above 0")
            object.__setattr__(self, name, array)

    @property
    def kind(self) -> str:
        """Whose statistics these are: "data set" or "evaluator".

        The contacts are 0 or 1, so with mean m their deviation is about sqrt(m (1 - m)); the
        evaluator's is 25 times smaller. Raises MotionError if neither fits.
        """
        m = self.mean[259:]
        if (m > 0).all() and (m < 1).all():
            size = float((self.std[259:] / np.sqrt(m * (1 - m))).mean())
            if 0.5 < size < 2:
                return "data set"
            if 0.5 < 25 * size < 2:
                return "evaluator"
        raise MotionError(
            "these are neither the statistics of HumanML3D nor those of its evaluator: the "
            "contacts (columns 259 to 262) do not fit. Are mean and std exchanged?"
        )


def read_statistics(mean: str | Path, std: str | Path) -> Statistics:
    """The statistics in two files, such as Mean.npy and Std.npy; `kind` says whose they are.

    Raises FileNotFoundError, and MotionError for files that contain something else.
    """
    rows = [_row(load_array(path), Path(path).name) for path in (mean, std)]
    return Statistics(*rows)


def _row(array: np.ndarray, name: str) -> Float[np.ndarray, "263"]:
    """The array in float64.  Raises MotionError unless it is a row of 263 numbers."""
    if array.shape != (NUMBERS,) or array.dtype.kind != "f":
        raise MotionError(
            f"{name} has shape {array.shape} and type {array.dtype}; the statistics of HumanML3D "
            f"are {NUMBERS} floating-point numbers"
        )
    return array.astype(np.float64)


def unstandardise(
    vectors: Float[np.ndarray, "T 263"], statistics: Statistics, name: str = "the array"
) -> Float[np.ndarray, "T 263"]:
    """The numbers of a standardised array: vectors * std + mean.

    Raises MotionError if the result is no motion, as with the wrong statistics.
    """
    check_shape(vectors, name)
    numbers = vectors * statistics.std + statistics.mean
    check_vectors(numbers, name)
    return numbers


def check_shape(vectors: np.ndarray, name: str = "the array") -> None:
    """Raise MotionError unless these are rows of 263 numbers without NaN."""
    if vectors.ndim != 2 or vectors.shape[1] != NUMBERS or not len(vectors):
        raise MotionError(f"{name} {describe_array(vectors)}")
    check_numbers(vectors, name)


def check_vectors(vectors: np.ndarray, name: str = "the array") -> None:
    """Raise MotionError unless these are the 263 numbers of a figure in metres.

    A standardised array has no legs of constant length. Two things betray numbers undone with the
    wrong statistics. No contact is 0 or 1. And the root moves at another speed in columns 1:3 than
    in columns 193:196, which say the same.
    """
    check_shape(vectors, name)
    others = vectors[:, 4:67].astype(np.float64).reshape(-1, 21, 3)
    bones = np.stack([others[:, low - 1] - others[:, high - 1] for high, low in LEGS], 1)
    lengths = np.linalg.norm(bones, axis=-1)
    usual = np.median(lengths, axis=0)
    spread = np.ptp(np.percentile(lengths, [10, 90], axis=0), axis=0)
    if not ((usual > LEG_BONE[0]) & (usual < LEG_BONE[1]) & (spread < UNSTEADY * usual)).all():
        raise MotionError(
            f"{name} is no figure in metres: its thighs and shanks are {_listed(usual)} m long and "
            f"vary by {_listed(spread)} m. The numbers are probably standardised; undo that with "
            f"the mean and std that they were made with: humanml3d.unstandardise(vectors, "
            f"humanml3d.read_statistics('Mean.npy', 'Std.npy'))"
        )
    size = scale_of_root(vectors)
    if size != "right":
        used, needed = ("evaluator", "data set") if size == "small" else ("data set", "evaluator")
        raise MotionError(
            f"{name}: the joints are right, but the motion of the root and the contacts are too "
            f"{size}. A standardised array was probably undone with the statistics of the {used}; "
            f"use those of the {needed}"
        )


def scale_of_root(vectors: Float[np.ndarray, "T 263"]) -> str:
    """Whether the root's motion and the contacts are "right", too "small" or too "large"."""
    contacts = vectors[:, 259:]
    if np.minimum(np.abs(contacts), np.abs(contacts - 1)).min() > 0.05:
        return "small" if (contacts > 0).all() and (contacts < 1).all() else "large"
    root = float(np.linalg.norm(vectors[:, 1:3], axis=1).mean())
    same = float(np.linalg.norm(vectors[:, [193, 195]], axis=1).mean())
    if max(root, same) < MOVES or same / 3 < root < 3 * same:
        return "right"
    return "small" if root < same else "large"


def check_numbers(array: np.ndarray, name: str) -> None:
    """Raise MotionError unless these are floating-point numbers without NaN and infinity."""
    if array.dtype.kind != "f":
        raise MotionError(f"{name} contains {array.dtype} and not floating-point numbers")
    broken = np.flatnonzero(~np.isfinite(array).reshape(len(array), -1).all(1))
    if len(broken):
        raise MotionError(
            f"{name}: {len(broken)} of {len(array)} frames contain NaN or infinity, first frame "
            f"{broken[0]}. Leave this file out, or cut these frames"
        )


def describe_array(array: np.ndarray) -> str:
    """What an array holds that is no motion of HumanML3D, and what to do."""
    shape = array.shape
    if shape == (NUMBERS,):
        what = "263 numbers in one row are one frame, or statistics such as Mean.npy: no motion"
    elif array.ndim == 3 and shape[2] == NUMBERS:
        what = BATCH
    elif array.ndim == 4 and (shape[1:3] == (NUMBERS, 1) or first_22(array[0]) is not None):
        what = BATCH
    else:
        fits = [words for axes, words in OTHERS.items() if shape[1:] == axes]
        what = "".join(fits) or "this is none of the arrays of HumanML3D"
    return (
        f"has shape {shape}; a motion of HumanML3D has (frames, {NUMBERS}) or (frames, 22, 3), "
        f"and at least one frame: {what}"
    )


def _listed(metres: np.ndarray) -> str:
    return ", ".join(f"{x:.2f}" for x in metres)


def load_array(path: str | Path) -> np.ndarray:
    """The array in a .npy file; a file with Python objects is not opened.

    Raises FileNotFoundError, and MotionError for another file or a damaged one.
    """
    path = home(path)
    check_there(path)
    try:
        with path.open("rb") as file:
            begins = file.read(6)
            if begins != b"\x93NUMPY":
                raise MotionError(f"{path.name} is no .npy file, whatever its name says")
            file.seek(0)
            check_header(file, path.name)
        return np.load(path, allow_pickle=False)
    except MotionError:
        raise
    except Exception as error:  # a damaged file may raise anything
        reason = "the file is damaged or cut off; copy it again"
        if "object" in str(error).lower():
            reason = RESULTS.format(name=path.name)
        raise MotionError(f"{path.name} cannot be read as npy: {reason}") from None


def joints_in(path: Path) -> tuple[Float[np.ndarray, "T 22 3"], str]:
    """The 22 joints in a .npy file, and in words what the file holds.

    Raises MotionError for another array.
    """
    array = load_array(path)
    if array.ndim == 2 and array.shape[1] == NUMBERS and len(array):
        check_numbers(array, path.name)
        return joints_of(array, path.name), f"HumanML3D, {NUMBERS} numbers a frame"
    joints = first_22(array)
    if joints is None:
        raise MotionError(f"{path.name} {describe_array(array)}")
    check_numbers(joints, path.name)
    body = SMPL_JOINTS.get(array.shape[-2], "22 joints")
    return joints.astype(np.float64), body if body != "22 joints" else "HumanML3D, 22 joints"


def first_22(array: np.ndarray) -> np.ndarray | None:
    """The joints (T, 22, 3) in an array of SMPL's joints, or None for another one.

    Its axes are frames, joints, x y z, or joints, x y z, frames as motion diffusion models write
    them; an axis of length 1 may stand before them.
    """
    if array.ndim == 4 and len(array) == 1:
        array = array[0]
    if array.ndim != 3:
        return None
    if array.shape[1] == 3 and array.shape[0] in SMPL_JOINTS and array.shape[2] > 3:
        array = array.transpose(2, 0, 1)
    if array.shape[1] not in SMPL_JOINTS or array.shape[2] != 3 or not len(array):
        return None
    return array[:, : len(HUMANML)]


def motion_of_smpl(
    array: np.ndarray, fps: float, name: str, source: str, up: str = "", unit: str = ""
) -> Motion | None:
    """A motion of SMPL's joints, however many there are; None for another array.

    Raises MotionError for what is not finite, or no figure.
    """
    joints = first_22(array)
    if joints is None:
        return None
    check_numbers(joints, name)
    return mended_joints(
        Motion(to_course(joints.astype(np.float64)), fps, source=source), name, up, unit
    )


@registry.readers.register(".npy")
def read_humanml3d(path: str | Path, up: str = "", unit: str = "") -> Motion:
    """A file of HumanML3D's folder new_joint_vecs or new_joints as a Motion of 20 frames/s.

    The figure keeps the bone lengths of the file; `retarget.onto_our_bones` gives it the course's.
    up, unit   as in `read_motion`
    Raises MotionError for another file. Issues a MotionWarning for what is mended or doubtful.
    """
    path = Path(path)
    joints, what = joints_in(path)
    motion = Motion(to_course(joints), FPS, source=f"{path.stem} ({what})")
    return mended_joints(motion, path.name, up, unit)
