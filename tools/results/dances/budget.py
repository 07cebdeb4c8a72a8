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

from motiondiff_edu.baselines.transformer import TransformerConfig
from motiondiff_edu.mofusion import MOFUSION_SMALL
from motiondiff_edu.performers.dance_windows import DanceWindows
from motiondiff_edu.performers.dancer import ETA, STEPS, Dancer
from motiondiff_edu.recipes.dancer import (
    DANCER_PLAIN,
    HEARING,
    X0,
    SongRecipe,
    train_dancer,
    training_windows,
)
from motiondiff_edu.recipes.ear import EAR
from motiondiff_edu.recipes.mofusion_loss import KINEMATIC, DanceLossWeights
from motiondiff_edu.recipes.songs import training_songs

from ..page.records import DANCES
from ..sweep import Sweep, Variant
from ..walks.scores import Kind
from .mfcc import CHANNELS, mfcc_and_beats, with_music_features
from .parts import DANCED, DanceSize, Stage, danced
from .scores import SHARE, bone_gain, share
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


def differs(words: str, *rivals: str, config=X0, **settings) -> Variant:
    """A dancer that differs from its first rival in what the words say."""
    return Variant(words, (config, settings), {rival: rival for rival in rivals})


VARIANTS = {
    "x0": differs(LIKE),
    "no-feet": differs("errors of poses and of changes, not of feet", "x0", **NO_FEET),
    "poses": differs(
        "errors of poses alone, as the paper has it", "no-feet", loss_weights=DanceLossWeights()
    ),
    "eps": differs("target eps, with its skip", "no-feet", config=EPS, **NO_FEET),
    "eps-weighted": differs(
        "high noise weighted, up to 21 times", "eps", config=EPS,
        loss_weights=DanceLossWeights(changes=5.0, high_noise=20.0),
    ),
    "v": differs("target v, with the skip", "no-feet", config=replace(EPS, target="v"), **NO_FEET),
    "constant": differs("kinematic losses, all steps alike", "x0", **KIN["constant"]),
    "alpha_bar": differs(
        "kinematic losses weighted by alpha_bar", "x0", "constant", **KIN["alpha_bar"]
    ),
    "snr": differs(
        "kinematic losses weighted by alpha_bar / (1 - alpha_bar), 5 at most",
        "x0", "constant", "alpha_bar", **KIN["snr"],
    ),
    "slide": differs("a foot loss of 2", "alpha_bar", kinematic=replace(KINEMATIC, slide=2.0)),
    "cosine": differs("the cosine schedule as it is", "x0", snr=1.0),
    "gain-noise": differs("music as from different loudspeakers", "x0", gain_noise=0.3),
    "ear": differs(
        "an ear that was trained first, on the same songs", "x0", config=HEARING, ear=EAR
    ),
    "linear-music": differs(
        "one linear layer for the music", "x0", config=replace(X0, music_layers=0)
    ),
    "transformer": differs("a plain transformer of equal size", "x0", config=PLAIN),
    "mfcc": differs(
        "MFCC and the true beats instead of Mel", "x0", config=replace(X0, C=CHANNELS)
    ),
    "regression": differs(
        "regression, errors of poses alone", "transformer",
        config=replace(PLAIN, deterministic=True),
    ),
}  # fmt: skip
MUSIC_FEATURES = {"mfcc": mfcc_and_beats}  # all others use log-Mel
N = len(SHARE)
DIFFERENCES = {
    "bas_share_minus_{}": Kind("of the data's", SHARE, lambda *x: share(*x[:N]) - share(*x[N:])),
    "bone_gain_over_{}": Kind("share", ("bones",), bone_gain),
}


@dataclass(frozen=True)
class Budget:
    """The length of training, its data, and the number of measurements."""

    steps: int = 1200
    songs: int = 400
    seconds: float = 20.0
    batch: int = 16
    ear_steps: int = 2400  # of an ear, which is trained first
    measured: DanceSize = DanceSize(songs=30, seeds=2, pieces=10, each=8)


FULL = Budget()
QUICK = Budget(3, 2, 8.0, batch=3, ear_steps=2, measured=DanceSize(3, 1, 2, 2))


def recipe_of(name: str, budget: Budget, seed: int = 0) -> SongRecipe:
    """The training of one variant with one seed, as `recipes.dancer` understands it."""
    config, settings = VARIANTS[name].recipe
    sizes = {key: getattr(budget, key) for key in ("steps", "songs", "seconds", "batch")}
    plain = {"config": config, "gain_noise": 0.0, "no_music": 0.0, "ear": None}
    settings = sizes | plain | settings
    if settings["ear"]:
        alike = {key: sizes[key] for key in ("songs", "seconds")}
        settings["ear"] = replace(EAR, steps=budget.ear_steps, **alike)
    return replace(DANCER_PLAIN, name=f"dance-budget.{name}", seed=seed, **settings)


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


def trained(name: str, seed: int, budget: Budget, runs: Path) -> Dancer:
    """The dancer of one variant.

    A run that was killed continues; one that is finished is only read.
    """
    features = name if name in MUSIC_FEATURES else ""
    runs.mkdir(parents=True, exist_ok=True)
    run, log = runs / f"{name}-{seed}.safetensors", partial(print, flush=True)
    return train_dancer(recipe_of(name, budget, seed), run, material(features, budget), log)


def about(name: str, budget: Budget) -> dict:
    """The settings of a row: training, songs and dances, and sampler."""
    size, recipe = budget.measured, recipe_of(name, budget)
    found = {"data": UNSEEN, "songs": size.songs, "dances": DANCES, "samples": size.seeds}
    found |= {"pieces": [size.pieces, size.each], "steps": STEPS, "eta": ETA}
    found |= {"trained_steps": recipe.steps, "trained_songs": recipe.songs, "batch": recipe.batch}
    return found | ({"ear_steps": recipe.ear.steps} if recipe.ear else {})


def sweep(budget: Budget, runs: Path) -> Sweep:
    """The dancers, with one training seed each."""

    def measure(name: str, dancer: Dancer, seed: int) -> dict:
        return danced(stage(name if name in MUSIC_FEATURES else "", budget), dancer).rows

    return Sweep(
        "dance-budget", VARIANTS, lambda name, seed: trained(name, seed, budget, runs), measure,
        DANCED, DIFFERENCES, lambda name: about(name, budget),
    )  # fmt: skip
