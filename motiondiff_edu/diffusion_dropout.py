"""Diffusion dropout: in some samples the past is noised like the future, so that the network must
use the control.

    q(x_s | x) = N(sqrt(alpha_bar_s) x, (1 - alpha_bar_s) I),
    with probability p_d for each sample of the batch

It is not nn.Dropout: nothing is set to zero, and nothing is rescaled. Two alternatives here do set
to zero: `frame_dropout` and `zero_past`; `baselines.linear_dropout` has their exact effect.
Source: MoDiff III-D, eq. 12, Alg. 1.  Notebook: 09
"""

from collections.abc import Callable
from dataclasses import dataclass

import torch
from jaxtyping import Bool, Float, Int
from torch import Tensor

from .ddpm import Schedule, draw, q_sample

P_D = (0.0, 0.05, 0.10, 0.15, 0.20, 0.25)  # MoDiff IV-A: the rates, one after the other
START = 0.5  # fraction of the training before the first rise: 500 of the paper's 1000 epochs

Past = Float[Tensor, "B T_h D"]


def diffusion_dropout(
    past: Past,
    s: Int[Tensor, "B"],
    schedule: Schedule,
    rate: float,
    generator: torch.Generator | None = None,
    *,
    shared: bool = True,
) -> Past:
    """Noise the past of each sample to its step s, with probability `rate`.

    `s` is the step of the target (Algorithm 1); with shared=False each past draws its own step. The
    noise of the past is independent of the target's.
    Raises ValueError for a rate outside 0..1, for a past that is not (B, T_h, D), and for steps
    that are not (B,) within 0..S.
    Source: MoDiff eq. 12, Alg. 1; shared=False is ours.  Notebook: 09
    """
    if past.ndim != 3 or s.shape != past.shape[:1] or (s < 0).any() or (s > schedule.S).any():
        raise ValueError(
            f"the past is {tuple(past.shape)} and s {s.tolist()!r:.50}: pass a past (B, T_h, D), "
            f"and for each of its samples a step from 0 to {schedule.S}"
        )
    hit = chosen(len(past), rate, generator).to(past.device)
    if not shared:
        s = torch.randint(1, schedule.S + 1, (len(past),), generator=generator).to(past.device)
    return q_sample(past, s, schedule, draw(past, generator)).where(hit[:, None, None], past)


def frame_dropout(past: Past, rate: float, generator: torch.Generator | None = None) -> Past:
    """MoGlow's dropout: each frame of a past becomes 0 (the mean pose) with probability `rate`."""
    hit = chosen(past.shape[0] * past.shape[1], rate, generator).to(past.device)
    return past.masked_fill(hit.view(*past.shape[:2], 1), 0.0)


def zero_past(past: Past, rate: float, generator: torch.Generator | None = None) -> Past:
    """The simplest alternative: the whole past of a sample becomes 0 with probability `rate`."""
    return past.masked_fill(chosen(len(past), rate, generator).to(past.device)[:, None, None], 0.0)


def chosen(n: int, rate: float, generator: torch.Generator | None = None) -> Bool[Tensor, "n"]:
    """True for each of n samples with probability `rate`."""
    if not 0 <= rate <= 1:
        raise ValueError(f"a rate must be between 0 and 1, not {rate:g}")
    return torch.rand(n, generator=generator) < rate


@dataclass
class Dropout:
    """Diffusion dropout for one training run: `modiff.training_loss(..., dropout=dropout)`.

    Its rate rises with `done`, the completed fraction of the training, 0 to 1. A training loop sets
    it before each step: `train_steps(..., before=dropout.now)`.
    Raises RuntimeError if it is called before `done` is set.
    Source: MoDiff Alg. 1, III-D (the scheduler P_d).  Notebook: 09
    """

    schedule: Schedule
    rate: Callable[[float], float]  # rate(done), such as `dropout_rate`
    steps: int  # of the whole training run
    shared: bool = True
    done: float | None = None

    def now(self, step: int) -> None:
        """Set `done` for a number of completed steps."""
        self.done = step / self.steps

    def __call__(
        self, past: Past, s: Int[Tensor, "B"], generator: torch.Generator | None = None
    ) -> Past:
        if self.done is None:
            raise RuntimeError(
                "diffusion dropout does not know the progress of the training: "
                "pass train_steps(..., before=dropout.now), or call dropout.now(step) yourself"
            )
        rate = self.rate(self.done)
        return diffusion_dropout(past, s, self.schedule, rate, generator, shared=self.shared)


def dropout_rate(rates: tuple[float, ...] = P_D, start: float = START) -> Callable[[float], float]:
    """The schedule P_d for a training of any length: `rate(done)`, where `done` goes from 0 to 1.

    The rate is 0 until `start`. The rest of the training is divided equally among the rates; a
    first rate of 0 stands for the part before `start`. (In the paper: .05 from epoch 500 on, .25
    from 900 to the end.)
    Raises ValueError unless the rates and start are in 0..1.  Source: MoDiff III-D, IV-A.
    Notebook: 09
    """
    risen = rates[1:] if len(rates) > 1 and rates[0] == 0 else rates
    if not risen or not all(0 <= rate <= 1 for rate in rates) or not 0 <= start <= 1:
        raise ValueError(f"rates and start must be between 0 and 1, not {rates} and {start:g}")

    def rate(done: float) -> float:
        if done < start or start == 1:
            return 0.0
        k = int((done - start) / (1 - start) * len(risen) + 1e-9)
        return risen[min(k, len(risen) - 1)]

    return rate
