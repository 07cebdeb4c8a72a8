"""The plan of the stage: where a move travels, to which side it turns, and how low it goes.

Every move has a way: it goes towards a place on the stage and turns to another wall there. So the
dancer uses the whole floor. The steps of a move can lead farther, those of a waltz up to 3 m from
the start; the next way leads back.
"""

from dataclasses import dataclass, field
from math import hypot, pi, sin

import numpy as np
from jaxtyping import Float
from scipy.interpolate import PchipInterpolator

ROOM = 1.5  # metres from the start: the radius of the stage
TRIES = 3  # places that are drawn; the farthest is chosen, so that there is a way to go
REST_SHARE = 0.25  # of a bar, half of it before a turn and half after: the dancer faces a wall


@dataclass(frozen=True)
class StagePlan:
    """How a genre uses the stage.

    pace   metres a count, for a move of size 1; from outside the stage the way is longer
    turns  degrees a bar, of which one is drawn for each move
    low    metres that the body sinks half-way through a move, at most
    stays  probability that a move turns to the same side as the last one
    """

    pace: float
    turns: tuple[float, ...]
    low: float
    stays: float = 0.6


@dataclass(frozen=True)
class Way:
    """The way of one move: over the stage and round, by count.

    `travel` metres in the world, and `turn` radians at the knots `counts`; `low` is how far the
    body sinks half-way, in metres.
    """

    travel: tuple[float, float] = (0.0, 0.0)
    counts: tuple[float, ...] = (0.0, 1.0)
    turn: tuple[float, ...] = (0.0, 0.0)
    low: float = 0.0
    round: PchipInterpolator = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "round", PchipInterpolator(self.counts, self.turn))

    def turned(self, count: float) -> float:
        """Radians to the left by a count; as at the end after it."""
        return float(self.round(min(max(count, 0.0), self.counts[-1])))

    def travelled(self, count: float) -> tuple[float, float]:
        """Metres, along x and z of the world, by a count; as at the end after it."""
        share = min(max(count / self.counts[-1], 0.0), 1.0)
        return self.travel[0] * share, self.travel[1] * share

    def sunk(self, count: float) -> float:
        """Metres that the body is lower at a count: nothing at both ends, `low` in the middle."""
        return self.low * sin(pi * min(max(count / self.counts[-1], 0.0), 1.0)) ** 2


def way(
    plan: StagePlan,
    here: tuple[float, float],
    counts: int,
    metre: int,
    before: float,
    size: float,
    rng: np.random.Generator,
) -> Way:
    """The way of the next move, from `here` (metres), in `counts` counts of bars of `metre`.

    before  radians that the last move turned; its sign may stay
    size    of the move: a calm one travels and turns less
    """
    places = _places(rng)
    goal = places[int(np.argmax(np.hypot(*(places - here).T)))]
    gap = goal - here
    outside = max(hypot(*here) - ROOM, 0.0)  # the moves themselves can lead there
    far = min((plan.pace * size * counts + outside) / max(hypot(*gap), 1e-6), 1.0)
    side = float(np.sign(before) or rng.choice([-1.0, 1.0]))
    side *= 1.0 if rng.random() < plan.stays else -1.0
    a_bar = side * np.radians(rng.choice(plan.turns)) * min(size, 1.0)
    knots, turn = [0.0], [0.0]
    for first in range(0, counts, metre):
        last = min(first + metre, counts)
        rest = REST_SHARE * (last - first) / 2
        turn += [turn[-1], turn[-1] + a_bar * (last - first) / metre]
        knots += [first + rest, last - rest]
    return Way(
        (float(far * gap[0]), float(far * gap[1])),
        (*knots, float(counts)),
        tuple(float(t) for t in (*turn, turn[-1])),
        plan.low * float(rng.random() ** 2),
    )


def _places(rng: np.random.Generator) -> Float[np.ndarray, "K 2"]:
    """Places anywhere on the stage, each as likely as another."""
    radius, angle = ROOM * np.sqrt(rng.random(TRIES)), 2 * pi * rng.random(TRIES)
    return np.stack([radius * np.sin(angle), radius * np.cos(angle)], -1)
