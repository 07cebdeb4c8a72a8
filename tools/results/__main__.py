"""Measure into docs/results, and write docs/RESULTS.md from it.

    python -m tools.results [--only PART ...] [--full] [--quick] [--weights NAME=FILE] [--render]

Parts: walker, walker-plain, walker-printed, walker-eps, walker-ddim10, walker-lookahead,
walker-eps-lookahead, footsteps; dancer, dancer-plain, regression, unheard (music like none in
training), guided (weights of guidance), ear (what the dancer hears, beside a beat tracker),
dance-data (the data's own dances), attention, dance-time;
mend (dropout and repairs), mend-both (both papers' repairs), inbetween, inbetween-departures (what
each is worth), known-answer (methods of filling in, on tasks whose answer is a formula); words
(motion from text: Table 2, captions that nobody trained for, editing); course (the checks of the
exercises). These parts train, for minutes a row: ladder (from the paper's walker to ours),
dance-budget, words-budget, inbetween-budget and mend-map. One row of them is a part as well:
ladder.ours, dance-budget.v. By name alone are measured: what needs recordings, with
MOTIONDIFF_REAL_DATA (recordings, recordings-inbetweens, recordings-reconstructions, real-music,
inbetween-budget), and course-shown (pages and demos, after `make pages`).
Without --only, all parts are measured for which there are shipped weights. --full adds the parts
that train; otherwise their records stay as they are. A training that was killed continues. --quick
measures little, into build/quick, and is for trying the code. --render only writes docs/RESULTS.md
from the existing records.
"""

import argparse
import sys
import time
from pathlib import Path

from benchmarks.records import show, write_records
from motiondiff_edu._files import replacing
from motiondiff_edu.pretrained import checkpoints
from motiondiff_edu.viz.metrics import footstep_curves

from .course.exercises import course_records
from .course.shown import shown_records
from .dances import budget as dance_budget
from .dances import real_music
from .dances.attention import attention_picture, attention_records
from .dances.guided import guided_records
from .dances.hearing import hearing_records
from .dances.parts import (
    DANCE_FULL,
    DANCE_QUICK,
    DANCES,
    Stage,
    dance_records,
    data_records,
)
from .dances.timing import TIMED, time_records
from .inbetweens import departures, inbetween, known_answer
from .page.cards import add_metrics
from .page.render import render
from .recordings import continuations, persons, reconstructions, trainings
from .recordings import inbetweens as recorded_inbetweens
from .recordings import windows as recorded
from .repairs import both, dropout, mend, repair
from .repairs.trials import names_of
from .walks import ladder
from .walks.parts import (
    FULL,
    LINES,
    QUICK,
    Bench,
    Walks,
    footstep_records,
    walker_records,
    weights_digest,
)
from .words import budget as word_budget
from .words import parts as words

DOCS, RUNS = Path("docs"), Path("build/runs")
MEASURED = (
    "footsteps",
    "dance-data",
    "attention",
    "dance-time",
    "known-answer",
    "course",
)  # parts that need shipped weights, or none
FILLS_IN, MASKED = departures.SHOWN, departures.NOT_SHOWN  # the weights of in-betweens
MENDED = {  # parts that need these weights
    "mend": {"walker", "walker-plain", *names_of("plain"), *names_of("dropout")},
    "mend-both": {both.WALKER, MASKED},
    "inbetween": {FILLS_IN, MASKED},
    "inbetween-departures": {FILLS_IN, MASKED},
    "words": {"mover"},
    "guided": {"dancer"},
    "ear": {"dancer"},
}
TRAINED = {
    "ladder": ("pace", "rates", *ladder.CELLS),
    "dance-budget": tuple(dance_budget.VARIANTS),
    "mend-map": tuple(dropout.RATES),
    "words-budget": tuple(word_budget.VARIANTS),
    "inbetween-budget": tuple(trainings.VARIANTS),
}
# by name alone: recordings are not part of the project, pages are made before
BY_NAME = (
    "recordings", "recordings-inbetweens", "recordings-reconstructions", "inbetween-budget",
    "real-music", "course-shown",
)  # fmt: skip
ROUNDS = 7  # of dance-time


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
    parser.add_argument(
        "--render",
        action="store_true",
        help="only write docs/RESULTS.md, from the existing records",
    )
    return parser.parse_args()


def main() -> None:
    chosen = arguments()
    docs = Path("build/quick") if chosen.quick else DOCS
    if not chosen.render:
        measure(chosen, docs / "results")
    if not chosen.quick:
        add_metrics(docs / "results")
    render(docs)
    print(f"written: {docs / 'RESULTS.md'}")


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


def parts_of(only: list[str], full: bool, lines: dict[str, Walks], weights: set[str]) -> list[str]:
    """The chosen parts, row by row.

    Without a choice these are all parts that have weights, and with `full` those that train.

    Exits with the list of names when one is unknown.
    """
    there = [prefix for prefix, line in lines.items() if line.name in weights]
    there += [part for part, name in DANCES.items() if name in weights]
    there += [part for part in MEASURED if part != "attention" or "dancer" in weights]
    there += [part for part, names in MENDED.items() if names <= weights]
    rows = {part: [f"{part}.{name}" for name in names] for part, names in TRAINED.items()}
    trained = [part for part in rows if part not in BY_NAME] if full else []
    wanted = only or [*there, *trained]
    parts = [row for part in wanted for row in rows.get(part, [part])]
    names = [*lines, *DANCES, *MEASURED, *MENDED, *BY_NAME]
    unknown = sorted(set(parts) - {*names, *(row for group in rows.values() for row in group)})
    if unknown:
        there = ", ".join(dict.fromkeys([*names, *rows]))
        sys.exit(
            f"no part is called {', '.join(unknown)}; there are: {there}; rows: "
            "ladder.ours, dance-budget.v ..."
        )
    return parts


def measure(chosen: argparse.Namespace, folder: Path) -> None:
    """Run the chosen parts and write their records.

    The records of all other parts stay as they are.
    """
    extra = weights_of(chosen.weights)
    bench = Bench(QUICK if chosen.quick else FULL, extra)
    lines = LINES | {name: Walks(name, name) for name in extra}
    stage = Stage(DANCE_QUICK if chosen.quick else DANCE_FULL, extra)
    suffix = " --quick" * chosen.quick + "".join(f" --weights {item}" for item in chosen.weights)
    for part in parts_of(chosen.only, chosen.full, lines, set(bench.weights)):
        began = time.monotonic()
        command = f"python -m tools.results --only {part}{suffix}"
        records = records_of(part, chosen.quick, bench, stage, lines, folder, command)
        show([one for one in records if one["value"] is not None])
        write_records(folder / f"{part}.json", records)
        print(f"{part}: {time.monotonic() - began:.0f} s", flush=True)


def records_of(
    part: str, quick: bool, bench: Bench, stage: Stage, lines, folder: Path, command: str
) -> list[dict]:
    """The records of one part; its figure, where it has one, is written beside them."""
    group, _, row = part.partition(".")
    if group == "ladder":
        size, runs = (ladder.QUICK, folder / "runs") if quick else (ladder.FULL, RUNS / group)
        return ladder.measure(row, folder / group, runs, size, command)
    if group == "dance-budget":
        size, runs = (
            (dance_budget.QUICK, folder / "runs") if quick else (dance_budget.FULL, RUNS / group)
        )
        return dance_budget.budget_records(row, size, runs, command)
    if group == "mend-map":
        size, runs = (
            (dropout.MAP_QUICK, folder / "map") if quick else (dropout.MAP_FULL, RUNS / group)
        )
        return dropout.map_records(row, size, bench.trials, runs, command)
    if part == "mend":
        return mend.records(bench, repair.QUICK if quick else repair.FULL, command)
    if part in ("inbetween", "inbetween-departures"):
        networks = {
            name: (checkpoints.load(stage.weights[name]), weights_digest(stage.weights[name]))
            for name in (FILLS_IN, MASKED)
        }
        size = inbetween.QUICK if quick else inbetween.FULL
        if part == "inbetween":
            return inbetween.inbetween_records(*networks.values(), size, command)
        return departures.departure_records(networks, size, command)
    if part == "mend-both":
        size = repair.QUICK if quick else repair.FULL
        return both.both_records(bench, stage.dancer(MASKED), size, command)
    if part in ("recordings", "recordings-reconstructions"):
        path = bench.weights["walker"]
        size = recorded.QUICK if quick else recorded.FULL
        measured = checkpoints.load_walker(path), weights_digest(path), size, command
        if part == "recordings-reconstructions":
            return reconstructions.reconstruction_records(*measured)
        return [*continuations.recorded_records(*measured), *persons.person_records(*measured)]
    if part == "recordings-inbetweens":
        return recorded_inbetweens.inbetween_records(
            checkpoints.load(stage.weights[FILLS_IN]),
            weights_digest(stage.weights[FILLS_IN]),
            recorded.QUICK if quick else recorded.FULL,
            command,
            recorded_inbetweens.on_all_cores,
        )
    if part == "real-music":
        return real_music.music_records(
            stage.dancer("dancer"),
            weights_digest(stage.weights["dancer"]),
            real_music.QUICK if quick else real_music.FULL,
            command,
        )
    if part == "guided":
        return guided_records(stage, command)
    if part == "ear":
        return hearing_records(stage, command)
    if part == "dance-data":
        return data_records(stage, command)
    if part == "words":
        studio = words.Studio(words.size_of(quick), bench.weights)
        return words.word_records(studio, command, words.on_all_cores)
    if group == "inbetween-budget":
        budget = trainings.QUICK if quick else trainings.FULL
        runs = folder / "runs" if quick else RUNS / group
        return trainings.budget_records(row, budget, runs, command)
    if group == "words-budget":
        size, runs = (
            (word_budget.QUICK, folder / "runs") if quick else (word_budget.FULL, RUNS / group)
        )
        return word_budget.budget_records(row, size, words.panel_of(size.trials), runs, command)
    if part == "known-answer":
        return known_answer.known_answer_records(
            known_answer.QUICK if quick else known_answer.FULL, command
        )
    if part == "course-shown":
        return shown_records(command)
    if part == "course":
        return course_records(command, 3 if quick else None)
    if part == "dance-time":
        size, rounds = (dance_budget.QUICK, 2) if quick else (dance_budget.FULL, ROUNDS)
        return time_records(TIMED, size, rounds, command)
    if part == "footsteps":
        records, curves = footstep_records(bench, command)
        save(
            footstep_curves({k: v for k, v in curves.items() if not k.endswith("-robust")}),
            folder / "footsteps.png",
        )
        return records
    if part == "attention":
        save(attention_picture(stage), folder / "attention.png")
        return attention_records(stage, command)
    if part in DANCES:
        return dance_records(stage, part, command)
    return walker_records(bench, lines[part], command)


def save(figure, path: Path) -> None:
    with replacing(path) as aside:
        figure.savefig(aside, dpi=110, format="png")


if __name__ == "__main__":
    main()
