"""What an eye finds in motion (`metrics.bodies`): of data, recordings, and what the verbs return.

eye.walks.{data, walker}.*          8 s of synthetic walks; and 8 s that `walk` puts after 2 s
eye.recorded.{recording, walker}.*  the same with windows of recordings, 2 s given and 4 s new
eye.dances.{data, dancer}.*         5 s to unseen songs
eye.inbetweens.{data, made}.*       synthetic walks with a keyframe a second
"""

import warnings
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from itertools import islice

import numpy as np
from jaxtyping import Float

import motiondiff_edu as md
from data_synth.walking import dataset
from motiondiff_edu.editing.masks import keyframes
from motiondiff_edu.metrics import bodies
from motiondiff_edu.motion.cleanup import Body, clean_up
from motiondiff_edu.motion.motion import Motion
from motiondiff_edu.performers.dancer import Dancer
from motiondiff_edu.performers.inbetweener import Inbetweener
from motiondiff_edu.performers.walker import Walker

from .dances.songs import TRAINED, dances_of, judged_songs
from .recordings.continuations import windows
from .recordings.inbetweens import SECOND
from .recordings.windows import RecordedSize
from .walks.scores import FPS, Measure, measure_of
from .walks.trials import UNSEEN

GIVEN = 40  # frames
Positions = np.ndarray  # (T, 21, 3)
WALKS: dict[str, tuple[str, Callable[[Positions], float]]] = {
    "toe_flutter": ("1/s", bodies.toe_flutter),
    "stride_change_cm": ("cm", bodies.stride_change),
    "hand_swing_cm": ("cm", bodies.hand_swing),
    "still_share": ("share", bodies.still_share),
}
DANCES: dict[str, tuple[str, Callable[[Positions], float]]] = {
    "elbow_spread_deg": ("degrees", bodies.elbow_spread),
    "trunk_lean_deg": ("degrees", bodies.trunk_lean),
    "still_share": ("share", bodies.still_share),
}


@dataclass(frozen=True)
class EyeSize:
    """The number of walks, songs and in-betweens."""

    clips: int = 20


FULL, QUICK = EyeSize(), EyeSize(clips=3)


def told(
    prefix: str, kinds: Mapping[str, tuple[str, Callable]], motions: Iterable[Positions]
) -> list[Measure]:
    """The mean of each measure, with its interval over motions; where it has no meaning, none."""
    rows: dict[str, list[float]] = {name: [] for name in kinds}
    for one in motions:
        for name, (_, measure) in kinds.items():
            try:
                rows[name].append(measure(one))
            except ValueError:  # no stride, for example
                rows[name].append(np.nan)
    return [
        measure_of(f"{prefix}.{name}", unit, np.nanmean, np.array(rows[name]))
        for name, (unit, _) in kinds.items()
        if not np.isnan(rows[name]).all()
    ]


def walked_on(
    walker: Walker, pasts: Iterable[tuple[Motion, Float[np.ndarray, "n 3"]]]
) -> list[Positions]:
    """What `walk` puts after the given frames, under this control."""
    found = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # recordings are unlike the training data
        for given, control in pasts:
            made = walker.walk(given, control, progress=False)
            found.append(made.positions[len(given) :])
    return found


def synthetic(size: EyeSize, seconds: float) -> list[Motion]:
    return [Motion.of_clip(clip) for clip in dataset(size.clips, seconds, seed=UNSEEN + 7)]


def walks(walker: Walker, size: EyeSize) -> list[Measure]:
    """Synthetic walks, and the walker's under the same control."""
    motions = synthetic(size, 10.0)
    pasts = [(one[:GIVEN], one.to_clip().control[GIVEN:]) for one in motions]
    data = [one.positions[GIVEN:] for one in motions]
    return told("walks.data", WALKS, data) + told("walks.walker", WALKS, walked_on(walker, pasts))


def recordings(walker: Walker, size: EyeSize) -> list[Measure]:
    """Recordings, and how the walker continues them at the speed that they have."""
    some = list(islice(windows(RecordedSize(each=1), walker.card["control_range"]), size.clips))
    made = walked_on(walker, [(one.given, one.control) for one in some])
    return told("recorded.recording", WALKS, [one.next for one in some]) + told(
        "recorded.walker", WALKS, made
    )


def dances(dancer: Dancer, size: EyeSize) -> list[Measure]:
    """The data's dances to unseen songs, and the dancer's after the clean-up."""
    songs = judged_songs(size.clips)
    made = [
        clean_up(one, FPS, body=Body.of(one, bones=dancer.bones))
        for one in dances_of(dancer, songs.mel, TRAINED, 0)
    ]
    found = []
    for name, some in (("data", songs.truth[:, 0, :TRAINED]), ("dancer", made)):
        found += told(f"dances.{name}", DANCES, some)
        pairs = zip(some, songs.beats(TRAINED), strict=True)
        rows = [bodies.accents(one, beats) if len(beats) > 4 else np.nan for one, beats in pairs]
        found.append(measure_of(f"dances.{name}.accents", "", np.nanmean, np.array(rows)))
    return found


def inbetweens(inbetweener: Inbetweener, size: EyeSize) -> list[Measure]:
    """How much stronger joints are accelerated at keyframes, in the data and in what is made."""
    rows: dict[str, list[float]] = {"data": [], "made": []}
    for one in synthetic(size, 6.0):
        known = keyframes(len(one), SECOND)
        made = md.inbetween(one, known, seed=0, progress=False)
        for name, motion in (("data", one), ("made", made)):
            rows[name].append(bodies.tick_at_keyframes(motion.positions, known.any(1)))
    return [measure_of(f"inbetweens.{name}.tick", "ratio", np.mean, np.array(row))
            for name, row in rows.items()]  # fmt: skip


def eye_records(
    walker: tuple[Walker, str],
    dancer: tuple[Dancer, str],
    inbetweener: tuple[Inbetweener, str],
    size: EyeSize,
    command: str,
) -> list[dict]:
    """The records of synthetic data; networks come with the digests of their weights."""
    found = walks(walker[0], size) + dances(dancer[0], size) + inbetweens(inbetweener[0], size)
    return _records(found, size, [one[1] for one in (walker, dancer, inbetweener)], command)


def recorded_records(walker: tuple[Walker, str], size: EyeSize, command: str) -> list[dict]:
    """The records of recordings."""
    return _records(recordings(walker[0], size), size, [walker[1]], command)


def _records(found: list[Measure], size: EyeSize, weights: list[str], command: str) -> list[dict]:
    seeds = {"data": UNSEEN + 7, "clips": size.clips, "weights": weights}
    return [one.as_record("eye.", seeds, command) for one in found]
