"""Dancers and in-betweeners with random weights, small enough for a test.

They move like noise; how they are called is the same as for trained ones.
"""

from dataclasses import replace

import torch

from motiondiff_edu.ddpm import cosine_schedule
from motiondiff_edu.mofusion import MoFusion, MoFusionConfig
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.performers.dancer import Dancer
from motiondiff_edu.performers.inbetweener import Inbetweener, KeyframeConfig, KeyframeMoFusion

TINY = MoFusionConfig(S=12, widths=(16, 24), heads=2, music_layers=1, target="x0", skip=False)
HEARS = MoFusionConfig(C=5, S=30, widths=(16, 24), heads=2, music_layers=1, target="x0", skip=False)


def dancer_to_mel(**changes) -> Dancer:
    torch.manual_seed(0)
    model = MoFusion(replace(TINY, **changes))
    with torch.no_grad():
        for weight in model.parameters():
            weight.add_(0.1 * torch.randn(weight.shape))
    motion = Scaler(torch.zeros(63), torch.full((63,), 0.1))
    mel = Scaler(torch.full((80,), -6.0), torch.ones(80))
    return Dancer(
        model.eval().requires_grad_(False), cosine_schedule(model.config.S), motion, mel, {}
    )


def dancer_of_bands(C: int = 0) -> Dancer:
    torch.manual_seed(0)
    model = MoFusion(replace(HEARS, C=C)).eval().requires_grad_(False)
    for weight in model.parameters():
        weight.add_(0.1 * torch.randn(weight.shape))
    scalers = Scaler(torch.zeros(63), torch.full((63,), 0.2)), Scaler.nothing(C)
    return Dancer(model, cosine_schedule(30), *scalers)


def small_inbetweener(**changes) -> Inbetweener:
    torch.manual_seed(0)
    config = KeyframeConfig(**{"S": 30, "widths": (16, 24), "heads": 2, **changes})
    model = KeyframeMoFusion(config).eval().requires_grad_(False)
    for weight in model.parameters():
        weight.add_(0.1 * torch.randn(weight.shape))
    return Inbetweener(model, cosine_schedule(30), Scaler(torch.zeros(63), torch.full((63,), 0.2)))
