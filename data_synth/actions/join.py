"""From one way of moving to another: a walk fades into an act on the spot, and back.

Both motions exist for a moment, with both feet planted in the same places. Bones are mixed by
their directions, so they keep their lengths, and the feet do not slide.
"""

import numpy as np
from jaxtyping import Float

from motiondiff_edu.motion.directions import unit
from motiondiff_edu.motion.skeleton import BONE_LENGTHS, BONES, PARENTS

from ..walking.legs import REACH, bend_knee

LENGTH = {child: float(length) for (_, child), length in zip(BONES, BONE_LENGTHS, strict=True)}
UPPER = (9, 10, 11, 12, *range(13, 21))
LEGS = ((1, 2, 3, 4), (5, 6, 7, 8))  # socket, knee, ankle, toe


def crossfade(
    a: Float[np.ndarray, "T 21 3"],
    b: Float[np.ndarray, "T 21 3"],
    share: Float[np.ndarray, "T"],
) -> Float[np.ndarray, "T 21 3"]:
    """The mix of two motions, `share` of b, with the toes of b.

    Where the mix begins, the toes of both must be in one place. Hips too far from a foot come down.
    Raises ValueError where that is not enough.
    """
    w = share[:, None]
    out = np.empty_like(a)
    out[:, 0] = a[:, 0] + w * (b[:, 0] - a[:, 0])
    out[:, 0, 1] -= _drop(a, b, out[:, 0], w)
    for joint in UPPER:
        out[:, joint] = out[:, PARENTS[joint]] + _bone(a, b, w, joint)
    for socket, knee, ankle, toe in LEGS:
        out[:, socket] = out[:, 0] + _bone(a, b, w, socket)
        out[:, toe] = b[:, toe]
        out[:, ankle] = out[:, toe] - _bone(a, b, w, toe)
        _check_reach(out[:, socket], out[:, ankle])
        toward = [unit(p[:, knee] - (p[:, socket] + p[:, ankle]) / 2) for p in (a, b)]
        out[:, knee] = bend_knee(
            out[:, socket], out[:, ankle], toward[0] + w * (toward[1] - toward[0])
        )
    return out


def _bone(a, b, w, joint: int) -> Float[np.ndarray, "T 3"]:
    """A bone from its parent, in the mixed direction."""
    first, second = (p[:, joint] - p[:, PARENTS[joint]] for p in (a, b))
    return mixed_bone(first, second, w, LENGTH[joint])


def mixed_bone(
    first: Float[np.ndarray, "T 3"],
    second: Float[np.ndarray, "T 3"],
    share: Float[np.ndarray, "T 1"],
    length: float,
) -> Float[np.ndarray, "T 3"]:
    """A bone of this length in the mixed direction of two, `share` of the second."""
    return length * unit(first + share * (second - first))


def _drop(a, b, hips: Float[np.ndarray, "T 3"], w) -> Float[np.ndarray, "T"]:
    """How far the hips must come down, so that both legs reach their feet."""
    drop = np.zeros(len(hips))
    for socket, _, _, toe in LEGS:
        apart = hips + _bone(a, b, w, socket) - (b[:, toe] - _bone(a, b, w, toe))
        most = np.sqrt(np.maximum(REACH**2 - (apart[:, [0, 2]] ** 2).sum(-1), 0.0))
        drop = np.maximum(drop, apart[:, 1] - most)
    return drop


def _check_reach(socket: Float[np.ndarray, "T 3"], ankle: Float[np.ndarray, "T 3"]) -> None:
    """Raise ValueError where no leg reaches the ankle."""
    far = np.linalg.norm(ankle - socket, axis=-1).max()
    if far > REACH + 0.005:
        raise ValueError(f"a leg of {REACH:.3f} m does not reach its foot, {far:.3f} m away")
