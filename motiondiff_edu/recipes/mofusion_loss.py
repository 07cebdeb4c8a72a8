"""What the losses of dancers, movers and in-betweeners share: the numbers of eq. 4."""

from jaxtyping import Float
from torch import Tensor

from ..beyond.loss_terms import Loss, changes, total, weighted
from ..ddpm import squared_error
from ..kinematic_loss import KinematicWeights

KINEMATIC = KinematicWeights(
    skeleton=400.0, asymmetry=5.0, motion=0.0, slide=0.3, over_time="alpha_bar"
)
CHANGES, TOE_CHANGES = 5.0, 0.2  # weights, see `beyond.loss_terms`


def data_loss(of_changes: float, of_toes: Loss, columns: Float[Tensor, "D"] | None = None) -> Loss:
    """The data term: squared errors of poses and of their changes, and the toes' (`toe_changes`).

    `columns`: weights of the features, for the errors of poses and of their changes.
    """
    poses = total(squared_error, changes(of_changes))
    return total(poses if columns is None else weighted(poses, columns), of_toes)
