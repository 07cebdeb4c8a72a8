"""What recipes of dancers, movers and in-betweeners have in common: the weights of eq. 4."""

from dataclasses import dataclass

from ..kinematic_loss import KinematicWeights
from .training import Recipe

KINEMATIC = KinematicWeights(
    skeleton=400.0, asymmetry=5.0, motion=0.0, slide=0.3, over_time="alpha_bar"
)


@dataclass(frozen=True)
class MoFusionRecipe(Recipe):
    """The weights of a loss: of its kinematic terms, and in its data term (`beyond.loss_terms`)."""

    kinematic: KinematicWeights | None = KINEMATIC  # None: no kinematic losses
    changes: float = 5.0
    toes: float = 0.2
