"""How far is each method of filling in from the true conditional? A test on Gaussian mixtures.

    truth:     p(unknown | known) of a mixture (`exact.conditional`)
    denoiser:  the exact one, so all errors come from the method
Methods:
    masked          masked sampling (MoFusion 4.4), with or without resampling
    there-and-back  draws the future from the past and the past from the future (MoDiff III-E)
    gibbs           the same, with the known entries given in both directions: Gibbs sampling
    exact           draws from the truth; its errors are those of a finite number of samples
Source: MoFusion 4.4; MoDiff III-E; the comparison is ours.  Notebook: 15
"""

from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from functools import cached_property

import torch
from jaxtyping import Bool, Float
from torch import Tensor

from ..beyond.guidance import blended, guided
from ..ddpm import Denoiser, Schedule, final, timesteps
from ..exact import Mixture, conditional, conditional_parts, sample_mixture
from ..inbetweening import inpaint_steps, resampling_steps
from .mixture_fit import responsibilities


@dataclass(frozen=True, eq=False)
class Problem:
    """A mixture, its exact denoiser, and the values of its known entries.

    `past` marks the entries from which there-and-back starts. If it is given, only unknown entries
    of the past are compared, so that all methods solve the same problem.
    """

    truth: Mixture
    denoise: Denoiser
    schedule: Schedule
    values: Float[Tensor, "D"]
    known: Bool[Tensor, "D"]
    past: Bool[Tensor, "D"] | None = None
    frames: int = 1  # number of frames in D, one after the other; `blend` needs it

    @cached_property
    def true_conditional(self) -> Mixture:
        """The true conditional of all unknown entries."""
        return conditional(self.truth, self.values, self.known)

    @property
    def compared(self) -> Bool[Tensor, "D"]:
        """The entries in which methods are compared."""
        return ~self.known if self.past is None else self.past & ~self.known


@dataclass(frozen=True)
class Method:
    """A method of filling in.

    Its kind is "exact", "masked" (with the options of `inpaint_steps`), "there-and-back" or "gibbs"
    (with `rounds`).
    """

    kind: str
    steps: int = 50
    resample: int = 1
    rounds: int = 20
    blend: int | None = None
    guidance: float = 0.0

    def __post_init__(self):
        """Raise ValueError for an unknown kind."""
        if self.kind not in ("exact", "masked", "there-and-back", "gibbs"):
            raise ValueError(
                f"kind must be exact, masked, there-and-back or gibbs, not {self.kind!r}"
            )

    @property
    def name(self) -> str:
        """For example `masked.50.x5`: fifty steps, each repeated five times.

        Methods that differ in an option that their kind uses have different names.
        """
        turns = "" if self.resample == 1 else f".x{self.resample}"
        turns += "" if self.blend is None else f".blended{self.blend}"
        turns += f".guided{self.guidance:g}" if self.guidance else ""
        ends = {"exact": "", "masked": f".{self.steps}{turns}"}
        return self.kind + ends.get(self.kind, f".{self.rounds}")


METHODS = (
    Method("exact"),
    *(Method("masked", steps) for steps in (5, 10, 50, 100)),
    *(Method("masked", 50, resample) for resample in (2, 5, 10)),
    Method("masked", 50, blend=3),
    Method("masked", 50, guidance=1.0),
)
ROUNDS = (
    Method("there-and-back", rounds=1),
    Method("there-and-back", rounds=20),
    Method("gibbs", rounds=20),
)


class ConditionalSampler:
    """Draws from p(other entries | known entries) of a mixture, for many known values at once."""

    def __init__(self, given: Mixture, known: Bool[Tensor, "D"]):
        self.given, self.known = given, known
        self.seen, self.gain, left = conditional_parts(given, known)
        variances, axes = torch.linalg.eigh(left)
        self.root = axes * variances.clamp(min=0).sqrt()[:, None]

    def draw(self, x: Float[Tensor, "N D"], generator: torch.Generator) -> Float[Tensor, "N D"]:
        """x with new draws of the other entries.

        First a part is drawn by its probability given the known entries, then a point of it.
        """
        value, filled = x[:, self.known], x.clone()
        part = torch.multinomial(responsibilities(self.seen, value), 1, generator=generator)[:, 0]
        noise = torch.randn(len(x), self.root.shape[-1], generator=generator, dtype=torch.float64)
        for k in part.unique():
            here = part == k
            off = value[here] - self.seen.means[k]
            new = (
                self.given.means[k, ~self.known]
                + off @ self.gain[k].T
                + noise[here] @ self.root[k].T
            )
            filled[here.nonzero(), (~self.known).nonzero()[:, 0]] = new
        return filled


def there_and_back(
    problem: Problem,
    x: Float[Tensor, "N D"],
    rounds: int,
    generator: torch.Generator,
    keep: bool = False,
) -> Float[Tensor, "N D"]:
    """Draw the future given the past, then the past given the future, `rounds` times.

    The holes are filled from each new past. Known entries of the future are given. As in III-E, the
    way back is not conditioned on the known entries of the past; they reach the holes only through
    the future. With `keep` it is, which makes this Gibbs sampling, with the true conditional as its
    limit.
    Raises ValueError for a problem without a past.  Source: MoDiff III-E.
    """
    if problem.past is None:
        raise ValueError("there-and-back needs a past to start from: set `past`")
    known, past = problem.known, problem.past
    ahead = ConditionalSampler(problem.truth, past | known)
    back = ConditionalSampler(problem.truth, (~past | known) if keep else ~past)
    for _ in range(rounds):
        x = ahead.draw(x, generator)
        x = torch.where(known, x, back.draw(x, generator))
    return x


def draw_samples(
    problem: Problem, method: Method, n: int, generator: torch.Generator
) -> Float[Tensor, "n D"]:
    """n samples by one method: known entries stay, the others are filled in.

    Notebook: 15
    """
    truth, known = problem.truth, problem.known
    values = problem.values.double().where(known, 0.0).expand(n, -1)
    if method.kind == "exact":
        return values.masked_scatter(~known, sample_mixture(problem.true_conditional, n, generator))
    if method.kind == "masked":
        shape = (n, problem.frames, -1)
        start = torch.randn(values.shape, generator=generator, dtype=torch.float64).view(shape)
        denoise, schedule = _framed(problem.denoise), problem.schedule
        held = values.reshape(shape), known.expand(n, -1).reshape(shape)
        if method.guidance:
            denoise = guided(denoise, schedule, *held, method.guidance)
        if method.blend is not None:
            denoise = blended(denoise, schedule, *held, method.blend)
        steps = resampling_steps(timesteps(schedule.S, method.steps), method.resample)
        loop = inpaint_steps(denoise, start, schedule, *held, steps=steps, generator=generator)
        return final(loop).x_s.flatten(1)
    x = torch.where(
        known, values, truth.mean()
    )  # missing entries start at the mean, as in `reconstruction`
    return there_and_back(problem, x, method.rounds, generator, keep=method.kind == "gibbs")


def _framed(denoise: Denoiser) -> Denoiser:
    """A denoiser of points (N, D) as one of motions (N, T, D / T)."""
    return lambda x, s: denoise(x.flatten(1), s).view_as(x)


@dataclass(frozen=True)
class Errors:
    """How far samples are from the true conditional: 0, 1 and 0 for perfect samples.

    mean    RMS over entries of (mean - true mean) / true standard deviation
    spread  root of the mean ratio of variances
    share   total variation distance between the probabilities of the parts
    """

    mean: float
    spread: float
    share: float


def errors_of(x: Float[Tensor, "N D"], problem: Problem) -> Errors:
    """The errors of samples against the true conditional."""
    truth, compared = problem.true_conditional, problem.compared[~problem.known]
    mean, variance = truth.mean()[compared], truth.covariance().diagonal()[compared]
    made = x[:, problem.compared]
    share = responsibilities(problem.truth, x).mean(0)
    return Errors(
        mean=float(((made.mean(0) - mean).square() / variance).mean().sqrt()),
        spread=float((made.var(0) / variance).mean().sqrt()),
        share=float((share - truth.weights).abs().sum() / 2),
    )


def conditional_errors(
    problem: Problem,
    methods: Iterable[Method] = METHODS,
    *,
    seeds: Iterable[int] = range(5),
    n: int = 200,
) -> Iterator[tuple[Method, int, Errors]]:
    """Every method with every seed, n samples each; yields (method, seed, errors).

    Notebook: 15
    """
    seeds = tuple(seeds)
    for method in methods:
        for seed in seeds:
            x = draw_samples(problem, method, n, torch.Generator().manual_seed(seed))
            yield method, seed, errors_of(x, problem)


def by_method(found: Iterable[tuple[Method, int, Errors]]) -> dict[str, dict[str, list[float]]]:
    """One value per seed, by method and measure: by_method(...)["masked.50"]["mean"].

    Notebook: 15
    """
    table: dict[str, dict[str, list[float]]] = {}
    for method, _, errors in found:
        row = table.setdefault(method.name, {})
        for measure, value in asdict(errors).items():
            row.setdefault(measure, []).append(value)
    return table
