"""Autoregression: predict T_p poses, keep the first few, move on.

The control may change at every frame.

A *window sampler* is a callable `sample(past (B, T_h, D), control (B, T_h + T_p, C), generator) ->
(B, T_p, D)` in the network's units. `rollout_steps` repeats it; `generate` does so for a trained
walker, in metres and m/s.
Source: MoDiff III-C, Alg. 2.  Notebook: 08
"""

import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

import torch
from jaxtyping import Float
from torch import Tensor

WindowSampler = Callable[[Tensor, Tensor, torch.Generator], Tensor]
Control = Tensor | Callable[[int], Tensor]


@runtime_checkable
class Units(Protocol):
    """Between metres (or m/s) and a network's units; `mean` lies where the network does."""

    mean: Tensor

    def transform(self, x: Tensor) -> Tensor: ...

    def inverse(self, x: Tensor) -> Tensor: ...


@runtime_checkable
class Sizes(Protocol):
    """Frames given and predicted; numbers in a pose and in a row of the control."""

    T_h: int
    T_p: int
    D: int
    C: int


@runtime_checkable
class AnyWalker(Protocol):
    """What `generate` needs of a walker: sizes, units, and a window sampler.

    `performers.walker.Walker` is one; whatever has these four can be walked with. A `card` that
    says which control was seen in training is used where there is one.
    """

    @property
    def config(self) -> Sizes: ...

    pose_scaler: Units
    control_scaler: Units

    def window_sampler(self, steps: int | None = None) -> WindowSampler: ...


@dataclass(frozen=True, eq=False)
class Frame:
    """One new frame.

    Its number after the past (from 0), its pose, and the whole window it was taken from.
    """

    t: int
    pose: Float[Tensor, "B D"]
    window: Float[Tensor, "B T_p D"]


def rollout_steps(
    sample: WindowSampler,
    past: Float[Tensor, "B T_h D"],
    control: Control,
    frames: int,
    T_p: int,
    *,
    generator: torch.Generator,
    keep: int = 1,
    hold: bool = True,
) -> Iterator[Frame]:
    """Yield `frames` new poses, one by one; of every predicted window the first `keep` are kept.

    `control` is (B, T, C), row 0 beside past[:, 0] and the last repeated past its end; or a
    callable t -> (B, C) that is asked for a row when it is walked under, once: it can change on the
    fly, and the past is not rewritten. hold=True: the network sees the control up to the step it is
    about to take, held over the future; hold=False (look-ahead): it sees what comes, as far as is
    known now.
    Raises ValueError unless 1 <= keep <= T_p.  Source: MoDiff III-C, Alg. 2.  Notebook: 07
    """
    if not 1 <= keep <= T_p:
        raise ValueError(f"keep must lie between 1 and T_p = {T_p}, got {keep}")
    T_h, rows = past.shape[1], []
    ask = control if callable(control) else lambda t: control[:, min(t, control.shape[1] - 1)]
    for t in range(0, frames, keep):
        rows += [ask(i) for i in range(len(rows), t + T_h)]
        ahead = rows[-1:] * T_p if hold else [ask(i) for i in range(t + T_h, t + T_h + T_p)]
        window = sample(past, torch.stack(rows[t : t + T_h] + ahead, dim=1), generator)
        for k in range(min(keep, frames - t)):
            yield Frame(t + k, window[:, k], window)
        past = torch.cat([past, window[:, :keep]], dim=1)[:, -T_h:]


def generate(
    walker: AnyWalker,
    past: Float[Any, "*B T_h D"],
    control: Float[Any, "*B T C"],
    *,
    seed: int = 0,
    generator: torch.Generator | None = None,
    steps: int | None = None,
    keep: int = 1,
    hold: bool = True,
) -> Float[Tensor, "*B n D"]:
    """Continue `past` (root-frame poses, metres) under `control` (m/s, m/s, rad/s).

    Returns n = T - T_h new poses, metres.

    Rows 0..T_h-1 of the control belong to the past. steps=None is DDPM with all S steps, a number
    is DDIM with so many. A past and control without a batch axis give poses without one. Arrays of
    numpy are taken too; a tensor comes back.
    Raises ValueError when past and control do not fit the walker or hold NaN; warns where the
    control asks for more than the walker saw in training.
    Source: MoDiff Alg. 2, Fig. 5.  Notebook: 07, 08
    """
    past, control = torch.as_tensor(past), torch.as_tensor(control)
    single = past.dim() == 2
    past, control = (x[None] if single else x for x in (past, control))
    T_h, frames = walker.config.T_h, control.shape[1] - past.shape[1]
    D, C = walker.config.D, walker.config.C
    if (
        past.dim() != 3
        or past.shape[0] != control.shape[0]
        or (past.shape[2], control.shape[-1]) != (D, C)
    ):
        raise ValueError(
            f"past {tuple(past.shape)} and control {tuple(control.shape)} do not go together: the "
            f"walker takes (B, {T_h}, {D}) and (B, T, {C}), or both without B; "
            "flatten positions (T, 21, 3) to (T, 63)"
        )
    if past.shape[1] != T_h:
        raise ValueError(
            f"the walker continues {T_h} past poses, got {past.shape[1]}: "
            f"pass past[..., -{T_h}:, :]"
        )
    if frames < 1:
        raise ValueError(
            f"control has {control.shape[1]} rows, {T_h} of them beside the past: none is left"
        )
    if not (torch.isfinite(past).all() and torch.isfinite(control).all()):
        raise ValueError("past or control holds NaN or infinity; fill the holes first")
    _warn_beyond(control, getattr(walker, "card", {}).get("control_range"))
    generator = generator or torch.Generator().manual_seed(seed)
    past, control = (x.float().to(walker.pose_scaler.mean.device) for x in (past, control))
    poses = walker.pose_scaler.transform(past)
    velocities = walker.control_scaler.transform(control)
    sample, T_p = walker.window_sampler(steps), walker.config.T_p
    loop = rollout_steps(
        sample, poses, velocities, frames, T_p, generator=generator, keep=keep, hold=hold
    )
    new = walker.pose_scaler.inverse(torch.stack([frame.pose for frame in loop], dim=1))
    return new[0] if single else new


def _warn_beyond(control: Float[Tensor, "B T C"], seen: dict | None) -> None:
    """Say which row asks for what no training clip asked for, by more than a tenth of the range."""
    if not seen:
        return
    low, high = torch.tensor(seen["low"]), torch.tensor(seen["high"])
    slack = 0.1 * (high - low)
    beyond = ((control < low - slack) | (control > high + slack)).nonzero()
    if len(beyond):
        batch, row, column = beyond[0].tolist()
        name = (
            ("forward speed", "speed to the left", "turning rate")[column]
            if len(low) == 3
            else f"column {column}"
        )
        warnings.warn(
            f"row {row} of the control asks for {control[batch, row, column]:.3g} ({name}); this "
            f"walker learnt from {low[column]:.3g} to {high[column]:.3g}, "
            "and will do something else",
            stacklevel=3,
        )
