"""BVH motion capture.

`read_bvh(path)` reads a file as written, `write_bvh(path, positions)` writes one.
"""

from .read import Bvh, read_bvh
from .tokens import BvhError
from .write import write_bvh

__all__ = ["Bvh", "BvhError", "read_bvh", "write_bvh"]
