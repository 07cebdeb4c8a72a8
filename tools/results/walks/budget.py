"""The value of each choice of a walker.

Small walkers are trained for the same CPU-seconds, and each differs from another in one choice.

How many future poses should be predicted at once (MoDiff says that T_p > 1 helps, and gives no
number)? What do the schedule, the optimizer, the past noise, the weights of the loss, the
footholds and the target do? All else is equal: network, data, seed, and the rollout, which keeps
one pose of every window.  Source: MoDiff III-A; the rest is ours
"""

from dataclasses import asdict, dataclass, replace
from functools import cache

import torch

from data_synth.walking import dataset
from motiondiff_edu.beyond.footholds import FootholdConfig
from motiondiff_edu.modiff import MoDiffConfig
from motiondiff_edu.motion.augment import augment
from motiondiff_edu.motion.clip import Clip
from motiondiff_edu.recipes.budget import BUDGET, train_for
from motiondiff_edu.recipes.walkers import OURS, Recipe

from .scores import Measure, score
from .trials import T_H, UNSEEN, Trials, unseen, walker_generate

SHOWN = (
    "bone_rmse_cm",
    "adherence_mps",
    "adherence_shuffled_over_own",
    "skating_mps",
    "drift_ratio",
)
SMALL = MoDiffConfig(  # small enough to learn much in minutes
    width=64,
    hidden=256,
    motion_layers=1,
    control_layers=1,
    cross_layers=1,
    decoder_layers=2,
    target="x0",
    skip=False,
)
FEET = FootholdConfig(**asdict(SMALL))
EPS = replace(SMALL, target="eps", skip=True)
HIGH_NOISE, JOINTS, SPREADS, ALIKE = (
    {"loss_weights": replace(OURS, **changes)}
    for changes in (
        {"high_noise": 3.0},
        {"bones": 0.0},
        {"bones": 0.0, "metres": 0.0},
        {"near": 0.0},
    )
)
LIKE = "the shipped walker's recipe without footholds and diffusion dropout, T_p = 10"
# name: (what differs, in words, from which other one, the network, changes of the recipe)
VARIANTS = {
    "T_p-10": (LIKE, "", SMALL, {}),
    "T_p-1": ("T_p = 1", "T_p-10", replace(SMALL, T_p=1), {}),
    "T_p-5": ("T_p = 5", "T_p-10", replace(SMALL, T_p=5), {}),
    "T_p-20": ("T_p = 20", "T_p-10", replace(SMALL, T_p=20), {}),
    "linear": ("linear schedule, 1e-4 to 0.1", "T_p-10", SMALL, {"schedule": "linear"}),
    "footholds": ("with footholds", "T_p-10", FEET, {}),
    "adam": (
        "Adam at 1e-3 instead of Muon at 3e-3",
        "T_p-10",
        SMALL,
        {"optimizer": "adam", "lr": 1e-3},
    ),
    "unshaken": ("the past as it is", "T_p-10", SMALL, {"past_noise": 0.0}),
    "eps": ("eps with the skip, high noise weighted", "T_p-10", EPS, HIGH_NOISE),
    "joints": ("errors of joints alone, none of bones", "T_p-10", SMALL, JOINTS),
    "spreads": ("errors in standard deviations", "joints", SMALL, SPREADS),
    "alike": ("all ten poses alike", "T_p-10", SMALL, ALIKE),
}


@dataclass(frozen=True)
class Budget:
    """CPU-seconds of each training, number of training and of test clips, and their length."""

    seconds: float = 160
    training: int = 300
    clips: int = 24
    walk_s: int = 8


FULL = Budget()
QUICK = Budget(seconds=2, training=6, clips=8, walk_s=6)


@cache
def material(budget: Budget) -> tuple[list[Clip], Trials]:
    """The training clips and the trials of all variants."""
    return augment(dataset(budget.training, 20.0, seed=1)), unseen(budget.clips, budget.walk_s)


def recipe_of(name: str) -> Recipe:
    """The training of one variant."""
    _, _, config, changes = VARIANTS[name]
    return replace(BUDGET, name=f"budget.{name}", config=config, **changes)


def measure(name: str, budget: Budget) -> list[Measure]:
    """The measures of one variant, and its number of training steps."""
    clips, trials = material(budget)
    walker, steps = train_for(budget.seconds, clips, recipe_of(name))
    walks = walker_generate(walker)(trials.past, trials.control, 0)
    found = [one for one in score(walks, trials.asked, trials.truth) if one.name in SHOWN]
    print(f"{name}: {steps} steps in {budget.seconds:g} CPU-seconds, T_h = {T_H}", flush=True)
    return [*found, Measure("steps", steps, steps, steps, "")]


def budget_records(name: str, budget: Budget, command: str) -> list[dict]:
    """The records of one variant, trained on one thread: the budget is in CPU-seconds.

    Compare only records of one machine.
    """
    before = torch.get_num_threads()
    torch.set_num_threads(1)
    seeds = {
        "data": UNSEEN,
        "training": 0,
        "rollouts": 0,
        "clips": budget.clips,
        "cpu_seconds": budget.seconds,
    }
    records = [one.as_record(f"budget.{name}.", seeds, command) for one in measure(name, budget)]
    torch.set_num_threads(before)
    return records
