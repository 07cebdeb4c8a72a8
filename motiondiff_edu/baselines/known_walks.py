"""In-betweening problems with a known answer: windows of walking under a fitted mixture.

A window has `frames` poses, one in `every` frames of the recording; its first half is the past. Its
columns are standardised.
Source: ours; the holes are those of MoFusion 4.4 and MoDiff III-E.  Notebook: 15
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import torch
from jaxtyping import Bool, Float
from torch import Tensor

from ..ddpm import Schedule
from ..editing.masks import body_part, keyframes, seed
from ..motion.clip import Clip
from ..motion.scaler import Scaler
from ..motion.skeleton import JOINTS, J
from .known_answer import Problem
from .mixture_fit import WindowMixture, fit_windows


@dataclass(frozen=True, eq=False)
class WalkMixture:
    """A mixture fitted to short windows of walking, and the scaler of a pose's coordinates."""

    fitted: WindowMixture
    scaler: Scaler
    frames: int

    @cached_property
    def truth(self):
        """The mixture over all frames * 63 entries."""
        return self.fitted.whole

    def metres(self, x: Float[Tensor, "N D"]) -> Float[np.ndarray, "N T 21 3"]:
        """Windows as poses in the root frame."""
        poses = self.scaler.inverse(x.reshape(len(x), self.frames, -1))
        return poses.reshape(len(x), self.frames, J, 3).double().numpy()

    def problem(
        self,
        window: Float[Tensor, "D"],
        known: Bool[np.ndarray, "T J"],
        schedule: Schedule,
        past: bool = False,
    ) -> Problem:
        """The problem to fill in the unknown entries of this window.

        `past=True` compares only the first half, and allows there-and-back as a method.
        """
        columns = torch.from_numpy(np.repeat(known, 3, axis=1)).flatten()
        half = torch.arange(len(columns)) < (self.frames // 2) * 3 * J
        denoise = self.fitted.denoiser(schedule)
        return Problem(
            self.truth, denoise, schedule, window, columns, half if past else None, self.frames
        )


def fit_walks(
    clips: Sequence[Clip],
    frames: int = 8,
    every: int = 2,
    K: int = 5,
    axes: int = 24,
    *,
    generator: torch.Generator | None = None,
) -> WalkMixture:
    """Fit K Gaussians to all windows of these walks, a fifth of a second apart.

    Raises ValueError if no clip is long enough, and as `fit_windows` does.  Notebook: 15
    """
    span = (frames - 1) * every + 1
    rows = [
        clip.features()[first : first + span : every]
        for clip in clips
        for first in range(0, len(clip) - span + 1, 4)
    ]
    if not rows:
        raise ValueError(f"no clip has {span} frames or more, so there is no window to fit")
    poses = torch.from_numpy(np.stack(rows))
    scaler = Scaler.fit(poses)
    return WalkMixture(
        fit_windows(scaler.transform(poses).flatten(1), K, axes, generator=generator),
        scaler,
        frames,
    )


def holes(frames: int) -> dict[str, Bool[np.ndarray, "T J"]]:
    """Masks for a window: a seed, keyframes, or a part of the body is given.

    Notebook: 15
    """
    return {
        "seed": seed(frames, frames // 2),
        "keyframes": keyframes(frames, frames),
        "lower body": body_part(frames, "lower body"),
    }


def holes_in_the_past(frames: int) -> dict[str, Bool[np.ndarray, "T J"]]:
    """Masks whose first half lacks the frames between its ends, or a leg.

    The second half is missing completely.
    """
    past = np.arange(frames)[:, None] < frames // 2
    ends = np.isin(np.arange(frames), (0, frames // 2 - 1))[:, None]
    leg = np.array(
        [name.startswith("Right") and name.endswith(("Leg", "Foot", "ToeBase")) for name in JOINTS]
    )
    return {"frames": np.repeat(ends, J, axis=1), "leg": past & ~leg}
