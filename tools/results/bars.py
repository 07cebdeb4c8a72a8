"""The goals that the figures are held against, by the names of their records."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Bar:
    """A figure and the range it should lie in; an open side is None."""

    name: str
    at_least: float | None = None
    at_most: float | None = None

    @property
    def text(self) -> str:
        if None not in (self.at_least, self.at_most):
            return f"{self.at_least:g} to {self.at_most:g}"
        return f"at least {self.at_least:g}" if self.at_most is None else f"at most {self.at_most:g}"

    def met(self, value: float) -> bool:
        return (self.at_least is None or value >= self.at_least) and (self.at_most is None or value <= self.at_most)


BARS = (
    Bar("walker.bone_rmse_cm", at_most=0.3),
    Bar("walker.adherence_excess_mps", at_most=0.03),
    Bar("walker.adherence_shuffled_over_own", at_least=5),
    Bar("walker.drift_ratio", at_most=1.2),
    Bar("walker.skating_over_data", at_most=1.5),
    Bar("walker.diversity_over_data", at_least=0.5, at_most=1.5),
    Bar("bench.modiff_frame_paper_x", at_least=6),
    Bar("bench.modiff_frame_small_x", at_least=3.3),
    Bar("bench.sampler_over_diffusers", at_most=0.27),
    Bar("bench.sampler_over_smalldiffusion", at_most=0.75),
    Bar("bench.walker_80s_bone_rmse_cm", at_most=0.5),
    Bar("bench.walker_80s_adherence_excess_mps", at_most=0.04),
    Bar("bench.import_over_torch", at_most=1.1),
)
