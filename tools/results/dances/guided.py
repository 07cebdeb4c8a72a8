"""The shipped dancer at several weights of guidance: what is gained in beats, and what it costs.

At weight 1 it dances without guidance.
"""

from dataclasses import dataclass, replace

import torch
from jaxtyping import Float

from motiondiff_edu.performers.dancer import Dancer

from ..walks.scores import Measure
from .parts import Stage, as_records, danced

WEIGHTS = (1, 2, 4)


@dataclass(frozen=True, eq=False)
class Guided:
    """A dancer that always dances with one weight of guidance; it is called as a dancer is."""

    dancer: Dancer
    weight: float

    def dance_mel(
        self, mel: Float[torch.Tensor, "B M C"], frames: int, *, generator: torch.Generator
    ) -> Float[torch.Tensor, "B T 21 3"]:
        return self.dancer.dance_mel(mel, frames, generator=generator, guidance=self.weight)


def guided_measures(stage: Stage, dancer: Dancer) -> list[Measure]:
    """All measures of dances of the length of training, for each weight."""
    return [
        replace(measure, name=f"{weight}.{measure.name}")
        for weight in WEIGHTS
        for measure in danced(stage, Guided(dancer, weight)).measures
    ]


def guided_records(stage: Stage, command: str) -> list[dict]:
    """The records `dancer.guided.WEIGHT.*` of the shipped dancer."""
    measures = guided_measures(stage, stage.dancer("dancer"))
    return as_records(stage, "dancer", measures, "dancer.guided.", command)
