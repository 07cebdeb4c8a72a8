"""Train for a number of CPU-seconds instead of steps: how comparisons at one budget are made."""

import math
import time
from dataclasses import replace

import torch

from ..beyond.schedules import SCHEDULES
from ..motion.clip import Clip
from ..performers.networks import network
from ..performers.walker import Walker
from ..performers.windows import Windows
from ..training import TrainState, train_steps
from .muon import optimizer_for
from .train_walker import dropout_of, loss_of
from .walkers import WALKER_X0, Recipe

WARM_UP = 100  # steps
BUDGET = replace(WALKER_X0, name="budget", batch=32, lr=3e-3, decay=0.99)


def train_for(seconds: float, clips: list[Clip], recipe: Recipe = BUDGET) -> tuple[Walker, int]:
    """A walker trained until the CPU-seconds of the loop are spent.

    The learning rate rises for 100 steps and falls to zero along a half cosine of the seconds.
    `loss` goes to `performers.windows.window_loss`; what it does not name is walker-x0's, with half
    its batch.
    """
    torch.manual_seed(recipe.seed)
    config = recipe.config
    windows, schedule = (
        Windows.of(clips, config.T_h, config.T_p),
        SCHEDULES[recipe.schedule](config.S),
    )
    model = network(config, windows.pose_scaler, windows.control_scaler)
    state = TrainState.start(model, recipe.seed, optimizer_for(model, recipe.optimizer))
    dropout = dropout_of(recipe, schedule)
    loss_fn = loss_of(recipe, windows, schedule, dropout)
    start = time.process_time()

    def spent() -> float:
        return min(1.0, (time.process_time() - start) / seconds)

    def rate(step: int) -> float:
        warm_up = min(1, (step + 1) / WARM_UP)
        return recipe.lr * warm_up * 0.5 * (1 + math.cos(math.pi * spent()))

    def before(step: int) -> None:
        if dropout:
            dropout.done = spent()

    loop = train_steps(
        state, loss_fn, 10**9, lr=rate, decay=recipe.decay, before=before, progress=False
    )
    for _ in loop:
        if spent() >= 1:
            break
    model = state.average.eval()
    return Walker(model, schedule, windows.pose_scaler, windows.control_scaler), state.step
