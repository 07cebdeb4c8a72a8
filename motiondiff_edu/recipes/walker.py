"""How walkers are made: data, windows, and Algorithm 1 with past noise and held control.

`loss_of` is the whole of what is trained, `train` the whole of how. A killed run continues where it
was saved last.

Source: MoDiff IV-A gives Adam, batch 64, 5e-5 and 1000 epochs on a GPU: WALKER_PAPER. The others
are ours, for one core and an hour or two each.
Notebook: 07
"""

import hashlib
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import Tensor

from .._files import digest_of_tensors
from ..beyond.past_noise import past_noise
from ..beyond.schedules import SCHEDULES
from ..ddpm import Schedule
from ..diffusion_dropout import P_D, START, Dropout, dropout_rate
from ..modiff import MODIFF_PAPER, MODIFF_SMALL, MoDiffConfig, training_loss
from ..motion.augment import mirror, reverse_time
from ..motion.clip import Clip
from ..motion.formats.files import read_motions
from ..performers.networks import WalkerConfig, network
from ..performers.walker import Walker
from ..performers.windows import Windows, held_control, typical_change
from ..training import LossFn
from .training import Provenance, Recipe, on_device, train_recipe


# ---- recipes -------------------------------------------------------------------------------------
@dataclass(frozen=True)
class WalkerRecipe(Recipe):
    """The sizes and rates of one training run of a walker.

    `clips` clips of `seconds` each are made from the data seed; later they are mirrored, and some
    are reversed in time.
    """

    config: WalkerConfig
    lr: float = 4e-3
    schedule: str = "leap"  # or "linear": `beyond.schedules`
    batch: int = 64  # windows a step
    held_control: float = 0.5  # share of the windows: `performers.windows`
    past_noise: float = 0.3  # standard deviations, at most: `beyond.past_noise`
    dropout: tuple[float, ...] = ()  # rates P_d of diffusion dropout in turn; none: no dropout
    dropout_start: float = START  # share of the training before the first of them
    begins_with: str = ""  # the recipe whose network this training continues; none: a fresh one
    clips: int = 720
    seconds: float = 20.0
    reversed_share: float = 0.25  # of the clips also played backwards
    styles: tuple[str, ...] | None = None  # of walking; None: all

    def __post_init__(self):
        """Raises ValueError for a batch under 1, and an unknown schedule or optimizer."""
        super().__post_init__()
        if self.schedule not in SCHEDULES:
            raise ValueError(f"schedule must be {' or '.join(SCHEDULES)}, not {self.schedule!r}")
        if self.batch < 1:
            raise ValueError(f"a batch needs a window at least, not batch = {self.batch}")


# The paper's rate of diffusion dropout is 0 at first. So `walker` and `walker-plain` have the first
# part of their training in common, WALKER_TRUNK, and each continues it: with the paper's rates, and
# without. The learning rate falls to 0 in both parts.
WALKER_TRUNK = WalkerRecipe("walker-trunk", MODIFF_SMALL, steps=20_000)
WALKER_PLAIN = replace(
    WALKER_TRUNK, name="walker-plain", begins_with="walker-trunk", steps=12_000, lr=2e-3, seed=1
)
WALKER = replace(WALKER_PLAIN, name="walker", dropout=P_D, dropout_start=0.0)
# The paper's recipe as it stands, at our small size: eps without a skip, Adam at 5e-5, batch 64,
# diffusion dropout, control never held. Ours: the data, the warm-up and cosine of the rate, and
# what the paper does not give: the linear schedule is TimeGrad's.
WALKER_PRINTED = WalkerRecipe(
    "walker-printed",
    replace(MODIFF_SMALL, skip=False),
    steps=12_000,
    lr=5e-5,
    optimizer="adam",
    schedule="linear",
    held_control=0.0,
    past_noise=0.0,
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
    width=64, hidden=128, motion_layers=1, control_layers=1, cross_layers=2, decoder_layers=2
)
MEND_PLAIN = replace(
    WALKER_TRUNK, name="mend-plain", config=MEND_CONFIG, steps=8000, past_noise=0.0, clips=360
)
MEND_DROPOUT = replace(MEND_PLAIN, name="mend-dropout", dropout=P_D)
PAIRS = tuple(
    replace(one, name=f"{one.name}-{k}", seed=k)
    for k in range(3)
    for one in (MEND_PLAIN, MEND_DROPOUT)
)

SHIPPED = (WALKER, WALKER_PLAIN, WALKER_PRINTED, *PAIRS)
RECIPES = {recipe.name: recipe for recipe in (*SHIPPED, WALKER_TRUNK, WALKER_PAPER)}


# ---- data ----------------------------------------------------------------------------------------
def training_clips(recipe: WalkerRecipe) -> list[Clip]:
    """The recipe's data, made from its seed.

    Each clip also appears mirrored, and a share of both reversed in time.
    """
    from data_synth.walking import dataset  # data_synth lies beside the package, and imports it

    clips = dataset(recipe.clips, recipe.seconds, seed=recipe.data_seed, styles=recipe.styles)
    both = [version for clip in clips for version in (clip, mirror(clip))]
    chosen = np.random.default_rng(recipe.data_seed).random(len(both)) < recipe.reversed_share
    return both + [reverse_time(clip) for clip, take in zip(both, chosen, strict=True) if take]


def clips_of(folder: str | Path) -> list[Clip]:
    """One's own motions for a walker: the files of a folder, at 20 frames/s, and mirrored.

    Warns and raises as `read_motions`.
    """
    clips = [motion.to_clip() for motion in read_motions(folder)]
    return [version for clip in clips for version in (clip, mirror(clip))]


# ---- training ------------------------------------------------------------------------------------
def train(
    recipe: WalkerRecipe,
    run_file: Path,
    clips: list[Clip] | None = None,
    log=print,
    first: Any = None,
    device: str | None = None,
) -> Walker:
    """Train (or continue) a recipe; `run_file` holds the run.

    Returns the averaged network as a walker.
    `first` is the trained network that the recipe begins with, if it names one.
    `device`: as in `training.on_device`.

    Raises ValueError when the run in `run_file` was begun with other settings, and when `first` is
    missing or not wanted.
    """
    if bool(recipe.begins_with) != (first is not None):
        advice = "a fresh network: leave out `first`"
        if recipe.begins_with:
            advice = f"the network of {recipe.begins_with}: pass it as `first`"
        raise ValueError(f"{recipe.name} begins with {advice}")
    source = "data_synth.walking, synthetic" if clips is None else f"{len(clips)} given clips"
    begun = prepared(recipe, training_clips(recipe) if clips is None else clips)
    windows = begun.windows
    begins = {}
    if first is not None:
        begun.model.load_state_dict(first.state_dict())
        begins = {"first": digest_of_tensors(first.state_dict())[:16]}
    about = {"network": type(recipe.config).__name__, "data": digest(windows)} | begins
    facts = {"frames": len(windows.poses), "control_range": control_range(windows)} | begins
    trained, card = train_recipe(
        recipe,
        run_file,
        on_device(begun.model, device),
        begun.loss_fn,
        Provenance(about, facts, source),
        warmup=500,
        log=log,
        before=begun.dropout.now if begun.dropout else None,
    )
    return begun.walker(trained, card)


@dataclass(frozen=True, eq=False)
class Prepared:
    """What a training begins with: data, noise schedule, a fresh network, its loss and dropout."""

    windows: Windows
    schedule: Schedule
    model: Any
    loss_fn: LossFn
    dropout: Dropout | None

    def walker(self, trained: Any, card: dict | None = None) -> Walker:
        """The walker of a trained network, in the units of these data."""
        scalers = self.windows.pose_scaler, self.windows.control_scaler
        return Walker(trained, self.schedule, *scalers, card or {})


def prepared(recipe: WalkerRecipe, clips: list[Clip]) -> Prepared:
    """What a recipe trains on these clips; the network's first weights follow from its seed."""
    config = recipe.config
    windows = Windows.of(clips, config.T_h, config.T_p)
    schedule = SCHEDULES[recipe.schedule](config.S)
    dropout = dropout_of(recipe, schedule)
    torch.manual_seed(recipe.seed)
    model = network(config)
    return Prepared(windows, schedule, model, loss_of(recipe, windows, schedule, dropout), dropout)


def loss_of(
    recipe: WalkerRecipe, windows: Windows, schedule: Schedule, dropout: Dropout | None = None
) -> LossFn:
    """Algorithm 1 of drawn windows; a share of them holds its control, and pasts are noised.

    Source: MoDiff Alg. 1; held control and past noise are ours.
    """
    change = typical_change(windows)

    def loss_fn(model: Any, generator: torch.Generator) -> Tensor:
        past, x0, control = windows.draw(recipe.batch, generator)
        control = held_control(control, windows.T_h, recipe.held_control, generator)
        past = past_noise(past, recipe.past_noise, change, generator)
        device = next(model.parameters()).device
        batch = (past.to(device), x0.to(device), control.to(device))
        return training_loss(model, batch, schedule, generator, dropout=dropout)

    return loss_fn


def dropout_of(recipe: WalkerRecipe, schedule: Schedule) -> Dropout | None:
    """The recipe's diffusion dropout, if it has one."""
    if not recipe.dropout:
        return None
    return Dropout(schedule, dropout_rate(recipe.dropout, recipe.dropout_start), recipe.steps)


def control_range(windows: Windows) -> dict[str, list[float]]:
    """The smallest and the largest of each column of the control in the data; m/s, m/s, rad/s."""
    control = windows.control_scaler.inverse(windows.control)
    return {name: [round(float(x), 3) for x in values] for name, values in
            (("low", control.amin(0)), ("high", control.amax(0)))}  # fmt: skip


def digest(windows: Windows) -> str:
    """A checksum of the standardised frames; a run resumes only with the same data."""
    frames = (windows.poses.numpy(), windows.control.numpy())
    return hashlib.sha256(b"".join(array.tobytes() for array in frames)).hexdigest()[:16]
