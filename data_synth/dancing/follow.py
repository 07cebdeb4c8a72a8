"""Feet follow the body: none points farther in or out than a leg allows.

A move turns the body, and its feet step and pivot with it. Where a move gives them no time, they
are left behind. So a standing foot that would point too far from where the body faces pivots on its
ball, and a foot in the air lands within reach.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from .curves import curve
from .script import Script, Step, Toe

IN, OUT = np.radians((-35.0, 55.0))  # of a foot against the body, outwards
AT_EASE = np.radians(7.0)
LASTS, SHORTEST = 0.55, 0.16  # beats of a pivot
AHEAD = 0.4  # beats: a pivot goes to where the body faces by then, so that the next one can wait
EVERY = 0.05  # beats between two looks at a standing foot


def facing(script: Script, b: Float[np.ndarray, "T"]) -> Float[np.ndarray, "T"]:
    """Where the body faces at beats b, in radians to the left: by its moves, and by the stage's."""
    own = curve(b, script.keys["heading"], hold=0.0, flow=0.8)
    return own + curve(b, script.floor, hold=0.0, flow=1.0)


def followed(
    script: Script, start: tuple[Toe, Toe], beats: tuple[float, float]
) -> tuple[list[Step], list[Step]]:
    """The steps of both feet, which stand at `start`, with the pivots that were missing.

    beats   the first and the last one of the dance
    """
    grid = np.arange(beats[0], beats[1] + EVERY, EVERY)
    body = grid, facing(script, grid)
    left, right = (
        list(_Follower(body, side, toe).through(steps, beats))
        for steps, side, toe in zip(script.steps, (1.0, -1.0), start, strict=True)
    )
    return left, right


@dataclass
class _Follower:
    """One foot on its way through its steps; `side` is 1 for the left one, and outwards."""

    body: tuple[Float[np.ndarray, "T"], Float[np.ndarray, "T"]]
    side: float
    toe: Toe

    def through(self, steps: list[Step], beats: tuple[float, float]) -> Iterator[Step]:
        """The steps, each after the pivots that the foot needs until it lifts."""
        stands, last = beats
        for step in steps:
            yield from self.pivots(stands, step.lift)
            self.toe = (step.x, step.z, self.within(step.yaw, step.land))
            yield replace(step, yaw=self.toe[2])
            stands = step.land
        yield from self.pivots(stands, last)

    def pivots(self, stands: float, until: float) -> Iterator[Step]:
        """Pivots on the spot from one beat to another, so that the foot never points too far."""
        while True:
            beats = np.arange(stands, until, EVERY)
            off = self.side * (self.toe[2] - np.interp(beats, *self.body))
            far = np.flatnonzero((off < IN) | (off > OUT))
            if not len(far):
                return
            begins = max(beats[far[0]] - LASTS / 2, stands + 0.02)
            ends = min(begins + LASTS, until - 0.02)
            if ends - begins < SHORTEST:
                return
            x, z, _ = self.toe
            soon = float(np.interp(ends + AHEAD, *self.body)) + self.side * AT_EASE
            self.toe = (x, z, self.within(soon, ends))
            yield Step(begins, ends, *self.toe, 0.0, pivot=True)
            stands = ends

    def within(self, yaw: float, beat: float) -> float:
        """The direction, or the nearest one that a leg allows at this beat."""
        body = float(np.interp(beat, *self.body))
        return body + self.side * float(np.clip(self.side * (yaw - body), IN, OUT))
