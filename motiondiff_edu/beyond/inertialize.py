"""Inertialisation: what is generated takes over the pose and the speed of the given motion.

From an unusual past a network jumps to the poses that it knows: its first frame is far from the
last given one. The difference of the two at the seam, in each bone's direction and in the place of
the pelvis, is added to the generated frames and fades within half a second, or within longer where
a joint has far to go. Given frames stay as they are, and so do the lengths of bones. The caller
locks the feet afterwards (`performers/joined.py`).
Gain: docs/RESULTS.md, *On recordings* (`real.seam_over_motion` beside
`real.unblended.seam_over_motion`). It costs: in that half second feet slide more, and the control
is kept less well.
Source: Bollo, *Inertialization* (Game Developers Conference 2018), with vectors for quaternions
"""

import numpy as np
from jaxtyping import Float

from ..motion.directions import build, plain_directions, unit
from ..motion.skeleton import HIPS, PARENTS

SECONDS, LONGEST = 0.5, 1.5  # until the generated motion is on its own
PACE = 1.0  # m/s: so fast, on average, goes the joint that has farthest to go


def fading(
    offset: Float[np.ndarray, "*J 3"], speed: Float[np.ndarray, "*J 3"], n: int
) -> Float[np.ndarray, "n *J 3"]:
    """`offset` at frame 0, changing by `speed` a frame there; from frame n on it would be 0.

    A polynomial of degree five in the time; at frame n its first three derivatives are 0, too.
    """
    u = (np.arange(n) / n).reshape(-1, *[1] * offset.ndim)
    # (1 - u)^4 (offset + (4 offset + n speed) u): value and slope at 0, and four zeros at 1
    return (1 - u) ** 4 * (offset + (4 * offset + n * speed) * u)


def inertialized(
    past: Float[np.ndarray, "T_h 21 3"], new: Float[np.ndarray, "T 21 3"], fps: float = 20.0
) -> Float[np.ndarray, "T 21 3"]:
    """`new` poses that go on from `past` without a jump (metres, both in the root frame)."""
    n = min(len(new), round(seconds_for(past, new) * fps))
    if len(past) < 2 or n < 2:
        return new
    bones, parents = plain_directions(new[:n]), PARENTS[1:]
    lengths = np.linalg.norm(new[:n, 1:] - new[:n, parents], axis=-1).T
    hips = new[:n, HIPS] + _faded(past[-2:, HIPS], new[:n, HIPS], n)
    bones = unit(bones + _faded(plain_directions(past[-2:]), bones, n))
    return np.concatenate([build(hips, bones, lengths), new[n:]])


def seconds_for(past: Float[np.ndarray, "T_h 21 3"], new: Float[np.ndarray, "T 21 3"]) -> float:
    """How long the difference at the seam fades, by how far a joint would jump."""
    far = np.linalg.norm(new[0] - past[-1], axis=-1).max()
    return float(np.clip(far / PACE, SECONDS, LONGEST))


def _faded(given: np.ndarray, new: np.ndarray, n: int) -> np.ndarray:
    """What to add to `new` (n frames), so that it goes on from two given frames."""
    speed = given[1] - given[0]
    return fading(given[1] + speed - new[0], speed - (new[1] - new[0]), n)
