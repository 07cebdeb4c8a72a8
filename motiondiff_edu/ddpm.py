"""Denoising diffusion (MoDiff, III-B and III-C).

The forward process adds noise by a fixed rule. A learned rule removes it again, step by step (DDPM)
or in leaps (DDIM).

Steps are numbered s = 1..S, and every table has S + 1 entries, so that `alpha_bar[s]` is that of
the paper, and alpha_bar[0] is 1. A *denoiser* is any callable `denoise(x_s, s) -> eps_hat`, with s
of shape (B,).
"""

import math
import operator
import warnings
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from numbers import Integral
from typing import NamedTuple, SupportsIndex, TypeVar

import torch
from jaxtyping import Float, Int
from torch import Tensor

Steps = Int[Tensor, "B"] | int
X = Float[Tensor, "B *shape"]  # a batch of anything: points, poses, windows
Table = Float[Tensor, "S_plus_1"]  # one number for each step
Denoiser = Callable[[Tensor, Tensor], Tensor]
Generators = torch.Generator | Sequence[torch.Generator]  # of a whole batch, or one for each row
Record = TypeVar("Record")  # what a sampling loop yields, such as Step


# ---- schedules -----------------------------------------------------------------------------------
class StepNumbers(NamedTuple):
    """The numbers of a step: x_s = signal x0 + noise eps.

    Floats for one step; for a step of each sample, tensors that multiply the batch.
    """

    beta: float | Tensor
    alpha: float | Tensor
    alpha_bar: float | Tensor
    signal: float | Tensor  # sqrt(alpha_bar)
    noise: float | Tensor  # sqrt(1 - alpha_bar)
    beta_tilde: float | Tensor  # the posterior's variance


@dataclass(frozen=True, eq=False)
class Schedule:
    """How much noise each step adds.

    It holds beta, alpha = 1 - beta and its running product alpha_bar, indexed by s = 0..S.
    """

    beta: Table
    alpha: Table
    alpha_bar: Table
    name: str = "schedule"

    @property
    def S(self) -> int:
        return len(self.beta) - 1

    @property
    def signal_left(self) -> float:
        """sqrt(alpha_bar[S]): the fraction of the clean sample's amplitude after the last step."""
        return math.sqrt(float(self.alpha_bar[-1]))

    def at(self, s: Steps, x: X, first: int = 0) -> StepNumbers:
        """The numbers of the step s: one for all, or one for each sample of the batch x.

        Raises IndexError for a step below `first` or above S.
        """
        s = checked_step(s, self.S, first)
        tables, numbers = self._tables
        if not isinstance(s, Tensor):
            return numbers[s]
        rows = tables.to(x.device)[:, s].to(x)
        return StepNumbers(*rows.reshape(len(rows), -1, *[1] * (x.dim() - 1)).unbind())

    @cached_property
    def _tables(self) -> tuple[Float[Tensor, "6 S_plus_1"], list[StepNumbers]]:
        """The numbers of all steps, and the same read once: a tensor is slow to give a number."""
        signal, noise = self.alpha_bar.sqrt(), (1 - self.alpha_bar).sqrt()
        rows = self.beta, self.alpha, self.alpha_bar, signal, noise, posterior_variance(self)
        tables = torch.stack(rows)
        return tables, [StepNumbers(*row) for row in tables.T.tolist()]


def make_schedule(beta: Float[Tensor, "S"], name: str = "schedule") -> Schedule:
    """Build a schedule from beta_1..beta_S.

    alpha_s = 1 - beta_s, alpha_bar_s = alpha_1 * ... * alpha_s.

    Raises ValueError unless every beta lies strictly between 0 and 1. Warns if more than 10 % of
    the signal is left after the last step.
    Source: MoDiff eq. 1-2. Notebook: 02.
    """
    beta = torch.cat([torch.zeros(1, dtype=torch.float64), beta.double()])
    bad = [s for s in range(1, len(beta)) if not 0 < beta[s] < 1]
    if bad or len(beta) < 2:
        where = f"beta_{bad[0]} = {float(beta[bad[0]]):g}" if bad else "there is none"
        raise ValueError(
            f"{name}: every beta must lie between 0 and 1, but {where}; "
            "use more steps or smaller betas"
        )
    schedule = Schedule(beta, 1 - beta, torch.cumprod(1 - beta, 0), name)
    if schedule.signal_left > 0.1:
        warnings.warn(
            f"{schedule_card(schedule)} Sampling starts from pure noise, which training then never "
            "shows: use more steps or larger betas.",
            stacklevel=3,
        )
    return schedule


def linear_schedule(S: int = 100, beta_1: float = 1e-4, beta_S: float = 0.1) -> Schedule:
    """beta grows evenly from beta_1 to beta_S.

    MoDiff gives no schedule: these are TimeGrad's numbers.
    Raises ValueError as `make_schedule`, and for a single step that would have two betas.
    Notebook: 02.
    """
    if S == 1 and beta_1 != beta_S:
        raise ValueError(
            f"one step has one beta, not {beta_1:g} and {beta_S:g}: pass S of 2 or more"
        )
    return make_schedule(
        torch.linspace(beta_1, beta_S, S, dtype=torch.float64), f"linear {beta_1:g} to {beta_S:g}"
    )


def rescaled_ddpm_schedule(S: int = 100) -> Schedule:
    """DDPM's 1e-4 to 0.02 over 1000 steps, times 1000 / S for fewer steps.

    Raises ValueError for 20 steps or fewer, for the last beta, 20 / S, would be 1 or more.
    Notebook: 02.
    """
    if S <= 20:
        raise ValueError(
            f"rescaled DDPM: {S} steps are too few, for every beta must lie between 0 and 1, and "
            "the last is 20 / S; use more steps, 21 at least"
        )
    return make_schedule(torch.linspace(0.1 / S, 20 / S, S, dtype=torch.float64), "rescaled DDPM")


def cosine_schedule(S: int = 1000, cap: float = 0.999) -> Schedule:
    """alpha_bar follows cos^2((s / S + .008) / 1.008 * pi / 2), with beta capped. Notebook: 02."""
    u = torch.arange(S + 1, dtype=torch.float64) / S
    curve = torch.cos((u + 0.008) / 1.008 * math.pi / 2) ** 2
    return make_schedule((1 - curve[1:] / curve[:-1]).clamp(max=cap), "cosine")


def schedule_card(schedule: Schedule) -> str:
    """A line of text: the signal that a schedule leaves at its last step, sqrt(alpha_bar[S]).

    Notebook: 02.
    """
    left = f"{100 * schedule.signal_left:.2g} % of the signal's amplitude is left."
    return f"{schedule.name}, S = {schedule.S}: after the last step {left}"


def at(table: Table, s: Steps, x: X, first: int = 0) -> Tensor:
    """table[s] for one s, or one for each sample; it multiplies x. Raises as `checked_step`."""
    s = checked_step(s, len(table) - 1, first)
    many = isinstance(s, Tensor)
    return table.to(x.device)[s].to(x).reshape(-1, *[1] * (x.dim() - 1)) if many else table[s].to(x)


def checked_step(s: Int[Tensor, "B"] | SupportsIndex, S: int, first: int = 0) -> Steps:
    """The step, or those of a batch.  Raises IndexError for one below `first` or above S."""
    if not isinstance(s, Tensor):
        s = low = high = operator.index(s)
    elif s.is_meta or not s.numel():  # there is no value to check
        return s
    else:
        low, high = int(s.min()), int(s.max())
    for step in (low, high):
        if not first <= step <= S:
            raise IndexError(f"s = {step}: steps must be {first} to {S} here; 0 is clean data")
    return s


def draw(
    like: Float[Tensor, "*shape"], generator: Generators | None = None
) -> Float[Tensor, "*shape"]:
    """Standard normal noise in the shape of `like`.

    It is drawn on the generator's device, so that a seed gives the same noise on every device. With
    a generator for each row of a batch, a row does not depend on the size of the batch.
    """
    if isinstance(generator, Sequence):
        return torch.stack([draw(row, one) for row, one in zip(like, generator, strict=True)])
    device = generator.device if generator else like.device
    return torch.randn(like.shape, generator=generator, dtype=like.dtype, device=device).to(
        like.device
    )


# ---- forward: adding noise -----------------------------------------------------------------------
def q_step(x_prev: X, s: Steps, schedule: Schedule, noise: X) -> X:
    """Add one step: x_s = sqrt(1 - beta_s) x_{s-1} + sqrt(beta_s) noise.

    Source: MoDiff eq. 1; MoFusion eq. 1.
    """
    beta = schedule.at(s, x_prev).beta
    return (1 - beta) ** 0.5 * x_prev + beta**0.5 * noise


def q_sample(x0: X, s: Steps, schedule: Schedule, noise: X) -> X:
    """Add s steps: x_s = sqrt(alpha_bar_s) x0 + sqrt(1 - alpha_bar_s) noise.

    Source: MoDiff eq. 2; MoFusion eq. 2.
    """
    now = schedule.at(s, x0)
    return now.signal * x0 + now.noise * noise


def posterior_variance(schedule: Schedule) -> Table:
    """beta_tilde_s = beta_s (1 - alpha_bar_{s-1}) / (1 - alpha_bar_s). Source: MoDiff eq. 7."""
    left = 1 - schedule.alpha_bar
    return torch.cat([left[:1], schedule.beta[1:] * left[:-1] / left[1:]])


def q_posterior(x0: X, x_s: X, s: Steps, schedule: Schedule) -> tuple[X, Tensor]:
    """Mean and variance of x_{s-1} when x_s and the clean x0 are both known.

    mean = sqrt(ab_{s-1}) beta_s / (1 - ab_s) x0 + sqrt(alpha_s) (1 - ab_{s-1}) / (1 - ab_s) x_s
    Source: MoDiff eq. 6-7. Notebook: 02.
    """
    now, before = schedule.at(s, x_s, first=1), schedule.at(s - 1, x_s)
    to_x0 = before.signal * now.beta / now.noise**2
    to_x_s = now.alpha**0.5 * before.noise**2 / now.noise**2
    return to_x0 * x0 + to_x_s * x_s, at(posterior_variance(schedule), s, x_s)


# ---- reverse: removing noise ---------------------------------------------------------------------
@dataclass(frozen=True, eq=False)
class Step:
    """One step of sampling: x_s, and the denoiser's eps_hat and x0_hat for it.

    At s = 0, x_s is the sample itself, and so is x0_hat.
    """

    s: int
    x_s: Tensor
    eps_hat: Tensor
    schedule: Schedule

    @property
    def x0_hat(self) -> Tensor:
        """(x_s - sqrt(1 - alpha_bar_s) eps_hat) / sqrt(alpha_bar_s)."""
        now = self.schedule.at(self.s, self.x_s)
        return (self.x_s - now.noise * self.eps_hat) / now.signal

    def clamp_x0(self, clip: float) -> "Step":
        """The step whose x0_hat is clamped to -clip..clip, with its eps_hat; s is at least 1."""
        now = self.schedule.at(self.s, self.x_s, first=1)
        x0_hat = self.x0_hat.clamp(-clip, clip)
        return replace(self, eps_hat=(self.x_s - now.signal * x0_hat) / now.noise)


def p_mean(x_s: X, s: Steps, eps_hat: X, schedule: Schedule) -> X:
    """mean = (x_s - beta_s / sqrt(1 - alpha_bar_s) eps_hat) / sqrt(alpha_s).

    Source: MoDiff eq. 9. Notebook: 04
    """
    now = schedule.at(s, x_s, first=1)
    return (x_s - now.beta / now.noise * eps_hat) / now.alpha**0.5


def p_sample(
    x_s: X, s: int, eps_hat: X, schedule: Schedule, noise: X | None, variance: str = "beta"
) -> X:
    """x_{s-1} = p_mean + sigma_s noise; the last step, s = 1, adds none.

    sigma_s^2 is beta_s, or with variance="posterior" its lower bound beta_tilde_s.
    Raises ValueError for an unknown variance, and for a step that lacks its noise.
    Source: MoDiff eq. 3, 11; MoFusion eq. 3.
    """
    now = schedule.at(s, x_s, first=1)
    variances = {"beta": now.beta, "posterior": now.beta_tilde}
    if variance not in variances:
        raise ValueError(f'variance must be "beta" or "posterior", not {variance!r}')
    mean = p_mean(x_s, s, eps_hat, schedule)
    if s == 1:
        return mean
    if noise is None:
        raise ValueError(f"step {s} adds noise: pass it as `noise`")
    return mean + math.sqrt(variances[variance]) * noise


def sample_steps(
    denoise: Denoiser,
    start: X,
    schedule: Schedule,
    *,
    generator: Generators | None = None,
    noise: Float[Tensor, "S *any"] | None = None,
    variance: str = "beta",
    clip: float | None = None,
) -> Iterator[Step]:
    """Sample from x_S back to x0, yielding S + 1 records, s = S..0; `start` is x_S.

    noise[s - 1], if given, is the noise of step s; the last step, s = 1, draws none. `clip`
    clamps x0_hat to [-clip, clip], up to rounding.
    Source: MoDiff Alg. 2. Notebook: 03.
    """
    x_s = start.detach()
    for s in range(schedule.S, 0, -1):
        step = _denoised(denoise, s, x_s, schedule, clip)
        yield step
        z = None if s == 1 else draw(x_s, generator) if noise is None else noise[s - 1]
        x_s = p_sample(x_s, s, step.eps_hat, schedule, z, variance)
    yield Step(0, x_s, torch.zeros_like(x_s), schedule)


def _denoised(denoise: Denoiser, s: int, x_s: X, schedule: Schedule, clip: float | None) -> Step:
    """The step s from x_s, at which the whole batch is."""
    with torch.no_grad():
        eps_hat = denoise(x_s, torch.full((len(x_s),), s, device=x_s.device))
    step = Step(s, x_s, eps_hat, schedule)
    return step if clip is None else step.clamp_x0(clip)


def timesteps(S: int, steps: int | Sequence[int]) -> list[int]:
    """The diffusion steps that a sampler visits: so many of S, evenly spaced, or those of a list.

    For example, timesteps(100, 4) = [100, 75, 50, 25].
    Raises ValueError unless 1 <= steps <= S, or for a list that does not fall from S to 1.
    Notebook: 03
    """
    if isinstance(steps, int | Integral):  # Integral: those of numpy, too
        if not 1 <= steps <= S:
            raise ValueError(f"the number of steps must be between 1 and {S}, not {steps}")
        return [S - (i * S) // int(steps) for i in range(steps)]
    visited = list(steps)
    falls = visited == sorted(set(visited), reverse=True)
    if not visited or not falls or not 1 <= visited[-1] <= visited[0] <= S:
        raise ValueError(f"steps must decrease and be within {S} to 1; these are {visited}")
    return visited


def ddim_sigma(s: int, after: int, schedule: Schedule, eta: float) -> float:
    """Standard deviation of the noise that a leap from s to `after` draws.

    sigma^2 = eta^2 (1 - ab_after) / (1 - ab_s) (1 - ab_s / ab_after); eta = 1 is DDPM's posterior.
    Raises ValueError for an eta outside 0..1, IndexError unless 0 <= after < s <= S.
    """
    if not 0 <= eta <= 1:
        raise ValueError(f"eta must be between 0 (no noise) and 1 (as DDPM), not {eta}")
    checked_step(s, schedule.S, first=1)
    checked_step(after, s - 1)
    now, then = (schedule.alpha_bar[step].item() for step in (s, after))
    return eta * math.sqrt((1 - then) / (1 - now) * (1 - now / then))


def ddim_step(
    x0_hat: X,
    eps_hat: X,
    after: int,
    schedule: Schedule,
    sigma: float = 0.0,
    noise: X | None = None,
) -> X:
    """Leap to step `after`.

    x_after = sqrt(ab_after) x0_hat + sqrt(1 - ab_after - sigma^2) eps_hat + sigma noise.
    Raises ValueError for a sigma without noise, IndexError for a step outside 0..S.
    Source: DDIM (Song, Meng and Ermon, 2021).
    """
    then = schedule.at(after, x0_hat)
    x = then.signal * x0_hat + math.sqrt(max(then.noise**2 - sigma**2, 0.0)) * eps_hat
    if not sigma:
        return x
    if noise is None:
        raise ValueError(f"a leap with sigma = {sigma:g} draws noise: pass it as `noise`")
    return x + sigma * noise


def ddim_steps(
    denoise: Denoiser,
    start: X,
    schedule: Schedule,
    steps: int | Sequence[int] = 10,
    eta: float = 0.0,
    *,
    generator: Generators | None = None,
    noise: Float[Tensor, "S *any"] | None = None,
    clip: float | None = None,
) -> Iterator[Step]:
    """Leap from x_S to x0 in a few `ddim_step`s, and yield a record of each, and of s = 0.

    With eta = 0 no noise is drawn. After few steps samples of a Gaussian then vary too little, so
    DDIM is not just a faster DDPM; those of other data, or of a network, need not. noise[s - 1], if
    given, is the noise of step s. `clip` clamps x0_hat.
    Raises ValueError for steps that do not decrease or are outside 1..S, and for eta outside 0..1.
    Notebook: 03
    """
    visited = timesteps(schedule.S, steps)
    x_s = start.detach()
    for s, after in zip(visited, [*visited[1:], 0], strict=True):
        sigma = ddim_sigma(s, after, schedule, eta)
        step = _denoised(denoise, s, x_s, schedule, clip)
        yield step
        z = None if not sigma else draw(x_s, generator) if noise is None else noise[s - 1]
        x_s = ddim_step(step.x0_hat, step.eps_hat, after, schedule, sigma, z)
    yield Step(0, x_s, torch.zeros_like(x_s), schedule)


def final(loop: Iterable[Record]) -> Record:
    """The last record of a sampling loop. Unlike `*_, last = loop`, it keeps no other."""
    return deque(loop, maxlen=1).pop()


# ---- the objective -------------------------------------------------------------------------------
def squared_error(error: X, s: Int[Tensor, "B"]) -> Float[Tensor, ""]:
    """Mean of error^2, with the same weight for all entries and all steps s.

    It is the loss of the papers (Algorithm 1 omits the square).
    Source: MoDiff eq. 10.
    """
    return error.square().mean()


def simple_loss(
    denoise: Denoiser, x0: X, s: Int[Tensor, "B"], schedule: Schedule, noise: X
) -> Float[Tensor, ""]:
    """Mean of ||eps - eps_hat(x_s, s)||^2 for given steps and noise.

    `modiff.training_loss` draws both.
    Source: MoDiff eq. 10.  Notebook: 04.
    """
    return squared_error(noise - denoise(q_sample(x0, s, schedule, noise), s), s)
