"""A schedule with more noise at every step: its signal-to-noise ratio, times a number.

What many entries tell together survives noise that hides each of them: images of more pixels,
dances of more frames. A schedule made for small things then hurries through the noise at which much
is decided.
Source: Hoogeboom and others, 2023 (simple diffusion), for images; for dances, ours.  Notebook: 12
"""

from ..ddpm import Schedule, make_schedule


def shifted(schedule: Schedule, snr: float) -> Schedule:
    """Multiply alpha_bar / (1 - alpha_bar) of every step by `snr`: alpha_bar' = snr ab / (1 - ab +
    snr ab).

    1 leaves the schedule as it is.  Raises ValueError for a number that is not positive.
    Notebook: 12
    """
    if not snr > 0:
        raise ValueError(
            f"the signal-to-noise ratio is multiplied by a number above 0, not {snr:g}"
        )
    if snr == 1:
        return schedule
    left = snr * schedule.alpha_bar / (1 - schedule.alpha_bar + snr * schedule.alpha_bar)
    return make_schedule(1 - left[1:] / left[:-1], f"{schedule.name}, signal-to-noise x {snr:g}")
