"""Human-motion diffusion, taken apart in notebooks and put together again.

MoDiff and MoFusion, readable and runnable.

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
    from .motion.files import read_motion
    from .motion.motion import Motion
    from .pretrained.shipped import inbetween, load, reconstruct
    from .widgets.motions import play

# Where each of the names lies, (module, name in it): imported when it is asked for, so that
# `import motiondiff_edu` takes no longer than `import torch`.
_FRONT_DOOR = {
    "Motion": (".motion.motion", "Motion"),
    "read_motion": (".motion.files", "read_motion"),
    "load": (".pretrained.shipped", "load"),
    "joystick": (".conditions.control", "joystick"),
    "keyframes": (".editing.masks", "keyframes_of"),
    "inbetween": (".pretrained.shipped", "inbetween"),
    "reconstruct": (".pretrained.shipped", "reconstruct"),
    "play": (".widgets.motions", "play"),
}
__all__ = [
    "Motion",
    "inbetween",
    "joystick",
    "keyframes",
    "load",
    "play",
    "read_motion",
    "reconstruct",
]

# What a Motion shows of itself, and the films it is saved as, are brought by the layer that draws.
registry.shows.announce(f"{__name__}.widgets.motions", "player")
registry.writers.announce(f"{__name__}.widgets.motions", ".mp4", ".gif", ".html")


def __getattr__(name: str) -> object:
    """One of the names above, imported now."""
    if name not in _FRONT_DOOR:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module, inner = _FRONT_DOOR[name]
    return globals().setdefault(name, getattr(importlib.import_module(module, __name__), inner))


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
