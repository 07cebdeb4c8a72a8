"""How the shipped walkers are made: data, sizes, steps.

One record each. The numbers of `footholds` were chosen on walks; nothing else is tuned by hand.

Source: MoDiff IV-A gives Adam, batch 64, 5e-5 and 1000 epochs on a GPU: WALKER_PAPER. The others
are ours, for one core and about an hour each. WALKER_TRUNK and `walker-eps` had four fifths of
their steps in bfloat16; the card of `walker-eps` says so.
"""

from dataclasses import dataclass, replace

from ..beyond.footholds import FootholdConfig
from ..diffusion_dropout import P_D, START
from ..modiff import MODIFF_PAPER, MODIFF_SMALL, MoDiffConfig
from ..performers.networks import Config


@dataclass(frozen=True)
class LossWeights:
    """What the loss adds to eq. 10, by the names of `beyond.loss_terms`. All 0 is the paper's loss.

    `metres`: power of `metre_weights`.  `near`: power of `near_weights`.
    `high_noise`: largest extra weight of `high_noise_weights`.  `bones`: weight of `bones`.
    """

    metres: float = 0.0
    near: float = 0.0
    high_noise: float = 0.0
    bones: float = 0.0


@dataclass(frozen=True)
class Recipe:
    """One training run of a walker.

    The defaults of optimizer and loss are the paper's, without its diffusion dropout. The paper
    gives no schedule: the linear one is TimeGrad's. The rate, the data and the held control are
    ours.
    `clips` clips of `seconds` each are made from the data seed; later they are mirrored, and some
    are reversed in time.
    """

    name: str
    config: Config  # of a network for walkers (`performers.networks`)
    steps: int
    schedule: str = "linear"  # or "leap": `beyond.schedules`
    lr: float = 2e-3
    optimizer: str = "adam"  # or "muon": `recipes.muon`
    batch: int = 64  # windows a step
    noises: int = 1  # diffusion steps drawn for each window: `beyond.shared_encoding`
    held_control: float = 0.5  # share of the windows: `beyond.held_control`
    past_noise: float = 0.0  # standard deviations: `beyond.past_noise`
    foot_noise: float = 0.05  # fraction of it under the held feet: `beyond.footholds`
    loss_weights: LossWeights = LossWeights()
    dropout: tuple[float, ...] = ()  # rates P_d of diffusion dropout in turn; none: no dropout
    dropout_start: float = START  # share of the training before the first of them
    noised_past_weight: float = 1.0  # of windows with a noised past: `beyond.noised_past_weight`
    begins_with: str = ""  # the recipe whose network this training continues; none: a fresh one
    decay: float = 0.999
    clips: int = 720
    seconds: float = 20.0
    reversed_share: float = 0.25  # of the clips also played backwards
    data_seed: int = 1
    seed: int = 0
    styles: tuple[str, ...] | None = None  # of walking; None: all

    def __post_init__(self):
        """Raises ValueError for batch or noises under 1, and an unknown schedule or optimizer."""
        for name, there in (("schedule", ("linear", "leap")), ("optimizer", ("adam", "muon"))):
            if getattr(self, name) not in there:
                raise ValueError(
                    f"{name} must be {' or '.join(there)}, not {getattr(self, name)!r}"
                )
        if min(self.batch, self.noises) < 1:
            raise ValueError(
                f"a batch needs a window and a noise at least, not batch = {self.batch}, "
                f"noises = {self.noises}"
            )


SMALL_FEET = FootholdConfig(width=128, hidden=256, cross_layers=2)  # MODIFF_SMALL with footholds
OURS = LossWeights(metres=2.0, near=1.0, bones=2.0)
# The paper's rate of diffusion dropout is 0 at first. So `walker` and `walker-plain` have the first
# part of their training in common, WALKER_TRUNK, and each continues it: with the paper's rates, and
# without. The learning rate falls to 0 in both parts.
WALKER_TRUNK = Recipe(
    "walker-trunk",
    SMALL_FEET,
    steps=20_000,
    schedule="leap",
    optimizer="muon",
    noises=2,
    past_noise=0.3,
    loss_weights=OURS,
)
WALKER_PLAIN = replace(
    WALKER_TRUNK,
    name="walker-plain",
    begins_with="walker-trunk",
    steps=12_000,
    lr=1e-3,
    seed=1,
)
WALKER = replace(
    WALKER_PLAIN, name="walker", dropout=P_D, dropout_start=0.0, noised_past_weight=0.2
)
WALKER_EPS = replace(
    WALKER_TRUNK,
    name="walker-eps",
    config=MODIFF_SMALL,
    loss_weights=replace(OURS, high_noise=3.0),
)
# The paper's recipe as it stands, at our small size: eps without a skip, Adam at 5e-5, batch 64,
# the plain loss, diffusion dropout, control never held. Ours: the data, the warm-up and cosine of
# the rate, and what the paper does not give: the linear schedule is TimeGrad's.
WALKER_PRINTED = Recipe(
    "walker-printed",
    replace(MODIFF_SMALL, skip=False),
    steps=12_000,
    lr=5e-5,
    held_control=0.0,
    dropout=P_D,
)
# The same at the paper's sizes. Ours: 300,000 steps and not 1000 epochs, for our data have windows
# that start at every frame. Nobody has trained it.
WALKER_PAPER = replace(
    WALKER_PRINTED, name="walker-paper", config=MODIFF_PAPER, steps=300_000, clips=2400
)

# Pairs of small walkers, alike but for diffusion dropout, each with three training seeds: notebooks
# 09 and 10. Their pasts have no other noise: past noise is our alternative to the paper's dropout.
MEND_CONFIG = MoDiffConfig(
    width=64,
    hidden=128,
    motion_layers=1,
    control_layers=1,
    cross_layers=2,
    decoder_layers=2,
    target="x0",
    skip=False,
)
MEND_PLAIN = replace(
    WALKER_TRUNK,
    name="mend-plain",
    config=MEND_CONFIG,
    steps=8000,
    batch=32,
    lr=3e-3,
    past_noise=0.0,
    clips=360,
)
MEND_DROPOUT = replace(MEND_PLAIN, name="mend-dropout", dropout=P_D)
PAIRS = tuple(
    replace(one, name=f"{one.name}-{k}", seed=k)
    for k in range(3)
    for one in (MEND_PLAIN, MEND_DROPOUT)
)

SHIPPED = (WALKER, WALKER_PLAIN, WALKER_PRINTED, WALKER_EPS, *PAIRS)
RECIPES = {recipe.name: recipe for recipe in (*SHIPPED, WALKER_TRUNK, WALKER_PAPER)}
