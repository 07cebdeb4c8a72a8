"""Recipes of the movers: data, sizes, losses and steps, in one record each.

The paper gives no widths, no steps and no weights of its losses, so all numbers are ours.
"""

from dataclasses import dataclass, replace

from ..conditions import clip
from ..kinematic_loss import KinematicWeights
from ..performers.planned_mofusion import PlannedConfig
from ..performers.text_mofusion import TextMoFusionConfig
from .dancers import KINEMATIC, OURS, DanceLossWeights


@dataclass(frozen=True)
class MoverRecipe:
    """One training run of a mover; by default with the paper's loss.

    The data are `clips` described clips of `data_synth.actions`; every clip is also mirrored, with
    its words. The words of the configuration are those of the captions, unless it names a CLIP.
    """

    name: str
    config: TextMoFusionConfig
    steps: int
    plan_steps: int = 0  # afterwards, of the network for timelines alone, which needs more of them
    kinematic: KinematicWeights | None = None
    loss_weights: DanceLossWeights = DanceLossWeights()
    metres: float = 0.0  # power of `beyond.loss_terms.metre_weights`; 0: all columns alike
    snr: float = 1.0  # factor on the signal-to-noise ratio of the cosine schedule
    frames: int = 3072  # of a batch, all motions together
    no_text: float = 0.0  # share of the texts left out: `beyond.classifier_free`
    lr: float = 2e-3
    optimizer: str = "muon"
    decay: float = 0.999
    clips: int = 12_000
    data_seed: int = 1
    seed: int = 0


MOVER_PLAIN = MoverRecipe(
    "mover-plain",
    PlannedConfig(),
    steps=10_000,
    plan_steps=14_000,
    loss_weights=OURS,
    metres=1.0,
    snr=0.1,
    no_text=0.1,
)
MOVER = replace(MOVER_PLAIN, name="mover", kinematic=replace(KINEMATIC, slide=1.0))
# The paper's own way to read. Never trained here, because no weights of CLIP were at hand.
MOVER_CLIP = replace(
    MOVER, name="mover-clip", config=replace(MOVER.config, clip=clip.NAME, clip_width=clip.WIDTH)
)
MOVER_RECIPES = {recipe.name: recipe for recipe in (MOVER, MOVER_PLAIN, MOVER_CLIP)}
