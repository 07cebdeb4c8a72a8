"""Movers with random weights, small enough for a test; they act as trained ones are called."""

import numpy as np
import torch

from data_synth.actions import captions
from motiondiff_edu.beyond import timeline
from motiondiff_edu.conditions.clip import ClipModel
from motiondiff_edu.conditions.text import base_vocabulary
from motiondiff_edu.ddpm import cosine_schedule
from motiondiff_edu.motion.moving_frame import D
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.performers.described_windows import with_even_timeline
from motiondiff_edu.performers.mover import Mover
from motiondiff_edu.performers.networks import network
from motiondiff_edu.performers.planned_mofusion import PlannedConfig
from motiondiff_edu.performers.text_mofusion import TextMoFusionConfig

WORDS = base_vocabulary(captions.vocabulary())
SIZES = {"widths": (16, 24), "heads": 2, "C": 20, "S": 30, "words": WORDS, "word_layers": 1}
SMALL = TextMoFusionConfig(**SIZES)
PLANNED = PlannedConfig(**SIZES, plan_widths=(8, 16))
SPREAD = Scaler(torch.linspace(-1, 1, D), torch.linspace(0.5, 2, D))


def with_timeline(scaler: Scaler) -> Scaler:
    """A scaler of motions with columns for a timeline."""
    mean, std = (
        torch.nn.functional.pad(part, (0, timeline.D), value=value)
        for part, value in ((scaler.mean, 0.1), (scaler.std, 1.0))
    )
    return with_even_timeline(Scaler(mean, std))


def scaler_of(features: np.ndarray) -> Scaler:
    """The scaler of the features of a motion (T, 66)."""
    return Scaler.fit(torch.from_numpy(features).float())


def mover_of(
    config: TextMoFusionConfig = SMALL,
    scaler: Scaler = SPREAD,
    card: dict | None = None,
    clip: ClipModel | None = None,
) -> Mover:
    torch.manual_seed(0)
    model = network(config)
    for parameter in model.parameters():  # blocks that begin at zero would hide their inputs
        if not parameter.any():
            torch.nn.init.normal_(parameter, std=0.1)
    model = model.eval().requires_grad_(False)
    if isinstance(config, PlannedConfig):
        scaler = with_timeline(scaler)
    return Mover(model, cosine_schedule(config.S), scaler, card or {}, clip)
