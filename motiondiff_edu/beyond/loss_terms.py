"""Other losses than the papers' mean square: named terms and weights.

A *loss* takes the error of the network's target (B, T, D) and the steps s (B,), and returns one
number; the papers use `ddpm.squared_error`. `total` adds losses. All of them are sums of squares
of the error or of its differences, and the error times sqrt(w) has a square with the weight w. So
`weighted_by_step` can wrap any loss. `weighted` has a limit: a difference must be of two errors of
one weight. Weights of columns suit the squared error and `changes`. Otherwise an error that both
ends share counts as well, which is right only where the weights convert units
(`recipes.inbetweener`).

    loss = total(weighted(squared_error, metre_weights(std, 1)), changes(5))

Gain: docs/RESULTS.md, *From MoFusion to our dancer*. Of errors of changes: dances differ more
(`dancer-departures.changes.*`). Of errors of toes: feet slide less, and bones are worse
(`dancer-departures.toes.*`).
Ours; neither paper has them.
Notebook: 12
"""

from collections.abc import Callable
from functools import reduce

import torch
from jaxtyping import Float, Int
from torch import Tensor

from ..ddpm import Schedule, Table, at
from ..motion.skeleton import TOES

Error = Float[Tensor, "B T D"]
Loss = Callable[[Error, Int[Tensor, "B"]], Float[Tensor, ""]]
Moves = Callable[[Error], Float[Tensor, "B T2 21 3"]]


def total(*losses: Loss) -> Loss:
    """The sum of losses."""
    return lambda error, s: reduce(torch.add, (loss(error, s) for loss in losses))


# ---- weights -------------------------------------------------------------------------------------
def weighted(loss: Loss, weights: Float[Tensor, "D"] | Float[Tensor, "B T D"]) -> Loss:
    """A loss whose squares have weights, by column (`metre_weights`) or entry.

    Losses of differences (`changes`, `toe_changes`) do not suit all of them: see above.
    """
    roots = weights.sqrt()
    return lambda error, s: loss(roots.to(error) * error, s)


def weighted_by_step(loss: Loss, weights: Table) -> Loss:
    """A loss whose squares have weights by diffusion step (`as_x0_errors`)."""
    roots = weights.sqrt()
    return lambda error, s: loss(at(roots, s, error) * error, s)


def metre_weights(std: Float[Tensor, "D"], power: float) -> Float[Tensor, "D"]:
    """Weights of columns: std^power, with mean 1.

    Power 2 measures errors in metres, power 0 in standard deviations.

    A toe moves ten times as far as a hip, so in metres its errors count more.
    """
    weights = std**power
    return weights / weights.mean()


def as_x0_errors(schedule: Schedule) -> Table:
    """Weights of steps for a network that predicts v: 1 - alpha_bar.

    x0_hat - x0 is sqrt(1 - alpha_bar) times the error of v, so errors count as those of x0.
    """
    return 1 - schedule.alpha_bar


# ---- terms ---------------------------------------------------------------------------------------
def changes(weight: float) -> Loss:
    """weight * the squared error of changes from frame to frame.

    It is large for a dance that jitters about the right poses.
    Notebook: 12
    """
    return lambda error, s: weight * error.diff(dim=1).square().mean()


def toe_changes(weight: float, moves: Moves, std: Float[Tensor, "D"], moved: float) -> Loss:
    """weight * the squared error of the toes' changes in the world / `moved`; for x0.

    A foot stands still only if the errors of pelvis and leg cancel. `moves` of features gives the
    changes of joints (`dance_frame.moves`, `moving_frame.moves`); `std` converts errors to metres.
    `moved` is the mean square change of a toe coordinate in a frame of the data, m^2
    (`performers.dance_windows.toes_moved`).
    """

    def loss(error: Error, s: Int[Tensor, "B"]) -> Float[Tensor, ""]:
        toes = moves(error * std.to(error))[:, :, list(TOES)]
        return weight / moved * toes.square().mean()

    return loss
