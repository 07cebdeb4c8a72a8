"""A walk to edit, and the generators of its edits."""

import numpy as np

from data_synth.walking import random_control, walk
from motiondiff_edu.motion.root_frame import to_world


def clip(T: int = 40) -> np.ndarray:
    """A real enough motion that starts somewhere, facing somewhere."""
    walked = walk(random_control(T / 20 + 1, np.random.default_rng(0), "turn"), 0)
    return to_world(walked.poses, walked.control, (3.0, -2.0, 0.7))[:T]
