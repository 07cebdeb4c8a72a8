"""Recordings that networks are trained on, and the split by person.

The training files are those of one collection, whose dancers and fighters are not named. So all of
it is on this side, together with the subjects of CMU's list who dance salsa and Indian dances or do
martial arts: they may be the same persons. Everybody else is kept for judging
(`tools/results/recordings`).
Data: the CMU Graphics Lab Motion Capture Database, mocap.cs.cmu.edu, created with funding from NSF
EIA-0196217.
"""

import os
import re
import warnings
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float

from ..motion.formats.files import read_motion
from ..motion.planting import find_contacts
from ..motion.root_frame import FPS
from ..motion.skeleton import TOES

VARIABLE = "MOTIONDIFF_REAL_DATA"  # names the folder with the recordings
FOLDERS = ("bvh", "cmu30")
TRAINED = ("acrnn_", "cmu_acrnn_")  # how the training files' names begin
# of CMU's list: who may be in that collection
SUBJECTS = {60, 61, 93, 94, 135}
# subject and trial of CMU's list, with the prefixes of the collections or without
TRIAL = re.compile(r"(?i)(?:cmu_)?(?:max_)?0*(\d+)_0*(\d+)")
CREDIT = (
    "The data used in this project was obtained from mocap.cs.cmu.edu. The database was created "
    "with funding from NSF EIA-0196217."
)


class RecordingsError(ValueError):
    """There are no recordings to train on; the message says where they are looked for."""


Recorded = tuple[Float[np.ndarray, "T 21 3"], Bool[np.ndarray, "T 2"]]


def recording_files() -> list[Path]:
    """All BVH files of the folders.

    Raises RecordingsError where MOTIONDIFF_REAL_DATA does not name a folder with recordings.
    """
    folder = os.environ.get(VARIABLE)
    found = [Path(folder) / one for one in FOLDERS] if folder else []
    files = [path for one in found for path in sorted(one.glob("*.bvh"))]
    if not files:
        raise RecordingsError(
            f"{VARIABLE} must name a folder with recordings in {' and '.join(FOLDERS)}"
        )
    return files


def training_recordings() -> list[Recorded]:
    """Positions (metres, world, 20 frames/s) and contacts of the recordings of training persons.

    Raises RecordingsError where there are none.
    """
    found, files = [], training_files(recording_files())
    if not files:
        raise RecordingsError(
            f"the recordings that {VARIABLE} names are all of persons who are kept for judging; "
            f"those of training begin with {' or '.join(TRAINED)}"
        )
    for path in files:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # notes on the file
            positions = read_motion(path).positions
        found.append((positions, find_contacts(positions[:, list(TOES)], FPS)))
    return found


def training_files(files: Sequence[Path]) -> list[Path]:
    """Each recording once: a trial that is there in two folders counts as the same one."""
    some = {path.stem.removeprefix("cmu_"): path for path in files if is_training(path.name)}
    return [some[name] for name in sorted(some)]


def is_training(name: str) -> bool:
    """Whether a file of this name is of the persons that networks are trained on."""
    trial = TRIAL.match(name)
    return name.lower().startswith(TRAINED) or bool(trial and int(trial[1]) in SUBJECTS)
