"""A guess drawn through what is given: `inbetweening.inpaint_steps(blend=partial(blended,
fade=10))`.

Source: ours; in motion graphs the same is done to splice clips.  Notebook: 15
"""

import torch
from jaxtyping import Bool, Float
from torch import Tensor

Fade = int | Float[Tensor, "D"]  # frames


def blended(
    x0_hat: Float[Tensor, "B T D"],
    given: Float[Tensor, "B T D"],
    known: Bool[Tensor, "B T D"],
    fade: Fade,
) -> Float[Tensor, "B T D"]:
    """x0_hat drawn through the given entries: what is wrong there is carried over to the frames
    between them.

    Between two known frames the correction goes evenly from the one's to the other's; before the
    first and after the last it fades to nothing within `fade` frames (one number, or one for each
    column; infinity: it stays). Ours: a network's guess and the given need not agree, and else the
    difference is a jump where they meet.
    """
    T = x0_hat.shape[1]
    frames = torch.arange(T, device=x0_hat.device).view(1, T, 1).expand(known.shape)
    before = (
        torch.where(known, frames, -1).cummax(1).values
    )  # the known frame behind each frame, -1 for none
    after = (
        torch.where(known, frames, T).flip(1).cummin(1).values.flip(1)
    )  # the one ahead, T for none
    wrong = (given - x0_hat).where(known, 0.0)
    behind = wrong.gather(1, before.clamp(min=0))
    ahead = wrong.gather(1, after.clamp(max=T - 1))
    share = (frames - before) / (after - before).clamp(min=1)
    alone = (1 - torch.where(before < 0, after - frames, frames - before) / (fade + 1)).clamp(min=0)
    behind = behind * torch.where(after < T, 1 - share, alone).where(
        before >= 0, torch.zeros_like(share)
    )
    ahead = ahead * torch.where(before >= 0, share, alone).where(after < T, torch.zeros_like(share))
    return torch.where(known, given, x0_hat + behind + ahead)
