"""In-betweens of recordings: a keyframe a second, and closer and wider ones.

Each window is filled in `samples` times: before second tries, and as `md.inbetween` does
it, which notices failures and tries again. They are compared with the better of straight lines and
arcs. Intervals are over persons.
"""

import warnings
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context

import numpy as np
import torch
from jaxtyping import Bool, Float

from motiondiff_edu.baselines.interpolation import linear, spherical
from motiondiff_edu.editing.inbetween import clean_samples
from motiondiff_edu.editing.masks import keyframes
from motiondiff_edu.editing.plausible import each_until_plausible
from motiondiff_edu.metrics.keyframes import energy_score, unknown_error
from motiondiff_edu.metrics.skating import skating
from motiondiff_edu.motion.motion import Motion
from motiondiff_edu.motion.root_frame import FPS
from motiondiff_edu.performers.inbetweener import STEPS, Inbetweener
from motiondiff_edu.performers.performer import generators

from ..walks.scores import SKATING_FLOOR, Measure
from .by_source import by_source
from .windows import RecordedSize, amounts, held_out, recorded

SECOND = 20  # frames
OTHERS = (5, 10, 40)  # frames between keyframes, beside one a second
# of the collection's files: people who walk and turn, and do nothing else; two of them
# (cmu_003) over uneven ground
WALKS = (
    "bvhpython_test_freebvh", "bvhtoolbox_walk01", "cmu_02_01", "cmu_002_02", "cmu_003_01",
    "cmu_003_02", "cmu_005_01", "cmu_12_01", "pymo_AV_8Walk",
)  # fmt: skip

Task = tuple[Inbetweener, Motion, int, int]  # who, what, frames between keyframes, samples
Run = Callable[[Sequence[Task]], list[dict[str, float]]]


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
        }
    return row


def measures_of(
    rows: list[dict[str, float]], walks: Bool[np.ndarray, "N"], sources: list[str]
) -> list[Measure]:
    """The measures of all windows."""
    columns = {name: np.array([row[name] for row in rows]) for name in rows[0]}

    def one(name: str, column: str, value: Callable, some: Bool[np.ndarray, "N"]) -> Measure:
        unit = "cm" if name.endswith("_cm") else "share" if name.endswith("_share") else "ratio"
        return by_source(name, unit, value, columns[column][some], np.array(sources)[some])

    every = np.ones(len(rows), bool)
    found = []
    for start, column in (("inbetween_", ""), ("inbetween_raw_", "raw_")):
        found += [
            one(f"{start}over_interpolation", f"{column}mean", np.median, every),
            one(f"{start}walks_over_interpolation", f"{column}mean", np.median, walks),
            one(f"{start}others_over_interpolation", f"{column}mean", np.median, ~walks),
            one(f"{start}one_over_interpolation", f"{column}one", np.median, every),
            one(f"{start}one_p90_over_interpolation", f"{column}one", high, every),
            one(f"{start}energy_over_interpolation", f"{column}energy", np.median, every),
            one(f"{start}others_energy_over_interpolation", f"{column}energy", np.median, ~walks),
            one(f"{start}skating_over_source", f"{column}skating", np.nanmedian, every),
            one(f"{start}skating_p90_over_source", f"{column}skating", high, every),
            one(f"{start}fastest_over_source", f"{column}fastest", high, every),
            one(f"{start}floor_cm", f"{column}depth", high, every),
        ]
    return [*found, one("inbetween_fallback_share", "again", np.mean, every)]


def high(values: Float[np.ndarray, "N"]) -> float:
    """The 90th percentile of the numbers among them."""
    return float(np.nanpercentile(values, 90)) if np.isfinite(values).any() else np.nan


def measured_alone(task: Task) -> dict[str, float]:
    """What is measured of one window."""
    inbetweener, motion, every, samples = task
    known = keyframes(len(motion), every)
    return row_of(filled(inbetweener, motion, known, samples), motion.positions, known)


def in_turn(tasks: Sequence[Task]) -> list[dict[str, float]]:
    return [measured_alone(task) for task in tasks]


def on_all_cores(tasks: Sequence[Task]) -> list[dict[str, float]]:
    """The tasks at the same time, one thread each. The numbers are those of `in_turn`."""
    start = {"mp_context": get_context("spawn"), "initializer": torch.set_num_threads}
    with ProcessPoolExecutor(**start, initargs=(1,)) as processes:
        return list(processes.map(measured_alone, tasks))


def inbetween_records(
    inbetweener: Inbetweener, weights: str, size: RecordedSize, command: str, run: Run = in_turn
) -> list[dict]:
    """The measures of in-betweens (`real.inbetween_*`), at other distances `real.gapN.`."""
    windows, walks = windows_and_walks(size)
    sources = [source for source, _ in windows]
    seeds = {"windows": len(windows)} | amounts(sources) | {"sampling": 0, "steps": STEPS}
    seeds |= {"samples": size.samples, "weights": weights, "walks": int(walks.sum())}
    tasks = [
        (inbetweener, motion, every, size.samples)
        for every in (SECOND, *OTHERS)
        for _, motion in windows
    ]
    rows, records = run(tasks), []
    for every in (SECOND, *OTHERS):
        here, rows = rows[: len(windows)], rows[len(windows) :]
        prefix = "real." if every == SECOND else f"real.gap{every}."
        found = measures_of(here, walks, sources)
        records += [one.as_record(prefix, seeds, command) for one in found]
    return records


def windows_and_walks(
    size: RecordedSize,
) -> tuple[list[tuple[str, Motion]], Bool[np.ndarray, "N"]]:
    """All windows of people whom no training has seen, by file, and which are walks."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # notes on the files
        windows = list(recorded(held_out(), size))
    return windows, np.array([source.startswith(WALKS) for source, _ in windows])


def rows_of(
    inbetweener: Inbetweener, windows: list[tuple[str, Motion]], every: int, samples: int
) -> list[dict[str, float]]:
    """What is measured of each window, with keyframes every so many frames."""
    return in_turn([(inbetweener, motion, every, samples) for _, motion in windows])
