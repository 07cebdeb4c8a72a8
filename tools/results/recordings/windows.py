"""Windows of recordings, of people whom no training has seen."""

import os
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import motiondiff_edu as md
from motiondiff_edu.motion.motion import Motion
from motiondiff_edu.motion.root_frame import FPS

FOLDERS = ("bvh", "cmu30")  # of MOTIONDIFF_REAL_DATA
SECONDS = 6.0
EACH = 3  # windows of a file, at most


@dataclass(frozen=True)
class RecordedSize:
    """The amount of measurement; `samples` of each in-between."""

    files: int | None = None
    each: int = EACH
    samples: int = 10


FULL, QUICK = RecordedSize(), RecordedSize(files=3, each=1, samples=2)


def recorded(size: RecordedSize) -> Iterator[tuple[str, Motion]]:
    """The file's name, and six seconds of it: the windows of all files that are read.

    Windows of a file are evenly spaced. Exits where MOTIONDIFF_REAL_DATA does not name a folder
    with recordings.
    """
    folder = Path(os.environ.get("MOTIONDIFF_REAL_DATA", ""))
    files = [path for one in FOLDERS for path in sorted((folder / one).glob("*.bvh"))]
    if not files:
        sys.exit("MOTIONDIFF_REAL_DATA must name a folder with recordings in bvh/ and cmu30/")
    n = round(SECONDS * FPS)
    for path in files[: size.files]:
        try:
            motion = md.read_motion(path)
        except ValueError:  # damaged on purpose, or no human
            continue
        count = min(size.each, len(motion) // n)
        for first in np.linspace(0, len(motion) - n, count).astype(int):
            yield path.name, motion[int(first) : int(first) + n]
