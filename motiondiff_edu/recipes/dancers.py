"""Recipes of the shipped dancers: data, sizes, losses and steps, in one record each.

The paper gives no widths, no steps and no weights of its losses, so all numbers are ours.
Notebook: 13
"""

from dataclasses import dataclass, replace

from ..baselines.transformer import HearingTransformerConfig
from ..kinematic_loss import KinematicWeights
from ..mofusion import MOFUSION_FULL, MOFUSION_SMALL
from ..performers.hearing_mofusion import HearingConfig
from ..performers.networks import Config
from .ear import EAR, EarRecipe

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


@dataclass(frozen=True)
class DanceRecipe:
    """One training run of a dancer; by default with the paper's loss.

    The data are `songs` songs of `seconds` each with `dances` dances each; every dance is also
    mirrored.
    """

    name: str
    config: Config  # of a network for dancers (`performers.networks`)
    steps: int
    kinematic: KinematicWeights | None = None
    loss_weights: DanceLossWeights = DanceLossWeights()
    gain_noise: float = 0.0  # `beyond.gain_noise`
    snr: float = 1.0  # factor on the signal-to-noise ratio of the cosine schedule
    frames: int = 100  # per window
    lr: float = 3e-3
    optimizer: str = "muon"
    batch: int = 32
    decay: float = 0.999
    songs: int = 1500
    seconds: float = 20.0
    dances: int = 2  # per song
    motions: int = 0  # if not 0: so many walks and dances without music, instead of songs
    data_seed: int = 1
    seed: int = 0


@dataclass(frozen=True)
class SongRecipe(DanceRecipe):
    """A training run on songs like real ones, usually with an ear that is trained first.

    Raises ValueError for a regression that is to dance without music, too (it has one dance only),
    and for an ear that does not fit the network.
    """

    no_music: float = 0.0  # share of the music left out: `beyond.classifier_free`
    ear: EarRecipe | None = EAR

    def __post_init__(self):
        if self.no_music and getattr(self.config, "deterministic", False):
            raise ValueError("no_music: a regression cannot be guided, so it always has its music")
        own = getattr(self.config, "ear", None)
        given = self.ear.config if self.ear else None
        if own != given:
            wanted = f"an ear with {own}" if own else "no ear: pass ear=None"
            found = (
                f"the ear given has {given}" if given else "none is given: pass ear=EarRecipe(...)"
            )
            raise ValueError(f"{self.name}: its network has {wanted}; {found}")


X0 = replace(MOFUSION_SMALL, target="x0", skip=False)
HEARING = HearingConfig(target="x0", skip=False)
OURS = DanceLossWeights(changes=5.0, toes=0.2)
DANCER_PLAIN = SongRecipe(
    "dancer-plain", HEARING, steps=8_000, loss_weights=OURS, gain_noise=0.3, snr=0.1, no_music=0.15
)
DANCER = replace(DANCER_PLAIN, name="dancer", kinematic=KINEMATIC)
REGRESSED = SongRecipe(
    "regression",
    HearingTransformerConfig(deterministic=True),
    steps=3000,
    gain_noise=0.3,
    snr=0.1,
)
# never trained: it needs a GPU
FULL = replace(HEARING, widths=MOFUSION_FULL.widths, heads=MOFUSION_FULL.heads)
DANCER_FULL = replace(DANCER, name="dancer-full", config=FULL, steps=200_000, batch=64)

UNCONDITIONAL = DanceRecipe(
    "unconditional",
    replace(X0, C=0),
    steps=6000,
    kinematic=KINEMATIC,
    loss_weights=OURS,
    gain_noise=0.3,
    snr=0.1,
    songs=0,
    motions=3000,
)

SHIPPED_DANCERS = (DANCER, DANCER_PLAIN, REGRESSED, UNCONDITIONAL)
DANCE_RECIPES = {recipe.name: recipe for recipe in (*SHIPPED_DANCERS, DANCER_FULL)}
