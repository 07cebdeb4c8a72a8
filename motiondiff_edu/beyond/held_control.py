"""Held control: in training, some windows do not know what comes.

With a joystick the control after the step about to be taken is not known, so a rollout holds it.
A network that was always trained with the true future control would trust a held one as well. So in
a share of the windows the control is held over the future, as in a rollout.
Beside it: docs/RESULTS.md, *From the paper's walker to ours* (`walker-departures.never-held.*`).
Ours; MoDiff takes the control up to t + T_p as known.  Notebook: 07
"""

import torch
from jaxtyping import Float
from torch import Tensor


def held_control(
    control: Float[Tensor, "B T C"], T_h: int, share: float, generator: torch.Generator
) -> Float[Tensor, "B T C"]:
    """The control of a batch, of which a `share` holds row T_h - 1 over the future.

    Notebook: 07
    """
    hold = torch.rand(len(control), generator=generator) < share
    held = control[:, T_h - 1 : T_h].expand_as(control[:, T_h:])
    future = held.where(hold[:, None, None].to(held.device), control[:, T_h:])
    return torch.cat([control[:, :T_h], future], dim=1)
