"""Windows of recordings, of people whom the network that is judged has not seen."""

import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import motiondiff_edu as md
from motiondiff_edu.motion.motion import Motion
from motiondiff_edu.motion.root_frame import FPS
from motiondiff_edu.recipes.recordings import TRAINED, TRIAL, is_training, recording_files

SECONDS = 6.0
SHORTEST = 2.0  # seconds: shorter recordings are left out
EACH = 5  # windows of a file, at most; they overlap by half at most


@dataclass(frozen=True)
class RecordedSize:
    """The amount of measurement; `samples` of each in-between."""

    files: int | None = None
    each: int = EACH
    samples: int = 10


FULL, QUICK = RecordedSize(), RecordedSize(files=5, each=1, samples=2)


def trials() -> list[Path]:
    """All recordings, each trial of the CMU collection once.

    Exits where MOTIONDIFF_REAL_DATA does not name a folder with recordings.
    """
    found = {}
    try:
        files = recording_files()
    except ValueError as error:
        sys.exit(str(error))
    for path in files:
        trial = TRIAL.match(path.name)
        found.setdefault(trial.groups() if trial else path.name, path)
    return list(found.values())


def held_out() -> list[Path]:
    """The recordings of people whom no training has seen."""
    return [path for path in trials() if not is_training(path.name)]


def person_of(source: str) -> str:
    """Whose recording it is: a subject of the CMU collection, the unnamed persons of the training
    collection, who count as one, or else the file's own.
    """
    trial = TRIAL.match(source)
    if trial:
        return trial[1]
    return TRAINED[0] if is_training(source) else source


def amounts(sources: list[str]) -> dict[str, int]:
    """How many files these are, and of how many persons."""
    return {"files": len(set(sources)), "persons": len({person_of(one) for one in sources})}


def recorded(
    files: list[Path], size: RecordedSize, shortest: float = SHORTEST
) -> Iterator[tuple[str, Motion]]:
    """The file's name, and six seconds of it: the windows of all files that are read.

    Windows of a file are evenly spaced; a single one is in its middle. A recording of less than
    six but `shortest` seconds is one window.
    """
    n = round(SECONDS * FPS)
    for path in files[: size.files]:
        try:
            motion = md.read_motion(path)
        except ValueError:  # damaged on purpose, or no human
            continue
        if len(motion) < shortest * FPS:
            continue
        length = min(n, len(motion))
        count = min(size.each, 1 + (len(motion) - length) // (length // 2))
        last = len(motion) - length
        for first in np.linspace(0, last, count).astype(int) if count > 1 else [last // 2]:
            yield path.name, motion[int(first) : int(first) + length]
