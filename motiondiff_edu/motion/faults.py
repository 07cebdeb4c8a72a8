"""Faults of a capture: joints that move faster than any actor, as when markers are exchanged.

The result is a mask, so the faults can be repaired: `editing.inbetween.inbetween(inbetweener,
clip.world(), ~clip.info["wild"])`. A joint can be wrong without moving fast. To be safe, repair
whole frames: `np.repeat(wild.any(1, keepdims=True), 21, 1)`.
Notebook: 10
"""

import numpy as np
from jaxtyping import Bool, Float

from .skeleton import HIPS

WILD = 15.0  # m/s; no limb of an actor moves faster, but a swapped marker does
SUSPECT = 10.0  # m/s; in a motion with a wild joint, this speed is suspect too
MARGIN_S, CLOSE_S = 0.05, 0.5


def wild_joints(
    speeds: Float[np.ndarray, "N 21"], fps: float | int, frames: int, to_fps: float | int
) -> Bool[np.ndarray, "{frames} 21"]:
    """True for the joints that are probably wrong, in a motion of `frames` at `to_fps`.

    `speeds` (m/s) are those of the file at `fps`.

    If no joint is faster than WILD, all joints are trusted. Otherwise a joint is suspect while it
    is faster than SUSPECT, and 0.05 s before and after. It is also suspect between two such moments
    up to half a second apart: markers that were exchanged and exchanged back are wrong in between,
    even if they move slowly. Where the pelvis is suspect, all joints are.
    """
    suspect = np.zeros((frames, speeds.shape[1]), bool)
    if not (np.nan_to_num(speeds) > WILD).any():
        return suspect
    for joint in range(speeds.shape[1]):
        times = np.flatnonzero(np.nan_to_num(speeds[:, joint]) > SUSPECT) / fps
        if not len(times):
            continue
        edges = np.flatnonzero(np.diff(times) > CLOSE_S)
        for first, last in zip(
            times[np.append(0, edges + 1)], times[np.append(edges, len(times) - 1)], strict=True
        ):
            start = int(np.floor((first - MARGIN_S) * to_fps))
            suspect[max(0, start) : int(np.ceil((last + MARGIN_S) * to_fps)) + 1, joint] = True
    suspect[suspect[:, HIPS]] = True
    return suspect
