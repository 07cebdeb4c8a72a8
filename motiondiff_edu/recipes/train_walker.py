"""Train a recipe into a walker: data, windows, card. A killed run continues where it was saved
last."""

import hashlib
from pathlib import Path

import numpy as np
import torch

from ..beyond.footholds import network
from ..diffusion_dropout import Dropout, dropout_rate
from ..motion.augment import mirror, reverse_time
from ..motion.clip import Clip
from ..performers.walker import SCHEDULES, Walker
from ..performers.windows import Windows, window_loss
from .train_recipe import train_recipe
from .walkers import Recipe


def training_clips(recipe: Recipe) -> list[Clip]:
    """The recipe's data: made from its seed, every clip mirrored as well, a share of both reversed
    in time."""
    from data_synth.walking import dataset  # data_synth lies beside the package, and imports it

    clips = dataset(recipe.clips, recipe.seconds, seed=recipe.data_seed, styles=recipe.styles)
    both = [version for clip in clips for version in (clip, mirror(clip))]
    chosen = np.random.default_rng(recipe.data_seed).random(len(both)) < recipe.reversed_share
    return both + [reverse_time(clip) for clip, take in zip(both, chosen, strict=True) if take]


def train(recipe: Recipe, run_file: Path, clips: list[Clip] | None = None, log=print) -> Walker:
    """Train (or continue) a recipe; `run_file` holds the run.  Returns the averaged network as a
    walker.

    Raises ValueError when the run in `run_file` was begun with other settings.
    """
    config = recipe.config
    windows = Windows.of(clips or training_clips(recipe), config.T_h, config.T_p)
    schedule = SCHEDULES[recipe.schedule](config.S)
    scalers = (windows.pose_scaler, windows.control_scaler)
    dropout = (
        Dropout(schedule, dropout_rate(recipe.dropout, recipe.calm), recipe.steps)
        if recipe.dropout
        else None
    )
    torch.manual_seed(recipe.seed)
    trained, card = train_recipe(
        recipe,
        run_file,
        network(config, *scalers),
        window_loss(windows, schedule, **recipe.loss_settings, dropout=dropout),
        before=dropout.now if dropout else None,
        about={"network": type(config).__name__, "data": digest(windows)},
        facts={"frames": len(windows.poses), "control_range": control_range(windows)},
        data="data_synth.walking, synthetic",
        warmup=500,
        log=log,
    )
    return Walker(trained, schedule, *scalers, card)


def control_range(windows: Windows) -> dict[str, list[float]]:
    """The smallest and the largest of each column of the control in the data; m/s, m/s, rad/s."""
    control = windows.control_scaler.inverse(windows.control)
    return {name: [round(float(x), 3) for x in values] for name, values in
            (("low", control.amin(0)), ("high", control.amax(0)))}  # fmt: skip


def digest(windows: Windows) -> str:
    """Of the frames as the network sees them: a run goes on with the data it was begun with, or not
    at all."""
    frames = (windows.poses.numpy(), windows.control.numpy())
    return hashlib.sha256(b"".join(array.tobytes() for array in frames)).hexdigest()[:16]
