"""A clip: root-frame poses with their control. Cutting clips into windows, and splitting by source.

Source: MoDiff IV-A (4-second clips, 20 frames/s, 50 % overlap).  Notebook: 01
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from jaxtyping import Bool, Float

from .root_frame import FPS, to_world


@dataclass(frozen=True, eq=False)
class Clip:
    """Poses in the root frame (metres), control (m/s, m/s, rad/s), and what is known about them.

    Further columns of the control are a condition of your own (docs/EXTENDING.md).
    `source` names the recording (or the seed) that the clip was cut from; splits are made by it.
    Notebook: 01
    """

    poses: Float[np.ndarray, "T 21 3"]
    control: Float[np.ndarray, "T C"]
    fps: float = FPS
    contacts: Bool[np.ndarray, "T 2"] | None = None  # left, right foot planted
    source: str = ""
    info: dict = field(default_factory=dict)

    def __post_init__(self):
        if len(self.poses) != len(self.control):
            raise ValueError(
                f"clip {self.source!r}: {len(self.poses)} poses but "
                f"{len(self.control)} rows of control"
            )

    def __len__(self) -> int:
        return len(self.poses)

    def world(
        self, start: tuple[float, float, float] = (0.0, 0.0, 0.0)
    ) -> Float[np.ndarray, "T 21 3"]:
        """Positions in the world, the root starting at `start` = (x, z, heading)."""
        return to_world(self.poses, self.control[:, :3], start, self.fps)

    def features(self) -> Float[np.ndarray, "T 63"]:
        """The 63 features per frame that the networks take, in float32."""
        return self.poses.reshape(len(self), -1).astype(np.float32)

    def cut(self, first: int, last: int) -> "Clip":
        """Frames first..last-1 as a clip of the same source.

        `info` is still that of the whole clip.
        """
        contacts = None if self.contacts is None else self.contacts[first:last]
        return replace(
            self, poses=self.poses[first:last], control=self.control[first:last], contacts=contacts
        )


def slice_clips(clips: Sequence[Clip], seconds: float = 4.0, overlap: float = 0.5) -> list[Clip]:
    """Cut clips into pieces of `seconds` that overlap by the fraction `overlap`.

    A shorter rest at the end is dropped.

    Raises ValueError unless 0 <= overlap < 1 and a piece has at least one frame.
    Source: MoDiff IV-A.  Notebook: 01
    """
    if not 0 <= overlap < 1:
        raise ValueError(f"overlap must lie in [0, 1), got {overlap}")
    pieces = []
    for clip in clips:
        length = round(seconds * clip.fps)
        if length < 1:
            raise ValueError(f"pieces of {seconds} s have no frame at {clip.fps:g} frames/s")
        stride = max(1, round(length * (1 - overlap)))
        pieces += [
            clip.cut(first, first + length) for first in range(0, len(clip) - length + 1, stride)
        ]
    return pieces


def split_by_source(
    clips: Sequence[Clip], fractions: Sequence[float], rng: np.random.Generator
) -> tuple[list[Clip], ...]:
    """Split clips into groups so that no source is in two of them.

    Slices of one recording share frames, so they must stay together.

    `fractions` of the sources go to each group; they sum to 1.
    Raises ValueError for other fractions, for a clip without a source, and if there are too few
    sources to give each group one.
    Notebook: 01
    """
    if min(fractions) < 0 or abs(sum(fractions) - 1) > 1e-9:
        raise ValueError(f"fractions must be 0 or more and sum to 1, not {list(fractions)}")
    nameless = next((k for k, clip in enumerate(clips) if not clip.source), None)
    if nameless is not None:
        raise ValueError(f"clip {nameless} has no source: it cannot be kept with clips like it")
    sources = np.array(sorted({clip.source for clip in clips}))
    rng.shuffle(sources)
    bounds = np.round(np.cumsum([0.0, *fractions]) * len(sources)).astype(int)
    empty = [k for k in range(len(fractions)) if fractions[k] and bounds[k] == bounds[k + 1]]
    if empty:
        raise ValueError(
            f"{len(sources)} sources leave group {empty[0]} without one: give more recordings, or "
            f"a larger fraction than {fractions[empty[0]]:g}"
        )
    groups = [set(sources[a:b]) for a, b in zip(bounds[:-1], bounds[1:], strict=True)]
    return tuple([clip for clip in clips if clip.source in group] for group in groups)
