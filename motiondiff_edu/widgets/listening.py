"""A figure that dances to a song, and what it listens to.

Attention, and what a silenced hit changes, over its waves.

Notebook: 12
"""

from functools import partial

from .player import Player
from .strips import Strips, pack_levels, pack_moved

_OWN = ("attention", "token_times", "moved", "hit", "scale")


class Listening(Player):
    """A `Player` whose music lane shows where in the music the present frame reads.

    `attention` (T, M) or {level: (T, M)}: rows over the whole motion, columns at `token_times`
    seconds, summing to one; `scale` "map" (full colour is the map's largest weight) or "frame"
    (each row's). `moved` (T,): how far the figure moved, in metres, when the sound at `hit` seconds
    (one or several) was silenced. A weight is where values were read, not why; `moved` is what a
    change did.  All else as for `Player`.
    Source: MoFusion Fig. 4  Notebook: 12
    """

    def __init__(
        self,
        positions,
        audio,
        attention=None,
        token_times=None,
        moved=None,
        hit=None,
        scale="map",
        **more,
    ):
        self._shown = dict(
            attention=attention, token_times=token_times, moved=moved, hit=hit, scale=scale
        )
        super().__init__(positions, audio=audio, **more)

    def show(self, positions, **changes) -> None:
        """Show another dance in the same place.

        `changes` replaces audio, attention, moved and what `Player` knows.
        """
        shown = self._shown | {name: changes.pop(name) for name in _OWN if name in changes}
        super().show(positions, strips=partial(_strips, shown), **changes)
        self._shown = shown


def _strips(shown: dict, frames: int) -> Strips:
    levels = ()
    if shown["attention"] is not None:
        levels = pack_levels(shown["attention"], shown["token_times"], shown["scale"])
    if shown["moved"] is None:
        return Strips(levels)
    return Strips(levels, *pack_moved(shown["moved"], frames, shown["hit"]))
