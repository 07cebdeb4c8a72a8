"""The model behind the repair bench, without a browser.

A window of a walk loses joints or frames; the walker repairs it, and the repair is compared with
the truth. The widget shows the outcome.  Source: MoDiff III-E, Fig. 6.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Bool, Float

from ..motion.clip import Clip
from ..motion.root_frame import FPS, root_path, to_world
from ..motion.skeleton import J
from ..rollout import AnyWalker
from .repairs import Reconstructions, sample_reconstructions


@dataclass(frozen=True, eq=False)
class Outcome:
    """The mean of the repairs and then each repair, in the world (metres), and words about them."""

    motions: Float[np.ndarray, "n T_h J 3"]
    mended: Reconstructions
    words: str


@dataclass(frozen=True, eq=False)
class RepairBench:
    """A walk, and a walker that repairs windows of it.

    A window is T_h frames of the walk; at least T_h frames must follow it. `samples` repairs are
    drawn in `rounds` rounds with `steps` steps of DDIM, always from the same `seed`.
    Raises ValueError for a walk that is too short, or not at 20 frames/s.
    """

    walker: AnyWalker
    clip: Clip
    samples: int = 10
    rounds: int = 5
    steps: int = 10
    seed: int = 0

    def __post_init__(self):
        if len(self.clip) < 2 * self.T_h:
            raise ValueError(
                f"the walk has {len(self.clip)} frames; the bench needs {2 * self.T_h}: "
                f"{self.T_h} to repair, and the control of {self.T_h} more to walk there and back"
            )
        if self.clip.fps != FPS:
            raise ValueError(
                f"the walker needs {FPS:g} frames/s, but the walk has {self.clip.fps:g}: "
                "resample it first"
            )

    @property
    def T_h(self) -> int:
        """Frames in the window."""
        return self.walker.config.T_h

    @property
    def last_first(self) -> int:
        """The last frame at which a window can begin."""
        return len(self.clip) - 2 * self.T_h

    def known(self, missing: Iterable[int]) -> Bool[np.ndarray, "T_h J"]:
        """The mask of the window.

        `missing` counts joint by joint, then frame by frame: frame x 21 + joint.

        Raises IndexError for a number beyond the window.
        """
        known = np.ones(self.T_h * J, bool)
        for number in missing:
            if not 0 <= number < len(known):
                raise IndexError(
                    f"entry {number} is outside the window's {len(known)} ({self.T_h} x {J})"
                )
            known[number] = False
        return known.reshape(self.T_h, J)

    def mend(self, first: int, missing: Iterable[int]) -> Iterator[Outcome]:
        """Repair the window at frame `first`; yield the outcome after each round there and back.

        Raises ValueError for a window outside the walk, or if nothing or everything is missing.
        """
        if not 0 <= first <= self.last_first:
            raise ValueError(
                f"the window begins at frame {first}; it can begin at 0 to {self.last_first}"
            )
        known, T_h = self.known(missing), self.T_h
        truth = self.clip.poses[first : first + T_h]
        control = self.clip.control[first : first + 2 * T_h]
        path, heading = root_path(self.clip.control)
        start = (*path[first], heading[first])
        holes = np.where(known[..., None], truth, np.nan)
        loop = sample_reconstructions(
            self.walker, holes, known, control, self.samples, rounds=self.rounds, steps=self.steps,
            generator=torch.Generator().manual_seed(self.seed),
        )  # fmt: skip
        for mended in loop:
            world = [
                to_world(poses, control[:T_h], start) for poses in (mended.mean, *mended.samples)
            ]
            yield Outcome(np.stack(world), mended, self._words(mended, truth))

    def _words(self, mended: Reconstructions, truth: Float[np.ndarray, "T_h J 3"]) -> str:
        found, holes = mended.errors(truth), int((~mended.known).sum())
        return (
            f"Round {mended.round} of {self.rounds}: {holes} of {mended.known.size} joint "
            f"positions were missing. Distance to the truth: {found['their mean']:.1f} cm for the "
            f"mean of {len(mended.samples)} repairs, {found['one repair']:.1f} cm for one repair. "
            f"Bone error: {found['bones of the mean']:.2f} cm and {found['bones of one']:.2f} cm. "
            f"The last round moved the repairs by {100 * mended.change:.1f} cm."
        )
