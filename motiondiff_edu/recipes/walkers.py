"""How the shipped walkers are made: data, sizes, steps. One record each; nothing is tuned by hand
afterwards.

Source: MoDiff IV-A gives Adam, batch 64, 5e-5 and 1000 epochs on a GPU: WALKER_PAPER. The others
are ours, for a core and an hour; those that are shipped had four fifths of their steps in bfloat16,
as their cards say.   Notebook: 07
"""

from dataclasses import dataclass, replace

from ..beyond.footholds import FootholdConfig
from ..diffusion_dropout import P_D
from ..modiff import MODIFF_PAPER, MODIFF_SMALL, MoDiffConfig


@dataclass(frozen=True)
class Recipe:
    """One training run. `seconds` of each of `clips` clips are made with the data seed; mirrored
    and reversed later."""

    name: str
    config: MoDiffConfig
    steps: int
    schedule: str = "linear"  # or "leap", see beyond.schedules
    lr: float = 2e-3
    optimizer: str = "muon"  # or "adam", the paper's
    batch: int = 64  # windows a step
    noises: int = 2  # diffusion steps drawn for each window
    jitter: float = 0.3  # of the past, in standard deviations
    metres: float = (
        2.0  # columns of the loss are weighted by their standard deviation to this power
    )
    near: float = 1.0  # its frames by one over how far poses move until then, to this power
    high_noise: float = 0.0  # largest extra weight of steps that are mostly noise
    bones: float = 2.0  # weight of the errors of bones, beside those of joints
    doubt: float = 0.05  # share of the shaking that reaches the feet's places, see foothold.py
    dropout: tuple[
        float, ...
    ] = ()  # rates of diffusion dropout, one after the other; none: no dropout
    calm: float = 0.5  # share of the training before the first of them
    decay: float = 0.999
    clips: int = 720
    seconds: float = 20.0
    reversed_share: float = 0.25  # of the clips also played backwards
    data_seed: int = 1
    seed: int = 0
    styles: tuple[str, ...] | None = None
    save_every: int = 2000  # steps

    @property
    def loss_settings(self) -> dict:
        """What `performers.windows.window_loss` is to be told."""
        names = ("batch", "noises", "jitter", "metres", "near", "high_noise", "bones", "doubt")
        return {name: getattr(self, name) for name in names}


SMALL_FEET = FootholdConfig(width=128, hidden=256, cross_layers=2)  # MODIFF_SMALL with footholds
WALKER_X0 = Recipe("walker-x0", SMALL_FEET, steps=20_000, schedule="leap")
WALKER_EPS = Recipe("walker-eps", MODIFF_SMALL, steps=20_000, schedule="leap", high_noise=3.0)
# The paper's sizes, Adam, 5e-5, batch 64, plain loss. Ours: the data, whose windows start at every
# frame (so 300,000 steps, not epochs) and hold the control in half of the cases; the skip; the
# warm-up and cosine of the rate.
WALKER_PAPER = Recipe(
    "walker-paper", MODIFF_PAPER, steps=300_000, lr=5e-5, optimizer="adam", noises=1, jitter=0.0, metres=0.0, near=0.0,
    bones=0.0, clips=2400,
)  # fmt: skip

# Pairs of small walkers, alike but for diffusion dropout, each with three training seeds: notebooks
# 09 and 10. Their pasts are not shaken: that is our remedy for what the paper's dropout is to mend.
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
MEND_PLAIN = Recipe(
    "mend-plain",
    MEND_CONFIG,
    steps=8000,
    schedule="leap",
    batch=32,
    lr=3e-3,
    jitter=0.0,
    clips=360,
    save_every=500,
)
MEND_DROPOUT = replace(MEND_PLAIN, name="mend-dropout", dropout=P_D)
PAIRS = tuple(
    replace(one, name=f"{one.name}-{k}", seed=k)
    for k in range(3)
    for one in (MEND_PLAIN, MEND_DROPOUT)
)

SHIPPED = (WALKER_X0, WALKER_EPS, *PAIRS)
RECIPES = {recipe.name: recipe for recipe in (*SHIPPED, WALKER_PAPER)}
