"""From the bytes of a BVH file to statements with line numbers, and to numbers.

A file that is not BVH raises an error early.
"""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...._files import home

LARGEST = 300_000_000  # bytes: an hour of a detailed skeleton at 120 frames/s is smaller
MOST_LINES = 2_000_000  # an hour at 240 frames/s has 864,000
LONGEST_NAME = 200  # letters of a joint's name
LONGEST_LINE = 1_000_000  # characters: a frame of a thousand joints has some 100,000
FARTHEST = 1e6  # the largest number: a kilometre in millimetres, or 2,777 turns in degrees
SNIFF = 65_536
BRACES = re.compile(r"([{}])")
RUN_TOGETHER = re.compile(r"\d[-+]\d*\.?\d")


class BvhError(ValueError):
    """A BVH file cannot be used; the message says where, what and what to do about it.

    Attributes: path, line (counted from 1, or None), joint (or None).
    """

    def __init__(
        self, problem: str, path: str | Path = "", line: int | None = None, joint: str | None = None
    ):
        place = [
            part
            for part in (Path(path).name, line and f"line {line}", joint and f"joint {joint[:60]}")
            if part
        ]
        super().__init__(f"{', '.join(place)}: {problem}" if place else problem)
        self.path = str(path)
        self.line = line
        self.joint = joint


@dataclass(frozen=True)
class Statement:
    """One statement of the hierarchy: a brace alone, or the words of a line between braces."""

    line: int
    text: str

    @property
    def word(self) -> str:
        return self.text.split(maxsplit=1)[0].lower()

    @property
    def rest(self) -> str:
        return self.text[len(self.word) :].strip()


def read_lines(path: str | Path) -> list[str]:
    """The lines of a BVH file, with any kind of line ends.

    Raises BvhError for a folder, an empty, binary, UTF-16 or HTML file, and for one that is too
    large, has too many lines or too long ones.
    """
    path = home(path)
    if path.is_dir():
        raise BvhError("this is a folder; give one of the .bvh files in it.", path)
    if path.stat().st_size > LARGEST:
        raise BvhError(
            f"the file is larger than {LARGEST // 1_000_000} MB; cut it into shorter takes.", path
        )
    with path.open("rb") as file:
        start = file.read(SNIFF)
        refuse_foreign(start, path)
        raw = start + file.read()
    refuse_too_many(raw, path)
    raw = raw.rstrip(b"\x1a\r\n\t ") + b"\n"  # Ctrl-Z ends a text of old programs
    lines = decode(raw).replace("\r\n", "\n").replace("\r", "\n").split("\n")
    longest = max(range(len(lines)), key=lambda index: len(lines[index]))
    if len(lines[longest]) > LONGEST_LINE:
        raise BvhError(
            f"the line has {len(lines[longest]):,} characters; write each frame on its own line.",
            path,
            longest + 1,
        )
    return lines


def refuse_too_many(raw: bytes, path: Path) -> None:
    """Raise BvhError for more lines than MOST_LINES, before they are made."""
    count = max(raw.count(b"\n"), raw.count(b"\r"))
    if count > MOST_LINES:
        raise BvhError(
            f"the file has {count:,} lines, and {MOST_LINES:,} at most are read; cut it into "
            "shorter takes, and remove blank lines.",
            path,
        )


def refuse_foreign(start: bytes, path: Path) -> None:
    """Raise BvhError when the first bytes show that this is not a BVH text file."""
    head = start.removeprefix(b"\xef\xbb\xbf").lstrip()
    if not head:
        raise BvhError("the file is empty; export or download it again.", path)
    if start[:2] in (b"\xff\xfe", b"\xfe\xff"):
        raise BvhError("the text is UTF-16; save it as UTF-8 or plain ASCII.", path, 1)
    if head[:1] == b"<":
        raise BvhError(
            "this is a web page, not a BVH file; fetch the raw file (not its preview page).",
            path,
            1,
        )
    if b"\0" in start:
        raise BvhError(
            "this is a binary file, but BVH is text that starts with HIERARCHY; "
            "export the take as BVH.",
            path,
        )
    if head.split(maxsplit=1)[0].lower() != b"hierarchy":
        shown = head[:40].decode("latin-1").split("\n")[0].strip()
        raise BvhError(
            f"a BVH file starts with HIERARCHY, but this one with '{shown}'; "
            "export the take as BVH.",
            path,
            1,
        )


def decode(raw: bytes) -> str:
    """Decode UTF-8 (without a byte-order mark), else Latin-1, which only joint names can need."""
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        return raw.decode("latin-1")


def statements(lines: list[str], path: str | Path) -> tuple[list[Statement], int]:
    """The statements of the HIERARCHY section, and the index of the line that says MOTION."""
    found = []
    for index, line in enumerate(lines):
        if line.strip().lower().rstrip(":") == "motion":
            return found, index
        pieces = (piece.strip() for piece in BRACES.split(line))
        found.extend(Statement(index + 1, piece) for piece in pieces if piece)
    last = max((index for index, line in enumerate(lines) if line.strip()), default=0)
    raise BvhError(
        "the file ends without a MOTION section; it is cut off, or contains only a skeleton.",
        path,
        last + 1,
    )


def to_number(text: str, path: str | Path, line: int, joint: str | None = None) -> float:
    """One number, finite and at most FARTHEST.  Raises BvhError, which names usual mistakes."""
    try:
        value = float(text) if "_" not in text else None
    except ValueError:
        value = None
    if value is None:
        raise BvhError(why_no_number(text), path, line, joint)
    if not np.isfinite(value):
        raise BvhError(
            f"the value '{text[:40]}' is not finite; repair the take where it was recorded.",
            path,
            line,
            joint,
        )
    if abs(value) > FARTHEST:
        raise BvhError(
            f"the value '{text[:40]}' is no angle in degrees and no place near a person (larger "
            f"than {FARTHEST:,.0f}); repair the take where it was recorded.",
            path,
            line,
            joint,
        )
    return value


def to_count(text: str) -> int | None:
    """A whole number of at most 18 digits, or None."""
    return int(text) if text.isascii() and text.isdecimal() and len(text) <= 18 else None


def why_no_number(text: str) -> str:
    """What is wrong with a word that should be a number, and what to do."""
    if re.fullmatch(r"[-+]?\d*,\d+([eE][-+]?\d+)?", text):
        return f"'{text}' has a decimal comma; export with decimal points (an English locale)."
    if RUN_TOGETHER.search(text):
        return (
            f"'{text}' looks like two numbers without a space between them; "
            "put a space before the second sign."
        )
    return (
        f"'{text[:40]}' is not a number; only numbers can stand here. "
        "Remove the comment or repair the line."
    )
