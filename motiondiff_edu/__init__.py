"""Human-motion diffusion: two papers, MoDiff and MoFusion, as readable code and as a course.

    import motiondiff_edu as md

    walk = md.read_motion("my_walk.bvh")
    more = md.load("walker").walk(walk, md.joystick([(3, 1.2, 0, 0)]), seed=0)
    more.save("more.bvh")
Start at notebook 00 (`motiondiff-edu lab`), or read ddpm.py first and modiff.py next.
"""

import importlib
from typing import TYPE_CHECKING

from .motion import registry

__version__ = "0.1.0"

if TYPE_CHECKING:
    from .conditions.control import joystick
    from .editing.masks import keyframes_of as keyframes
    from .motion.formats.files import read_motion, read_motions
    from .motion.motion import Motion
    from .pretrained.checkpoints import load
    from .pretrained.shipped import edit, inbetween, reconstruct
    from .widgets.motions import play

# Public name -> (module, name in it). A module is imported at the first use of its name, so that
# `import motiondiff_edu` is not slower than `import torch`.
_FRONT_DOOR = {
    "Motion": (".motion.motion", "Motion"),
    "read_motion": (".motion.formats.files", "read_motion"),
    "read_motions": (".motion.formats.files", "read_motions"),
    "load": (".pretrained.checkpoints", "load"),
    "joystick": (".conditions.control", "joystick"),
    "keyframes": (".editing.masks", "keyframes_of"),
    "edit": (".pretrained.shipped", "edit"),
    "inbetween": (".pretrained.shipped", "inbetween"),
    "reconstruct": (".pretrained.shipped", "reconstruct"),
    "play": (".widgets.motions", "play"),
}
__all__ = [
    "Motion",
    "edit",
    "inbetween",
    "joystick",
    "keyframes",
    "load",
    "play",
    "read_motion",
    "read_motions",
    "reconstruct",
]

# The player of a Motion, and the writers of films and pages, are registered by the widgets.
registry.shows.announce(f"{__name__}.widgets.motions", "player")
registry.writers.announce(f"{__name__}.widgets.motions", ".mp4", ".gif", ".html")


def __getattr__(name: str) -> object:
    """Import one of the public names at its first use."""
    if name not in _FRONT_DOOR:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module, inner = _FRONT_DOOR[name]
    return globals().setdefault(name, getattr(importlib.import_module(module, __name__), inner))


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
