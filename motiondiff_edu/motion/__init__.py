"""Motion as arrays.

The skeleton, forward kinematics, the root frame, clips, and the files they come from.
"""

from . import registry

registry.readers.announce(f"{__name__}.formats.files", ".bvh", ".npz")
registry.readers.announce(f"{__name__}.formats.humanml3d", ".npy")
registry.writers.announce(f"{__name__}.formats.files", ".bvh", ".npz")
