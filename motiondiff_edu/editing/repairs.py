"""One past, repaired several times: different random draws fill the same holes differently.

The mean of the repairs is closest to the truth but hardly moves; each single repair is a motion.
The repair bench shows both.
Source: MoDiff III-E; drawing several is ours.  Notebook: 10
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Bool, Float
from torch import Tensor

from ..metrics import keyframes as measures
from ..metrics.bodies import bone_rmse
from ..motion.cleanup import Body, clean_bones
from ..reconstruction import Rollout, Stop, reconstruct_steps
from ..rollout import AnyWalker


@dataclass(frozen=True, eq=False)
class Reconstructions:
    """`n` repairs of each past after `round` rounds (root frame, metres).

    `change` is how far the last round moved them (m).
    """

    samples: Float[np.ndarray, "n *B T_h J 3"]
    known: Bool[np.ndarray, "*B T_h J"]
    round: int
    change: float

    @property
    def mean(self) -> Float[np.ndarray, "*B T_h J 3"]:
        """The mean of the repairs; the known joints are unchanged."""
        return np.where(self.known[..., None], self.samples[0], self.samples.mean(0))

    def errors(self, truth: Float[np.ndarray, "*B T_h J 3"]) -> dict[str, float]:
        """Distance from the truth, spread, and bone error, in cm.

        Distance and bone error are given for one repair and for the mean.
        """
        found = {
            "one repair": measures.missing_error(self.samples, truth, self.known),
            "their mean": measures.missing_error(self.mean, truth, self.known),
            "bones of one": bone_rmse(self.samples),
            "bones of the mean": bone_rmse(self.mean),
        }
        return found | (
            {"spread": measures.missing_spread(self.samples, self.known)}
            if len(self.samples) > 1
            else {}
        )


def sample_reconstructions(
    walker: AnyWalker,
    past: Float[np.ndarray, "*B T_h J 3"],
    known: Bool[np.ndarray, "*_ _ _"],
    control: Float[np.ndarray, "*B T 3"],
    n: int = 10,
    *,
    generator: torch.Generator,
    rounds: int = 5,
    steps: int | None = 10,
) -> Iterator[Reconstructions]:
    """Repair each past `n` times; yield the repairs after each round there and back.

    Pasts are root-frame positions (metres), with NaN in the holes and with or without a batch axis.
    `control` has T_h rows for the past and T_h rows after it (m/s, m/s, rad/s).
    Raises ValueError when nothing is missing, nothing is known, or shapes do not fit.  Notebook: 10
    """
    if known.shape != past.shape[:-1]:
        raise ValueError(
            f"known is {known.shape}; it must have an entry for each joint of "
            f"each frame: {past.shape[:-1]}"
        )
    if known.all():
        raise ValueError("nothing is missing, so there is nothing to repair")
    if not known.any():
        raise ValueError("nothing is known, so the repair has no information")
    T_h, J = known.shape[-2:]
    mask = torch.from_numpy(known.reshape(-1, T_h, J)).repeat_interleave(3, dim=-1)
    rows = (np.reshape(past, (-1, T_h, 3 * J)), np.reshape(control, (-1, control.shape[-2], 3)))
    holes, steer = (torch.from_numpy(np.asarray(row, np.float32)) for row in rows)
    batch = [row.repeat(n, 1, 1) for row in (holes, mask, steer)]
    for done in reconstruct_steps(Rollout(walker, generator, steps), *batch, stop=Stop(rounds)):
        samples = done.past.double().numpy().reshape(n, *past.shape)
        yield Reconstructions(
            np.where(known[..., None], past, samples), known, done.number, float(done.change.mean())
        )


def with_bones(
    past: Float[Tensor, "B T_h D"], known: Bool[Tensor, "B T_h D"], walked: Float[Tensor, "B T D"]
) -> Float[Tensor, "B T_h D"]:
    """The past, with its missing joints moved until the bones have their right lengths.

    For `reconstruct_steps(correct=with_bones)`. Otherwise the bone between a generated and a known
    joint changes its length.
    Source: ours.
    """
    joints, ahead = (x.double().cpu().unflatten(-1, (-1, 3)).numpy() for x in (past, walked))
    here = known.cpu().unflatten(-1, (-1, 3)).all(-1).numpy()
    return torch.from_numpy(clean_bones(joints, here, Body.of(ahead))).flatten(-2).to(past)
