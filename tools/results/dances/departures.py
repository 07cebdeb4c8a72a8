"""What each departure of the dancer is worth at its own size, from the simplest recipe up.

`base` is MoFusion at the shipped width: eps with the skip, Adam, the cosine schedule, one linear
layer of the music, and kinematic losses weighted by alpha_bar, thirteen times as heavy as the
shipped dancer's. Each other variant adds what its words say to another one. A training has a
quarter of the shipped dancer's steps. Dances are sampled as `Dancer.dance` does it, and measured
before the clean-up.
docs/results/dancer-departures/plan.json has the validation loss of `base` for each rate that was
tried, after 300 steps; an optimiser has the rate with the smallest one.
Source: MoFusion 3, 4.1.  Notebook: 12, 13
"""

from dataclasses import dataclass, replace
from functools import cache, partial
from pathlib import Path

import torch

from motiondiff_edu.mofusion import MOFUSION_SMALL
from motiondiff_edu.performers.dancer import ETA, STEPS, Dancer
from motiondiff_edu.pretrained.checkpoints import load
from motiondiff_edu.recipes.dancer import HEARING, DanceRecipe, train_dancer, training_windows
from motiondiff_edu.recipes.ear import EAR, ear_within
from motiondiff_edu.recipes.mofusion import KINEMATIC

from ..sweep import Sweep, Variant, differences, further, tuned_rate
from .parts import DANCED, DanceSize, Stage, danced
from .songs import UNSEEN

PLAN = Path(__file__).parents[3] / "docs" / "results" / "dancer-departures" / "plan.json"
LINEAR_MUSIC = replace(MOFUSION_SMALL, music_layers=0)
X0 = {"target": "x0", "skip": False}
BASE = DanceRecipe(
    "base", LINEAR_MUSIC, steps=2_000, optimizer="adam", kinematic=KINEMATIC, changes=0.0, toes=0.0,
)  # fmt: skip


VARIANTS: dict[str, Variant] = {"base": Variant("MoFusion: eps with the skip, Adam", {})}
added = partial(further, VARIANTS)
VARIANTS |= {"muon": added("Muon", optimizer="muon")}
VARIANTS |= {"x0": added("x0 instead of eps", "muon", config=replace(LINEAR_MUSIC, **X0))}
VARIANTS |= {
    "convolutions": added("convolutions over the Mel", "x0", config=replace(MOFUSION_SMALL, **X0))
}
VARIANTS |= {"changes": added("errors of changes", "convolutions", changes=DanceRecipe.changes)}
VARIANTS |= {"toes": added("errors of toes", "changes", toes=DanceRecipe.toes)}
VARIANTS |= {
    "ear": added("an ear", "toes", config=HEARING, ear=EAR),
    "no-kinematics": added("no kinematic losses", "toes", kinematic=None),
}
VARIANTS |= {
    "light-kinematics": added("lighter kinematic losses", "ear", kinematic=DanceRecipe.kinematic),
    "guidable": added("music left out at times", "ear", no_music=0.15),
}


@dataclass(frozen=True)
class Size:
    """How much is danced; steps and songs of the training (None: all)."""

    measured: DanceSize = DanceSize(songs=30, seeds=2, pieces=10, each=8)
    steps: int | None = None
    songs: int | None = None


FULL = Size()
QUICK = Size(DanceSize(songs=3, seeds=1, pieces=2, each=2), steps=3, songs=2)


def recipe_of(name: str, seed: int, size: Size) -> DanceRecipe:
    """The recipe of a variant, with the tuned rate of its optimiser.

    Raises ValueError where no rate was tried for that.
    """
    recipe = replace(BASE, **VARIANTS[name].recipe)
    rate = tuned_rate(PLAN, recipe.optimizer)
    steps, songs = size.steps or recipe.steps, size.songs or recipe.songs
    name = f"dancer-departures-{name}"
    return replace(recipe, name=name, seed=seed, lr=rate, steps=steps, songs=songs)


@cache
def stage(size: DanceSize) -> Stage:
    """The songs of the measurement: the same for all."""
    return Stage(size)


def sweep(size: Size, runs: Path) -> Sweep:
    """The variants, trained on one thread, whatever the machine has; ears are the shipped one."""

    def trained(name: str, seed: int) -> Dancer:
        torch.set_num_threads(1)
        recipe = recipe_of(name, seed, size)
        ear = ear_within(load("dancer")) if recipe.ear else None
        run, log = runs / f"{name}-{seed}.safetensors", partial(print, flush=True)
        return train_dancer(recipe, run, training_windows(recipe), log, ear)

    def about(name: str) -> dict:
        recipe, measured = recipe_of(name, 0, size), size.measured
        found = {"data": UNSEEN, "songs": measured.songs, "samples": measured.seeds}
        found |= {"pieces": [measured.pieces, measured.each], "ddim_steps": STEPS, "eta": ETA}
        found |= {"steps": recipe.steps, "rate": recipe.lr, "trained_songs": recipe.songs}
        weights = recipe.kinematic
        found |= {"kinematic": [weights.skeleton, weights.asymmetry] if weights else []}
        return found | {"widths": list(recipe.config.widths)}

    return Sweep(
        "dancer-departures", VARIANTS, trained,
        lambda name, dancer, seed: danced(stage(size.measured), dancer).rows,
        DANCED, differences(DANCED), about, (0,),
    )  # fmt: skip
