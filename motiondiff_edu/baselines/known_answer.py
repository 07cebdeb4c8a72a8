"""How far is each way of filling in from the true conditional?

Judged where that is known: on Gaussian mixtures.

    wanted: p(unknown | known) of a mixture (`exact.conditional`)
    asked:  the exact denoiser, so the method alone errs
Ways: masked sampling (MoFusion 4.4), with and without resampling, in few steps or many;
there-and-back (MoDiff III-E), which draws the future from the past and the past from the future;
the same with what is known kept in view, which is Gibbs sampling; and draws from the wanted itself,
whose errors are those of counting.
Source: MoFusion 4.4; MoDiff III-E; the comparison is ours.  Notebook: 15
"""

from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from functools import cached_property

import torch
from jaxtyping import Bool, Float
from torch import Tensor

from ..beyond.guidance import blended, guided
from ..ddpm import Denoiser, Schedule, timesteps
from ..exact import Mixture, conditional, mixture, sample_mixture
from ..inbetweening import inpaint_steps, resampled
from .mixture_fit import responsibilities


@dataclass(frozen=True, eq=False)
class Question:
    """A mixture, its exact denoiser, and some of its entries given.

    `past` is what there-and-back starts from.

    Only unknown entries of the past are judged where a past is named, so that all ways answer the
    same question.
    """

    truth: Mixture
    denoise: Denoiser
    schedule: Schedule
    values: Float[Tensor, "D"]
    known: Bool[Tensor, "D"]
    past: Bool[Tensor, "D"] | None = None
    frames: int = 1  # D is so many frames, one after the other: what `blend` goes by

    @cached_property
    def wanted(self) -> Mixture:
        """The true conditional of all unknown entries."""
        return conditional(self.truth, self.values, self.known)

    @property
    def judged(self) -> Bool[Tensor, "D"]:
        """The entries in which ways are compared."""
        return ~self.known if self.past is None else self.past & ~self.known


@dataclass(frozen=True)
class Way:
    """A way to fill in.

    "exact", "masked" (with what `inpaint_steps` takes), "there-and-back" or "gibbs" (`rounds`).
    """

    kind: str
    steps: int = 50
    resample: int = 1
    rounds: int = 20
    blend: int | None = None
    guidance: float = 0.0

    def __post_init__(self):
        """Raises ValueError for a kind that is none."""
        if self.kind not in ("exact", "masked", "there-and-back", "gibbs"):
            raise ValueError(
                f"the ways are exact, masked, there-and-back and gibbs, not {self.kind!r}"
            )

    @property
    def name(self) -> str:
        """As `masked.50.x5`: fifty steps, each made five times."""
        turns = ("" if self.resample == 1 else f".x{self.resample}") + (
            ".blended" if self.blend is not None else ""
        )
        turns += ".guided" if self.guidance else ""
        ends = {"exact": "", "masked": f".{self.steps}{turns}"}
        return self.kind + ends.get(self.kind, f".{self.rounds}")


WAYS = (
    Way("exact"),
    *(Way("masked", steps) for steps in (5, 10, 50, 100)),
    *(Way("masked", 50, resample) for resample in (2, 5, 10)),
    Way("masked", 50, blend=3),
    Way("masked", 50, guidance=1.0),
)
ROUNDS = (
    Way("there-and-back", rounds=1),
    Way("there-and-back", rounds=20),
    Way("gibbs", rounds=20),
)


class Rest:
    """Draws from p(the rest | these entries) of a mixture, for many values of these entries at
    once."""

    def __init__(self, given: Mixture, known: Bool[Tensor, "D"]):
        covariances = torch.einsum("kia,ka,kja->kij", given.axes, given.variances, given.axes)
        inside, across = covariances[:, known][:, :, known], covariances[:, ~known][:, :, known]
        self.given, self.known = given, known
        self.seen = mixture(given.weights, given.means[:, known], inside)
        self.gain = torch.linalg.solve(inside, across.mT).mT
        left = covariances[:, ~known][:, :, ~known] - self.gain @ across.mT
        variances, axes = torch.linalg.eigh((left + left.mT) / 2)
        self.root = axes * variances.clamp(min=0).sqrt()[:, None]

    def draw(self, x: Float[Tensor, "N D"], generator: torch.Generator) -> Float[Tensor, "N D"]:
        """x with the rest drawn anew.

        First the part that its known entries speak for, then a point of it.
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
    question: Question,
    x: Float[Tensor, "N D"],
    rounds: int,
    generator: torch.Generator,
    keep: bool = False,
) -> Float[Tensor, "N D"]:
    """Draw the future given the past, then the past given the future, `rounds` times.

    The holes are filled from each new past.

    What is known of the future is given, too. As in III-E the way back does not look at what is
    known of the past: it reaches the holes through the future only. `keep`: it does look, which
    makes this Gibbs sampling, with the true conditional for its end.
    Raises ValueError for a question that names no past.  Source: MoDiff III-E.
    """
    if question.past is None:
        raise ValueError("there-and-back needs a past to start from: name it in the question")
    known, past = question.known, question.past
    ahead = Rest(question.truth, past | known)
    back = Rest(question.truth, (~past | known) if keep else ~past)
    for _ in range(rounds):
        x = ahead.draw(x, generator)
        x = torch.where(known, x, back.draw(x, generator))
    return x


def answers(
    question: Question, way: Way, n: int, generator: torch.Generator
) -> Float[Tensor, "n D"]:
    """n samples by one way: the known entries as they are, the others filled in.

    Notebook: 15
    """
    truth, known = question.truth, question.known
    values = question.values.double().where(known, 0.0).expand(n, -1)
    if way.kind == "exact":
        return values.masked_scatter(~known, sample_mixture(question.wanted, n, generator))
    if way.kind == "masked":
        shape = (n, question.frames, -1)
        start = torch.randn(values.shape, generator=generator, dtype=torch.float64).view(shape)
        denoise, schedule = _framed(question.denoise), question.schedule
        held = values.reshape(shape), known.expand(n, -1).reshape(shape)
        if way.guidance:
            denoise = guided(denoise, schedule, *held, way.guidance)
        if way.blend is not None:
            denoise = blended(denoise, schedule, *held, way.blend)
        steps = resampled(timesteps(schedule.S, way.steps), way.resample)
        loop = inpaint_steps(denoise, start, schedule, *held, steps=steps, generator=generator)
        *_, last = loop
        return last.x_s.flatten(1)
    x = torch.where(
        known, values, truth.mean()
    )  # what is missing is the mean at first, as in `reconstruction`
    return there_and_back(question, x, way.rounds, generator, keep=way.kind == "gibbs")


def _framed(denoise: Denoiser) -> Denoiser:
    """The same for motions (N, T, D / T) as for points (N, D)."""
    return lambda x, s: denoise(x.flatten(1), s).view_as(x)


@dataclass(frozen=True)
class Errors:
    """How far samples are from the wanted: 0, 1 and 0 for whoever draws from it.

    mean: root mean square over entries of (mean - wanted mean) / wanted deviation. spread: root of
    the mean ratio of variances. share: largest possible difference in probability (total variation)
    between shares of the parts.
    """

    mean: float
    spread: float
    share: float


def errors_of(x: Float[Tensor, "N D"], question: Question) -> Errors:
    """Samples against the true conditional."""
    wanted, judged = question.wanted, question.judged[~question.known]
    mean, variance = wanted.mean()[judged], wanted.covariance().diagonal()[judged]
    made = x[:, question.judged]
    share = responsibilities(question.truth, x).mean(0)
    return Errors(
        mean=float(((made.mean(0) - mean).square() / variance).mean().sqrt()),
        spread=float((made.var(0) / variance).mean().sqrt()),
        share=float((share - wanted.weights).abs().sum() / 2),
    )


def conditional_errors(
    question: Question, ways: Iterable[Way] = WAYS, *, seeds: Iterable[int] = range(5), n: int = 200
) -> Iterator[tuple[Way, int, Errors]]:
    """Every way with every seed, n samples each: (way, seed, errors), as soon as each is known.
    Notebook: 15"""
    seeds = tuple(seeds)
    for way in ways:
        for seed in seeds:
            x = answers(question, way, n, torch.Generator().manual_seed(seed))
            yield way, seed, errors_of(x, question)


def gathered(found: Iterable[tuple[Way, int, Errors]]) -> dict[str, dict[str, list[float]]]:
    """By the ways' names and by figure, one number for each seed:
    gathered(...)["masked.50"]["mean"].   Notebook: 15"""
    table: dict[str, dict[str, list[float]]] = {}
    for way, _, errors in found:
        row = table.setdefault(way.name, {})
        for figure, value in asdict(errors).items():
            row.setdefault(figure, []).append(value)
    return table
