"""The head turns first: a dancer looks where the body will face a moment later.

The chest follows the eyes, and the pelvis the chest.
"""

import numpy as np
from jaxtyping import Float

AHEAD = 0.35  # seconds by which the eyes are ahead of the pelvis
FARTHEST = 50.0  # degrees that head and chest together turn ahead of the pelvis, at most
CHEST = 0.3  # share of the head's turn that the chest takes over


def ahead_of_the_turn(
    heading: Float[np.ndarray, "T"], fps: float
) -> tuple[Float[np.ndarray, "T"], Float[np.ndarray, "T"]]:
    """Degrees to the left by which the head and the chest lead a turn of `heading` (radians).

    The limit is soft: the faster the turn, the nearer the head is to FARTHEST.
    """
    frames = np.arange(len(heading))
    soon = np.interp(frames + AHEAD * fps, frames, heading)
    lead = FARTHEST * np.tanh(np.degrees(soon - heading) / FARTHEST)
    return (1 - CHEST) * lead, CHEST * lead
