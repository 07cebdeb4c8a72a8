"""Lower weights for windows whose past was noised by diffusion dropout.

A future that follows a noised past cannot be predicted well: its error is several times that of a
future after a clean past. So at the paper's last rate, a quarter of the windows makes up most of
the loss, and the network learns the millimetres of a clean past less well. With a weight below 1
these windows count less. The best prediction for each window stays the same; only a network that
is too small or trained too briefly for both is moved towards the clean ones.
Gain: docs/RESULTS.md, *From the paper's walker to ours* (`ladder.ours-both-light.*` beside
`ladder.ours-both.*`): feet slide less; the other intervals contain 0.
Ours; in Algorithm 1 all windows have weight 1.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

import torch
from jaxtyping import Bool, Float, Int
from torch import Tensor

from ..diffusion_dropout import changed_samples
from .loss_terms import Error, Loss

Past = Float[Tensor, "B T_h D"]


@dataclass
class NoisedPastWeight:
    """Wraps diffusion dropout, and lowers the loss weight of the windows whose past it noised.

    Pass both to `modiff.training_loss`:

        light = NoisedPastWeight(dropout, 0.2)
        training_loss(..., dropout=light, loss=light.weighted(loss))
    dropout  makes the noised past, such as `diffusion_dropout.Dropout`
    weight   of the squares of a window with a noised past; 1 changes nothing
    Raises ValueError for a weight below 0, and RuntimeError if the loss is called without the
    dropout of its batch.
    """

    dropout: Callable[[Past, Int[Tensor, "B"], torch.Generator | None], Past]
    weight: float
    noised: Bool[Tensor, "B"] | None = field(default=None, init=False)

    def __post_init__(self):
        if self.weight < 0:
            raise ValueError(f"a weight must not be negative, not {self.weight:g}")

    def __call__(
        self, past: Past, s: Int[Tensor, "B"], generator: torch.Generator | None = None
    ) -> Past:
        noised = self.dropout(past, s, generator)
        self.noised = changed_samples(past, noised)
        return noised

    def weighted(self, loss: Loss) -> Loss:
        """The loss whose squares have `weight` in windows with a noised past."""

        def lighter(error: Error, s: Int[Tensor, "B"]) -> Float[Tensor, ""]:
            if self.noised is None:
                raise RuntimeError(
                    "this loss needs the dropout of the same batch: pass the NoisedPastWeight as "
                    "`dropout`, beside the loss that it weighs"
                )
            factor = torch.where(self.noised, self.weight**0.5, 1.0).to(error)
            self.noised = None  # of this batch alone
            return loss(factor[:, None, None] * error, s)

        return lighter
