"""Train for a number of CPU-seconds instead of steps: how comparisons at one budget are made."""

import math
import time
from dataclasses import replace

import torch

from ..modiff import MODIFF_SMALL, MoDiff, MoDiffConfig
from ..motion.clip import Clip
from ..muon import MuonAndAdam
from ..training import TrainState, train_steps
from ..walker import SCHEDULES, Walker
from ..windows import Windows, window_loss

X0_SMALL = replace(MODIFF_SMALL, target="x0", skip=False)


def train_for(
    seconds: float,
    clips: list[Clip],
    config: MoDiffConfig = X0_SMALL,
    *,
    lr: float = 3e-3,
    seed: int = 0,
    optimizer: str = "muon",
    schedule: str = "leap",
    **loss,
) -> tuple[Walker, int]:
    """A walker trained until the CPU-seconds of the loop are spent, and the number of steps it took.

    The learning rate rises for 100 steps and falls to zero along a half cosine of the seconds. `loss` goes to
    `windows.window_loss`.  Notebook: 07
    """
    torch.manual_seed(seed)
    windows, levels, model = Windows.of(clips, config.T_h, config.T_p), SCHEDULES[schedule](config.S), MoDiff(config)
    state = TrainState.start(model, seed, MuonAndAdam(model) if optimizer == "muon" else None)
    start = time.process_time()

    def spent() -> float:
        return (time.process_time() - start) / seconds

    def rate(step: int) -> float:
        return lr * min(1, (step + 1) / 100) * 0.5 * (1 + math.cos(math.pi * min(1.0, spent())))

    settings = {"jitter": 0.3, "metres": 2.0, "near": 1.0} | loss
    loss_fn = window_loss(windows, levels, **settings)
    for _ in train_steps(state, loss_fn, 10**9, lr=rate, decay=0.99, progress=False):
        if spent() >= 1:
            break
    return Walker(state.average.eval(), levels, windows.pose_scaler, windows.control_scaler), state.step
