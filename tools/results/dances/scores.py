"""The measures of dances, each with its interval over songs.

The functions take arrays: the data's own dances are scored by the same code.
"""

import warnings
from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from motiondiff_edu.metrics.bodies import repeat_score
from motiondiff_edu.metrics.dances import (
    BeatScores,
    NoBeatsWarning,
    beat_scores,
    kinematic_beats,
    music_alignment,
)
from motiondiff_edu.metrics.distributions import (
    FewSamplesWarning,
    diversity,
    fid,
    kinetic_features,
    normalise,
)
from motiondiff_edu.metrics.walks import skating

from ..walks.scores import FPS, Kind, Measure, measure_of, ratio, root_mean, squared_bone_error

Beats = Sequence[Float[np.ndarray, "_"]]


def rows_of(
    dances: Float[np.ndarray, "R N T J 3"], beats: Beats
) -> dict[str, Float[np.ndarray, "N"]]:
    """The mean over R dances to each song.

    The measures are score, score with other songs, chance, beats per beat, speed.

    `bas_music` is the form of MoFusion's eq. 10, averaged over the music's beats; `skating` is how
    fast standing toes slide, m/s.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", NoBeatsWarning)
        scored: list[BeatScores] = [beat_scores(one, beats) for one in dances]
    names = (
        "bas_clips",
        "bas_shuffled_clips",
        "bas_chance_clips",
        "beats_per_beat_clips",
        "speed_clips",
    )
    rows = {
        name.removesuffix("_clips"): np.nanmean([getattr(s, name) for s in scored], axis=0)
        for name in names
    }
    still = np.zeros(
        (*dances.shape[1:3], 3)
    )  # a dance has no control: its positions are the world's
    rows["skating"] = np.nanmean([skating(one, still) for one in dances], axis=0)
    return rows | {"bas_music": np.mean([_music_form(one, beats) for one in dances], axis=0)}


def _music_form(dances: Float[np.ndarray, "N T J 3"], beats: Beats) -> Float[np.ndarray, "N"]:
    """Use only beats within the clip: a dancer cannot dance to the others."""
    end = (dances.shape[1] - 1) / FPS
    within = [music[(music >= 0) & (music <= end)] for music in beats]
    return np.array(
        [music_alignment(kinematic_beats(one), b) for one, b in zip(dances, within, strict=True)]
    )


SHARE = ("bas", "bas_shuffled", "data.bas", "data.bas_shuffled")


def share(own, own_shuffled, data, data_shuffled) -> float:
    """A dancer's alignment beyond that with other songs, divided by the same of the data."""
    return (np.nanmean(own) - np.nanmean(own_shuffled)) / (
        np.nanmean(data) - np.nanmean(data_shuffled)
    )


# of `rows_of`; those of the data are named data.*
BEATS = {
    "bas": Kind("", ("bas",), np.nanmean),
    "bas_shuffled": Kind("", ("bas_shuffled",), np.nanmean),
    "bas_chance": Kind("", ("bas_chance",), np.nanmean),
    "bas_data": Kind("", ("data.bas",), np.nanmean),
    "bas_data_shuffled": Kind("", ("data.bas_shuffled",), np.nanmean),
    "bas_music": Kind("", ("bas_music",), np.nanmean),
    "bas_music_data": Kind("", ("data.bas_music",), np.nanmean),
    "bas_share": Kind("ratio", SHARE, share),
    "beats_per_beat": Kind("", ("beats_per_beat",), np.nanmean),
    "beats_per_beat_over_data": Kind("ratio", ("beats_per_beat", "data.beats_per_beat"), ratio),
    "speed_mps": Kind("m/s", ("speed",), np.nanmean),
    "speed_over_data": Kind("ratio", ("speed", "data.speed"), ratio),
    "skating_mps": Kind("m/s", ("skating",), np.nanmean),
    "skating_data_mps": Kind("m/s", ("data.skating",), np.nanmean),
}
BONES = {"bone_rmse_cm": Kind("cm", ("bones",), root_mean)}
# of `variety_rows`
VARIETY = {
    "multimodality": Kind("", ("modes",), np.mean),
    "multimodality_data": Kind("", ("data.modes",), np.mean),
    "multimodality_over_data": Kind("ratio", ("modes", "data.modes"), ratio),
    **{f"{kind}{end}": Kind("", (f"{kind}{end}",), np.mean)
       for kind in ("fid", "diversity") for end in ("", "_data")},
}  # fmt: skip


def beat_rows(
    own: dict[str, np.ndarray], data: dict[str, np.ndarray]
) -> dict[str, Float[np.ndarray, "N"]]:
    """The rows of BEATS: beat alignment, with all that is needed to interpret it."""
    return own | {f"data.{name}": row for name, row in data.items()}


def worst_share(name: str, groups: list[list[np.ndarray]]) -> Measure:
    """The smallest `share` of several groups of as many songs; rows as `share` takes them."""
    size = len(groups[0])

    def smallest(*rows: np.ndarray) -> float:
        return min(share(*rows[k : k + size]) for k in range(0, len(rows), size))

    return measure_of(name, "ratio", smallest, *(rows for group in groups for rows in group))


def longer(name: str, long: list[np.ndarray], short: list[np.ndarray]) -> Measure:
    """`share` of long dances over that of short ones; rows as `share` takes them."""
    return measure_of(
        name, "ratio", lambda *rows: share(*rows[:4]) / share(*rows[4:]), *long, *short
    )


def bone_rows(dances: Float[np.ndarray, "R N T J 3"]) -> dict[str, Float[np.ndarray, "N"]]:
    """The row of BONES: squared errors of each song, cm^2, the mean over R dances."""
    return {"bones": np.mean([squared_bone_error(one) for one in dances], axis=0)}


def bone_gain(with_losses: Float[np.ndarray, "*N"], without: Float[np.ndarray, "*N"]) -> float:
    """1 - RMSE with / RMSE without kinematic losses, of squared errors."""
    return 1 - root_mean(with_losses) / root_mean(without)


def features_of(dances: Float[np.ndarray, "N K T J 3"]) -> Float[np.ndarray, "N K F"]:
    """Kinetic features of every dance."""
    return np.stack([np.stack([kinetic_features(one) for one in row]) for row in dances])


def variety_rows(
    own: Float[np.ndarray, "N K F"],
    data: Float[np.ndarray, "N K F"],
    all_data: Float[np.ndarray, "P F"],
) -> dict[str, np.ndarray]:
    """The rows of VARIETY: MultiModality (K dances to one song), and FID and Diversity of all.

    On kinetic features normalised by `all_data`. `fid_data`, of as many dances of the data, is a
    perfect dancer's FID: few clips never give 0.
    """
    modes, modes_data = (diversity(normalise(x, all_data)) for x in (own, data))
    pooled, pooled_data = (x.reshape(-1, x.shape[-1]) for x in (own, data))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FewSamplesWarning)
        once = {"fid": fid(pooled, all_data), "fid_data": fid(pooled_data, all_data)}
    once |= {"diversity": diversity(normalise(pooled, all_data))}
    once |= {"diversity_data": diversity(normalise(pooled_data, all_data))}
    rows = {"modes": modes, "data.modes": modes_data}
    return rows | {name: np.array([float(value)]) for name, value in once.items()}


def repeat_measure(dances: Float[np.ndarray, "N T J 3"]) -> Measure:
    """The repetition of a dance at the best lag of 1 to 8 s."""
    return measure_of("repeat", "", np.mean, np.array([repeat_score(one) for one in dances]))
