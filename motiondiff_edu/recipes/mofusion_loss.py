"""What the losses of dancers and movers share: eq. 4 with the terms that a recipe names."""

from collections.abc import Callable
from dataclasses import dataclass

import torch
from jaxtyping import Bool, Float
from torch import Tensor, nn

from ..beyond import loss_terms
from ..ddpm import Schedule, squared_error
from ..kinematic_loss import Body, KinematicWeights, kinematic_parts, training_loss, weight_by_step
from ..motion.scaler import Scaler

BatchLoss = Callable[[nn.Module, Tensor, object, Tensor, torch.Generator], Tensor]

KINEMATIC = KinematicWeights(
    skeleton=400.0, asymmetry=5.0, motion=0.0, slide=0.3, over_time="alpha_bar"
)


@dataclass(frozen=True)
class DanceLossWeights:
    """Weights of the terms of `beyond.loss_terms` in the data loss. All 0 is the paper's loss.

    changes     weight of `changes`
    toes        weight of `toe_changes`
    high_noise  largest extra weight of `high_noise_weights`
    """

    changes: float = 0.0
    toes: float = 0.0
    high_noise: float = 0.0


OURS = DanceLossWeights(changes=5.0, toes=0.2)


def batch_loss(
    weights: KinematicWeights | None,
    loss: loss_terms.Loss,
    schedule: Schedule,
    scaler: Scaler,
    body_of: Callable[[Scaler], Body],
) -> BatchLoss:
    """A function of (model, x0, context, planted, generator): eq. 4, with `loss` as its data term.

    `weights` None leaves the kinematic losses out. The parts of the batch are on one device.
    `body_of` is that of the features' frame, `dance_frame.body_of` for instance.
    """
    lambda_k = weight_by_step(schedule, weights.over_time) if weights else None

    def of_batch(
        model: nn.Module,
        x0: Float[Tensor, "B T D"],
        context: object,
        planted: Bool[Tensor, "B T 2"],
        generator: torch.Generator,
    ) -> Float[Tensor, ""]:
        body = body_of(scaler.to(x0.device))

        def kinematic(x0_hat: Tensor, x0: Tensor) -> Tensor:
            assert weights
            return weights.total(kinematic_parts(x0_hat, x0, body, planted))

        return training_loss(
            model,
            (x0, context),
            schedule,
            generator,
            kinematic=kinematic if weights else None,
            lambda_k=lambda_k,
            loss=loss,
        )

    return of_batch


def weighted_loss(
    weights: DanceLossWeights,
    schedule: Schedule,
    scaler: Scaler,
    moves: loss_terms.Moves,
    moved: Callable[[], float],
    columns: Float[Tensor, "D"] | None = None,
) -> loss_terms.Loss:
    """The mean square of eq. 4's data term, with the weights and terms that are not 0.

    `moves` is that of the features' frame, `dance_frame.moves` for instance.
    `columns`: weights of the features, for the errors of poses and of their changes.
    `moved()`: the mean square change of a toe's coordinate in the data; asked for with toes alone.
    """
    loss = squared_error
    if weights.changes:
        loss = loss_terms.total(loss, loss_terms.changes(weights.changes))
    if columns is not None:
        loss = loss_terms.weighted(loss, columns)
    if weights.toes:
        toes = loss_terms.toe_changes(weights.toes, moves, scaler.std, moved())
        loss = loss_terms.total(loss, toes)
    if weights.high_noise:
        steps = loss_terms.high_noise_weights(schedule, weights.high_noise)
        loss = loss_terms.weighted_by_step(loss, steps)
    return loss
