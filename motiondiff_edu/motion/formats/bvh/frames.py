"""The MOTION section of a BVH file: frame count, frame time, and one row of numbers per frame."""

from array import array
from math import isfinite
from pathlib import Path

import numpy as np
from jaxtyping import Float

from ...arguments import too_many_frames
from .tokens import FARTHEST, BvhError, to_count, to_number

SLOWEST, FASTEST = 0.5, 0.001  # s per frame; a frame time outside this range is an error
REPLACE_FPS = "pass file_fps= to md.read_motion, or --file-fps to motiondiff-edu convert"
USUAL_RATES = (24.0, 25.0, 30.0, 50.0, 60.0, 100.0, 120.0, 240.0)
EXACT_RATES = [float(n) for n in range(1, 1001)] + [n * 1000 / 1001 for n in (24, 30, 60, 120)]


def header(lines: list[str], motion: int, path: str | Path) -> tuple[int, int, str, int, int]:
    """The header of the motion section.

    Returns the declared number of frames and its line, the text of the frame time and its line, and
    the index of the first data line.
    """
    frames_at = next_filled(lines, motion + 1)
    time_at = next_filled(lines, frames_at + 1)
    frames = after_keyword(lines, frames_at, "frames", path)
    time = after_keyword(lines, time_at, "frame time", path)
    declared = to_count(frames)
    if declared is None:
        raise BvhError(
            f"'{frames[:40]}' is not a number of frames; 'Frames:' takes a whole number.",
            path,
            frames_at + 1,
        )
    return declared, frames_at + 1, time, time_at + 1, time_at + 1


def next_filled(lines: list[str], start: int) -> int:
    """Index of the first line from `start` that is not blank (or the length of the file)."""
    return next((index for index in range(start, len(lines)) if lines[index].strip()), len(lines))


def after_keyword(lines: list[str], index: int, keyword: str, path: str | Path) -> str:
    """The text after `keyword:` on a line; blanks, tabs or nothing can stand between."""
    text = " ".join(lines[index].split()) if index < len(lines) else ""
    if not text.lower().startswith(keyword):
        shown = f"'{text[:40]}'" if text else "the end of the file"
        problem = f"expected '{keyword.title()}:' after MOTION, found {shown}."
        raise BvhError(problem, path, min(index, len(lines) - 1) + 1)
    return text[len(keyword) :].strip().removeprefix(":").strip()


def frame_time(text: str, line: int, path: str | Path, file_fps: float | None) -> float:
    """Seconds per frame; `file_fps` replaces the value of the file.

    Values from 0.001 to 0.5 s are accepted. A frame time of 24 or 1 is a frame rate or a
    placeholder in the wrong field.
    """
    if file_fps is not None:
        if not 0 < file_fps < np.inf:
            raise BvhError(
                f"file_fps must be a positive number of frames a second, not {file_fps:g}.", path
            )
        if file_fps < 1 / SLOWEST:
            raise BvhError(
                f"file_fps is {file_fps:g} frames a second, and 2 at least are read. If that is "
                f"the time of a frame, pass {1 / file_fps:.6g}.",
                path,
            )
        return 1.0 / file_fps
    value = to_number(text, path, line)
    if value <= 0:
        raise BvhError(
            f"the frame time is {text[:40]} s; it must be positive. Correct it, or {REPLACE_FPS}.",
            path,
            line,
        )
    if value > SLOWEST or value < FASTEST:
        hint = (
            f" If {value:g} is the frame rate, write {1 / value:.6g}"
            if value > 1
            else " Write seconds per frame"
        )
        raise BvhError(
            f"a frame time of {text[:40]} s is not plausible; {FASTEST} to {SLOWEST} s are read."
            f"{hint}, or {REPLACE_FPS}, to replace the value of the file.",
            path,
            line,
        )
    return value


def rate(seconds: float) -> float:
    """Frames per second behind a rounded frame time: .0333 is 30, .008342 is 120000/1001.

    A usual rate is meant if its frame time is the number when rounded to as many decimals.
    """
    _, _, decimals = f"{seconds:.12f}".rstrip("0").partition(".")
    for usual in USUAL_RATES:
        if 3 <= len(decimals) < 12 and abs(1 / usual - seconds) <= 0.501 * 10.0 ** -len(decimals):
            return usual
    nearest = min(EXACT_RATES, key=lambda exact: abs(exact * seconds - 1))
    return nearest if abs(nearest * seconds - 1) < 3e-4 else 1 / seconds


def frame_rows(
    lines: list[str],
    first: int,
    declared: int,
    columns: list[tuple[str, str]],
    path: str | Path,
    declared_line: int,
) -> Float[np.ndarray, "T K"]:
    """All frames as an array (T, channels).

    A frame can be wrapped over several lines but must end where a line ends. So a missing or an
    additional number is found in the frame where it is, not at the end of the file.
    `columns` are (joint, channel) pairs. Raises BvhError.
    """
    if declared == 0:
        raise BvhError(
            "the file declares 0 frames; export it with its motion.", path, declared_line
        )
    if not columns:
        raise BvhError(
            "no joint has channels, so nothing can move; check the CHANNELS lines.",
            path,
            declared_line,
        )
    if words := too_many_frames(declared):
        raise BvhError(f"the file has {words}.", path, declared_line)
    values, counts = numbers(lines, first, columns, path)
    check_frame_ends(counts, columns, path)
    found = len(values) // len(columns)
    if found != declared:
        what = (
            "frames are missing or the file is cut off"
            if found < declared
            else "the count is wrong"
        )
        raise BvhError(
            f"'Frames: {declared}', but {found} frames follow: {what}. "
            f"If the {found} are right, write 'Frames: {found}'.",
            path,
            declared_line,
        )
    return values.reshape(declared, len(columns))


def numbers(
    lines: list[str], first: int, columns: list[tuple[str, str]], path: str | Path
) -> tuple[np.ndarray, list[tuple[int, int]]]:
    """Every number of the data block, and (line, count) of each line that has numbers."""
    values, counts = array("d"), []
    for index in range(first, len(lines)):
        words = lines[index].split()
        if words:
            values.extend(row_of(words, len(values), columns, path, index + 1))
            counts.append((index + 1, len(words)))
    return np.array(values), counts


def row_of(
    words: list[str], before: int, columns: list[tuple[str, str]], path: str | Path, line: int
) -> list[float]:
    """The words of one line as numbers; each word is checked only if one of them is bad."""
    try:
        row = list(map(float, words))
        if max(map(abs, row)) <= FARTHEST and "_" not in "".join(words) and isfinite(sum(row)):
            return row
    except ValueError:
        pass
    for position, word in enumerate(words, start=before):
        joint, channel = columns[position % len(columns)]
        to_number(word, path, line, f"{joint} ({channel})")
    return row


def check_frame_ends(
    counts: list[tuple[int, int]], columns: list[tuple[str, str]], path: str | Path
) -> None:
    """Raise BvhError unless every frame ends at the end of a line.

    A frame is a number for each of `columns`.
    """
    held = 0
    begun = 0
    width = len(columns)
    for line, count in counts:
        begun = line if held == 0 else begun
        held += count
        if held > width:
            raise BvhError(
                f"the frame that begins on line {begun} has {held} numbers, but {width} are "
                "expected; a number is missing or added, or CHANNELS does not fit the data.",
                path,
                line,
            )
        held %= width
    if held:
        raise BvhError(
            f"the last frame, begun on line {begun}, has only {held} of {width} numbers; this one "
            "is the first that is missing: the file is cut off. "
            "Fetch it again, or remove that frame and lower 'Frames:' by one.",
            path,
            counts[-1][0],
            "{} ({})".format(*columns[held]),
        )
