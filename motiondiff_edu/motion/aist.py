"""Dances from AIST++: keypoints3d pickles, read without running what a pickle may hold.

A pickle is a program; unpickling a stranger's file runs it. Here it may name four things: the numpy
array, its type, and the two functions that put an array together. Everything else is refused by
name. Centimetres become metres; 60 frames/s; y up; the floor is put to 0.
"""

import io
import pickle
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float, Int
from numpy._core import multiarray, numeric

AIST_FPS = 60.0
COCO = (
    "Nose",
    "LeftEye",
    "RightEye",
    "LeftEar",
    "RightEar",
    "LeftShoulder",
    "RightShoulder",
    "LeftElbow",
    "RightElbow",
    "LeftWrist",
    "RightWrist",
    "LeftHip",
    "RightHip",
    "LeftKnee",
    "RightKnee",
    "LeftAnkle",
    "RightAnkle",
)
LARGEST = 300_000_000  # bytes
FLOOR_PERCENTILE = 1.0


class AistError(ValueError):
    """A file is no AIST++ keypoints file, or not a safe one.

    The message says what it is and what to do.
    """


@dataclass(frozen=True, eq=False)
class Keypoints:
    """A recorded dance: 17 joints (`COCO`) in metres at 60 frames/s, the floor at y = 0.

    `floor` is the height in metres that was taken off; `nan_frames` the frames with a missing joint
    (left as NaN); `tempo` the music's beats a minute as the file's name tells, or None.
    """

    positions: Float[np.ndarray, "T 17 3"]
    floor: float
    nan_frames: Int[np.ndarray, "n"]
    tempo: float | None
    source: str
    fps: float = AIST_FPS


def read_keypoints(path: str | Path, optimised: bool = True) -> Keypoints:
    """Read a keypoints3d pickle of AIST++.

    `optimised` takes keypoints3d_optim, which has no gaps, else the raw ones.

    The floor is the 1st percentile over frames of the lowest joint: the ankles of a standing figure
    come to 0, since COCO has no toes, and one bad frame does not lower it.
    Raises AistError for anything else than such a file: other pickles (unread beyond the first
    foreign name), .npy features, other shapes; FileNotFoundError where there is none.
    """
    path = Path(path).expanduser()
    if path.is_dir():
        raise AistError(f"{path.name}: this is a folder; give one of the .pkl files in it.")
    if path.stat().st_size > LARGEST:
        raise AistError(
            f"{path.name}: larger than {LARGEST // 1_000_000} MB, and no keypoints file is."
        )
    content = _load(path)
    key = "keypoints3d_optim" if optimised else "keypoints3d"
    cm = _array(content, key, path.name)
    known = np.isfinite(cm).all((1, 2))
    if not known.any():
        raise AistError(f"{path.name}: every frame of {key} has a missing joint.")
    positions = cm / 100.0
    floor = float(np.percentile(positions[known][..., 1].min(1), FLOOR_PERCENTILE))
    return Keypoints(
        positions - [0.0, floor, 0.0], floor, np.flatnonzero(~known), tempo_of(path.name), path.name
    )


def tempo_of(name: str) -> float | None:
    """Beats a minute of the music that an AIST++ name tells: mBR2 is 80 + 10 * 2 = 100.

    House (mHO2) 110 + 5 * 2 = 120.

    None where the name has no music in it.
    """
    music = re.search(r"_m([A-Z]{2})(\d)(?:_|\.|$)", name)
    if music is None:
        return None
    start, step = (110.0, 5.0) if music[1] == "HO" else (80.0, 10.0)
    return start + step * int(music[2])


_ADMITTED = {
    ("numpy", "ndarray"): np.ndarray,
    ("numpy", "dtype"): np.dtype,
    ("_codecs", "encode"): None,
}
for _numpy in ("numpy.core", "numpy._core"):  # before and since numpy 2
    _ADMITTED[f"{_numpy}.multiarray", "_reconstruct"] = multiarray._reconstruct
    _ADMITTED[f"{_numpy}.numeric", "_frombuffer"] = numeric._frombuffer


class _Restricted(pickle.Unpickler):
    """An unpickler that finds nothing but what an array is made of."""

    def find_class(self, module: str, name: str):
        if (module, name) not in _ADMITTED:
            raise AistError(
                f"it names {module}.{name}, which an array does not need: "
                "such a file may run a program"
            )
        return _ADMITTED[module, name] or _encode


def _encode(text: str, encoding: str) -> bytes:
    """What pickles of Python 2 spell their bytes with."""
    if encoding not in ("latin1", "latin-1"):
        raise AistError(f"it asks for the codec {encoding!r}, and only latin1 is needed")
    return text.encode("latin1")


def _load(path: Path):
    """What is in the file, or an AistError that says what sort of file it is."""
    raw = path.read_bytes()
    if raw.startswith(b"\x93NUMPY"):
        raise AistError(f"{path.name}: {_told_of_npy(raw)}")
    try:
        return _Restricted(io.BytesIO(raw), encoding="latin1").load()
    except AistError as error:
        raise AistError(f"{path.name}: not read: {error}.") from None
    except Exception as error:  # a damaged pickle may raise anything
        raise AistError(
            f"{path.name}: no pickle, or a damaged one ({type(error).__name__}: {error})."
        ) from None


def _told_of_npy(raw: bytes) -> str:
    wanted = (
        "what is wanted is a pickle of AIST++'s folder keypoints3d, with positions (frames, 17, 3)."
    )
    try:
        shape = np.load(io.BytesIO(raw), allow_pickle=False).shape
    except ValueError:
        return f"a .npy file that holds Python objects; {wanted}"
    if shape[-1:] == (34,):
        return (
            f"a .npy file of shape {shape}: 34 music or motion features a frame, normalised, "
            f"and no joints; {wanted}"
        )
    return f"a .npy file of shape {shape}; {wanted}"


def _array(content, key: str, name: str) -> Float[np.ndarray, "T 17 3"]:
    if not isinstance(content, dict) or key not in content:
        holds = (
            ", ".join(map(str, content)) if isinstance(content, dict) else type(content).__name__
        )
        hint = (
            " These are joint angles: take the file of that name in keypoints3d."
            if "smpl_poses" in holds
            else ""
        )
        raise AistError(f"{name}: holds {holds}, and no {key}.{hint}")
    found = content[key]
    if not isinstance(found, np.ndarray) or found.dtype.kind != "f":
        raise AistError(f"{name}: {key} is no array of numbers.")
    if found.ndim != 3 or found.shape[1:] != (len(COCO), 3) or len(found) == 0:
        raise AistError(f"{name}: {key} has shape {found.shape}, and should have (frames, 17, 3).")
    return found.astype(np.float64)
