"""Reconstruction: continue the motion, reverse it in time, continue it again, and fill the holes.

    past with holes -> T_h new frames -> both reversed in time
                    -> T_h new frames: the past, as it may have been

The holes are filled from it. This repeats until the filled entries stop changing. No extra training
is needed.
Where we differ: "reverse the order" is not enough for the control: velocities change their sign,
and since control[t] leads from frame t to t + 1 they move by one frame.
Source: MoDiff III-E.  Notebook: 10
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import torch
from jaxtyping import Float, Shaped
from torch import Tensor

from .ddpm import final
from .rollout import AnyWalker, generate


@dataclass(frozen=True, eq=False)
class Rollout:
    """A walker, and how it is sampled on both ways.

    `steps`: as in `rollout.generate`. `keep`: poses kept of each window, by default all T_p.
    keep=1 is the paper's rollout: T_p times the cost, and larger errors.
    """

    walker: AnyWalker
    generator: torch.Generator
    steps: int | None = 10
    keep: int | None = None

    def continued(
        self, past: Float[Tensor, "B T_h D"], control: Float[Tensor, "B T 3"]
    ) -> Float[Tensor, "B n D"]:
        """The n = T - T_h poses after `past` (metres); the walker sees the control ahead."""
        keep = self.keep or self.walker.config.T_p
        return generate(
            self.walker,
            past,
            control,
            generator=self.generator,
            steps=self.steps,
            keep=keep,
            hold=False,
        )


@dataclass(frozen=True)
class Stop:
    """The rounds end when no sample's holes change by more than `tolerance`, or after `rounds`.

    Sampling is random, so the change can stay above the tolerance in every round.
    """

    rounds: int = 5
    tolerance: float = 1e-3  # metres, RMS over the holes of a sample


@dataclass(frozen=True, eq=False)
class Round:
    """One round, there and back.

    It has the past after it, and how far the filled entries moved (metres, RMS per sample).
    """

    number: int
    past: Float[Tensor, "B T_h D"]
    change: Float[Tensor, "B"]


def reverse_control(control: Float[Tensor, "*B T 3"]) -> Float[Tensor, "*B T 3"]:
    """The control of the same walk played backwards: -control[T - 2 - t]; the last row repeats.

    Raises ValueError for a single row.  Source: MoDiff III-E, mended (sign and shift).
    Notebook: 10
    """
    if control.shape[-2] < 2:
        raise ValueError(
            f"the control {tuple(control.shape)} has one row in time; a way back takes 2 at least"
        )
    back = -control[..., :-1, :].flip(-2)
    return torch.cat([back, back[..., -1:, :]], dim=-2)


# (rollout, ahead, control, given, known) -> the frames before `ahead`; all in reversed time
WayBack = Callable[[Rollout, Tensor, Tensor, Tensor, Tensor], Tensor]
# (past, known, ahead) -> the past, corrected; all in the order of time
Correction = Callable[[Tensor, Tensor, Tensor], Tensor]


def plain_way_back(rollout: Rollout, ahead, control, given, known) -> Float[Tensor, "B T_h D"]:
    """The paper's way back: it uses only the new frames `ahead`, not the known entries.

    `beyond.back_with_known` has others.  Source: MoDiff III-E.
    """
    return rollout.continued(ahead, control)


def reconstruct_steps(
    rollout: Rollout,
    past: Float[Any, "B _ _"],
    known: Shaped[Any, "_ _ _"],
    control: Float[Any, "_ _ _"],
    *,
    way_back: WayBack = plain_way_back,
    guess: Float[Tensor, "B T_h D"] | None = None,
    correct: Correction | None = None,
    stop: Stop = Stop(),
) -> Iterator[Round]:
    """Fill the holes of `past` (metres), round by round, until `stop`.

    `control`: T_h rows for the past, then T_h rows for its continuation.
    `guess`: what the holes hold at first (metres), by default the mean pose.
    `way_back`: the paper's, or one of `beyond.back_with_known`, which use what is known.
    `correct`: applied to the filled past after each round, as `editing.repairs.with_bones`.
    Raises ValueError if shapes do not fit the walker, a sample has no known entry, or
    `stop.rounds` is below 1.  Source: MoDiff III-E, Fig. 6; the stop rule is ours.
    """
    past, known, control = map(torch.as_tensor, (past, known, control))
    _check(rollout.walker, past, known, control)
    home, there = past.device, rollout.walker.pose_scaler.mean.device
    past, known, control = (x.to(there) for x in (past, known, control))
    if stop.rounds < 1:
        raise ValueError(f"rounds = {stop.rounds}: give 1 at least, to fill the holes")
    missing, mean = ~known, rollout.walker.pose_scaler.mean.to(past).expand_as(past)
    filled = torch.where(known, past, mean if guess is None else guess.to(past))
    reversed_control = reverse_control(control)
    for number in range(1, stop.rounds + 1):
        ahead = rollout.continued(filled, control)
        turned = (ahead.flip(1), reversed_control, past.flip(1), known.flip(1))
        back = way_back(rollout, *turned).flip(1).to(past)
        before, filled = filled, torch.where(known, past, back)
        filled = correct(filled, known, ahead) if correct else filled
        moved = (filled - before).square().flatten(1).sum(1)
        change = (moved / missing.flatten(1).sum(1).clamp(min=1)).sqrt()
        yield Round(number, filled.to(home), change.to(home))
        if not (change > stop.tolerance).any():
            return


def reconstruct(
    rollout: Rollout,
    past: Float[Any, "B _ _"],
    known: Shaped[Any, "_ _ _"],
    control: Float[Any, "_ _ _"],
    *,
    way_back: WayBack = plain_way_back,
    guess: Float[Tensor, "B T_h D"] | None = None,
    correct: Correction | None = None,
    stop: Stop = Stop(),
) -> Float[Tensor, "B T_h D"]:
    """The past after the last of `reconstruct_steps`: known entries stay as given, bit by bit.
    Notebook: 10"""
    loop = reconstruct_steps(
        rollout, past, known, control, way_back=way_back, guess=guess, correct=correct, stop=stop
    )
    return final(loop).past


def _check(walker: AnyWalker, past: Tensor, known: Tensor, control: Tensor) -> None:
    T_h, D = walker.config.T_h, walker.config.D
    if past.shape[1:] != (T_h, D):
        raise ValueError(
            f"past is {tuple(past.shape)}; the walker takes (B, {T_h}, {D}): flatten (21, 3) to 63"
        )
    if known.shape != past.shape or known.dtype != torch.bool:
        raise ValueError(
            f"known is {known.dtype} {tuple(known.shape)}; "
            f"give bool, {tuple(past.shape)} as past is"
        )
    holes = (known & ~past.isfinite()).nonzero().tolist()
    if holes:
        raise ValueError(
            f"past{holes[0]} is marked as known, but is NaN or infinite: "
            f"set known{holes[0]} to False ({len(holes)} such entries)"
        )
    if control.shape[:2] != (len(past), 2 * T_h):
        raise ValueError(
            f"control is {tuple(control.shape)}; give ({len(past)}, {2 * T_h}, 3): past + way there"
        )
    nothing = (~known.flatten(1).any(1)).nonzero()
    if len(nothing):
        sample = int(nothing[0])
        raise ValueError(
            f"sample {sample} has no known entry: mark at least one True in known[{sample}]"
        )
