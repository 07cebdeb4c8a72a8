"""The value of each choice of a dancer.

The dancers are trained for equally many steps, and each differs from another in one choice.

Where in diffusion time is the beat decided (the targets look hardest at different noise)? What do
the kinematic losses do, and their weight over time? Is a linear layer enough for the music, a U-Net
better than a transformer, Mel as good as MFCC with the beats given? All else is equal: data, seed,
steps, sampler.  Source: MoFusion 3, 4.1; choices are ours
"""

from dataclasses import dataclass, replace
from functools import cache, partial
from pathlib import Path

import numpy as np

from motiondiff_edu._files import digest_of_tensors, replacing
from motiondiff_edu.baselines.transformer import TransformerConfig
from motiondiff_edu.mofusion import MOFUSION_SMALL
from motiondiff_edu.performers.dance_windows import DanceWindows
from motiondiff_edu.performers.dancer import ETA, STEPS, Dancer
from motiondiff_edu.recipes.dancers import (
    DANCER_PLAIN,
    HEARING,
    KINEMATIC,
    X0,
    DanceLossWeights,
    SongRecipe,
)
from motiondiff_edu.recipes.ear import EAR
from motiondiff_edu.recipes.songs import training_songs
from motiondiff_edu.recipes.train_dancer import train_dancer, training_windows

from ..walks.scores import Measure
from .mfcc import CHANNELS, mfcc_and_beats, with_music_features
from .parts import Danced, DanceSize, Stage, danced
from .scores import bone_gain, share_minus
from .songs import UNSEEN, mel_of

LIKE = (
    "target x0, shifted schedule, no kinematic losses, changes weighted 5, feet 0.2, "
    "convolutions over the Mel, no ear, always with music"
)
KIN = {
    name: {"kinematic": replace(KINEMATIC, over_time=name)}
    for name in ("constant", "alpha_bar", "snr")
}
PLAIN = TransformerConfig()  # 2.64 M parameters; the U-Net has 2.65 M
EPS = replace(
    MOFUSION_SMALL, target="eps", skip=True
)  # a network without it does not learn eps in so few steps
NO_FEET = {
    "loss_weights": DanceLossWeights(changes=5.0)
}  # errors of eps or v are not positions, so they have no toes
# name: (what differs, in words, from which other one, the network, settings of the training)
VARIANTS = {
    "x0": (LIKE, "", X0, {}),
    "no-feet": ("errors of poses and of changes, not of feet", "x0", X0, NO_FEET),
    "poses": (
        "errors of poses alone, as the paper has it",
        "no-feet",
        X0,
        {"loss_weights": DanceLossWeights()},
    ),
    "eps": ("target eps, with its skip", "no-feet", EPS, NO_FEET),
    "eps-weighted": (
        "high noise weighted, up to 21 times",
        "eps",
        EPS,
        {"loss_weights": DanceLossWeights(changes=5.0, high_noise=20.0)},
    ),
    "v": ("target v, with the skip", "no-feet", replace(EPS, target="v"), NO_FEET),
    "constant": ("kinematic losses, all steps alike", "x0", X0, KIN["constant"]),
    "alpha_bar": ("kinematic losses weighted by alpha_bar", "x0", X0, KIN["alpha_bar"]),
    "snr": (
        "kinematic losses weighted by alpha_bar / (1 - alpha_bar), 5 at most",
        "x0",
        X0,
        KIN["snr"],
    ),
    "slide": ("a foot loss of 2", "alpha_bar", X0, {"kinematic": replace(KINEMATIC, slide=2.0)}),
    "cosine": ("the cosine schedule as it is", "x0", X0, {"snr": 1.0}),
    "gain-noise": ("music as from different loudspeakers", "x0", X0, {"gain_noise": 0.3}),
    "ear": ("an ear that was trained first, on the same songs", "x0", HEARING, {"ear": EAR}),
    "linear-music": ("one linear layer for the music", "x0", replace(X0, music_layers=0), {}),
    "transformer": ("a plain transformer of equal size", "x0", PLAIN, {}),
    "mfcc": ("MFCC and the true beats instead of Mel", "x0", replace(X0, C=CHANNELS), {}),
    "regression": (
        "regression, errors of poses alone",
        "transformer",
        replace(PLAIN, deterministic=True),
        {},
    ),
}
RIVALS = {"alpha_bar": ("constant",), "snr": ("constant", "alpha_bar")}  # also compared with these
MUSIC_FEATURES = {"mfcc": mfcc_and_beats}  # all others use log-Mel
SHARE = ("bas", "bas_shuffled")
DANCES = 2  # of data_synth: from 2 on they travel, turn and change level, to songs like recordings


@dataclass(frozen=True)
class Budget:
    """The length of training, its data, and the number of measurements."""

    steps: int = 1200
    songs: int = 400
    seconds: float = 20.0
    batch: int = 16
    save_every: int = 50
    ear_steps: int = 2400  # of an ear, which is trained first
    measured: DanceSize = DanceSize(songs=30, seeds=2, pieces=10, each=8)


FULL = Budget()
QUICK = Budget(3, 2, 8.0, batch=3, save_every=2, ear_steps=2, measured=DanceSize(3, 1, 2, 2))


def recipe_of(name: str, budget: Budget) -> SongRecipe:
    """The training of one variant, as `recipes.train_dancer` understands it."""
    _, _, config, settings = VARIANTS[name]
    sizes = {
        key: getattr(budget, key) for key in ("steps", "songs", "seconds", "batch", "save_every")
    }
    plain = {"config": config, "gain_noise": 0.0, "no_music": 0.0, "ear": None}
    settings = sizes | plain | settings
    if settings["ear"]:
        alike = {key: sizes[key] for key in ("songs", "seconds", "save_every")}
        settings["ear"] = replace(EAR, steps=budget.ear_steps, **alike)
    return replace(DANCER_PLAIN, name=f"dance-budget.{name}", **settings)


@cache
def material(name: str, budget: Budget) -> DanceWindows:
    """The training data: `name` is one of MUSIC_FEATURES, or "" for log-Mel."""
    recipe = recipe_of("x0", budget)
    if not name:
        return training_windows(recipe)
    return with_music_features(
        material("", budget),
        MUSIC_FEATURES[name],
        training_songs(recipe.songs, recipe.data_seed, recipe.seconds),
    )


@cache
def stage(name: str, budget: Budget) -> Stage:
    """The songs of the measurement: the same for all, with the features of training."""
    return Stage(budget.measured, hear=MUSIC_FEATURES.get(name, mel_of))


def trained(name: str, budget: Budget, runs: Path) -> Dancer:
    """The dancer of one variant.

    A run that was killed continues; one that is finished is only read.
    """
    features = name if name in MUSIC_FEATURES else ""
    runs.mkdir(parents=True, exist_ok=True)
    run, log = runs / f"{name}.safetensors", partial(print, flush=True)
    return train_dancer(recipe_of(name, budget), run, material(features, budget), log)


def about(name: str, budget: Budget) -> str:
    """The settings of a row: training, songs and dances, and sampler."""
    return repr((recipe_of(name, budget), budget.measured, DANCES, STEPS, ETA))


def gains(name: str, found: Danced, runs: Path, budget: Budget) -> list[Measure]:
    """The gains of a row over the row with which it is compared, on the same songs.

    The bootstrap draws both together.
    """
    measures = []
    own = [rows[key] for rows in (found.own, found.data) for key in SHARE]
    for rival in filter(None, (VARIANTS[name][1], *RIVALS.get(name, ()))):
        kept = runs / f"{rival}.npz"
        other = dict(np.load(kept)) if kept.is_file() else {"about": ""}
        if str(other["about"]) != about(rival, budget):
            print(
                f"{name}: {rival} was not measured here under the same budget, "
                "so there are no differences to it"
            )
            continue
        measures.append(
            share_minus(
                f"bas_share_minus_{rival}", own, [other["own_" + k] for k in SHARE] + own[2:]
            )
        )
        measures.append(
            replace(bone_gain(found.squares, other["squares"]), name=f"bone_gain_over_{rival}")
        )
    return measures


def keep(name: str, found: Danced, runs: Path, budget: Budget) -> None:
    """Save the rows of each song, for variants that are compared with this one."""
    rows = {f"own_{key}": found.own[key] for key in SHARE} | {"squares": found.squares}
    rows["about"] = np.array(about(name, budget))
    with replacing(runs / f"{name}.npz") as aside, open(aside, "wb") as file:
        np.savez(file, **rows)


def on_old_dances(record: dict) -> bool:
    """Whether a variant was trained and measured on earlier dances than those of today."""
    ours = record["name"].startswith("dance-budget.")
    return ours and record["seeds"].get("dances", 1) < DANCES


def budget_records(name: str, budget: Budget, runs: Path, command: str) -> list[dict]:
    """Train (or continue) one variant, and measure it."""
    dancer = trained(name, budget, runs)
    songs = stage(name if name in MUSIC_FEATURES else "", budget)
    found = danced(songs, dancer)
    keep(name, found, runs, budget)
    size, recipe = budget.measured, recipe_of(name, budget)
    seeds = {
        "data": UNSEEN,
        "songs": size.songs,
        "dances": DANCES,
        "sampling": list(range(size.seeds)),
        "steps": STEPS,
        "eta": ETA,
    }
    seeds |= {"training": recipe.seed, "trained_steps": recipe.steps, "trained_songs": recipe.songs}
    seeds |= {"batch": recipe.batch, "weights": digest_of_tensors(dancer.model.state_dict())[:16]}
    if recipe.ear:
        seeds["ear_steps"] = recipe.ear.steps
    measures = [*found.measures, *gains(name, found, runs, budget)]
    return [measure.as_record(f"dance-budget.{name}.", seeds, command) for measure in measures]
