"""The value of each choice of a mover, and two baselines, by trainings of equal length.

Each row differs from the recipe of the mover in one choice, and is trained with three seeds. The
bag of words and the regression have no timeline either: compare them with that row. Without a
timeline the network is a fifth smaller; a step is then faster. Steps, sampler and captions are
equal. The networks are half as wide as the shipped mover's and see a twelfth of the frames that it
saw; so the numbers say what a choice is worth, and not how good a mover can be. The regression saw
older clips, of fewer acts: do not compare its row with the others.
Source: MoFusion 3; choices are ours
"""

from dataclasses import dataclass, field, replace
from functools import cache, partial
from pathlib import Path

import numpy as np

from data_synth.actions.neighbours import KINDS as PAIRS
from motiondiff_edu.baselines.text import BagConfig, RegressionConfig
from motiondiff_edu.metrics import texts
from motiondiff_edu.metrics.texts import KINDS as RECOGNISED
from motiondiff_edu.metrics.texts import actions
from motiondiff_edu.motion import moving_frame
from motiondiff_edu.performers.mover import Mover
from motiondiff_edu.pretrained.judges import judges
from motiondiff_edu.recipes.mover import MOVER, MoverRecipe, train_mover

from ..sweep import Sweep, Variant, differences
from ..walks.scores import Kind, ratio, root_mean, squared_bone_error
from .rows import performed
from .scores import RETRIEVED, Panel, by_trial, nearer, retrieved, sliding
from .trials import UNSEEN, Positions, unseen

STEPS = 25  # of DDIM: most rows were measured so
SIZES = replace(MOVER.config, widths=(48, 48, 64), plan_widths=(24, 24, 32))
SMALL = replace(MOVER, config=SIZES, steps=2400, plan_steps=0, frames=1024)
ALONE = replace(SIZES.of_one(), D=moving_frame.D)


def network_of(config: type) -> dict:
    """Another network with the sizes of the mover without a timeline."""
    return {"config": config(**vars(ALONE))}


VARIANTS = {
    "ours": Variant("the mover's recipe", {}),
    "no-timeline": Variant("no timeline", {"config": ALONE}),
    "no-kinematic": Variant("no kinematic losses", {"kinematic": None}),
    "columns-alike": Variant("all columns alike, without weights by their spread", {"metres": 0.0}),
    "cosine": Variant("the cosine schedule as it is", {"snr": 1.0}),
    "bag": Variant("no timeline, a bag of words", network_of(BagConfig)),
    "regression": Variant("no timeline, no noise: regression", network_of(RegressionConfig)),
}


@dataclass(frozen=True)
class Budget:
    """The seeds of the trainings, the number of unseen captions, and changes of all recipes."""

    seeds: tuple[int, ...] = (0, 1, 2)
    trials: int = 256
    training: dict = field(default_factory=dict)


FULL = Budget()
QUICK = Budget((0, 1), 40, {"steps": 3, "clips": 12, "frames": 300})


def recipe_of(name: str, seed: int, budget: Budget) -> MoverRecipe:
    """The training of one variant with one seed."""
    settings = {"name": f"words-budget.{name}", "seed": seed}
    return replace(SMALL, **settings, **budget.training, **VARIANTS[name].recipe)


def trained(name: str, seed: int, budget: Budget, runs: Path) -> Mover:
    """The mover of a variant.

    A run that was killed continues; one that is finished is only read.
    """
    runs.mkdir(parents=True, exist_ok=True)
    run = runs / f"{name}-{seed}.safetensors"
    return train_mover(recipe_of(name, seed, budget), run, log=partial(print, flush=True))


KINDS = {f"{kind}_accuracy": Kind("share", (kind,), np.nanmean) for kind in RECOGNISED}
KINDS |= {
    f"minimal_pair{kind}": Kind("share", (f"right{kind}", f"pairs{kind}"), ratio)
    for kind in ("", *(f".{one}" for one in PAIRS))
}
KINDS |= {
    "bone_rmse_cm": Kind("cm", ("bones",), root_mean),
    "skating_mps": Kind("m/s", ("sliding",), np.nanmean),
}
KINDS |= {name: Kind(unit, (name,), np.mean) for name, unit in RETRIEVED.items()}


def rows_of(panel: Panel, made: list[Positions]) -> dict[str, np.ndarray]:
    """The rows of KINDS of one training: a number for each trial, or one for all of them."""
    points = panel.row(made)
    rows = dict(texts.rows_of(panel.trials.phrases, [actions(x) for x in made]))
    for kind, (right, there) in by_trial(panel, nearer(panel, points)).items():
        rows |= {f"right{kind}": right, f"pairs{kind}": there}
    rows["bones"] = np.array([squared_bone_error(x[None])[0] for x in made])
    rows["sliding"] = np.array([sliding(x) for x in made])
    return rows | {one.name: np.array([one.value]) for one in retrieved(panel, points)}


def sweep(budget: Budget, runs: Path, panel: Panel | None = None) -> Sweep:
    """The movers; `panel` is that of `budget.trials` captions, made where it is first needed."""
    judged = cache(lambda: panel or Panel(judges(), unseen(budget.trials)))

    def measure(name: str, mover: Mover, seed: int) -> dict[str, np.ndarray]:
        return rows_of(judged(), performed(mover, steps=STEPS)(judged().trials, seed))

    def about(name: str) -> dict:
        found = {"data": UNSEEN, "trials": budget.trials, "steps": STEPS}
        return found | {"trained_steps": recipe_of(name, 0, budget).steps}

    return Sweep(
        "words-budget", VARIANTS, lambda name, seed: trained(name, seed, budget, runs), measure,
        KINDS, differences(KINDS), about, budget.seeds,
    )  # fmt: skip
