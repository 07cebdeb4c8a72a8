"""Hearing: what a song's score says of its sound, and how a song's Mel frames are augmented.

A dancer learns to hear through its dances alone, and there the beat is a small part of the error.
So an ear is taught first, from songs without dances: where in the beat and in the bar each moment
is, whether there is a beat at all, and the genre. For that a song can be heard faster, higher,
in noise, without some of its bands, or from other loudspeakers, which a dance could not follow.

    place in the beat      0 on a beat, 1/2 between two; a network gives it as cosine and sine
    count                  beats since the first one, with the place behind the point

Gain: docs/RESULTS.md, *From MoFusion to our dancer* (`dancer-departures.ear.*`): dances stop on the
beat several times as often beyond chance.
Ours; after beat trackers that are taught by scores (Böck and Schedl, 2011). The paper's network
hears through its own loss alone.  Notebook: 12
"""

import math
from dataclasses import dataclass

import numpy as np
import torch
from jaxtyping import Float, Int
from torch import Tensor

PAUSE = 1.75  # beats: in a longer gap between two beats there is none to be heard
Ranges = tuple[tuple[float, float], ...]


def beat_counts(
    times: Float[np.ndarray, "M"],
    beats: Float[np.ndarray, "K"],
    bar_position: Int[np.ndarray, "K"],
    metre: int,
) -> Float[np.ndarray, "M 2"]:
    """Beats and bars counted at these times (seconds), with fractions; NaN where there is no beat.

    The second column is a whole number on a downbeat. There is no beat before the first and after
    the last, nor in a pause, which lasts PAUSE usual beats or more.
    """
    made = np.full((len(times), 2), np.nan)
    if len(beats) < 2:
        return made
    lengths = np.diff(beats)
    k = np.searchsorted(beats, times, side="right") - 1
    inside = (k >= 0) & (k < len(lengths))
    k = k.clip(0, len(lengths) - 1)
    inside &= lengths[k] < PAUSE * np.median(lengths)
    place = (times - beats[k]) / lengths[k]
    steps = (np.diff(bar_position) - 1) % metre + 1  # in a pause, to the next place
    number = bar_position[0] + np.concatenate([[0], np.cumsum(steps)])
    made[inside] = np.stack([k + place, (number[k] + place) / metre], -1)[inside]
    return made


def on_circles(count: Float[Tensor, "*B M 2"]) -> Float[Tensor, "*B M 4"]:
    """Cosine and sine of the place in the beat, then of that in the bar; 0 where there is none."""
    angles = 2 * math.pi * count.nan_to_num()
    parts = torch.stack([angles.cos(), angles.sin()], -1).flatten(-2)
    return parts.where(~count.isnan().any(-1, keepdim=True), 0.0)


def tempo_factors(
    tempi: Float[Tensor, "B"],
    ranges: Ranges,
    limits: tuple[float, float],
    generator: torch.Generator,
) -> Float[Tensor, "B"]:
    """How many times faster to play songs of these tempi (BPM), so that they stay in the ranges.

    Equal ratios within the limits are equally likely; 1 where a few draws find none.
    """
    least, most = map(math.log, limits)
    factors = (least + (most - least) * torch.rand(8, len(tempi), generator=generator)).exp()
    heard = factors * tempi
    fits = torch.stack([(low <= heard) & (heard <= high) for low, high in ranges]).any(0)
    first = fits.int().argmax(0)
    chosen = factors.gather(0, first[None])[0]
    return chosen.where(fits.any(0), 1.0)


@dataclass(frozen=True)
class MelAugmentation:
    """How much a song is changed before it is heard. Shares are those of the pieces changed.

    faster   largest factor of the speed, and the share
    higher   bands, up or down, at most
    noise    largest standard deviation of noise that differs from frame to frame, and the share
    hidden   bands that are silent, at most, and the share
    """

    faster: tuple[float, float] = (1.33, 0.7)
    higher: float = 4.0
    noise: tuple[float, float] = (0.5, 0.5)
    hidden: tuple[int, float] = (40, 0.3)


SILENT = -2.0  # standard deviations: a band without sound


def augmented(
    mel: Float[Tensor, "B M C"], how: MelAugmentation, generator: torch.Generator
) -> Float[Tensor, "B M C"]:
    """Standardised Mel frames higher or lower, with noise, and without some bands."""
    B, _, C = mel.shape

    def drawn(*shape: int) -> Tensor:
        return torch.rand(*shape, generator=generator)

    shift = how.higher * (2 * drawn(B, 1, 1) - 1)
    mel = interpolated_rows(mel.mT, torch.arange(C) + shift[:, 0]).mT
    most, share = how.noise
    amount = most * drawn(B, 1, 1) * (drawn(B, 1, 1) < share)
    mel = mel + amount * torch.randn(mel.shape, generator=generator)
    most, share = how.hidden
    width = most * drawn(B, 1) * (drawn(B, 1) < share)
    first = drawn(B, 1) * (C - width)
    bands = torch.arange(C)
    hidden = (first <= bands) & (bands < first + width)
    return mel.where(~hidden[:, None], SILENT)


def gain_noise(
    mel: Float[Tensor, "B M C"], amount: float, generator: torch.Generator
) -> Float[Tensor, "B M C"]:
    """Standardised Mel frames as from other loudspeakers, so that an ear does not depend on how a
    song was mastered.

    They get a level and a tilt over the bands, both of standard deviation `amount`, the same at all
    times of a piece.
    """
    level, tilt = amount * torch.randn(2, len(mel), 1, 1, generator=generator)
    return mel + level + tilt * torch.linspace(-1, 1, mel.shape[-1])


def interpolated_rows(
    rows: Float[Tensor, "B M C"], at: Float[Tensor, "B N"]
) -> Float[Tensor, "B N C"]:
    """Rows at places between whole numbers, on straight lines; beyond the ends, the end's row."""
    at = at.clamp(0, rows.shape[1] - 1)
    low = at.floor().long().clamp(max=max(rows.shape[1] - 2, 0))
    share = (at - low)[..., None]
    high = (low + 1).clamp(max=rows.shape[1] - 1)
    index = torch.arange(len(rows))[:, None]
    return torch.lerp(rows[index, low], rows[index, high], share)
