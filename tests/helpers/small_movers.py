"""Movers with random weights, small enough for a test; they act as trained ones are called."""

from collections.abc import Callable

import numpy as np
import torch
from torch import nn

from data_synth.actions import captions
from motiondiff_edu.beyond import timeline
from motiondiff_edu.conditions.clip import Clip
from motiondiff_edu.conditions.text import base_vocabulary
from motiondiff_edu.ddpm import cosine_schedule
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.performers.described_windows import with_even_timeline
from motiondiff_edu.performers.mover import Mover
from motiondiff_edu.performers.text_mofusion import TextMoFusion, TextMoFusionConfig

WORDS = base_vocabulary(captions.vocabulary())
SMALL = TextMoFusionConfig(widths=(16, 24), heads=2, C=20, S=30, words=WORDS, word_layers=1)
SPREAD = Scaler(torch.linspace(-1, 1, SMALL.D), torch.linspace(0.5, 2, SMALL.D))


def with_timeline(features: np.ndarray) -> Scaler:
    """The scaler of motions with a timeline, of the features of some motion (T, 66)."""
    beside = np.zeros((len(features), timeline.D))
    return with_even_timeline(
        Scaler.fit(torch.from_numpy(np.concatenate([features, beside], -1)).float())
    )


def mover_of(
    config: TextMoFusionConfig = SMALL,
    scaler: Scaler = SPREAD,
    card: dict | None = None,
    clip: Clip | None = None,
    build: Callable[..., nn.Module] = TextMoFusion,
) -> Mover:
    torch.manual_seed(0)
    model = build(config)
    for parameter in model.parameters():  # blocks that begin at zero would hide their inputs
        if not parameter.any():
            torch.nn.init.normal_(parameter, std=0.1)
    model = model.eval().requires_grad_(False)
    return Mover(model, cosine_schedule(config.S), scaler, card or {}, clip)
