"""What each departure of the walker is worth at its own size, from the simplest recipe up.

`base` is MoDiff at the shipped width: eps with the skip, Adam, the linear schedule, diffusion
dropout, control held in half of the windows, and the plain loss. Each other variant adds what its
words say to another one. A training has a quarter of the shipped walker's steps. Walks are sampled
as `Walker.walk` does it, by DDIM in ten steps with held control, and measured before and after the
clean-up.
docs/results/walker-departures/plan.json has the validation loss of `base` for each rate that was
tried, after 2,000 steps (Adam and Muon on other unseen clips each); an optimiser has the rate with
the smallest one. Muon gained most of the first departures, so the next ones are added to it.
Source: MoDiff III-D, IV-A, Alg. 1.  Notebook: 07
"""

from dataclasses import dataclass, replace
from functools import cache, partial
from pathlib import Path

import numpy as np
import torch

from data_synth.walking import dataset
from motiondiff_edu.diffusion_dropout import P_D
from motiondiff_edu.metrics.distributions import spread
from motiondiff_edu.metrics.walks import ROBUST, adherence, footsteps, heel_speed, skating
from motiondiff_edu.modiff import MODIFF_SMALL
from motiondiff_edu.performers.performer import STEPS
from motiondiff_edu.performers.walker import Walker
from motiondiff_edu.recipes.walker import WalkerRecipe, train, training_clips

from ..repairs.trials import SHARE, continued
from ..sweep import Rows, Sweep, Variant, differences, further, tuned_rate
from .parts import size_of_network
from .scores import (
    CLEANED,
    EDGE,
    FPS,
    Kind,
    excess,
    ratio,
    ratio_of_roots,
    root_mean,
    shuffled_adherence,
    squared_bone_error,
)
from .trials import (
    T_H,
    UNSEEN,
    Choices,
    Trials,
    choices,
    cleaned_rows,
    rollouts_of,
    walker_generate,
)

PLAN = Path(__file__).parents[3] / "docs" / "results" / "walker-departures" / "plan.json"
BASE = WalkerRecipe(
    "base", MODIFF_SMALL, steps=8_000, optimizer="adam", schedule="linear", past_noise=0.0,
    dropout=P_D,
)  # fmt: skip


VARIANTS: dict[str, Variant] = {"base": Variant("MoDiff: eps with the skip, Adam", {})}
added = partial(further, VARIANTS)
VARIANTS |= {
    "leap": added("leap schedule", schedule="leap"),
    "muon": added("Muon", optimizer="muon"),
}
VARIANTS |= {"muon-leap": added("leap schedule", "muon", schedule="leap")}
VARIANTS |= {
    "past-noise": added("past noise instead of dropout", "muon-leap", past_noise=0.3, dropout=()),
    "no-dropout": added("no diffusion dropout", "muon-leap", dropout=()),
}
VARIANTS |= {
    "both": added("diffusion dropout as well", "past-noise", dropout=P_D),
    "one-pose": added("one future pose", "past-noise", config=replace(MODIFF_SMALL, T_p=1)),
}


@dataclass(frozen=True)
class Size:
    """Clips to walk, pasts with `each` continuations; steps and training clips (None: all)."""

    clips: int = 60
    pasts: int = 16
    each: int = 24
    seconds: float = 8.0
    steps: int | None = None
    training: int | None = None


FULL, QUICK = Size(), Size(clips=4, pasts=2, each=3, seconds=6.5, steps=20, training=12)


def recipe_of(name: str, seed: int, size: Size) -> WalkerRecipe:
    """The recipe of a variant, with the tuned rate of its optimiser.

    Raises ValueError where no rate was tried for that.
    """
    recipe = replace(BASE, **VARIANTS[name].recipe)
    rate = tuned_rate(PLAN, recipe.optimizer)
    steps, clips = size.steps or recipe.steps, size.training or recipe.clips
    name = f"walker-departures-{name}"
    return replace(recipe, name=name, seed=seed, lr=rate, steps=steps, clips=clips)


@cache
def material(size: Size) -> tuple[Trials, Choices]:
    """What all variants walk."""
    clips = dataset(size.clips, size.seconds + T_H / FPS, seed=UNSEEN)
    return Trials.of(clips), choices(size.pasts, size.each)


def rows_of(walker: Walker, size: Size) -> Rows:
    """What is measured of each walk; spreads and steps are repeated to as many rows."""
    trials, asked = material(size)
    frames = trials.truth.shape[1]
    whole, broken = (
        continued(walker, trials, share, frames, steps=STEPS) for share in (0.0, SHARE)
    )
    first, last = slice(None, EDGE), slice(-EDGE, None)
    own = spread(rollouts_of(walker_generate(walker, STEPS), asked))
    found = {
        "bone": squared_bone_error(whole),
        "bone_first": squared_bone_error(whole[:, first]),
        "bone_last": squared_bone_error(whole[:, last]),
        "bone_broken": squared_bone_error(broken),
        "adherence": adherence(whole, trials.asked),
        "adherence_first": adherence(whole[:, first], trials.asked[:, first]),
        "adherence_last": adherence(whole[:, last], trials.asked[:, last]),
        "adherence_shuffled": shuffled_adherence(whole, trials.asked),
        "skating": skating(whole, trials.asked),
    } | cleaned_rows(whole, trials)
    for name, poses in (("steps", whole), ("steps_data", trials.truth)):
        each = [footsteps([one], ROBUST).count for one in heel_speed(poses, trials.asked)]
        found[name] = np.array(each)
    for name, one in (("spread", own), ("spread_data", spread(asked.drawn))):
        found[name] = np.resize(one, size.clips)
    return found


KINDS = {
    "bone_rmse_cm": Kind("cm", ("bone",), root_mean),
    "broken_over_whole": Kind("ratio", ("bone_broken", "bone"), ratio_of_roots),
    "adherence_excess_mps": Kind("m/s", ("adherence", "adherence_data"), excess),
    "adherence_shuffled_over_own": Kind("ratio", ("adherence_shuffled", "adherence"), ratio),
    "drift_bone_ratio": Kind("ratio", ("bone_last", "bone_first"), ratio_of_roots),
    "drift_adherence_ratio": Kind("ratio", ("adherence_last", "adherence_first"), ratio),
    "skating_mps": Kind("m/s", ("skating",), np.nanmean),
    **CLEANED,
    "diversity_over_data": Kind("ratio", ("spread", "spread_data"), ratio),
    "footsteps_robust_over_data": Kind("ratio", ("steps", "steps_data"), ratio),
}


def sweep(size: Size, runs: Path) -> Sweep:
    """The variants, trained on one thread, whatever the machine has."""

    def trained(name: str, seed: int) -> Walker:
        torch.set_num_threads(1)
        recipe = recipe_of(name, seed, size)
        return train(recipe, runs / f"{name}-{seed}.safetensors", training_clips(recipe))

    def about(name: str) -> dict:
        recipe = recipe_of(name, 0, size)
        found = {"data": UNSEEN, "clips": size.clips, "steps": recipe.steps, "rate": recipe.lr}
        return found | {"ddim_steps": STEPS, "network": size_of_network(recipe.config)}

    return Sweep(
        "walker-departures", VARIANTS, trained,
        lambda name, walker, seed: rows_of(walker, size),
        KINDS, differences(KINDS), about, (0,),
    )  # fmt: skip
