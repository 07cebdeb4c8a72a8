"""A folder of HumanML3D: motions with the captions that describe them.

    for name, motion, captions in read_clips("HumanML3D", "train"):
        print(name, motion.seconds, captions[0].text)
The folder holds new_joint_vecs or new_joints (000021.npy ...), texts (000021.txt ...), and lists of
names (train.txt, val.txt, test.txt). A name that begins with M is the mirrored clip: M000021 is
000021 with left and right exchanged, in the motion and in its captions.
Source: HumanML3D (Guo and others, 2022).
"""

import math
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from ..._files import home
from ..arguments import check_there
from ..motion import Motion, MotionError, MotionWarning
from ..root_frame import FPS
from .humanml3d import joints_in, to_course

MOTIONS = ("new_joint_vecs", "new_joints")
LISTED = 3  # names of missing files in a warning


class Caption(NamedTuple):
    """One description; `span` is the part it describes (seconds), or None for the whole clip.

    `tokens` are words in their basic form with their part of speech: ("walk", "VERB").
    """

    text: str
    tokens: tuple[tuple[str, str], ...]
    span: tuple[float, float] | None


class Described(NamedTuple):
    """A motion at 20 frames/s, and the captions that describe all of it."""

    name: str
    motion: Motion
    captions: tuple[Caption, ...]


def read_captions(path: str | Path) -> list[Caption]:
    """The captions of a text file, one a line: caption#tokens#start#end, times in seconds.

    0.0#0.0 means the whole clip; so does nan, which some files contain.
    Raises FileNotFoundError, and MotionError with file and line.
    """
    path = home(path)
    captions = []
    for number, line in enumerate(_lines_of(path), 1):
        if not line.strip():
            continue
        try:
            captions.append(_caption(line.strip()))
        except ValueError as error:
            raise MotionError(f"{path.name}, line {number}: {error}") from None
    if not captions:
        raise MotionError(f"{path.name} contains no caption")
    return captions


def _caption(line: str) -> Caption:
    """One line of a text file.  Raises ValueError."""
    fields = line.rsplit("#", 3)
    if len(fields) != 4:
        raise ValueError(f"{line[:60]!r} is not of the form caption#tokens#start#end")
    text, tokens, *times = fields
    if not text.strip():
        raise ValueError("the caption is empty")
    words = []
    for token in tokens.split():
        word, slash, tag = token.rpartition("/")
        if not slash or not word or not tag:
            raise ValueError(f"the token {token!r} is not of the form word/TAG, such as walk/VERB")
        words.append((word, tag))
    return Caption(text.strip(), tuple(words), _span(*times))


def _span(first: str, last: str) -> tuple[float, float] | None:
    try:
        start, end = float(first), float(last)
    except ValueError:
        raise ValueError(f"start and end must be seconds, not {first!r} and {last!r}") from None
    if math.isnan(start) or math.isnan(end) or start == end == 0:
        return None
    if not 0 <= start < end < math.inf:
        raise ValueError(f"a span must begin at 0 or later and then end, not {start:g} to {end:g}")
    return start, end


def _lines_of(path: Path) -> list[str]:
    """The lines of a text.  Raises FileNotFoundError, and MotionError for what is no text."""
    check_there(path)
    try:
        return path.read_text(encoding="utf-8").splitlines()
    except (UnicodeDecodeError, OSError) as error:
        raise MotionError(f"{path.name} cannot be read as text in UTF-8: {error}") from None


def split_names(path: str | Path) -> list[str]:
    """The names of clips in a list such as train.txt, one a line.

    Raises FileNotFoundError, and MotionError with the line for what is no name.
    """
    path = home(path)
    names = []
    for number, line in enumerate(_lines_of(path), 1):
        name = line.strip()
        if not name:
            continue
        if not name.isalnum():
            raise MotionError(f"{path.name}, line {number}: {name[:40]!r} is no name of a clip")
        names.append(name)
    return names


def read_clips(
    folder: str | Path, split: str | None = None, *, mirrored: bool = True
) -> Iterator[Described]:
    """The motions of a folder of HumanML3D, one after the other, with their captions.

    split      "train", "val", "test" ...: the list of names of that name; None reads every file
    mirrored   False leaves out the clips whose names begin with M

    A caption with a span comes with that part of the motion; captions with the same span come
    together. Frames are those from int(20 start) to int(20 end) - 1.
    Clips without motion or text are skipped, and counted in a MotionWarning at the end. Faulty
    files are skipped too, each with a MotionWarning.
    Raises FileNotFoundError for a missing folder or list, and MotionError for a folder without
    motions or texts, before the first clip is read.
    """
    folder = home(folder)
    check_there(folder)
    places = [folder / name for name in MOTIONS if (folder / name).is_dir()]
    texts = folder / "texts"
    if not places or not texts.is_dir():
        raise MotionError(
            f"{folder} is no folder of HumanML3D: it needs a folder {' or '.join(MOTIONS)}, and a "
            f"folder texts"
        )
    if split is None:
        names = sorted({path.stem for place in places for path in place.glob("*.npy")})
    else:
        names = split_names(folder / f"{split}.txt")
    wanted = [name for name in names if mirrored or not name.startswith("M")]  # as in M000021
    return _clips(places, texts, wanted)


def _clips(places: list[Path], texts: Path, names: list[str]) -> Iterator[Described]:
    motionless, wordless = [], []
    for name in names:
        files = [place / f"{name}.npy" for place in places]
        file = next((path for path in files if path.is_file()), None)
        if file is None:
            motionless.append(name)
        elif not (texts / f"{name}.txt").is_file():
            wordless.append(name)
        else:
            yield from _described(name, file, texts / f"{name}.txt")
    _tell_missing(motionless, wordless, len(names))


def _described(name: str, file: Path, text: Path) -> Iterator[Described]:
    """The parts of one clip that have captions; nothing, with a warning, if a file is faulty."""
    try:
        captions = read_captions(text)
        motion = Motion(to_course(joints_in(file)[0]), FPS, source=name)
    except MotionError as error:
        warnings.warn(f"{name} is skipped: {error}", MotionWarning, stacklevel=2)
        return
    parts: dict[tuple[float, float] | None, list[Caption]] = {}
    for caption in captions:
        parts.setdefault(caption.span, []).append(caption)
    for span, together in parts.items():
        first, last = frames_of(span, len(motion))
        if last > first:
            yield Described(name, motion[first:last], tuple(together))
        elif span:
            warnings.warn(
                f"{text.name}: no frame lies between {span[0]:g} and {span[1]:g} s of a motion of "
                f"{motion.seconds:.2f} s; {together[0].text[:40]!r} is skipped",
                MotionWarning,
                stacklevel=2,
            )


def frames_of(span: tuple[float, float] | None, count: int) -> tuple[int, int]:
    """The first frame of a span (seconds) and the one after its last, of `count` at 20 a second.

    As the data set counts them: fractions of a frame are dropped.
    """
    if span is None:
        return 0, count
    first, last = (int(seconds * FPS) for seconds in span)
    return first, min(last, count)


def _tell_missing(motionless: list[str], wordless: list[str], count: int) -> None:
    """Warn how many of the clips were skipped because a file is missing."""
    for names, what in ((motionless, "motion"), (wordless, "text")):
        if names:
            more = " ..." if len(names) > LISTED else ""
            warnings.warn(
                f"{len(names)} of {count} clips have no {what} file and were skipped: "
                f"{', '.join(names[:LISTED])}{more}",
                MotionWarning,
                stacklevel=3,
            )
