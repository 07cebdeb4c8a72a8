"""What arms and head do besides walking: waving, hands on hips, looking about.

These behaviours begin and end at random times.

A pose of an arm is (swing, abduction, twist, elbow) in degrees: swing forward +, twist inward +,
elbow bent +.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from ..noise import follow

# kind -> pose of (left, right) arm, or None where the arm keeps swinging
_WAVE = (12.0, 62.0, -78.0, 88.0)
_HIP = (-20.0, 41.0, 62.0, 84.0)
_HELD = (14.0, 10.0, 22.0, 96.0)
ARM_POSES = {
    "wave left": (_WAVE, None),
    "wave right": (None, _WAVE),
    "hands on hips": (_HIP, _HIP),
    "left hand on hip": (_HIP, None),
    "right hand on hip": (None, _HIP),
    "left hand held": (_HELD, None),
    "right hand held": (None, _HELD),
}
ARM_KINDS = (*ARM_POSES, "arms still", "arms swinging")
HEAD_KINDS = ("look left", "look right", "look down")
LASTS = {"arms": (1.5, 2.0), "head": (0.8, 1.2)}  # seconds: the least, and the mean beyond it


@dataclass(frozen=True)
class Behaviours:
    """How much of each behaviour there is at every frame, 0..1, smooth."""

    arms: Float[np.ndarray, "T 9"]
    head: Float[np.ndarray, "T 3"]


def _states(
    u: np.ndarray,
    kinds: int,
    per_second: float,
    lasts: tuple[float, float],
    calm: np.ndarray,
    fps: float,
):
    """One-hot rows of the present behaviour.

    A behaviour begins and ends at random, but it lasts at least its shortest duration.
    """
    on = np.zeros((len(u), kinds))
    kind, since = -1, 0
    draw = u[:, 0].tolist()
    choice = u[:, 1].tolist()
    calm = calm.tolist()
    for t in range(len(draw)):
        if kind < 0 and draw[t] < per_second / fps and calm[t]:
            kind, since = min(int(choice[t] * kinds), kinds - 1), t
        elif kind >= 0 and t - since > lasts[0] * fps and draw[t] > 1 - 1 / (lasts[1] * fps):
            kind = -1
        if kind >= 0:
            on[t, kind] = 1.0
    return on


def behaviours(
    u: Float[np.ndarray, "T 4"], per_minute: float, calm: Bool[np.ndarray, "T"], fps: float
) -> Behaviours:
    """Draw the behaviours from uniform numbers.

    None begins where `calm` is False (in a fast run).
    """
    arms = _states(u[:, :2], len(ARM_KINDS), per_minute / 100, LASTS["arms"], calm, fps)
    head = _states(u[:, 2:], len(HEAD_KINDS), per_minute / 100, LASTS["head"], calm, fps)
    return Behaviours(follow(arms, 0.12, fps, 3), follow(head, 0.12, fps, 3))


def pose_arm(
    free: Float[np.ndarray, "T 4"], side: int, doing: Behaviours, wave: Float[np.ndarray, "T"]
) -> Float[np.ndarray, "T 4"]:
    """Mix the freely swinging arm (side 0 left, 1 right) with the poses of present behaviours.

    `wave` in -1..1.
    """
    pose = free.copy()
    for k, name in enumerate(ARM_POSES):
        target = ARM_POSES[name][side]
        if target is None:
            continue
        goal = np.broadcast_to(np.array(target), free.shape)
        if name.startswith("wave"):
            goal = goal + np.stack([0 * wave, 0 * wave, 16 * wave, 14 * wave], -1)
        pose = pose + doing.arms[:, k, None] * (goal - free)
    return pose


def swing_factor(doing: Behaviours) -> Float[np.ndarray, "T"]:
    """Factor on the arm swing: some behaviours hold the arms nearly still, others swing wide."""
    k = len(ARM_POSES)
    return 1 - 0.8 * doing.arms[:, k] + 0.55 * doing.arms[:, k + 1]
