"""There and back: how what is missing in the past is found.

By walking on, turning round, and walking back.

    past with holes -> T_h new frames -> both reversed in time
                    -> T_h new frames: the past, as it may have been

The holes are filled from it, and again, until filling changes nothing. Nothing is trained for it.
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

from .rollout import AnyWalker, generate


@dataclass(frozen=True, eq=False)
class Round:
    """One time there and back.

    The past as it is now, and how far the filled entries moved (metres, RMS per sample).
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


# (walker, ahead, control, given, known, generator=, steps=) -> the frames before `ahead`; all
# turned round in time
WayBack = Callable[..., Tensor]


def walked_back(
    walker: AnyWalker, ahead, control, given, known, **options
) -> Float[Tensor, "B T_h D"]:
    """The paper's: from what was walked ahead, no more (others: `beyond.back_with_known`).
    Source: MoDiff III-E."""
    return generate(walker, ahead, control, hold=False, **options)


def repair_steps(
    walker: AnyWalker,
    past: Float[Any, "B _ _"],
    known: Shaped[Any, "_ _ _"],
    control: Float[Any, "_ _ _"],
    *,
    way_back: WayBack = walked_back,
    guess: Float[Tensor, "B T_h D"] | None = None,
    rounds: int = 5,
    tolerance: float = 1e-3,
    generator: torch.Generator,
    steps: int | None = 10,
    keep: int | None = None,
    correct: Callable[[Tensor, Tensor, Tensor], Tensor] | None = None,
) -> Iterator[Round]:
    """Fill the holes of `past` (metres), round by round.

    Rounds end when the entries move by less than `tolerance` metres (RMS).

    `control` has T_h rows beside the past and T_h for the way there. Holes are the mean pose at
    first (zero once standardised), or `guess` (metres), from a regression, say. Stops after
    `rounds` at the latest: a sampler's own spread may be above the tolerance. `way_back`: the
    paper's, or one of `beyond.back_with_known`, which heed what is known. Of each window `keep`
    poses are kept, by default all T_p; keep=1 is the paper's rollout (ten times dearer, and farther
    off). `settle(past, known, ahead)` mends the filled past after each round:
    `editing.repairs.with_bones`, for one.
    Raises ValueError for what does not fit.  Source: MoDiff III-E, Fig. 6; the stop rule is ours.
    """
    past, known, control = map(torch.as_tensor, (past, known, control))
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
    if control.shape[:2] != (len(past), 2 * T_h):
        raise ValueError(
            f"control is {tuple(control.shape)}; give ({len(past)}, {2 * T_h}, 3): past + way there"
        )
    if not known.flatten(1).any(1).all():
        raise ValueError(
            f"of sample {int((~known.flatten(1).any(1)).nonzero()[0])} nothing is known at all"
        )
    if rounds < 1:
        raise ValueError(f"rounds = {rounds}: give 1 at least, to fill the holes")
    missing, mean = ~known, walker.pose_scaler.mean.to(past).expand_as(past)
    filled = torch.where(known, past, mean if guess is None else guess.to(past))
    options = {"generator": generator, "steps": steps, "keep": keep or walker.config.T_p}
    for number in range(1, rounds + 1):
        ahead = generate(walker, filled, control, hold=False, **options)
        turned = [x.flip(1) for x in (ahead, past, known)]
        back = (
            way_back(walker, turned[0], reverse_control(control), *turned[1:], **options)
            .flip(1)
            .to(past)
        )
        before, filled = filled, torch.where(known, past, back)
        filled = correct(filled, known, ahead) if correct else filled
        moved = (filled - before).square().flatten(1).sum(1)
        change = (moved / missing.flatten(1).sum(1).clamp(min=1)).sqrt()
        yield Round(number, filled, change)
        if not (change > tolerance).any():
            return


def repair(walker: AnyWalker, past, known, control, **options) -> Float[Tensor, "B T_h D"]:
    """The last of `repair_steps`: known entries come back bit by bit as they were given.
    Notebook: 10"""
    return list(repair_steps(walker, past, known, control, **options))[-1].past
