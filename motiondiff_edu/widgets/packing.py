"""Motion as bytes for the browser.

Joints relative to the root as int16 at 1/2048 m, the root's path as float32.

World positions as int16 would overflow on a long walk; relative ones reach 16 m from the hips,
which is enough for any body.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from os import PathLike

import numpy as np
from jaxtyping import Bool, Float

from ..motion.skeleton import JOINTS

UNITS_PER_METRE = 2048
REACH = 32767 / UNITS_PER_METRE  # 15.9995 m
FARTHEST = 10_000.0  # metres from the origin: there, float32 is half a millimetre


@dataclass(frozen=True)
class Packed:
    """Little-endian bytes of several figures, one after the other, each (frames, joints, 3)."""

    joints: bytes  # int16, relative to joint 0 of the same frame
    roots: bytes  # float32, (frames, 3): joint 0
    frames: tuple[int, ...]
    joint_count: int


def _joint_name(j: int, count: int) -> str:
    return f"joint {j} ({JOINTS[j]})" if count == len(JOINTS) else f"joint {j}"


def _where(bad: Bool[np.ndarray, "T J"], figure: int) -> str:
    frame, joint = (int(v) for v in np.argwhere(bad)[0])
    return f"figure {figure}, frame {frame}, {_joint_name(joint, bad.shape[1])}"


def _relative_units(positions: Float[np.ndarray, "T J 3"]) -> Float[np.ndarray, "T J 3"]:
    return np.rint((positions - positions[:, :1]) * UNITS_PER_METRE)


def check_positions(positions: Float[np.ndarray, "T J 3"], figure: int = 0) -> None:
    """Raise ValueError if a position is not finite or too far from the root.

    The message names figure, frame and joint.
    """
    if not len(positions):
        raise ValueError(f"figure {figure} has no frames")
    bad = ~np.isfinite(positions).all(-1)
    if bad.any():
        raise ValueError(
            f"{_where(bad, figure)}: the position is not finite ({int(bad.sum())} joints in all). "
            "Check where the motion was computed; a diverged rollout is the usual cause"
        )
    far = (np.abs(_relative_units(positions)) > 32767).any(-1)
    if far.any():
        raise ValueError(
            f"{_where(far, figure)}: more than {REACH:.0f} m from joint 0. "
            "Positions must be in metres: are these cm?"
        )
    away = (np.abs(positions) > FARTHEST).any(-1)
    if away.any():
        raise ValueError(
            f"{_where(away, figure)}: more than {FARTHEST:,.0f} m from the origin. Positions must "
            "be in metres; subtract the place where the motion begins"
        )


def as_figures(positions: object) -> list[Float[np.ndarray, "T J 3"]]:
    """One or several motions as float64 arrays.

    One motion (T, J, 3), a batch (N, T, J, 3) or a sequence of motions, arrays or tensors.
    Raises ValueError for anything else; a file's name is to be read first.
    """
    if isinstance(positions, str | PathLike):
        raise ValueError(f"{str(positions)!r} is a file's name: md.play(md.read_motion(...))")
    if isinstance(positions, Sequence):
        figures = [_numbers(p) for p in positions]
    else:
        array = _numbers(positions)
        figures = list(array) if array.ndim == 4 else [array]
    if not figures:
        raise ValueError("no figure given")
    for i, figure in enumerate(figures):
        if figure.ndim != 3 or figure.shape[-1] != 3:
            raise ValueError(
                f"figure {i} has shape {figure.shape}; it must be (frames, joints, 3) in metres"
            )
    if len({figure.shape[1] for figure in figures}) > 1:
        raise ValueError(
            f"figures have different numbers of joints: {[figure.shape[1] for figure in figures]}"
        )
    return figures


def _numbers(positions: object) -> np.ndarray:
    """An array of real numbers, float64."""
    try:
        array = np.asarray(positions)
        if np.iscomplexobj(array):
            raise TypeError("they are complex")
        return array.astype(np.float64)
    except (TypeError, ValueError) as error:
        what = type(positions).__name__
        raise ValueError(f"positions must be numbers in metres, not {what} ({error})") from None


def pack(figures: Sequence[Float[np.ndarray, "_ J 3"]]) -> Packed:
    """Pack figures; positions are never clipped.  Raises ValueError as `check_positions` does.

    Stored joints are within 1/4096 m (0.24 mm) of the given ones, plus the rounding of the root to
    float32.
    """
    joints, roots = [], []
    for i, positions in enumerate(figures):
        check_positions(positions, i)
        root = positions[:, 0].astype("<f4")
        joints.append(_relative_units(positions).astype("<i2").tobytes())
        roots.append(root.tobytes())
    frames = tuple(len(f) for f in figures)
    return Packed(b"".join(joints), b"".join(roots), frames, figures[0].shape[1])


def unpack(packed: Packed) -> list[Float[np.ndarray, "_ J 3"]]:
    """Unpack the positions, as the browser does."""
    joints = (
        np.frombuffer(packed.joints, "<i2").reshape(-1, packed.joint_count, 3) / UNITS_PER_METRE
    )
    whole = joints + np.frombuffer(packed.roots, "<f4").reshape(-1, 1, 3)
    return np.split(whole, np.cumsum(packed.frames)[:-1])


def as_contacts(contacts: object, frames: Sequence[int]) -> list[Bool[np.ndarray, "_ 2"] | None]:
    """For each figure (T, 2) bool (left, right planted) or None, after a check of its frames."""
    given = (
        list(contacts)
        if isinstance(contacts, Sequence)
        else [contacts] + [None] * (len(frames) - 1)
    )
    if len(given) != len(frames):
        raise ValueError(f"{len(given)} contact arrays for {len(frames)} figures")
    out = [None if c is None else np.asarray(c, dtype=bool) for c in given]
    for i, (c, n) in enumerate(zip(out, frames, strict=True)):
        if c is not None and c.shape != (n, 2):
            raise ValueError(
                f"contacts of figure {i} have shape {c.shape}; they must be ({n}, 2): left, right"
            )
    return out


def pack_contacts(
    contacts: Sequence[Bool[np.ndarray, "_ 2"] | None], frames: Sequence[int]
) -> bytes:
    """One byte per frame: 1 for left, 2 for right, 3 for both planted; 0 for none or unknown."""
    codes = [
        np.zeros(n, np.uint8) if c is None else (c[:, 0] + 2 * c[:, 1]).astype(np.uint8)
        for c, n in zip(contacts, frames, strict=True)
    ]
    return np.concatenate(codes).tobytes()


def per_figure(value: object, count: int, name: str) -> list:
    """A list with one value for each figure, from such a list or a single value."""
    values = list(value) if isinstance(value, list | tuple) else [value] * count
    if len(values) != count:
        raise ValueError(f"{len(values)} values of `{name}` for {count} figures")
    return values
