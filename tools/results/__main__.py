"""Measure into docs/results, and write docs/RESULTS.md and docs/RESULTS_ALL.md from it.

    python -m tools.results [--only PART ...] [--full] [--quick] [--weights NAME=FILE] [--render]

Without --only, all parts are measured for which there are shipped weights; a name that is not known
lists all parts. --full adds the sweeps that train, for minutes or hours a variant:
walker-departures (from MoDiff to our walker), dancer-departures and words-budget. One
variant of a sweep is a part as well: walker-departures.leap, dancer-departures.ear. Otherwise
their records stay as they are. A training that was killed continues. By name alone are measured:
what needs recordings, with MOTIONDIFF_REAL_DATA (recordings, recordings-inbetweens,
recordings-reconstructions, real-music, eye-recordings, inbetween-budget, gate, files), collect, and
course-shown (pages and demos, after `make pages`). --quick measures little, into build/quick, and
is for trying the code. --render only writes the pages from the existing records.
"""

import argparse
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import cached_property
from multiprocessing import get_context
from pathlib import Path

import torch

from benchmarks.records import show, write_records
from motiondiff_edu._files import replacing
from motiondiff_edu.performers.dancer import Dancer
from motiondiff_edu.performers.inbetweener import Inbetweener
from motiondiff_edu.pretrained import checkpoints
from motiondiff_edu.viz.walks import footstep_curves

from . import eyes, files, gate
from .course.bad_copies import collect_records
from .course.exercises import course_records
from .course.shown import shown_records
from .dances import departures as dance_departures
from .dances import parts as dances
from .dances import real_music
from .dances.attention import attention_picture, attention_records
from .dances.hearing import hearing_records
from .dances.timing import time_records
from .inbetweens import departures, inbetween
from .page.cards import add_metrics
from .page.render import render
from .recordings import continuations, persons, reconstructions, trainings
from .recordings import inbetweens as recorded_inbetweens
from .recordings import windows as recorded
from .repairs import both, mend, repair
from .repairs.trials import names_of
from .sweep import Sweep, Variant, run
from .walks import departures as walker_departures
from .walks.parts import FULL, LINES, QUICK, Bench, Walks, footstep_records, walker_records
from .walks.parts import weights_digest as digest
from .words import budget as word_budget
from .words import free
from .words import parts as words

DOCS, RUNS = Path("docs"), Path("build/runs")
ROUNDS = 7  # of dance-time


@dataclass(frozen=True)
class Context:
    """How much is measured, with which weights, and where records and trainings are kept."""

    quick: bool
    weights: Mapping[str, Path]  # those that are not shipped
    folder: Path
    runs: Path

    @cached_property
    def bench(self) -> Bench:
        return Bench(self.of(FULL, QUICK), dict(self.weights))

    @cached_property
    def stage(self) -> dances.Stage:
        return dances.Stage(self.of(dances.DANCE_FULL, dances.DANCE_QUICK), dict(self.weights))

    def of(self, full, quick):
        """The size of a measurement."""
        return quick if self.quick else full

    def performer(self, name: str) -> tuple[Dancer | Inbetweener, str]:
        """A dancer or an in-betweener, and the digest of its weights."""
        path = self.stage.weights[name]
        return checkpoints.load(path), digest(path)

    def walker(self) -> tuple:
        """The shipped walker, the digest of its weights, and the size for recordings."""
        path = self.bench.weights["walker"]
        return checkpoints.load(path), digest(path), self.recorded

    @property
    def recorded(self) -> recorded.RecordedSize:
        return self.of(recorded.FULL, recorded.QUICK)


@dataclass(frozen=True)
class Part:
    """What is measured in one go, and the weights that it needs."""

    records: Callable[[Context, str], list[dict]]  # also takes the command
    weights: frozenset[str] = frozenset()
    by_name: bool = False  # recordings are not part of the project, pages are made before


def part(records: Callable, *weights: str, by_name: bool = False) -> Part:
    return Part(records, frozenset(weights), by_name)


def footsteps(c: Context, command: str) -> list[dict]:
    records, curves = footstep_records(c.bench, command)
    shown = {name: one for name, one in curves.items() if not name.endswith("-robust")}
    save(footstep_curves(shown), c.folder / "footsteps.png")
    return records


def attention(c: Context, command: str) -> list[dict]:
    save(attention_picture(c.stage), c.folder / "attention.png")
    return attention_records(c.stage, command)


def on_all_cores(function: Callable, tasks: Sequence) -> list:
    """As `map`, for tasks at the same time, one thread each."""
    start = {"mp_context": get_context("spawn"), "initializer": torch.set_num_threads}
    with ProcessPoolExecutor(**start, initargs=(1,)) as processes:
        return list(processes.map(function, tasks))


def words_records(c: Context, command: str) -> list[dict]:
    studio = words.Studio(words.size_of(c.quick), c.bench.weights)
    return words.word_records(studio, command, on_all_cores)


def continued(c: Context, command: str) -> list[dict]:
    measured = *c.walker(), command
    return [*continuations.recorded_records(*measured), *persons.person_records(*measured)]


SHOWN, MASKED = departures.SHOWN, departures.NOT_SHOWN  # the weights of in-betweens
PARTS = {
    **{name: part(lambda c, command, name=name: dances.dance_records(c.stage, name, command),
                  weights) for name, weights in dances.DANCES.items()},
    "footsteps": part(footsteps),
    "dance-data": part(lambda c, command: dances.data_records(c.stage, command)),
    "attention": part(attention, "dancer"),
    "dance-time": part(lambda c, command: time_records(c.of(ROUNDS, 2), command)),
    "course": part(lambda c, command: course_records(command, c.of(None, 3))),
    "mend": part(lambda c, command: mend.records(c.bench, c.of(repair.FULL, repair.QUICK), command),
                 "walker", "walker-plain", *names_of("plain"), *names_of("dropout")),
    "mend-both": part(lambda c, command: both.both_records(
        c.bench, c.stage.dancer(MASKED), c.of(repair.FULL, repair.QUICK), command),
        both.WALKER, MASKED),
    "inbetween": part(lambda c, command: inbetween.inbetween_records(
        c.performer(SHOWN), c.performer(MASKED), c.of(inbetween.FULL, inbetween.QUICK), command),
        SHOWN, MASKED),
    "words": part(words_records, "mover"),
    "eye": part(lambda c, command: eyes.eye_records(
        c.walker()[:2], c.performer("dancer"), c.performer(SHOWN), c.of(eyes.FULL, eyes.QUICK),
        command), "walker", "dancer", SHOWN),
    "eye-recordings": part(lambda c, command: eyes.recorded_records(
        c.walker()[:2], c.of(eyes.FULL, eyes.QUICK), command), "walker", by_name=True),
    "dance-ways": part(lambda c, command: dances.way_records(c.stage, command), "dancer"),
    "ear": part(lambda c, command: hearing_records(c.stage, command), "dancer"),
    "recordings": part(continued, "walker", by_name=True),
    "recordings-reconstructions": part(
        lambda c, command: reconstructions.reconstruction_records(*c.walker(), command), "walker",
        by_name=True),
    "recordings-inbetweens": part(lambda c, command: recorded_inbetweens.inbetween_records(
        *c.performer(SHOWN), c.recorded, command, on_all_cores), SHOWN,
        by_name=True),
    "real-music": part(lambda c, command: real_music.music_records(
        *c.performer("dancer"), c.of(real_music.FULL, real_music.QUICK), command), "dancer",
        by_name=True),
    "gate": part(lambda c, command: gate.gate_records(command, c.quick), by_name=True),
    "words-free": part(lambda c, command: free.free_records(
        c.bench.weights["mover"], command, c.quick), "mover", by_name=True),
    "files": part(lambda c, command: files.file_records(command, c.quick), by_name=True),
    "collect": part(lambda c, command: collect_records(command, c.quick), by_name=True),
    "course-shown": part(lambda c, command: shown_records(command), by_name=True),
}  # fmt: skip


@dataclass(frozen=True)
class Trained:
    """A sweep: its variants, and how it is made; `weights`: of one that trains nothing."""

    variants: Mapping[str, Variant]
    sweep: Callable[[Context, Path], Sweep]
    by_name: bool = False
    weights: frozenset[str] | None = None


SWEEPS = {
    "inbetween-departures": Trained(
        departures.VARIANTS,
        lambda c, runs: departures.sweep({name: c.performer(name) for name in (SHOWN, MASKED)},
                                         c.of(inbetween.FULL, inbetween.QUICK)),
        weights=frozenset({SHOWN, MASKED})),
    "walker-departures": Trained(
        walker_departures.VARIANTS,
        lambda c, runs: walker_departures.sweep(
            c.of(walker_departures.FULL, walker_departures.QUICK), runs)),
    "dancer-departures": Trained(
        dance_departures.VARIANTS,
        lambda c, runs: dance_departures.sweep(
            c.of(dance_departures.FULL, dance_departures.QUICK), runs)),
    "words-budget": Trained(
        word_budget.VARIANTS,
        lambda c, runs: word_budget.sweep(c.of(word_budget.FULL, word_budget.QUICK), runs)),
    "inbetween-budget": Trained(
        trainings.VARIANTS,
        lambda c, runs: trainings.sweep(c.of(trainings.FULL, trainings.QUICK), runs),
        by_name=True),
}  # fmt: skip


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="python -m tools.results",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--only", nargs="+", default=[], metavar="PART", help="only these parts")
    parser.add_argument("--full", action="store_true", help="also the parts that train (hours)")
    parser.add_argument("--quick", action="store_true", help="few clips; written to build/quick")
    parser.add_argument(
        "--weights", nargs="+", default=[], metavar="NAME=FILE", help="weights that are not shipped"
    )
    parser.add_argument("--render", action="store_true", help="only write the pages")
    return parser.parse_args()


def main() -> None:
    chosen = arguments()
    docs = Path("build/quick") if chosen.quick else DOCS
    if not chosen.render:
        measure(chosen, docs / "results")
    if not chosen.quick:
        add_metrics(docs / "results")
    missing = render(docs)
    if missing and not chosen.quick:
        print(f"the template names records that do not exist: {', '.join(missing)}")
    print(f"written: {docs / 'RESULTS.md'} and {docs / 'RESULTS_ALL.md'}")


def weights_of(items: list[str]) -> dict[str, Path]:
    """NAME=FILE, for weights that are not shipped."""
    pairs = [item.partition("=") for item in items]
    bad = next(
        (item for item, (_, _, file) in zip(items, pairs, strict=True) if not Path(file).is_file()),
        None,
    )
    if bad:
        sys.exit(f"--weights takes NAME=FILE with a weights file that exists, not {bad!r}")
    return {name: Path(file) for name, _, file in pairs}


def parts_of(only: list[str], full: bool, lines: Mapping[str, Walks], weights: set[str]) -> list:
    """The chosen parts; a sweep is its variants, each a part of its own.

    Without a choice these are all parts that have weights, and with `full` the sweeps that train.
    Exits with the list of names when one is unknown.
    """
    there = [prefix for prefix, line in lines.items() if line.name in weights]
    there += [n for n, one in PARTS.items() if one.weights <= weights and not one.by_name]
    for name, one in SWEEPS.items():
        trains = one.weights is None
        if (full and not one.by_name) if trains else one.weights <= weights:
            there.append(name)
    rows = {n: [f"{n}.{variant}" for variant in one.variants] for n, one in SWEEPS.items()}
    parts = [row for name in only or there for row in rows.get(name, [name])]
    names = [*lines, *PARTS]
    unknown = sorted(set(parts) - {*names, *(row for group in rows.values() for row in group)})
    if unknown:
        sys.exit(
            f"no part is called {', '.join(unknown)}; there are: {', '.join([*names, *rows])}; "
            "variants of the last: walker-departures.leap, dancer-departures.ear ..."
        )
    return parts


def measure(chosen: argparse.Namespace, folder: Path) -> None:
    """Run the chosen parts and write their records; those of all other parts stay as they are."""
    extra = weights_of(chosen.weights)
    runs = folder / "runs" if chosen.quick else RUNS
    context = Context(chosen.quick, extra, folder, runs)
    lines = LINES | {name: Walks(name, name) for name in extra}
    suffix = " --quick" * chosen.quick + "".join(f" --weights {item}" for item in chosen.weights)
    for name in parts_of(chosen.only, chosen.full, lines, set(context.bench.weights)):
        began = time.monotonic()
        records = records_of(name, context, lines, f"python -m tools.results --only {name}{suffix}")
        show([one for one in records if one["value"] is not None])
        write_records(folder / f"{name}.json", records)
        print(f"{name}: {time.monotonic() - began:.0f} s", flush=True)


def records_of(name: str, context: Context, lines: Mapping, command: str) -> list[dict]:
    """The records of one part; its picture, where it has one, is written beside them."""
    group, _, variant = name.partition(".")
    if group in SWEEPS:
        sweep = SWEEPS[group].sweep(context, context.runs / group)
        return run(sweep, variant, context.folder / group, command)
    if name in PARTS:
        return PARTS[name].records(context, command)
    return walker_records(context.bench, lines[name], command)


def save(figure, path: Path) -> None:
    with replacing(path) as aside:
        figure.savefig(aside, dpi=110, format="png")


if __name__ == "__main__":
    main()
