"""Two schedules of our own: more noise at every step, and no steps at low noise.

More noise: if many entries carry the same information, it survives noise that hides each single
entry (images with more pixels, dances with more frames). A schedule for small samples then spends
too few steps at the noise levels that decide the large structure.
Gain: docs/RESULTS.md. No steps at low noise: *From the paper's walker to ours*
(`walker-departures.leap.*`). More noise: *On recordings* (`inbetween-budget.cosine.*`, without it):
of recorded walks the mean in-between is a seventh nearer, and half as many samples fail. The mover
(`words-budget.cosine.*`, without it) shows .088 [.047, .129] more of the acts, and its bones are a
quarter farther off. For dances bones alone gained, and sliding, variety and FID lost, so they do
without.
Source: Hoogeboom and others, 2023 (simple diffusion), for images; for motion, ours.
"""

from collections.abc import Callable

import torch

from ..ddpm import Schedule, linear_schedule, make_schedule


def shifted(schedule: Schedule, snr: float) -> Schedule:
    """Multiply alpha_bar / (1 - alpha_bar) of every step by `snr`.

    With ab for alpha_bar: alpha_bar' = snr ab / (1 - ab + snr ab).

    1 leaves the schedule unchanged.  Raises ValueError for a number that is not positive.
    """
    if not snr > 0:
        raise ValueError(
            f"snr multiplies the signal-to-noise ratio and must be above 0, not {snr:g}"
        )
    if snr == 1:
        return schedule
    left = snr * schedule.alpha_bar / (1 - schedule.alpha_bar + snr * schedule.alpha_bar)
    return make_schedule(1 - left[1:] / left[:-1], f"{schedule.name}, signal-to-noise x {snr:g}")


def leap_schedule(
    S: int = 100, leap: float = 0.37, beta_2: float = 0.03, beta_S: float = 0.08
) -> Schedule:
    """beta_1 = leap, then evenly from beta_2 to beta_S.

    After step 1 the noise is sqrt(leap / (1 - leap)) times the signal, by default 0.77 times.

    At lower noise, x_s tells a small network no more about a pose than it already knows. Each step
    there would add the network's error again, and a rollout repeats these steps in each frame. One
    leap from step 1 to the clean pose avoids that. Ours.
    """
    rest = torch.linspace(beta_2, beta_S, S - 1, dtype=torch.float64)
    return make_schedule(
        torch.cat([torch.tensor([leap], dtype=torch.float64), rest]), f"leap {leap:g}"
    )


# by their names in recipes
SCHEDULES: dict[str, Callable[[int], Schedule]] = {"linear": linear_schedule, "leap": leap_schedule}
