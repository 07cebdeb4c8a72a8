"""Measure into docs/results, and write docs/RESULTS.md from it.

    python -m tools.results [--only PART ...] [--quick] [--weights NAME=FILE] [--render]

Parts: walker-eps, walker-x0, walker-ddim10, their -lookahead lines, footsteps, budget (which trains; one row of it:
budget.T_p-5), dancer, dancer-plain, regression, unheard (music like none in training). --quick
measures little, into build/quick, and is for trying the code; --render only writes docs/RESULTS.md from the records
that are there.
"""

import argparse
import sys
import time
from pathlib import Path

from benchmarks.records import show, write_records
from motiondiff_edu.files import replacing
from motiondiff_edu.viz.metrics import footstep_curves

from . import budget
from .cards import add_metrics
from .dance_parts import DANCE_FULL, DANCE_QUICK, DANCES, Stage, dance_records
from .parts import FULL, LINES, QUICK, Bench, Walks, alias_records, footstep_records, walker_records
from .render import render

DOCS, OTHERS = Path("docs"), ("footsteps", "budget")


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m tools.results", description=__doc__)
    parser.add_argument("--only", nargs="+", default=[], metavar="PART", help="only these parts")
    parser.add_argument("--quick", action="store_true", help="few clips; written to build/quick")
    parser.add_argument("--weights", nargs="+", default=[], metavar="NAME=FILE", help="weights that are not shipped")
    parser.add_argument("--render", action="store_true", help="only docs/RESULTS.md, from the records there")
    return parser.parse_args()


def main() -> None:
    asked = arguments()
    docs = Path("build/quick") if asked.quick else DOCS
    if not asked.render:
        measure(asked, docs / "results")
    write_records(docs / "results" / "walker.json", alias_records(docs / "results"))
    if not asked.quick:
        add_metrics(docs / "results")
    render(docs)
    print(f"written: {docs / 'RESULTS.md'}")


def weights_of(items: list[str]) -> dict[str, Path]:
    """NAME=FILE, for weights that are not shipped."""
    pairs = [item.partition("=") for item in items]
    bad = next((item for item, (_, _, file) in zip(items, pairs, strict=True) if not Path(file).is_file()), None)
    if bad:
        sys.exit(f"--weights takes NAME=FILE with a weights file that exists, not {bad!r}")
    return {name: Path(file) for name, _, file in pairs}


def measure(asked: argparse.Namespace, folder: Path) -> None:
    """Run the parts asked for (all that have weights, when none is named) and write their records."""
    extra = weights_of(asked.weights)
    bench, lines = Bench(QUICK if asked.quick else FULL, extra), LINES | {name: Walks(name, name) for name in extra}
    options = " --quick" * asked.quick + "".join(f" --weights {item}" for item in asked.weights)
    stage = Stage(DANCE_QUICK if asked.quick else DANCE_FULL, extra)
    there = [prefix for prefix, line in lines.items() if line.name in bench.weights]
    there += [part for part, name in DANCES.items() if name in stage.weights]
    rows = [f"budget.{name}" for name in budget.VARIANTS]
    parts = [row for part in asked.only or [*there, *OTHERS] for row in (rows if part == "budget" else [part])]
    unknown = set(parts) - set(lines) - set(OTHERS) - set(rows) - set(DANCES)
    if unknown:
        there = ", ".join([*lines, *OTHERS, *DANCES])
        sys.exit(f"no part is called {', '.join(sorted(unknown))}; there are: {there}")
    for part in parts:
        began, command = time.monotonic(), f"python -m tools.results --only {part}{options}"
        if part == "footsteps":
            records, curves = footstep_records(bench, command)
            figure = footstep_curves({k: v for k, v in curves.items() if not k.endswith("-robust")})
            with replacing(folder / "footsteps.png") as aside:
                figure.savefig(aside, dpi=110, format="png")
        elif part in rows:
            size = budget.FULL if bench.size == FULL else budget.QUICK
            records = budget.budget_records(part.removeprefix("budget."), size, command)
        elif part in DANCES:
            records = dance_records(stage, part, command)
        else:
            records = walker_records(bench, lines[part], command)
        show([one for one in records if one["value"] is not None])
        write_records(folder / f"{part}.json", records)
        print(f"{part}: {time.monotonic() - began:.0f} s")


if __name__ == "__main__":
    main()
