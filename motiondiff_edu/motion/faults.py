"""Where a capture cannot be right.

Joints that move faster than any actor's, as when markers are exchanged.

What is found is a mask, so that it can be mended: `editing.inbetween.inbetween(dancer,
clip.world(), ~clip.info["wild"])`. A joint may be wrong without haste: to be safe, doubt whole
frames, `np.repeat(wild.any(1, keepdims=True), 21, 1)`.
Notebook: 10
"""

import numpy as np
from jaxtyping import Bool, Float

from .skeleton import HIPS

WILD = 15.0  # m/s; no limb of an actor moves faster, a swapped marker does
HASTY = 10.0  # m/s; beside such a joint, this is suspicious too
MARGIN_S, CLOSE_S = 0.05, 0.5


def wild_joints(
    speeds: Float[np.ndarray, "N 21"], fps: float | int, frames: int, to_fps: float | int
) -> Bool[np.ndarray, "{frames} 21"]:
    """Of a motion of `frames` at `to_fps`, the joints that are not to be believed.

    `speeds` are the file's, in m/s.

    Nothing is doubted unless some joint passes WILD. Then every joint is doubted while it passes
    HASTY and 0.05 s around, and between two such moments up to half a second apart: markers
    exchanged and exchanged back are wrong in between, though they are calm. Where the pelvis is
    doubted, all is.
    """
    doubted = np.zeros((frames, speeds.shape[1]), bool)
    if not (np.nan_to_num(speeds) > WILD).any():
        return doubted
    for joint in range(speeds.shape[1]):
        times = np.flatnonzero(np.nan_to_num(speeds[:, joint]) > HASTY) / fps
        if not len(times):
            continue
        edges = np.flatnonzero(np.diff(times) > CLOSE_S)
        for first, last in zip(
            times[np.append(0, edges + 1)], times[np.append(edges, len(times) - 1)], strict=True
        ):
            start = int(np.floor((first - MARGIN_S) * to_fps))
            doubted[max(0, start) : int(np.ceil((last + MARGIN_S) * to_fps)) + 1, joint] = True
    doubted[doubted[:, HIPS]] = True
    return doubted
