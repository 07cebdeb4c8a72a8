"""In-betweens of recordings: a keyframe a second, and closer and wider ones.

Each window is filled in `samples` times: before second tries, and as `md.inbetween` does
it, which notices failures and tries again. They are compared with the better of straight lines and
arcs. Intervals are over persons.
"""

import warnings
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from motiondiff_edu.baselines.interpolation import linear, spherical
from motiondiff_edu.editing.inbetween import clean_samples
from motiondiff_edu.editing.masks import keyframes
from motiondiff_edu.editing.plausible import each_until_plausible, folded
from motiondiff_edu.metrics.keyframes import energy_score, unknown_error
from motiondiff_edu.metrics.walks import skating
from motiondiff_edu.motion.motion import Motion
from motiondiff_edu.motion.root_frame import FPS
from motiondiff_edu.performers.inbetweener import Inbetweener
from motiondiff_edu.performers.performer import STEPS, generators

from ..sweep import GROUPS
from ..walks.scores import SKATING_FLOOR, Kind, measures
from .windows import RecordedSize, amounts, held_out, person_of, recorded

SECOND = 20  # frames
OTHERS = (5, 10, 40)  # frames between keyframes, beside one a second
# of the collection's files: people who walk and turn, and do nothing else; two of them
# (cmu_003) over uneven ground
WALKS = (
    "bvhpython_test_freebvh", "bvhtoolbox_walk01", "cmu_02_01", "cmu_002_02", "cmu_003_01",
    "cmu_003_02", "cmu_005_01", "cmu_12_01", "pymo_AV_8Walk",
)  # fmt: skip

Task = tuple[Inbetweener, Motion, int, int]  # who, what, frames between keyframes, samples


@dataclass(frozen=True, eq=False)
class Filled:
    """The answers for one window: samples before and after the second tries, and interpolations."""

    raw: Float[np.ndarray, "S T J 3"]
    made: Float[np.ndarray, "S T J 3"]
    again: Bool[np.ndarray, "S"]
    lines: Float[np.ndarray, "T J 3"]
    arcs: Float[np.ndarray, "T J 3"]


def filled(
    inbetweener: Inbetweener, motion: Motion, known: Bool[np.ndarray, "T J"], samples: int
) -> Filled:
    """A window, filled in as `md.inbetween` does it."""
    truth, draws = motion.positions, generators(0, samples)

    def generate(some, remainder):
        how = {"samples": len(some), "steps": STEPS, "remainder": remainder, "generator": some}
        return clean_samples(inbetweener.fill(truth, known, **how), known)

    raw = list(generate(draws, 1.0))
    made, notes = zip(*each_until_plausible(raw, draws, truth, known, generate), strict=True)
    again = [
        bool(note) or one is not first for one, note, first in zip(made, notes, raw, strict=True)
    ]
    lines, arcs = linear(truth, known), spherical(truth, known)
    return Filled(np.stack(raw), np.stack(made), np.array(again), lines, arcs)


def row_of(one: Filled, truth: Float[np.ndarray, "T J 3"], known: Bool[np.ndarray, "T J"]) -> dict:
    """What is measured of one window; errors and scores over those of the better interpolation."""

    def error(made: Float[np.ndarray, "T J 3"]) -> float:
        return float(unknown_error(made[None], truth[None], known)[0])

    def fastest(positions: Float[np.ndarray, "T J 3"]) -> float:
        return float(FPS * np.linalg.norm(np.diff(positions, axis=0), axis=-1).max())

    def sliding(positions: Float[np.ndarray, "T J 3"]) -> float:
        still = np.zeros((1, len(positions), 3))
        return float(skating(positions[None], still)[0])

    rival = min(error(one.lines), error(one.arcs))
    row = {"again": one.again.mean()}
    for start, samples in (("", one.made), ("raw_", one.raw)):
        score = energy_score(samples[:, None], truth[None], known)[0]
        row |= {
            f"{start}mean": error(samples.mean(0)) / rival,
            f"{start}one": error(samples[0]) / rival,
            f"{start}energy": float(score) / rival,
            f"{start}skating": sliding(samples[0]) / max(sliding(truth), SKATING_FLOOR),
            f"{start}fastest": fastest(samples[0]) / fastest(truth),
            f"{start}depth": 100 * max(0.0, truth[..., 1].min() - samples[0][..., 1].min()),
            f"{start}folded": np.mean([folded(made, truth, known).any() for made in samples]),
        }
    return row


def high(values: Float[np.ndarray, "N"]) -> float:
    """The 90th percentile of the numbers among them."""
    return float(np.nanpercentile(values, 90)) if np.isfinite(values).any() else np.nan


def _kinds() -> dict[str, Kind]:
    found = {}
    for start, raw in (("inbetween_", ""), ("inbetween_raw_", "raw_")):
        for name, row, value in (
            ("over_interpolation", "mean", np.nanmedian),
            ("walks_over_interpolation", "mean.walks", np.nanmedian),
            ("others_over_interpolation", "mean.others", np.nanmedian),
            ("one_over_interpolation", "one", np.nanmedian),
            ("one_p90_over_interpolation", "one", high),
            ("energy_over_interpolation", "energy", np.nanmedian),
            ("others_energy_over_interpolation", "energy.others", np.nanmedian),
            ("skating_over_source", "skating", np.nanmedian),
            ("skating_p90_over_source", "skating", high),
            ("fastest_over_source", "fastest", high),
            ("floor_cm", "depth", high),
            ("folded_share", "folded", np.mean),
        ):
            unit = {"cm": "cm", "share": "share"}.get(name.rsplit("_")[-1], "ratio")
            found[start + name] = Kind(unit, (raw + row,), value)
    return found | {"inbetween_fallback_share": Kind("share", ("again",), np.mean)}


KINDS = _kinds()  # before second tries, they are named raw


def columns(rows: list[dict[str, float]], sources: list[str]) -> dict[str, np.ndarray]:
    """The rows of KINDS for windows of these files; those of walks and others have NaN elsewhere.

    The row `group` says whose each window is.
    """
    found = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    walks = np.array([source.startswith(WALKS) for source in sources])
    for name in ("mean", "energy", "raw_mean", "raw_energy"):
        found[f"{name}.walks"] = np.where(walks, found[name], np.nan)
        found[f"{name}.others"] = np.where(walks, np.nan, found[name])
    return found | {GROUPS: np.array([person_of(source) for source in sources])}


def measured_alone(task: Task) -> dict[str, float]:
    """What is measured of one window."""
    inbetweener, motion, every, samples = task
    known = keyframes(len(motion), every)
    return row_of(filled(inbetweener, motion, known, samples), motion.positions, known)


def inbetween_records(
    inbetweener: Inbetweener, weights: str, size: RecordedSize, command: str, each: Callable = map
) -> list[dict]:
    """The measures of in-betweens (`real.inbetween_*`), at other distances `real.gapN.`.

    `each`: `map`, or a function that calls its function for several windows at once.
    """
    windows = windows_of(size)
    sources = [source for source, _ in windows]
    walks = sum(source.startswith(WALKS) for source in sources)
    seeds = {"windows": len(windows)} | amounts(sources) | {"sampling": 0, "steps": STEPS}
    seeds |= {"samples": size.samples, "weights": weights, "walks": walks}
    tasks = [
        (inbetweener, motion, every, size.samples)
        for every in (SECOND, *OTHERS)
        for _, motion in windows
    ]
    rows, records = list(each(measured_alone, tasks)), []
    for every in (SECOND, *OTHERS):
        here, rows = rows[: len(windows)], rows[len(windows) :]
        prefix = "real." if every == SECOND else f"real.gap{every}."
        found = columns(here, sources)
        found = measures(KINDS, found, found[GROUPS])
        records += [one.as_record(prefix, seeds, command) for one in found]
    return records


def windows_of(size: RecordedSize) -> list[tuple[str, Motion]]:
    """All windows of people whom no training has seen, each with its file."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # notes on the files
        return list(recorded(held_out(), size))
