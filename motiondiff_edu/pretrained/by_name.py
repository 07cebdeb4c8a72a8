"""The front door's `load`: a performer by the name of its shipped weights, or from a file.

Notebook: 00
"""

from pathlib import Path

from ..conditions.clip import Clip
from . import checkpoints
from .checkpoints import AnyPerformer, CheckpointError


def load(name: str | Path, clip: Clip | str | Path | None = None) -> AnyPerformer:
    """A performer: shipped weights by name ("walker", "dancer", "mover" ...), or your own file.

    `clip`: for your own mover that reads by CLIP, the folder of that CLIP (`checkpoints.load`).
    Raises CheckpointError for an unknown name, with a list of the names, for a faulty file, and for
    `clip` with shipped weights, none of which reads by CLIP.
    Notebook: 00
    """
    if str(name).endswith(".safetensors"):
        return checkpoints.load(Path(name).expanduser(), clip)
    if clip is not None and name in checkpoints.available():
        raise CheckpointError(f"the shipped {name!r} does not read by CLIP: leave `clip` out")
    return checkpoints.pretrained(str(name))
