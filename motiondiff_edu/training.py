"""One training loop, a generator.

It yields after every step, keeps an averaged copy, and can be killed and resumed.

Nothing here knows what is trained: `loss_fn(model, generator)` draws its own batch and noise from
the generator. A network with dropout draws from torch's global generator as well. A run saves the
states of both, which is why it continues bit for bit when it is resumed (`recipes.training`).
Source: MoDiff Alg. 1.   Notebook: 05, 07
"""

import copy
import math
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import compress
from typing import Any

import torch
from torch import Tensor, nn
from tqdm.auto import tqdm

LossFn = Callable[[nn.Module, torch.Generator], Tensor]


class NonFiniteLoss(RuntimeError):
    """The loss became NaN or infinite; the message says which weights were kept."""


@dataclass(eq=False)
class TrainState:
    """Everything that a run consists of.

    `recipes.training.save_run` writes it and `recipes.training.resume_run` reads it.
    """

    model: nn.Module
    average: nn.Module  # exponential moving average of the weights: what is used after training
    optimizer: Any  # a torch.optim.Optimizer, or muon.MuonAndAdam
    generator: torch.Generator
    decay: float = 0.999  # share that the average keeps at each step, less in the first steps
    step: int = 0
    seconds: float = 0.0  # spent in training so far (wall-clock time)

    @classmethod
    def start(
        cls, model: nn.Module, seed: int = 0, optimizer=None, decay: float = 0.999
    ) -> "TrainState":
        """A fresh run of this model; the default optimizer is Adam.

        `seed` is that of `state.generator`. The dropout of a network (`MODIFF_PAPER` has some)
        draws from torch's global generator instead: for the same run again, call
        `torch.manual_seed` as well.
        """
        average = copy.deepcopy(model).requires_grad_(False).eval()
        optimizer = optimizer or torch.optim.Adam(model.parameters(), fused=True)
        return cls(model, average, optimizer, torch.Generator().manual_seed(seed), decay)


@dataclass(frozen=True)
class Saving:
    """A function that writes a state, and the seconds of training between two such writes.

    `recipes.training.saver` makes one.
    """

    write: Callable[[TrainState], object]
    every: float = 300.0  # seconds


@dataclass(frozen=True)
class TrainStep:
    """What one step of training reports."""

    step: int
    loss: float
    grad_norm: float
    lr: float


def cosine_lr(peak: float, steps: int, warmup: int = 100) -> Callable[[int], float]:
    """Learning rate: rises evenly for `warmup` steps, then falls to zero along a half cosine.
    Notebook: 05"""

    def lr(step: int) -> float:
        if step < warmup:
            return peak * (step + 1) / warmup
        return (
            peak
            * 0.5
            * (1 + math.cos(math.pi * min(1.0, (step - warmup) / max(1, steps - warmup))))
        )

    return lr


def train_steps(
    state: TrainState,
    loss_fn: LossFn,
    steps: int,
    *,
    lr: float | Callable[[int], float] = 1e-3,
    clip: float = 1.0,
    save: Saving | None = None,
    before: Callable[[int], object] | None = None,
    progress: bool = True,
) -> Iterator[TrainStep]:
    """Train until `state.step == steps`, yielding after each step.

    `clip`: largest norm of the gradient.
    `save`: writes the state every `save.every` seconds of training, and at the end.
    `before`: called ahead of each step with the number of steps done, for losses that change on
    the way (`diffusion_dropout.Dropout.now`).
    The whole network is in training mode at each step: a part that shall stay without dropout has
    to be made without it.
    Raises NonFiniteLoss with what to do; the last good weights stay in `state`, and are saved
    (broken ones are not).
    Source: MoDiff Alg. 1 (the loop).  Notebook: 05, 07
    """
    bar = tqdm(
        total=steps,
        initial=state.step,
        disable=not progress,
        desc="training",
        unit="step",
        mininterval=1.0,
    )
    saved = state.seconds
    with bar, _evaluating_after(state.model):
        while state.step < steps:
            state.model.train()  # at each step: the caller may have sampled since the last one
            began, rate = time.perf_counter(), lr(state.step) if callable(lr) else lr
            if before:
                before(state.step)
            loss = loss_fn(state.model, state.generator)
            state.optimizer.zero_grad(set_to_none=True)
            loss.backward()
            norm = nn.utils.clip_grad_norm_(state.model.parameters(), clip)
            if not (torch.isfinite(loss) and torch.isfinite(norm)):
                _stop(state, loss.item(), norm.item(), rate, save)
            for group in state.optimizer.param_groups:
                group["lr"] = rate
            state.optimizer.step()
            _follow(state)
            state.step, state.seconds = state.step + 1, state.seconds + time.perf_counter() - began
            if save and (state.seconds - saved >= save.every or state.step == steps):
                save.write(state)
                saved = state.seconds
            bar.update()
            report = TrainStep(state.step, loss.item(), norm.item(), rate)
            if state.step % 20 == 0:
                bar.set_postfix_str(f"loss {report.loss:.4f}", refresh=False)
            yield report


@contextmanager
def _evaluating_after(model: nn.Module) -> Iterator[None]:
    """The model is in evaluation mode afterwards, also after an error or a `break`."""
    try:
        yield
    finally:
        model.eval()


@torch.no_grad()
def _follow(state: TrainState) -> None:
    """average <- decay average + (1 - decay) model, with a shorter memory at the start."""
    decay = min(state.decay, (1 + state.step) / (10 + state.step))
    means, news = (list(one.state_dict().values()) for one in (state.average, state.model))
    floats = [mean.is_floating_point() for mean in means]
    torch._foreach_lerp_([*compress(means, floats)], [*compress(news, floats)], 1 - decay)
    for mean, new, is_float in zip(means, news, floats, strict=True):
        if not is_float:
            mean.copy_(new)


def _stop(state: TrainState, loss: float, norm: float, rate: float, save: Saving | None) -> None:
    weights = [*state.model.parameters(), *state.average.parameters()]
    if all(torch.isfinite(weight).all() for weight in weights):
        kept = "The weights are those of the last good step." + (
            f" They are saved: {save.write(state)}." if save else ""
        )
    else:
        kept = (
            "The update before had broken the weights already; "
            "they are not saved, and what was saved earlier stays."
        )
    raise NonFiniteLoss(
        f"step {state.step}: the loss is {loss}, the gradient's norm {norm}, at learning rate "
        f"{rate:g}. {kept} Usual causes: a learning rate too high (try a tenth), "
        "or NaN in the data (Scaler.fit refuses those)."
    )
