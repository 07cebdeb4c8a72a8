"""Dances from AIST++: keypoints3d pickles, read without running code that a pickle may contain.

A pickle is a program; unpickling a file from a stranger runs it. Here a pickle may name only five
things: the numpy array, its dtype, the two functions that build an array, and the one that spells
bytes. They only collect what the array is made of, and numpy makes it when all is checked. Every
other name raises an error. The result is in metres, at 60 frames/s, with y up and the floor at 0.
"""

import io
import math
import pickle
import pickletools
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from ..._files import home
from ..arguments import too_many_frames

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
MOST_STEPS = 5_000  # of a pickle; one of arrays has some dozens
MOST_AGAIN = 10  # tuples that a pickle uses once more; one of arrays uses none
FARTHEST = 1e6  # centimetres: ten kilometres
FLOOR_PERCENTILE = 1.0


class AistError(ValueError):
    """The file is not an AIST++ keypoints file, or not a safe one.

    The message says what the file is and what to do.
    """


@dataclass(frozen=True, eq=False)
class Keypoints:
    """A recorded dance: 17 joints (`COCO`) in metres at 60 frames/s, the floor at y = 0.

    `floor` is the height in metres that was subtracted. A missing joint stays NaN.
    """

    positions: Float[np.ndarray, "T 17 3"]
    floor: float
    source: str
    fps: float = AIST_FPS


def read_keypoints(path: str | Path) -> Keypoints:
    """Read keypoints3d_optim of a keypoints3d pickle of AIST++; keypoints3d beside it has gaps.

    The floor is the 1st percentile over frames of the lowest joint. COCO has no toes, so the ankles
    of a standing figure come to height 0. One bad frame does not lower the floor.
    Raises AistError for any other file: other pickles (reading stops at the first foreign name),
    .npy features, other shapes. Raises FileNotFoundError for a missing file.
    """
    path = home(path)
    if path.is_dir():
        raise AistError(f"{path.name}: this is a folder; give one of the .pkl files in it.")
    content = _load(path)
    key = "keypoints3d_optim"
    cm = _array(content, key, path.name)
    known = np.isfinite(cm).all((1, 2))
    if not known.any():
        raise AistError(f"{path.name}: every frame of {key} has a missing joint.")
    positions = cm / 100.0
    floor = float(np.percentile(positions[known][..., 1].min(1), FLOOR_PERCENTILE))
    return Keypoints(positions - [0.0, floor, 0.0], floor, path.name)


def full_pose(path: Path) -> np.ndarray | None:
    """The positions (T, 24, 3) of SMPL's joints in a pickle of EDGE, or None for another file."""
    content = _load(path)
    found = content.get("full_pose") if isinstance(content, dict) else None
    return found.made() if isinstance(found, _Array) else None


def _short(value: object) -> str:
    """A value of a file in a message: a text, or else its type, for it may be endless to print."""
    return repr(value[:20]) if isinstance(value, str) else type(value).__name__


def _named(key: object) -> str:
    return key[:80] if isinstance(key, str) else _short(key)


class _Step:
    """A function that a pickle may call and cannot change."""

    __slots__ = ("function",)

    def __init__(self, function: Callable):
        self.function = function

    def __call__(self, *arguments):
        return self.function(*arguments)

    def __setstate__(self, state):
        raise AistError("it changes a function, which an array does not need")


class _Numbers:
    """A dtype as a pickle spells it: kind and bytes of a number, and later their order."""

    def __init__(self, code, *how):
        if not (isinstance(code, str) and re.fullmatch(r"[fiub][1248]", code)):
            raise AistError(f"it has an array of {_short(code)}, not of numbers")
        self.code = code

    def __setstate__(self, state):
        order = state[1]
        if order not in ("<", ">", "|", "="):
            raise AistError(f"it has numbers with the byte order {_short(order)}")
        self.code = order + self.code


class _Array:
    """An array as a pickle spells it. numpy makes it at the end, from checked parts.

    numpy itself must not be called by a pickle: told to read bytes as objects, it would follow
    addresses that the file made up.
    """

    def __init__(self, *placeholder):
        self.parts = None

    @classmethod
    def from_buffer(cls, raw, dtype, shape, order="C") -> "_Array":
        made = cls()
        made.__setstate__((1, shape, dtype, order == "F", raw))
        return made

    def __setstate__(self, state):
        _, shape, dtype, fortran, raw = state
        self.parts = shape, dtype, fortran, raw

    def made(self) -> np.ndarray:
        shape, dtype, fortran, raw = self.parts or ((), None, False, b"")
        if isinstance(raw, str):  # Python 2
            raw = raw.encode("latin1")
        whole = isinstance(shape, tuple) and all(type(n) is int and n >= 0 for n in shape)
        if not (whole and isinstance(dtype, _Numbers) and isinstance(raw, bytes | bytearray)):
            raise AistError("it has an array that is not made of a shape and of numbers")
        if words := too_many_frames(max(shape, default=0)):
            raise AistError(f"it has an array of {words}")
        numbers = np.dtype(dtype.code)
        if math.prod(shape) * numbers.itemsize != len(raw):
            raise AistError(f"it has an array whose shape does not fit its {len(raw)} bytes")
        return np.frombuffer(raw, numbers).reshape(shape, order="F" if fortran else "C")


def _encode(text: object, encoding: object) -> bytes:
    """Replaces `_codecs.encode`, which pickles of Python 2 use for their bytes."""
    if encoding not in ("latin1", "latin-1"):
        raise AistError(f"it uses the codec {_short(encoding)}, and only latin1 is needed")
    if not isinstance(text, str):
        raise AistError(f"it encodes {_short(text)}, which is no text")
    return text.encode("latin1")


_ADMITTED: dict[tuple[str, str], Callable] = {
    ("numpy", "ndarray"): _Array,
    ("numpy", "dtype"): _Numbers,
    ("_codecs", "encode"): _encode,
}
for _numpy in ("numpy.core", "numpy._core"):  # before and since numpy 2
    _ADMITTED[f"{_numpy}.multiarray", "_reconstruct"] = _Array
    _ADMITTED[f"{_numpy}.numeric", "_frombuffer"] = _Array.from_buffer


class _Restricted(pickle.Unpickler):
    """An unpickler that finds only the names that an array needs, and our own code behind them."""

    def find_class(self, module: str, name: str):
        if (module, name) not in _ADMITTED:
            raise AistError(
                f"it names {module}.{name}, which an array does not need: "
                "such a file may run a program"
            )
        return _Step(_ADMITTED[module, name])


def _check_cost(raw: bytes) -> None:
    """Raise AistError for a pickle that takes more memory or time than arrays do.

    A few bytes can ask for billions of places in the memo, and tuples within tuples, each one there
    twice, take for ever where their hash is needed.
    """
    memo, tuples = set(), set()
    place, again = 0, 0
    before = ""
    number: Any
    for k, (op, number, _) in enumerate(pickletools.genops(raw)):
        if op.name in ("PUT", "BINPUT", "LONG_BINPUT", "MEMOIZE"):
            place = len(memo) if op.name == "MEMOIZE" else number
            memo.add(place)
            (tuples.add if "TUPLE" in before else tuples.discard)(place)
        elif op.name in ("GET", "BINGET", "LONG_BINGET", "DUP"):
            again += op.name == "DUP" or number in tuples
        if max(k, place) > MOST_STEPS or again > MOST_AGAIN:
            raise AistError("it has more parts than arrays need")
        before = op.name


def _load(path: Path):
    """The content of the file.  Raises AistError, which says what sort of file it is."""
    if path.stat().st_size > LARGEST:
        raise AistError(
            f"{path.name}: larger than {LARGEST // 1_000_000} MB, so it is not a keypoints file."
        )
    raw = path.read_bytes()
    if raw.startswith(b"\x93NUMPY"):
        raise AistError(f"{path.name}: {_describe_npy(raw)}")
    try:
        _check_cost(raw)
        return _Restricted(io.BytesIO(raw), encoding="latin1").load()
    except AistError as error:
        raise AistError(f"{path.name}: not read: {error}.") from None
    except Exception as error:  # a damaged pickle may raise anything
        raise AistError(
            f"{path.name}: not a pickle, or a damaged one ({type(error).__name__}: {error})."
        ) from None


def _describe_npy(raw: bytes) -> str:
    """What a .npy file contains, and which file to give instead."""
    wanted = "give a pickle of AIST++'s folder keypoints3d, with positions (frames, 17, 3)."
    try:
        shape = np.load(io.BytesIO(raw), allow_pickle=False).shape
    except Exception as error:  # a damaged file may raise anything
        what = "contains Python objects" if "object" in str(error).lower() else "is damaged"
        return f"a .npy file that {what}; {wanted}"
    if shape[-1:] == (34,):
        return (
            f"a .npy file of shape {shape}: 34 normalised music or motion features per frame, "
            f"without joints; {wanted}"
        )
    return f"a .npy file of shape {shape}; {wanted}"


def _array(content, key: str, name: str) -> Float[np.ndarray, "T 17 3"]:
    if not isinstance(content, dict) or key not in content:
        holds = ", ".join(map(_named, content)) if isinstance(content, dict) else ""
        holds = f"{holds:.200}" or type(content).__name__
        hint = (
            " These are joint angles: take the file of that name in keypoints3d."
            if "smpl_poses" in holds
            else ""
        )
        raise AistError(f"{name}: contains {holds}, but no {key}.{hint}")
    try:
        found = content[key].made() if isinstance(content[key], _Array) else None
    except AistError as error:
        raise AistError(f"{name}: not read: {error}.") from None
    if found is None or found.dtype.kind != "f":
        raise AistError(f"{name}: {key} is not an array of numbers.")
    if found.ndim != 3 or found.shape[1:] != (len(COCO), 3) or len(found) == 0:
        raise AistError(f"{name}: {key} has shape {found.shape}; it should be (frames, 17, 3).")
    if (np.abs(found) > FARTHEST).any():
        raise AistError(f"{name}: {key} goes ten kilometres away; it should be in centimetres.")
    return found.astype(np.float64)
