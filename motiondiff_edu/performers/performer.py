"""What all performers share: a network and its noise schedule, sampling, and a progress bar."""

import copy
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, TypeVar

import numpy as np
import torch
from jaxtyping import Float
from torch import Tensor
from tqdm.auto import tqdm

from ..ddpm import Denoiser, Generators, Schedule, Step, ddim_steps, final, sample_steps
from ..motion.arguments import checked_seed
from ..motion.scaler import Scaler
from ..prediction import denoiser_of
from .networks import AnyNetwork, Config

Own = TypeVar("Own", bound="Performer")  # the class of a performer, or of one made of it
Watch = Callable[[Iterable[Step]], Iterable[Step]]  # wraps a loop, as `bar` does

# default of DDIM, but for dances: more change little (docs/RESULTS_ALL.md: walker-ddpm,
# words.steps50, inbetween.steps50)
STEPS = 10


@contextmanager
def float32() -> Iterator[None]:
    """torch's default type is float32 in a `with`, or in a function that this decorates."""
    usual = torch.get_default_dtype()
    torch.set_default_dtype(torch.float32)
    try:
        yield
    finally:
        torch.set_default_dtype(usual)


def generators(seed: int, count: int, *also: int) -> list[torch.Generator]:
    """A generator for each of `count` samples. The first ones are those of a smaller count.

    `also`: whole numbers of 0 or more that are mixed into the seed.
    Raises ValueError for a seed that torch does not take.
    """
    seed = checked_seed(seed)
    if also:
        seed = int(np.random.SeedSequence([seed, *also]).generate_state(1, np.uint64)[0])
    further = np.random.SeedSequence(seed).generate_state(count, np.uint64)[1:]
    return [torch.Generator().manual_seed(one) for one in (seed, *further.tolist())]


def sample_motion(
    denoise: Denoiser,
    x_S: Float[Tensor, "B T D"],
    schedule: Schedule,
    steps: int | None,
    eta: float,
    generator: Generators | None,
    watch: Watch = iter,
) -> Float[Tensor, "B T D"]:
    """A whole motion from noise: DDIM with at most S steps, or for None DDPM with all of them.

    DDPM draws noise of the posterior's variance here; `Walker` and `ddpm.sample_steps` take beta_s.
    `watch` gets the sampling loop, and shows how far it is.
    """
    if steps is None:
        loop = sample_steps(denoise, x_S, schedule, variance="posterior", generator=generator)
    else:
        steps = min(steps, schedule.S)
        loop = ddim_steps(denoise, x_S, schedule, steps, eta, generator=generator)
    return final(watch(loop)).x_s


@contextmanager
def evaluating(model: AnyNetwork) -> Iterator[None]:
    """The network without dropout; afterwards the parts that were in training mode are so again."""
    # only where a part is in training mode: eval() visits every layer
    training = [part for part in model.modules() if part.training] if model.training else []
    if training:
        model.eval()
    try:
        yield
    finally:
        for part in training:
            part.training = True


@dataclass(frozen=True, eq=False, repr=False)
class Performer:
    """A trained network and its schedule; each kind of performer adds its units.

    Raises ValueError for a schedule with another number of steps than the network's.
    """

    model: AnyNetwork
    schedule: Schedule

    def __post_init__(self):
        if self.schedule.S != self.model.config.S:
            raise ValueError(
                f"the schedule has {self.schedule.S} steps, the network {self.model.config.S}"
            )

    def __repr__(self) -> str:
        """One line: what it is called, its network, and how large that is."""
        name = getattr(self, "card", {}).get("name", "not named")
        numbers = sum(weights.numel() for weights in self.model.parameters())
        return (
            f"{type(self).__name__} {name!r}: {type(self.model).__name__} of {numbers:,} weights, "
            f"predicts {self.config.target}, {self.schedule.S} diffusion steps"
        )

    def __getattr__(self, name: str):
        """Called for missing attributes: `walker.dance` raises an error that names the dancer."""
        verbs = {"walk": "walker", "dance": "dancer", "act": "mover", "fill": "inbetweener"}
        if name in verbs:
            this = type(self).__name__.lower()
            article = "an" if this[0] in "aeiou" else "a"
            raise AttributeError(f"{article} {this} cannot {name}; md.load({verbs[name]!r}) can")
        return object.__getattribute__(self, name)  # the usual error, or that inside a property

    def to(self: Own, device: str | torch.device) -> Own:
        """The same performer on another device; it moves there what it is given."""
        units = {name: one for name, one in vars(self).items() if isinstance(one, Scaler)}
        moved: dict[str, Any] = {name: one.to(device) for name, one in units.items()}
        return replace(self, model=copy.deepcopy(self.model).to(device), **moved)

    @property
    def config(self) -> Config:
        return self.model.config

    def _denoiser(self, network: Callable[..., Tensor], *given) -> Denoiser:
        """`network(x_s, s, *given)` in evaluation mode, as a denoiser: it returns eps_hat."""

        def evaluated(x_s: Tensor, s: Tensor) -> Tensor:
            with evaluating(self.model):
                return network(x_s, s, *given)

        return denoiser_of(evaluated, self.schedule, self.config.target)


DELAY = 1.0  # seconds before it appears: a shorter computation shows no bar
Record = TypeVar("Record")


def bar(
    what: str, total: int | None = None, shown: bool = True
) -> Callable[[Iterable[Record]], Iterator[Record]]:
    """A function that gives a loop a bar with these words; the bar disappears at the end.

    `total`: the number of the loop's records. No bar is shown when the output is not a terminal.
    """
    return partial(
        tqdm,
        desc=what,
        total=total,
        delay=DELAY,
        mininterval=0.5,
        leave=False,
        disable=None if shown else True,
    )
