"""From the paper's walker to ours, one choice at a time: what each departure is worth.

All rungs share one small network size, the data, and the budget: as many steps as 600 CPU-seconds
are worth on one thread. Each is trained with three seeds. `ours` is the recipe of the shipped
walker's trunk at this size, before diffusion dropout is added at the end; from it one choice is
taken out at a time. `printed` is the recipe as MoDiff prints it, with TimeGrad's schedule, for
MoDiff gives none; to it one choice is added at a time. docs/results/ladder/plan.json has what a
step of each rung costs (`pace`, ms), and the rates that were tried on validation clips.
Source: MoDiff III-D, IV-A, Alg. 1.  Notebook: 07
"""

import json
from dataclasses import asdict, dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
import torch

from data_synth.walking import dataset
from motiondiff_edu.beyond.footholds import FootholdConfig
from motiondiff_edu.diffusion_dropout import P_D
from motiondiff_edu.metrics.walks import adherence, skating
from motiondiff_edu.performers.walker import Walker
from motiondiff_edu.recipes.walker import (
    MEND_CONFIG,
    OURS,
    LossWeights,
    WalkerRecipe,
    train,
    training_clips,
)

from ..repairs.trials import SHARE, continued
from ..sweep import Rows, Sweep, Variant, differences
from .parts import size_of_network
from .scores import FPS, WALKS, Kind, ratio_of_roots, root_mean, squared_bone_error
from .trials import T_H, UNSEEN, Trials

PLAN = Path(__file__).parents[3] / "docs" / "results" / "ladder" / "plan.json"
CPU_SECONDS = 600
PRINTED_RATE = 5e-5  # MoDiff IV-A

EPS = replace(MEND_CONFIG, target="eps", skip=False)
EPS_SKIP = replace(MEND_CONFIG, target="eps", skip=True)
FOOTHOLDS = FootholdConfig(**asdict(MEND_CONFIG))
COMMON = {"steps": 0, "clips": 360}
OUR_RECIPE = WalkerRecipe(
    "ours", FOOTHOLDS, **COMMON, schedule="leap", optimizer="muon", batch=32, noises=2,
    past_noise=0.3, loss_weights=OURS,
)  # fmt: skip
PRINTED = WalkerRecipe("printed", EPS, **COMMON, lr=PRINTED_RATE, held_control=0.0, dropout=P_D)


@dataclass(frozen=True)
class Rung:
    """A recipe without its steps; its budget; and which of the tuned rates it has (none: its own).

    Rungs of one whole recipe and one optimiser share a rate: only the choice that is named differs.
    """

    recipe: WalkerRecipe
    budget: float = 1.0  # times CPU_SECONDS
    rate: str = ""


def out(words: str, base: str = "ours", **changes) -> Variant:
    """A choice taken out of our recipe."""
    recipe = replace(OUR_RECIPE, **changes)
    return Variant(words, Rung(recipe, rate=f"ours-{recipe.optimizer}"), {"base": base})


def into(words: str, budget: float = 1.0, rate: str = "", **changes) -> Variant:
    """A choice added to the printed recipe."""
    return Variant(words, Rung(replace(PRINTED, **changes), budget, rate), {"base": "printed"})


VARIANTS = {
    "ours": Variant("our recipe", Rung(OUR_RECIPE, rate="ours-muon")),
    "ours-eps": out("eps instead of x0, no footholds", config=EPS),
    "ours-skip": out("eps with the skip instead of x0, no footholds", config=EPS_SKIP),
    "ours-no-footholds": out("no footholds", config=MEND_CONFIG),
    "ours-adam": out("Adam instead of Muon", optimizer="adam"),
    "ours-linear": out("linear schedule, 1e-4 to 0.1", schedule="linear"),
    "ours-plain-loss": out("the plain loss", loss_weights=LossWeights()),
    "ours-clean-past": out("the past as it is", past_noise=0.0),
    "ours-dropout": out("diffusion dropout instead of past noise", past_noise=0.0, dropout=P_D),
    "ours-both": out("diffusion dropout beside past noise", dropout=P_D),
    "ours-both-light": out(
        "both, noised pasts with a fifth of the weight", "ours-both",
        dropout=P_D, noised_past_weight=0.2,
    ),
    "ours-never-held": out("control never held", held_control=0.0),
    "ours-T_p-1": out("T_p = 1", config=replace(FOOTHOLDS, T_p=1)),
    "ours-T_p-5": out("T_p = 5", config=replace(FOOTHOLDS, T_p=5)),
    "ours-T_p-20": out("T_p = 20", config=replace(FOOTHOLDS, T_p=20)),
    "printed": Variant("the printed recipe", Rung(PRINTED)),
    "printed-longer": into("4 times the budget", budget=4.0),
    "printed-skip": into("the skip", config=EPS_SKIP),
    "printed-x0": into("x0 instead of eps", config=MEND_CONFIG),
    "printed-footholds": into("x0 with footholds", config=FOOTHOLDS),
    "printed-rate": into("Adam at the best of three rates", rate="printed-adam"),
    "printed-muon": into("Muon", rate="printed-muon", optimizer="muon"),
    "printed-leap": into("leap schedule", schedule="leap"),
    "printed-loss": into("our loss terms", loss_weights=OURS),
    "printed-noise": into("past noise beside diffusion dropout", past_noise=0.3),
    "printed-clean-past": into("no diffusion dropout", dropout=()),
    "printed-held": into("control held in half of the windows", held_control=0.5),
}  # fmt: skip


@dataclass(frozen=True)
class Size:
    """Clips to walk, seconds of each, training clips (None: the recipe's), share of the budget."""

    clips: int = 40
    seconds: float = 8.0
    training: int | None = None
    budget: float = 1.0


FULL, QUICK = Size(), Size(clips=4, seconds=6.5, training=12, budget=0.002)


def recipe_of(name: str, seed: int, size: Size) -> WalkerRecipe:
    """The recipe of a rung for one training seed, its steps and its rate filled in.

    Raises ValueError for a rung without a pace.
    """
    rung, plan = VARIANTS[name].recipe, json.loads(PLAN.read_text(encoding="utf-8"))
    if name not in plan["pace"]:
        raise ValueError(
            f"{PLAN} has no pace of {name}: add the CPU-milliseconds of a training step on one "
            "thread, timed in turn with those of another rung, and scaled by that rung's pace"
        )
    seconds = CPU_SECONDS * rung.budget * size.budget
    steps = max(20, round(1000 * seconds / plan["pace"][name]))
    rate = plan["rates"][rung.rate] if rung.rate else rung.recipe.lr
    return replace(rung.recipe, name=f"ladder-{name}", steps=steps, lr=rate, seed=seed)


@cache
def trials_of(size: Size) -> Trials:
    """What all rungs walk."""
    return Trials.of(dataset(size.clips, size.seconds + T_H / FPS, seed=UNSEEN))


@cache
def clips_of(size: Size):
    """What all rungs are trained on."""
    clips = OUR_RECIPE.clips if size.training is None else size.training
    return training_clips(replace(OUR_RECIPE, clips=clips))


def rows_of(walker: Walker, trials: Trials, seed: int) -> Rows:
    """What is measured of each walk: DDPM with all steps, control held, whole and broken pasts."""
    frames = trials.truth.shape[1]
    whole, broken = (continued(walker, trials, share, frames, seed) for share in (0.0, SHARE))
    return {
        "bone": squared_bone_error(whole),
        "bone_broken": squared_bone_error(broken),
        "adherence": adherence(whole, trials.asked),
        "adherence_data": adherence(trials.truth, trials.asked),
        "skating": skating(whole, trials.asked),
    }


KINDS = {
    "bone_rmse_cm": Kind("cm", ("bone",), root_mean),
    "adherence_excess_mps": replace(
        WALKS["adherence_excess_mps"], rows=("adherence", "adherence_data")
    ),
    "skating_mps": Kind("m/s", ("skating",), np.nanmean),
    "broken_over_whole": Kind("ratio", ("bone_broken", "bone"), ratio_of_roots),
}


def sweep(size: Size, runs: Path) -> Sweep:
    """The ladder, trained on one thread, whatever the machine has."""

    def trained(name: str, seed: int) -> Walker:
        torch.set_num_threads(1)
        return train(
            recipe_of(name, seed, size), runs / f"{name}-{seed}.safetensors", clips_of(size)
        )

    def about(name: str) -> dict:
        recipe = recipe_of(name, 0, size)
        found = {"data": UNSEEN, "clips": size.clips, "steps": recipe.steps, "rate": recipe.lr}
        return found | {"cpu_seconds": CPU_SECONDS, "network": size_of_network(recipe.config)}

    return Sweep(
        "ladder", VARIANTS, trained,
        lambda name, walker, seed: rows_of(walker, trials_of(size), seed),
        KINDS, differences(KINDS), about, (0, 1, 2),
    )  # fmt: skip
