"""Train for a number of CPU-seconds instead of steps: how comparisons at one budget are made."""

import math
import time

import torch

from ..beyond.schedules import SCHEDULES
from ..modiff import MoDiffConfig
from ..motion.clip import Clip
from ..performers.networks import network
from ..performers.walker import Walker
from ..performers.windows import Windows, window_loss
from ..training import TrainState, train_steps
from .muon import optimizer_for
from .walkers import WALKER_X0

SETTINGS = WALKER_X0.loss_settings | {"batch": 32}


def train_for(
    seconds: float,
    clips: list[Clip],
    config: MoDiffConfig = WALKER_X0.config,
    *,
    lr: float = 3e-3,
    seed: int = 0,
    optimizer: str = WALKER_X0.optimizer,
    schedule: str = WALKER_X0.schedule,
    **loss,
) -> tuple[Walker, int]:
    """A walker trained until the CPU-seconds of the loop are spent, and the number of steps it
    took.

    The learning rate rises for 100 steps and falls to zero along a half cosine of the seconds.
    `loss` goes to `performers.windows.window_loss`; what it does not name is walker-x0's, with half
    its batch.
    """
    torch.manual_seed(seed)
    windows, levels = Windows.of(clips, config.T_h, config.T_p), SCHEDULES[schedule](config.S)
    model = network(config, windows.pose_scaler, windows.control_scaler)
    state = TrainState.start(model, seed, optimizer_for(model, optimizer))
    start = time.process_time()

    def spent() -> float:
        return (time.process_time() - start) / seconds

    def rate(step: int) -> float:
        return lr * min(1, (step + 1) / 100) * 0.5 * (1 + math.cos(math.pi * min(1.0, spent())))

    loss_fn = window_loss(windows, levels, **(SETTINGS | loss))
    for _ in train_steps(state, loss_fn, 10**9, lr=rate, decay=0.99, progress=False):
        if spent() >= 1:
            break
    return Walker(
        state.average.eval(), levels, windows.pose_scaler, windows.control_scaler
    ), state.step
