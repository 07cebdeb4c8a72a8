"""`motiondiff-edu collect FOLDER`: run the exercises of many students' copies, into a table."""

import argparse
import csv
import io
import json
import os
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

from .._files import check_writable, replacing
from . import answers
from .answers import OPEN, RIGHT, UNREADABLE, Answer
from .places import notebook_folder

HELP = "run the exercises of many students' copies, and show which mistakes a class makes"
EXAMPLE = "collect handed_in --out class.csv"
ABSENT = "no copy"
SIGNS = {RIGHT: "+", OPEN: ".", ABSENT: " "}  # all others: x


class CollectError(ValueError):
    """There is nothing to collect."""


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of `collect`."""
    parser.description = (
        "Run the exercises of many students' copies. FOLDER has a folder for each student, with "
        "copies of the notebooks in it (deeper folders are looked into, too). Every answer runs "
        "in a process of its own with limits of time and, on Linux, of memory. With it runs "
        "what the student's cells before it define: imports, functions, classes, plain values. "
        "That keeps answers apart; it is no protection against malice: do not run code of people "
        "whom you do not trust."
    )
    parser.add_argument("folder", type=Path, metavar="FOLDER")
    parser.add_argument("--out", type=Path, metavar="FILE.csv", help="also write all results here")
    parser.add_argument(
        "--only", nargs="+", default=[], metavar="NB", help="only these notebooks, 02 for instance"
    )
    parser.add_argument("--seconds", type=int, default=20, help="for each answer (default: 20)")
    parser.add_argument(
        "--gigabytes", type=float, default=2.0, help="of memory for each answer (default: 2)"
    )


def run(chosen: argparse.Namespace) -> int:
    """Try all answers, print the table and the commonest mistakes, write the CSV file."""
    if not hasattr(os, "fork"):
        raise CollectError("collect needs a system with fork: Linux, macOS, or WSL on Windows")
    if chosen.seconds < 1 or chosen.gigabytes <= 0:
        raise CollectError("--seconds must be 1 or more, and --gigabytes above 0")
    if chosen.out:
        check_writable(chosen.out)
    copies = copies_of(chosen.folder, chosen.only)
    rows = []
    for number in sorted({number for _, number in copies}):
        theirs = {who: paths for (who, nb), paths in copies.items() if nb == number}
        count = sum(map(len, theirs.values()))
        print(f"notebook {number}: {count} copies ...", file=sys.stderr, flush=True)
        rows += results_of(number, theirs, chosen.seconds, chosen.gigabytes)
    print(table(rows))
    print(mistakes(rows))
    if chosen.out:
        with replacing(chosen.out) as part:
            part.write_text(as_csv(rows), encoding="utf-8")
        print(f"written: {chosen.out}")
    return 0


def copies_of(folder: Path, only: list[str]) -> dict[tuple[str, str], list[Path]]:
    """{(student, notebook's number): the copies, that changed last first}. Raises CollectError.

    There may be several: `lab --fresh` keeps the old copy beside the new one.
    """
    if not folder.is_dir():
        raise CollectError(f"{folder} is no folder; it should have a folder for each student")
    wanted = {number.zfill(2) for number in only}
    found: dict[tuple[str, str], list[Path]] = {}
    for path in sorted(folder.glob("*/**/[0-9][0-9]_*.ipynb")):
        if ".ipynb_checkpoints" in path.parts or (wanted and path.name[:2] not in wanted):
            continue
        who = printable(path.relative_to(folder).parts[0])
        found.setdefault((who, path.name[:2]), []).append(path)
    if not found:
        raise CollectError(
            f"{folder} has no copies of the notebooks; expected for instance "
            f"{folder / 'a_student' / '02_noise.ipynb'}"
        )
    return {key: sorted(paths, key=_changed, reverse=True) for key, paths in found.items()}


def printable(name: str) -> str:
    """A folder's name; bytes that are no UTF-8 are written as \\udce9 and the like."""
    return name.encode("utf-8", "backslashreplace").decode("utf-8")


def _changed(path: Path) -> float:
    return path.stat().st_mtime


def results_of(
    number: str, copies: dict[str, list[Path]], seconds: int, gigabytes: float
) -> list[dict]:
    """A row {"student", "notebook", "exercise", "result", "message"} for each exercise of each."""
    own = next(iter(sorted((notebook_folder() / "student").glob(f"{number}_*.ipynb"))), None)
    if own is None:
        raise CollectError(f"the course has no notebook {number}")
    handed_out = answers.of_copy(own)
    rows = []
    todo = []
    for who, paths in copies.items():
        try:
            given = attempts(paths, handed_out)
        except answers.CopyError as error:
            rows += [_row(who, number, name, UNREADABLE, str(error)) for name in handed_out]
            continue
        for name in handed_out:
            rows.append(_row(who, number, name, OPEN, "its cell is gone"))
            if name in given:
                answer = {"source": given[name].source, "before": given[name].before}
                todo.append((rows[-1], {"check": name, **answer}))
    if todo:
        found = run_all(own, [answer for _, answer in todo], seconds, gigabytes)
        for (row, _), (result, message) in zip(todo, found, strict=True):
            row |= {"result": result, "message": message}
    return rows


def attempts(paths: list[Path], handed_out: dict[str, Answer]) -> dict[str, Answer]:
    """{check: the answer of the first copy that has one; else the cell as it was handed out}.

    Raises CopyError where no copy can be read.
    """
    found: dict[str, Answer] = {}
    failed = []
    for path in reversed(paths):  # so the first one has the last word
        try:
            given = answers.of_copy(path)
        except answers.CopyError as error:
            failed.append(error)
            continue
        for name in handed_out.keys() & given.keys():
            if name not in found or given[name].source != handed_out[name].source:
                found[name] = given[name]
    if len(failed) == len(paths):
        raise failed[0]
    return found


def _row(who: str, number: str, name: str, result: str, message: str) -> dict:
    return {
        "student": who, "notebook": number, "exercise": name, "result": result, "message": message,
    }  # fmt: skip


def run_all(notebook: Path, todo: list[dict], seconds: int, gigabytes: float) -> list[list[str]]:
    """(result, message) of each answer, from `trial` in another process and an empty folder."""
    given = {"answers": todo, "seconds": seconds, "gigabytes": gigabytes}
    with tempfile.TemporaryDirectory(prefix="motiondiff_collect_") as folder:
        empty, results = Path(folder) / "empty", Path(folder) / "results.json"
        empty.mkdir()
        command = [sys.executable, "-m", "motiondiff_edu.course.trial", str(notebook.resolve())]
        done = subprocess.run(
            [*command, str(results)],
            input=json.dumps(given),
            stdout=subprocess.DEVNULL,  # whatever runs there may write to it
            stderr=subprocess.PIPE,
            text=True,
            cwd=empty,
            env=os.environ | {"OMP_NUM_THREADS": "1", "MPLBACKEND": "Agg"},
        )
        if done.returncode:
            last = (done.stderr.strip().splitlines() or ["it ended without a word"])[-1]
            raise CollectError(f"{notebook.name} cannot be prepared: {last}")
        return json.loads(results.read_text(encoding="utf-8"))


def table(rows: list[dict]) -> str:
    """A line for each student, a sign for each exercise: + right, x wrong, . not attempted."""
    columns = list(dict.fromkeys((row["notebook"], row["exercise"]) for row in rows))
    students = sorted({row["student"] for row in rows})
    result = {(row["student"], row["notebook"], row["exercise"]): row["result"] for row in rows}
    width = max(map(len, students))
    numbers = list(dict.fromkeys(number for number, _ in columns))
    head = " ".join(
        f"{number:<{max(2, sum(one == number for one, _ in columns))}}" for number in numbers
    )
    lines = [f"{'':{width}}  {head}"]
    for who in students:
        groups, right = [], 0
        for number in numbers:
            results = [result.get((who, n, name), ABSENT) for n, name in columns if n == number]
            right += results.count(RIGHT)
            groups.append(f"{''.join(SIGNS.get(one, 'x') for one in results):<2}")
        lines.append(f"{who:{width}}  {' '.join(groups)}  {right} of {len(columns)}")
    return "\n".join(["", *lines, "", "+ right   x wrong or failed   . not attempted", ""])


def mistakes(rows: list[dict], most: int = 12) -> str:
    """The commonest messages of the class."""
    counts = Counter(
        (row["notebook"], row["exercise"], row["message"])
        for row in rows
        if row["result"] not in (RIGHT, OPEN)
    )
    lines = [
        f"{count:3d} x  {number} {name}: {message}"
        for (number, name, message), count in counts.most_common(most)
    ]
    return "\n".join(["The commonest mistakes:", *(lines or ["none"]), ""])


def as_csv(rows: list[dict]) -> str:
    """The results as a table, a row for each exercise of each student."""
    text = io.StringIO()
    fields = ("student", "notebook", "exercise", "result", "message")
    writer = csv.DictWriter(text, fields, lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()
