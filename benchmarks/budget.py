"""Training for a number of CPU-seconds instead of steps, to compare recipes at equal cost."""

import math
import time
from collections.abc import Callable
from dataclasses import replace

from motiondiff_edu.motion.clip import Clip
from motiondiff_edu.performers.walker import Walker
from motiondiff_edu.recipes.muon import optimizer_for
from motiondiff_edu.recipes.walker import WALKER_TRUNK, WalkerRecipe, prepared
from motiondiff_edu.training import TrainState, train_steps

WARM_UP = 100  # steps
BUDGET = replace(WALKER_TRUNK, name="budget", batch=32, lr=3e-3, decay=0.99)


def train_for(
    seconds: float,
    clips: list[Clip],
    recipe: WalkerRecipe = BUDGET,
    clock: Callable[[], float] = time.process_time,
) -> tuple[Walker, int]:
    """Train a walker until the CPU-seconds of the loop are spent; return it with its steps.

    The recipe's own number of steps, number of clips and data seed are ignored. The learning rate
    rises for 100 steps and falls to zero along a half cosine of the seconds. Diffusion dropout
    rises with the seconds, too. `clock` returns seconds; by default the CPU time of this process.
    """
    begun = prepared(recipe, clips)
    optimizer = optimizer_for(begun.model, recipe.optimizer)
    state = TrainState.start(begun.model, recipe.seed, optimizer, recipe.decay)
    start = clock()

    def spent() -> float:
        return min(1.0, (clock() - start) / seconds)

    def rate(step: int) -> float:
        warm_up = min(1, (step + 1) / WARM_UP)
        return recipe.lr * warm_up * 0.5 * (1 + math.cos(math.pi * spent()))

    def before(step: int) -> None:
        if begun.dropout:
            begun.dropout.done = spent()

    for _ in train_steps(state, begun.loss_fn, 10**9, lr=rate, before=before, progress=False):
        if spent() >= 1:
            break
    return begun.walker(state.average.eval()), state.step
