"""What a dancer listens to, over the waves of its song.

Attention, and what a silenced hit changes. They are packed for the page: attention in 8 bits, each
row scaled by its largest weight, which is stored too; the error is at most 1/510 of that weight.
Notebook: 12
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float, UInt8

from ..viz.over_time import edges_of
from .sound import as_times


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

    def strips(self, frames: int) -> "Strips":
        """Packed for a motion of so many frames.  Raises ValueError for what does not fit."""
        levels = ()
        if self.attention is not None:
            levels = pack_levels(self.attention, self.token_times, self.scale)
        if self.moved is None:
            return Strips(levels)
        return Strips(levels, *pack_moved(self.moved, frames, self.hit))


@dataclass(frozen=True, eq=False)
class Level:
    """One attention map: rows over the motion's time, columns between `edges` (seconds).

    `tops` are the largest weights of the rows.
    """

    name: str
    codes: UInt8[np.ndarray, "T M"]
    tops: Float[np.ndarray, "T"]
    edges: Float[np.ndarray, "M1"]
    full: float | None  # the weight that has full colour; None: the row's largest

    def weights(self) -> Float[np.ndarray, "T M"]:
        """Unpack the map, as the browser does."""
        return self.codes / 255 * self.tops[:, None]


@dataclass(frozen=True, eq=False)
class Strips:
    """Attention maps, and how far the figure `moved` (m) when the sound at `hits` is silenced."""

    levels: tuple[Level, ...] = ()
    moved: Float[np.ndarray, "T"] | None = None
    hits: tuple[float, ...] = ()

    def record(self) -> dict:
        """The page's record besides the codes; equal edges are stored once."""
        edges = [level.edges.round(4).tolist() for level in self.levels]
        once = [e for i, e in enumerate(edges) if e not in edges[:i]]
        levels = [
            {
                "name": level.name,
                "rows": len(level.codes),
                "edges": once.index(own),
                "full": level.full,
                "tops": [float(f"{v:.5g}") for v in level.tops],
            }
            for level, own in zip(self.levels, edges, strict=True)
        ]
        moved = None
        if self.moved is not None:
            values = self.moved.round(4).tolist()
            moved = {"values": values, "top": max(values), "hits": list(self.hits)}
        return {"levels": levels, "edges": once, "moved": moved}

    def codes(self) -> bytes:
        """The codes of all levels, row after row, one level after the other."""
        return b"".join(level.codes.tobytes() for level in self.levels)

    def words(self) -> str:
        """The alternative text."""
        said = (
            [f"attention of {', '.join(level.name for level in self.levels)} as colour"]
            if self.levels
            else []
        )
        if self.moved is not None:
            said.append(f"how far the figure moves without a hit, up to {self.moved.max():.2f} m")
        return "; ".join(said)


def pack_levels(attention: object, token_times: object, scale: str = "map") -> tuple[Level, ...]:
    """Pack one map (T, M) or a dictionary of named maps.

    Rows sum to one and cover the whole motion evenly; a map can have fewer rows than frames.
    `token_times` are the times in seconds of the columns (or {name: times}); a column reaches
    halfway to its neighbours. Full colour is the largest weight of the whole map. With
    `scale="frame"` it is that of each row, which shows where a row looks but not how sharply.
    Raises ValueError for maps that are not attention, and for times that do not fit.
    """
    if scale not in ("map", "frame"):
        raise ValueError(f'scale must be "map" or "frame", not {scale!r}')
    maps = attention if isinstance(attention, Mapping) else {"attention": attention}
    if not maps:
        raise ValueError("attention is empty: pass a map (T, M), or {name: map}")
    return tuple(
        _level(str(name), m, _times_of(name, token_times), scale) for name, m in maps.items()
    )


def pack_moved(
    moved: object, frames: int, hit: object = None
) -> tuple[np.ndarray, tuple[float, ...]]:
    """The curve (T,) in metres, one value per frame, and the times of silenced hits in seconds."""
    curve = np.asarray(moved, dtype=np.float64)
    if curve.shape != (frames,) or not np.isfinite(curve).all() or (curve < 0).any():
        raise ValueError(
            f"`moved` must be one finite distance in metres per frame, ({frames},), not shape "
            f"{curve.shape}"
        )
    times = None if hit is None else np.atleast_1d(hit)
    return curve, tuple(as_times(times, "hit", np.inf))


def check_attention(
    weights: Float[np.ndarray, "..."], times: Float[np.ndarray, "_"], name: str = "attention"
) -> None:
    """Raise ValueError unless rows are finite, not negative and sum to one, and times increase.

    There must be one time for each column.
    """
    if weights.ndim != 2 or not weights.size:
        raise ValueError(
            f"{name}: a map must be (motion rows, tokens), not {weights.shape}; "
            "for several heads pass one of them"
        )
    if not np.isfinite(weights).all() or (weights < -1e-6).any():
        raise ValueError(
            f"{name}: weights must be finite and not negative; if these are scores, apply softmax"
        )
    off = np.abs(weights.sum(1) - 1)
    if off.max() > 1e-2:
        row = int(off.argmax())
        raise ValueError(
            f"{name}: row {row} sums to {weights[row].sum():.3g}, not 1. "
            "Is the map (motion, music), and taken after softmax?"
        )
    if (
        times.shape != weights.shape[1:]
        or not np.isfinite(times).all()
        or (np.diff(times) <= 0).any()
    ):
        raise ValueError(
            f"{name}: token_times must be increasing seconds, "
            f"one for each of the {weights.shape[1]} columns, not shape {times.shape}"
        )


def _times_of(name: object, token_times: object) -> object:
    if not isinstance(token_times, Mapping):
        return token_times
    if name not in token_times:
        raise ValueError(
            f"token_times has no times for {name!r}; it has {', '.join(map(str, token_times))}"
        )
    return token_times[name]


def _level(name: str, weights: object, times: object, scale: str) -> Level:
    weights = np.asarray(weights, dtype=np.float64)
    times = np.asarray([] if times is None else times, dtype=np.float64)
    check_attention(weights, times, name)
    weights = weights.clip(0)
    tops = weights.max(1)
    codes = np.rint(weights / tops[:, None] * 255).astype(np.uint8)
    return Level(name, codes, tops, edges_of(times), float(tops.max()) if scale == "map" else None)
