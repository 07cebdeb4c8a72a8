"""What happens at the repair bench.

A window of a walk loses joints or frames, the walker mends it, and it is judged.

No browser here: the widget shows what comes out.  Source: MoDiff III-E, Fig. 6.
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
from .repairs import Mended, mend_steps


@dataclass(frozen=True, eq=False)
class Outcome:
    """Where the repairs are in the world (metres), and what is to be said of them.

    The mean comes first, and then each.
    """

    motions: Float[np.ndarray, "n T_h J 3"]
    mended: Mended
    words: str


@dataclass(frozen=True, eq=False)
class RepairBench:
    """A walk and a walker.

    `first` + T_h frames of the walk are the window, and T_h frames must follow it.

    `samples` repairs are drawn in `rounds` rounds with `steps` steps of DDIM, always from the same
    `seed`.
    Raises ValueError for a walk that is too short, or has not 20 frames/s.
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
                f"{self.T_h} to be mended, and the control of {self.T_h} to walk there and back"
            )
        if self.clip.fps != FPS:
            raise ValueError(
                f"the walker knows {FPS:g} frames/s, and the walk has {self.clip.fps:g}: "
                "resample it first"
            )

    @property
    def T_h(self) -> int:
        """Frames in the window."""
        return self.walker.config.T_h

    @property
    def last_first(self) -> int:
        """The last frame at which a window may begin."""
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
                    f"entry {number} is not among the {len(known)} of the window ({self.T_h} x {J})"
                )
            known[number] = False
        return known.reshape(self.T_h, J)

    def mend(self, first: int, missing: Iterable[int]) -> Iterator[Outcome]:
        """After each round there and back, the repairs in the world and what is to be said.

        Raises ValueError for a window that is not within the walk, or in which nothing, or all, is
        missing.
        """
        if not 0 <= first <= self.last_first:
            raise ValueError(
                f"the window begins at frame {first}; it may begin at 0 to {self.last_first}"
            )
        known, T_h = self.known(missing), self.T_h
        truth = self.clip.poses[first : first + T_h]
        control = self.clip.control[first : first + 2 * T_h]
        path, heading = root_path(self.clip.control)
        start = (*path[first], heading[first])
        holes = np.where(known[..., None], truth, np.nan)
        loop = mend_steps(
            self.walker, holes, known, control, self.samples, rounds=self.rounds, steps=self.steps,
            generator=torch.Generator().manual_seed(self.seed),
        )  # fmt: skip
        for mended in loop:
            world = [
                to_world(poses, control[:T_h], start) for poses in (mended.mean, *mended.samples)
            ]
            yield Outcome(np.stack(world), mended, self._words(mended, truth))

    def _words(self, mended: Mended, truth: Float[np.ndarray, "T_h J 3"]) -> str:
        found, holes = mended.errors(truth), int((~mended.known).sum())
        return (
            f"Round {mended.round} of {self.rounds}: {holes} of {mended.known.size} places were "
            f"missing. From the truth the mean of {len(mended.samples)} repairs is "
            f"{found['their mean']:.1f} cm away, one repair {found['one repair']:.1f} cm; bones "
            f"err by {found['bones of the mean']:.2f} and {found['bones of one']:.2f} cm. "
            f"The last round moved the repairs by {100 * mended.change:.1f} cm."
        )
