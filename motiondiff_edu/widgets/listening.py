"""What a dancer listens to, over the waves of its song.

Attention, and what a silenced hit changes.

Notebook: 12
"""

from dataclasses import dataclass
from typing import Any

from .strips import Strips, pack_levels, pack_moved


@dataclass(frozen=True, eq=False)
class Listening:
    """Where in the music the present frame reads, for a player's `Soundtrack`.

    `attention` (T, M) or {level: (T, M)}: rows over the whole motion, columns at `token_times`
    seconds, summing to one; `scale` "map" (full colour is the map's largest weight) or "frame"
    (each row's). `moved` (T,): how far the figure moved, in metres, when the sound at `hit` seconds
    (one or several) was silenced. A weight is where values were read, not why; `moved` is what a
    change did.
    Source: MoFusion Fig. 4  Notebook: 12
    """

    attention: Any = None
    token_times: Any = None
    moved: Any = None
    hit: Any = None
    scale: str = "map"

    def strips(self, frames: int) -> Strips:
        """Packed for a motion of so many frames.  Raises ValueError for what does not fit."""
        levels = ()
        if self.attention is not None:
            levels = pack_levels(self.attention, self.token_times, self.scale)
        if self.moved is None:
            return Strips(levels)
        return Strips(levels, *pack_moved(self.moved, frames, self.hit))
