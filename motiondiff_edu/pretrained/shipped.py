"""The front door's verbs that need weights: `load`, and `inbetween` and `reconstruct`.

Notebook: 00, 15
"""

from functools import lru_cache
from pathlib import Path

import numpy as np
import torch
from jaxtyping import Bool

from ..editing import inbetween as inbetweens
from ..editing import reconstruct as reconstruction
from ..editing.masks import checked_known
from ..motion.checks import checked_count
from ..motion.motion import Motion, MotionError, as_motion
from ..motion.root_frame import FPS
from ..motion.skeleton import TOES
from ..performers.dancer import Dancer
from ..performers.walker import Walker
from ..performers.with_bar import with_bar
from . import checkpoints

STEPS = 50  # of DDIM, for in-betweens


def load(name: str | Path) -> Walker | Dancer:
    """A walker or dancer: shipped weights by name ("walker", "dancer" ...), or a file of your own.

    Raises CheckpointError with the names there are, or with what is wrong with the file.
    Notebook: 00
    """
    if str(name).endswith(".safetensors"):
        return checkpoints.load(Path(name).expanduser())
    return checkpoints.pretrained(str(name))


def inbetween(
    motion: Motion,
    known: Bool[np.ndarray, "T J"],
    *,
    samples: int = 1,
    seed: int = 0,
    steps: int = STEPS,
    progress: bool = True,
) -> Motion | list[Motion]:
    """Make what is not `known` of a motion anew, by the shipped unconditional network.

    With `samples` above 1 a list of so many.

    Known joints stay exactly where they are; a joint can be given only where the pelvis is.
    Raises MotionError and ValueError for what does not fit.  Source: MoFusion 4.4.  Notebook: 15
    """
    known, count = _fitting(motion, known), checked_count(samples, "samples")
    draw = torch.Generator().manual_seed(seed)
    if known.all():
        raise MotionError(f"{motion.name}: all is known, there is nothing to make")
    with with_bar(_shipped("unconditional"), steps, "filling in", progress) as dancer:
        made = inbetweens.inbetween(
            dancer, motion.positions, known, samples=count, steps=steps, generator=draw
        )
    made = [_made(motion, known, positions, "in-betweens") for positions in made]
    return made if samples > 1 else made[0]


def reconstruct(
    motion: Motion, known: Bool[np.ndarray, "T J"], *, seed: int = 0, progress: bool = True
) -> Motion:
    """Find the joints that are not `known`, by the shipped walker there and back.

    A motion of any length.

    Known joints stay exactly where they are. The pelvis must be known in every frame: the walk's
    control is read from it.
    Raises MotionError where it is not, and for what does not fit.  Source: MoDiff III-E.
    """
    known, walker = _fitting(motion, known), _shipped("walker")
    total = reconstruction.evaluations(walker, known)
    generator = torch.Generator().manual_seed(seed)
    with with_bar(walker, total, "reconstructing", progress) as walker:
        whole = reconstruction.reconstruct(walker, motion.positions, known, generator=generator)
    return _made(motion, known, whole, "reconstructed")


@lru_cache(maxsize=4)
def _shipped(name: str) -> Walker | Dancer:
    return checkpoints.pretrained(name)


def _fitting(motion: Motion, known) -> Bool[np.ndarray, "T J"]:
    """The mask, if it fits, for a motion at the networks' frame rate."""
    if abs(as_motion(motion).fps - FPS) > 1e-6:
        raise MotionError(
            f"{motion.name} has {motion.fps:g} frames/s, the networks know {FPS:g}: bring it there "
            f"by motion.resampled({FPS:g}), and make `known` for that"
        )
    return checked_known(motion, known)


def _made(motion: Motion, known: np.ndarray, positions: np.ndarray, how: str) -> Motion:
    """The motion with other positions; its contacts only where no toe was made anew."""
    kept = motion.contacts if known[:, list(TOES)].all() else None
    along = {"audio": motion.audio, "sample_rate": motion.sample_rate, "contacts": kept}
    return Motion(positions, motion.fps, source=f"{motion.name}, {how}", **along)
