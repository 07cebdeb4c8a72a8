"""How the shipped dancers are made: data, sizes, losses, steps. One record each.

The paper gives neither widths nor steps nor the weights of its losses: all numbers are ours.
Notebook: 13
"""

from dataclasses import dataclass, replace

from ..baselines.regression import REGRESSION
from ..baselines.transformer import TransformerConfig
from ..kinematic_loss import KinematicWeights
from ..mofusion import MOFUSION_FULL, MOFUSION_SMALL, MoFusionConfig

KINEMATIC = KinematicWeights(
    skeleton=400.0, asymmetry=5.0, motion=0.0, slide=0.3, over_time="alpha_bar"
)


@dataclass(frozen=True)
class DanceRecipe:
    """One training run on `songs` songs of `seconds` each, `dances` to each song, every dance
    mirrored as well."""

    name: str
    config: MoFusionConfig | TransformerConfig
    steps: int
    kinematic: KinematicWeights | None = None
    high_noise: float = 0.0  # largest extra weight of steps that are mostly noise
    changes: float = (
        5.0  # weight of the errors of changes from frame to frame, beside those of poses
    )
    feet: float = 0.2  # weight of the errors of the toes' changes in the world
    shake: float = 0.3  # how much the music's level and balance vary (`DanceWindows.draw`)
    snr: float = 0.1  # of the cosine schedule: its signal-to-noise ratio is multiplied by it
    frames: int = 100  # of a window
    lr: float = 3e-3
    optimizer: str = "muon"
    batch: int = 32
    decay: float = 0.999
    songs: int = 1500
    seconds: float = 20.0
    dances: int = 2  # to each song
    motions: int = 0  # walks and dances without music, in place of songs
    data_seed: int = 1
    seed: int = 0
    save_every: int = 250  # steps

    @property
    def loss_settings(self) -> dict:
        """What `performers.dance_windows.dance_loss` is to be told."""
        return {
            name: getattr(self, name)
            for name in ("batch", "high_noise", "changes", "feet", "shake")
        }


X0 = replace(MOFUSION_SMALL, target="x0", skip=False)
DANCER = DanceRecipe("dancer", X0, steps=10_000, kinematic=KINEMATIC)
DANCER_PLAIN = DanceRecipe("dancer-plain", X0, steps=10_000)
REGRESSED = DanceRecipe("regression", REGRESSION, steps=3000)
FULL = replace(MOFUSION_FULL, target="x0", skip=False)  # never trained: it wants a GPU
DANCER_FULL = replace(DANCER, name="dancer-full", config=FULL, steps=200_000, batch=64)

UNCONDITIONAL = DanceRecipe(
    "unconditional", replace(X0, C=0), steps=6000, kinematic=KINEMATIC, songs=0, motions=3000
)

SHIPPED_DANCERS = (DANCER, DANCER_PLAIN, REGRESSED, UNCONDITIONAL)
DANCE_RECIPES = {recipe.name: recipe for recipe in (*SHIPPED_DANCERS, DANCER_FULL)}
