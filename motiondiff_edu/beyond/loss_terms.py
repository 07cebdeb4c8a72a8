"""Other losses than the papers' mean square: named terms and weights.

A *loss* takes the error of the network's target (B, T, D) and the steps s (B,), and returns one
number; the papers use `ddpm.squared_error`. `total` adds losses. All of them are sums of squares
of the error or of its differences, and the error times sqrt(w) has a square with the weight w. So
`weighted_by_step` can wrap any loss. `weighted` has a limit: a difference must be of two errors of
one weight. Weights of frames suit the squared error and `bones`, those of columns the squared error
and `changes`. Otherwise an error that both ends share counts as well, which is right only where the
weights convert units (`recipes.inbetweener`).

    in_metres = weighted(squared_error, metre_weights(std))
    loss = weighted(total(in_metres, bones(2, std)), near_weights(change))

Gain: docs/RESULTS.md, *From the paper's walker to ours* (`ladder.ours-plain-loss.*`): bone errors
are smaller, feet slide more and the control is kept less well. docs/RESULTS_ALL.md
(`dance-budget.poses.*`, `.no-feet.*`, `.eps-weighted.*`).
Ours; neither paper has them.
Notebook: 07, 12
"""

from collections.abc import Callable
from functools import reduce

import numpy as np
import torch
from jaxtyping import Float, Int
from torch import Tensor

from ..ddpm import Schedule, Table, at
from ..motion.skeleton import BONES, TOES

Error = Float[Tensor, "B T D"]
Loss = Callable[[Error, Int[Tensor, "B"]], Float[Tensor, ""]]
Moves = Callable[[Error], Float[Tensor, "B T2 21 3"]]


def total(*losses: Loss) -> Loss:
    """The sum of losses.

    Notebook: 07
    """
    return lambda error, s: reduce(torch.add, (loss(error, s) for loss in losses))


# ---- weights -------------------------------------------------------------------------------------
def weighted(
    loss: Loss, weights: Float[Tensor, "D"] | Float[Tensor, "T 1"] | Float[Tensor, "B T D"]
) -> Loss:
    """A loss whose squares have weights, by column (`metre_weights`), frame (`near_weights`) or
    entry.

    Losses of differences (`bones`, `changes`, `toe_changes`) do not suit all of them: see above.
    """
    roots = weights.sqrt()
    return lambda error, s: loss(roots.to(error) * error, s)


def weighted_by_step(loss: Loss, weights: Table) -> Loss:
    """A loss whose squares have weights by diffusion step (`high_noise_weights`)."""
    roots = weights.sqrt()
    return lambda error, s: loss(at(roots, s, error) * error, s)


def metre_weights(std: Float[Tensor, "D"], power: float = 2.0) -> Float[Tensor, "D"]:
    """Weights of columns: std^power, with mean 1.

    Power 2 measures errors in metres, power 0 in standard deviations.

    A toe moves ten times as far as a hip, so in metres its errors count more.
    """
    weights = std**power
    return weights / weights.mean()


def near_weights(change: Float[Tensor, "T D"], power: float = 1.0) -> Float[Tensor, "T 1"]:
    """Weights of future frames: 1 / (how far poses move until then)^power, with mean 1.

    `change` is how far each column moves in 1, 2, ... frames, in metres. The first frame moves
    least and gets the largest weight; it is the only frame of a window that a rollout keeps.
    Raises ValueError where nothing moves.
    """
    if not change.any(1).all():
        raise ValueError("nothing moves in these windows, so no frame is nearer than another")
    weights = 1 / change.square().mean(1, keepdim=True).sqrt() ** power
    return weights / weights.mean()


def high_noise_weights(schedule: Schedule, largest: float) -> Table:
    """Weights of steps: 1 + min((1 - alpha_bar) / alpha_bar, largest).

    For eps: at high noise eps is nearly x_s itself, so its error is small, but these steps decide
    the pose.
    """
    noise_over_signal = (1 - schedule.alpha_bar) / schedule.alpha_bar
    return 1 + noise_over_signal.clamp_max(largest)


def as_x0_errors(schedule: Schedule) -> Table:
    """Weights of steps for a network that predicts v: 1 - alpha_bar.

    x0_hat - x0 is sqrt(1 - alpha_bar) times the error of v, so errors count as those of x0.
    """
    return 1 - schedule.alpha_bar


# ---- terms ---------------------------------------------------------------------------------------
def bones(weight: float, std: Float[Tensor, "D"]) -> Loss:
    """weight * mean of `bone_errors` / mean variance of a column; for x0 in the root frame.

    If knee and ankle have the same error, the shin keeps its length; the errors of single joints do
    not show that. `std` converts errors to metres.  Notebook: 07
    """
    share = weight / std.square().mean()
    return lambda error, s: share.to(error) * bone_errors(error * std.to(error)).mean()


def bone_errors(error: Float[Tensor, "B T D"]) -> Float[Tensor, "B T 20"]:
    """Squared difference between each joint's error and its parent's, averaged over the axes.

    `error` is in metres.
    """
    joints = error.unflatten(-1, (-1, 3))
    parents, children = np.array(BONES).T
    return (joints[..., children, :] - joints[..., parents, :]).square().mean(-1)


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
