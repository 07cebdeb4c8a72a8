"""Train a recipe into a walker: data, windows, Algorithm 1 with the recipe's departures, card.

A killed run continues where it was saved last.
"""

import hashlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch
from torch import Tensor, nn

from .._files import digest_of_tensors
from ..beyond import loss_terms
from ..beyond.footholds import CleanFootholds, FootholdConfig
from ..beyond.held_control import held_control
from ..beyond.noised_past_weight import NoisedPastWeight
from ..beyond.past_noise import past_noise
from ..beyond.schedules import SCHEDULES
from ..beyond.shared_encoding import SharedEncoding, repeated
from ..ddpm import Schedule, squared_error
from ..diffusion_dropout import Dropout, dropout_rate
from ..modiff import training_loss
from ..motion.augment import mirror, reverse_time
from ..motion.clip import Clip
from ..motion.formats.files import read_motions
from ..motion.root_frame import FPS
from ..performers.networks import network
from ..performers.walker import Walker
from ..performers.windows import Windows, typical_change
from ..training import LossFn
from .train_recipe import Provenance, on_device, train_recipe
from .walkers import LossWeights, Recipe


def training_clips(recipe: Recipe) -> list[Clip]:
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
    clips = [motion.resampled(FPS).to_clip() for motion in read_motions(folder)]
    return [version for clip in clips for version in (clip, mirror(clip))]


def train(
    recipe: Recipe,
    run_file: Path,
    clips: list[Clip] | None = None,
    log=print,
    first: nn.Module | None = None,
    device: str | None = None,
) -> Walker:
    """Train (or continue) a recipe; `run_file` holds the run.

    Returns the averaged network as a walker.
    `first` is the trained network that the recipe begins with, if it names one.
    `device`: as in `train_recipe.on_device`.

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
    model: nn.Module
    loss_fn: LossFn
    dropout: Dropout | None

    def walker(self, trained: nn.Module, card: dict | None = None) -> Walker:
        """The walker of a trained network, in the units of these data."""
        scalers = self.windows.pose_scaler, self.windows.control_scaler
        return Walker(trained, self.schedule, *scalers, card or {})


def prepared(recipe: Recipe, clips: list[Clip]) -> Prepared:
    """What a recipe trains on these clips; the network's first weights follow from its seed."""
    config = recipe.config
    windows = Windows.of(clips, config.T_h, config.T_p)
    schedule = SCHEDULES[recipe.schedule](config.S)
    dropout = dropout_of(recipe, schedule)
    torch.manual_seed(recipe.seed)
    model = network(config, windows.pose_scaler, windows.control_scaler)
    return Prepared(windows, schedule, model, loss_of(recipe, windows, schedule, dropout), dropout)


def loss_of(
    recipe: Recipe, windows: Windows, schedule: Schedule, dropout: Dropout | None = None
) -> LossFn:
    """The recipe's loss: its data, `modiff.training_loss`, and the departures that it names.

    A share of the windows, `recipe.held_control`, holds the control of the next step over the whole
    future: interactive use does not know the future control.
    """
    loss, change = weighted_loss(recipe.loss_weights, windows, schedule), typical_change(windows)
    footholds = isinstance(recipe.config, FootholdConfig)

    def loss_fn(model: nn.Module, generator: torch.Generator) -> Tensor:
        device = next(model.parameters()).device
        past, x0, control = windows.draw(recipe.batch, generator)
        control = held_control(control, windows.T_h, recipe.held_control, generator)
        noised = past
        if recipe.past_noise:
            noised = past_noise(past, recipe.past_noise, change[0], generator)
        batch = tuple(part.to(device) for part in (past, noised, x0, control))
        past, noised, x0, control = repeated(batch, recipe.noises)
        if recipe.noises > 1:
            model = SharedEncoding(model, recipe.noises)
        if footholds:
            model = CleanFootholds(model, past, noised, recipe.foot_noise)
        batch = (noised, x0, control)
        if dropout is None:
            return training_loss(model, batch, schedule, generator, loss=loss)
        light = NoisedPastWeight(dropout, recipe.noised_past_weight)
        both = {"dropout": light, "loss": light.weighted(loss)}
        return training_loss(model, batch, schedule, generator, **both)

    return loss_fn


def weighted_loss(weights: LossWeights, windows: Windows, schedule: Schedule) -> loss_terms.Loss:
    """eq. 10's mean square, with the weights and terms that are not 0."""
    std, loss = windows.pose_scaler.std, squared_error
    if weights.metres:
        loss = loss_terms.weighted(loss, loss_terms.metre_weights(std, weights.metres))
    if weights.bones:
        loss = loss_terms.total(loss, loss_terms.bones(weights.bones, std))
    if weights.near:
        change = typical_change(windows) * std
        loss = loss_terms.weighted(loss, loss_terms.near_weights(change, weights.near))
    if weights.high_noise:
        steps = loss_terms.high_noise_weights(schedule, weights.high_noise)
        loss = loss_terms.weighted_by_step(loss, steps)
    return loss


def dropout_of(recipe: Recipe, schedule: Schedule) -> Dropout | None:
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
