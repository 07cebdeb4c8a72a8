"""Ways back that also use the known entries: for `reconstruction.reconstruct_steps(way_back=...)`.

The paper walks back as if nothing were known, and fills the holes from the result. But known joints
constrain the missing ones beside them, and known frames those before and after.
Gain: docs/RESULTS_ALL.md (`mend-both.*`, `mend.*`).
Source: ours; the mask is MoFusion 4.4's, the walk MoDiff III-E's.  Notebook: 15
"""

from typing import Protocol, runtime_checkable

import torch
from jaxtyping import Bool, Float
from torch import Tensor

from ..ddpm import Denoiser, Schedule, draw, final
from ..inbetweening import inpaint_steps
from ..reconstruction import Rollout, plain_way_back
from ..rollout import AnyWalker
from .guidance import blended_guess, guided

WEIGHT, MOVES = 0.6, 5  # of guidance, in masked_way_back
FADE = 10  # frames within which blended_way_back's correction fades where nothing more is known
Frames = Float[Tensor, "B T_h D"]


@runtime_checkable
class DenoisingWalker(AnyWalker, Protocol):
    """A walker with its schedule, and a denoiser that can be differentiated."""

    @property
    def schedule(self) -> Schedule: ...

    def denoiser(self, past: Tensor, control: Tensor) -> Denoiser: ...


def blended_way_back(
    rollout: Rollout,
    ahead: Frames,
    control: Float[Tensor, "B T C"],
    given: Frames,
    known: Bool[Tensor, "B _ _"],
) -> Frames:
    """The paper's way back, corrected by `blended_guess`: it does not jump where a hole ends."""
    back = plain_way_back(rollout, ahead, control, given, known)
    return blended_guess(back, given.to(back), known, FADE)


@torch.no_grad()
def masked_way_back(
    rollout: Rollout,
    ahead: Frames,
    control: Float[Tensor, "B T C"],
    given: Frames,
    known: Bool[Tensor, "B _ _"],
) -> Frames:
    """Sample the past as the window after `ahead`, by masked sampling guided by the known entries.

    The sampling is `inbetweening.inpaint_steps`, in reversed time.
    Raises ValueError for a walker that is no DenoisingWalker, and for one that predicts more or
    fewer poses than it is given.
    Notebook: 15
    """
    walker = rollout.walker
    if not isinstance(walker, DenoisingWalker):
        raise ValueError(f"a {type(walker).__name__} lacks a schedule, or a denoiser")
    config, schedule = walker.config, walker.schedule
    if config.T_p != config.T_h:
        raise ValueError(
            f"this walker predicts {config.T_p} poses from {config.T_h}: its window is not the "
            "past. Use blended_way_back"
        )
    given, ahead = (walker.pose_scaler.transform(x.float()) for x in (given, ahead))
    network = walker.denoiser(ahead, walker.control_scaler.transform(control.float()))
    start = draw(given, rollout.generator)
    loop = inpaint_steps(
        guided(network, schedule, given, known, WEIGHT, MOVES),
        start,
        schedule,
        given,
        known,
        steps=rollout.steps or schedule.S,
        generator=rollout.generator,
    )
    return walker.pose_scaler.inverse(final(loop).x_s)
