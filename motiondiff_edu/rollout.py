"""Autoregressive rollout: predict T_p poses, keep the first few, and repeat.

The control can change at every frame.

A *window sampler* is a callable `sample(past (B, T_h, D), control (B, T_h + T_p, C), generator) ->
(B, T_p, D)` in the network's units. `rollout_steps` repeats it. `generate` does so for a trained
walker on tensors, in metres and m/s; `Walker.walk`, for a Motion in the world.
Source: MoDiff III-C, Alg. 2.  Notebook: 08
"""

import math
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

import torch
from jaxtyping import Float
from torch import Tensor

from .ddpm import Generators

WindowSampler = Callable[[Tensor, Tensor, Generators], Tensor]
Control = Tensor | Callable[[int], Tensor]
# shares of the training's range of control; beyond it by more, `generate` warns or refuses
SLACK, FAR = 0.1, 0.5
COLUMNS = ("forward speed", "speed to the left", "turning rate")  # m/s, m/s, rad/s


@runtime_checkable
class Units(Protocol):
    """Conversion between metres (or m/s) and a network's units; `mean` is on its device."""

    @property
    def mean(self) -> Tensor: ...

    def transform(self, x: Tensor) -> Tensor: ...

    def inverse(self, x: Tensor) -> Tensor: ...


@runtime_checkable
class Sizes(Protocol):
    """Frames given (T_h) and predicted (T_p); widths of a pose (D) and of a row of control (C)."""

    @property
    def T_h(self) -> int: ...

    @property
    def T_p(self) -> int: ...

    @property
    def D(self) -> int: ...

    @property
    def C(self) -> int: ...


@runtime_checkable
class AnyWalker(Protocol):
    """The interface of a walker for `generate`: sizes, units, and a window sampler.

    `performers.walker.Walker` has it. If there is also a `card` with the range of control in
    training, `generate` warns a little beyond that range, and refuses what is far beyond it.
    """

    @property
    def config(self) -> Sizes: ...

    @property
    def pose_scaler(self) -> Units: ...

    @property
    def control_scaler(self) -> Units: ...

    def window_sampler(self, steps: int | None = None) -> WindowSampler: ...


@dataclass(frozen=True, eq=False)
class Frame:
    """One new frame: its index after the past (from 0), its pose, and its predicted window."""

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
    generator: Generators,
    keep: int = 1,
    hold: bool = True,
) -> Iterator[Frame]:
    """Yield `frames` new poses, one by one; each predicted window gives its first `keep` poses.

    control  (B, T, C), where row 0 belongs to past[:, 0] and the last row repeats; or a callable
             t -> (B, C), called when a row is needed, so that it can change on the fly: with `hold`
             once for each row, else again for each window that looks ahead to it
    hold     True: the network sees the control up to the next step, held over the future;
             False (look-ahead): it sees the future control as far as it is known
    Raises ValueError unless 1 <= keep <= T_p.  Source: MoDiff III-C, Alg. 2.  Notebook: 07
    """
    if not 1 <= keep <= T_p:
        raise ValueError(f"keep must be between 1 and T_p = {T_p}, not {keep}")
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
    generator: Generators | None = None,
    steps: int | None = None,
    keep: int = 1,
    hold: bool = True,
) -> Float[Tensor, "*B n D"]:
    """Continue `past` (root-frame poses, metres) under `control` (m/s, m/s, rad/s).

    Returns n = T - T_h new poses in metres, as a tensor.

    Past and control are tensors or arrays of numpy, with or without a batch axis. Rows 0..T_h-1 of
    the control belong to the past. steps=None is DDPM with all S steps, a number is
    DDIM with that many.
    Raises ValueError if past and control do not fit the walker or contain NaN, and for a control
    that leaves the range of the training data by over half its width. Warns where it leaves it by
    over a tenth.
    Source: MoDiff Alg. 2, Fig. 5.  Notebook: 07, 08
    """
    past, control = torch.as_tensor(past), torch.as_tensor(control)
    check_inputs(walker.config, past, control)
    single, T_h = past.dim() == 2, walker.config.T_h
    past, control = (x[None] if single else x for x in (past, control))
    check_range(control, T_h, getattr(walker, "card", {}).get("control_range"), hold=hold)
    generator = generator or torch.Generator().manual_seed(seed)
    past, control = (x.float().to(walker.pose_scaler.mean.device) for x in (past, control))
    poses = walker.pose_scaler.transform(past)
    velocities = walker.control_scaler.transform(control)
    sample, T_p = walker.window_sampler(steps), walker.config.T_p
    frames = control.shape[1] - T_h
    loop = rollout_steps(
        sample, poses, velocities, frames, T_p, generator=generator, keep=keep, hold=hold
    )
    new = walker.pose_scaler.inverse(torch.stack([frame.pose for frame in loop], dim=1))
    return new[0] if single else new


def check_inputs(sizes: Sizes, past: Tensor, control: Tensor) -> None:
    """Raise ValueError unless past and control fit a walker of these sizes and have no NaN."""
    T_h = sizes.T_h
    D, C = sizes.D, sizes.C
    if (
        past.dim() not in (2, 3)
        or past.dim() != control.dim()
        or past.shape[:-2] != control.shape[:-2]
        or (past.shape[-1], control.shape[-1]) != (D, C)
    ):
        raise ValueError(
            f"past {tuple(past.shape)} and control {tuple(control.shape)} do not fit together: the "
            f"walker takes (B, {T_h}, {D}) and (B, T, {C}), or both without B; "
            "flatten positions (T, 21, 3) to (T, 63)"
        )
    if past.shape[-2] != T_h:
        raise ValueError(
            f"the walker continues {T_h} past poses, not {past.shape[-2]}: "
            f"pass past[..., -{T_h}:, :]"
        )
    if control.shape[-2] <= T_h:
        raise ValueError(
            f"control has {control.shape[-2]} rows and {T_h} of them belong to the past; "
            "there is none for the future"
        )
    if not (torch.isfinite(past).all() and torch.isfinite(control).all()):
        raise ValueError("past or control contains NaN or infinity; fill the holes first")


def check_range(
    control: Float[Tensor, "B T C"],
    T_h: int,
    seen: dict | None,
    size: float = 1.0,
    hold: bool = True,
) -> None:
    """Warn about speeds beyond the control of the training clips by over a tenth of its range.

    Raises ValueError beyond the range by over half its width. Row T_h - 1 leads to the first new
    frame; the rows before it belong to the past. The last row leads beyond the end; a network sees
    it only if it looks ahead (not `hold`). Messages have the speeds of a figure that is `size`
    times as large.
    """
    if not seen:
        return
    low, high = (torch.tensor(seen[end], device=control.device) for end in ("low", "high"))
    ahead = control[:, T_h - 1 : -1] if hold else control[:, T_h - 1 :]
    far = (low - ahead).maximum(ahead - high)

    share = FAR if (far > FAR * (high - low)).any() else SLACK
    beyond, found = far > share * (high - low), []
    for column in beyond.any(1).any(0).nonzero().flatten().tolist():
        batch, row = beyond[..., column].nonzero()[0].tolist()
        name = COLUMNS[column] if column < len(COLUMNS) <= len(low) else f"column {column}"
        unit = size if name in COLUMNS[:2] else 1.0
        asks, least, most = (
            unit * float(x) for x in (ahead[batch, row, column], low[column], high[column])
        )
        found.append(
            f"a {name} of {asks:.3g} in frame {row} of the future "
            f"(training: {least:.3g} to {most:.3g})"
        )
    words = "; ".join(found)
    if words and share == FAR:
        raise ValueError(
            "the control leaves the range that this walker was trained on by over half its width: "
            f"{words}. Speeds are in m/s, turning is in rad/s; 90 degrees a second are "
            f"{math.pi / 2:.2f} rad/s"
        )
    if words:
        warnings.warn(
            f"the control asks for more than this walker was trained on, and it will not follow "
            f"well: {words}",
            stacklevel=3,
        )
