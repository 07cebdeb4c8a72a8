"""`motiondiff-edu collect FOLDER`: run the exercises of many students' copies, into a table.

Nothing of a copy is read or run here: that is done by `trial`, in a process of its own.
"""

import argparse
import contextlib
import csv
import io
import json
import os
import re
import secrets
import select
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from .._files import check_writable, replacing
from . import answers, fence
from .answers import DIED, OPEN, RIGHT, SLOW
from .places import notebook_folder

HELP = "run the exercises of many students' copies, and show which mistakes a class makes"
EXAMPLE = "collect handed_in --out class.csv"
ABSENT = "no copy"
SIGNS = {RIGHT: "+", OPEN: ".", ABSENT: " "}  # all others: x
WIDEST = 40  # characters of a student's name in the table
COPIES = 20  # of one notebook by one student; the others, that changed earlier, are left out
DEEPEST = 50  # folders, one in the other
PREPARED = 300  # seconds to prepare a notebook's names
GRACE = 5  # seconds more than an answer has, for `trial` to end it and to say so
MARK = "MOTIONDIFF_COLLECT"  # environment variable of all processes that come of a runner


class CollectError(ValueError):
    """There is nothing to collect."""


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of `collect`."""
    parser.description = (
        "Run the exercises of many students' copies. FOLDER has a folder for each student, with "
        "copies of the notebooks in it (deeper folders are looked into, too; of several copies "
        "the newest attempt at each exercise counts). Every answer runs in a process and an empty "
        "folder of its own with limits of time and, on Linux, of memory and of where it writes. "
        "With it runs what the student's cells before it define: imports, functions, classes, "
        "values. That keeps answers apart; it is no protection against malice: do not run code of "
        "people whom you do not trust."
    )
    parser.add_argument("folder", type=Path, metavar="FOLDER")
    parser.add_argument("--out", type=Path, metavar="FILE.csv", help="also write all results here")
    parser.add_argument("--overwrite", action="store_true", help="replace an existing FILE.csv")
    parser.add_argument(
        "--only", nargs="+", default=[], metavar="NB", help="only these notebooks, 02 for instance"
    )
    parser.add_argument("--seconds", type=int, default=20, help="for each answer (default: 20)")
    parser.add_argument(
        "--gigabytes", type=float, default=2.0, help="of memory for each answer (default: 2)"
    )


def run(chosen: argparse.Namespace) -> int:
    """Try all answers, print the table and what several people made wrong, write the CSV file."""
    if not hasattr(os, "fork"):
        raise CollectError("collect needs a system with fork: Linux, macOS, or WSL on Windows")
    if chosen.seconds < 1 or chosen.gigabytes <= 0:
        raise CollectError("--seconds must be 1 or more, and --gigabytes above 0")
    if chosen.out:
        if chosen.out.exists() and not chosen.overwrite:
            raise CollectError(f"{chosen.out} exists: choose another name, or add --overwrite")
        check_writable(chosen.out)
    if can := fence.without(fence.version()):
        progress(f"on this system an answer can {', '.join(can)}: collect only from whom you trust")
    copies = copies_of(chosen.folder, chosen.only)
    rows, whole = results(copies, chosen.seconds, chosen.gigabytes)
    say(table(rows))
    say(mistakes(rows))
    if chosen.out:
        with replacing(chosen.out) as part:
            part.write_text(as_csv(rows), encoding="utf-8-sig")  # by which Excel knows UTF-8
        say(f"written: {chosen.out}")
    return 0 if whole else 1


def say(text: str) -> None:
    """Print it, with escapes for what the terminal's encoding does not have."""
    encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
    print(text.encode(encoding, "backslashreplace").decode(encoding))


def copies_of(folder: Path, only: list[str]) -> dict[tuple[str, str], list[Path]]:
    """{(student, notebook's number): the copies, that changed last first}. Raises CollectError.

    There may be several: `lab --fresh` keeps the old copy beside the new one.
    """
    if not folder.is_dir():
        raise CollectError(f"{folder} is no folder; it should have a folder for each student")
    wanted = {number_of(f"{number.zfill(2)}.") for number in only}
    if "" in wanted:
        raise CollectError(f"--only takes numbers of notebooks, 02 for instance, not {only}")
    found: dict[tuple[str, str], list[Path]] = {}
    others = []
    for path in sorted(_notebooks(folder)):
        who, *inside = path.relative_to(folder).parts
        number = number_of(path.name)
        if number and inside and (not wanted or number in wanted):
            found.setdefault((name_of(who), number), []).append(path)
        elif not number or not inside:
            others.append(name_of(str(path.relative_to(folder))))
    if others:
        progress(
            f"left out, for they are in no student's folder or have another name than the "
            f"notebooks of the course: {', '.join(others)}"
        )
    if not found:
        raise CollectError(
            f"{folder} has no copies of the notebooks; expected for instance "
            f"{folder / 'a_student' / '02_noise.ipynb'}"
        )
    students = {name_of(path.name) for path in folder.glob("[!.]*") if os.path.isdir(path)}
    if none := sorted(students - {who for who, _ in found}):
        progress(f"no copies were found in the folders: {', '.join(none)}")
    for (who, number), paths in found.items():
        inside = {path.relative_to(folder).parts[1:-1] for path in paths}
        if len(inside) > 1:
            progress(
                f"{who} has copies of {number} in several folders, and the newest attempt at each "
                f"exercise counts. Is {folder} one folder too high?"
            )
    return {key: sorted(paths, key=_changed, reverse=True) for key, paths in found.items()}


@cache
def course_names() -> dict[str, str]:
    """The names of the course's notebooks without .ipynb, by number."""
    paths = (notebook_folder() / "student").glob("[0-9][0-9]_*.ipynb")
    return {path.name[:2]: path.stem for path in sorted(paths)}


def number_of(name: str) -> str:
    """Which notebook a file is by its name: 02_noise, "Copy of 02_noise", 02-noise-1; or ""."""
    for number, stem in course_names().items():
        if re.search(re.escape(stem).replace("_", "[_ -]"), name, re.I):
            return number
    numbered = re.match(r"(\d\d)(_|[ .-](?!\d))", name)  # and no date
    return numbered[1] if numbered else ""


def _notebooks(folder: Path) -> Iterator[Path]:
    """All that has a notebook's ending in the students' folders, also a folder of such a name.

    What cannot be listed is left out. A student's folder may be a link; no other one is followed.
    """
    yield from folder.glob("*.ipynb")  # beside the folders; they are named and left out
    todo = [(path, 1) for path in folder.iterdir() if path.name != ".ipynb_checkpoints"]
    while todo:
        inside, depth = todo.pop()
        with contextlib.suppress(OSError):
            for path in inside.iterdir():
                if path.suffix.lower() == ".ipynb":
                    yield path
                skipped = os.path.islink(path) or path.name == ".ipynb_checkpoints"
                if depth < DEEPEST and not skipped and os.path.isdir(path):
                    todo.append((path, depth + 1))


def name_of(folder: str) -> str:
    """The student's name: that of the folder, printable, and another one for each folder."""
    return printable(folder.replace("\\", "\\\\"))


def printable(text: str) -> str:
    """The text with escapes (\\n, \\x1b, \\udce9) for what does not print."""
    return "".join(
        one if one.isprintable() else one.encode("unicode_escape").decode() for one in text
    )


def _changed(path: Path) -> float:
    """When it changed; 0 for a link that leads nowhere."""
    try:
        return path.stat().st_mtime
    except OSError:
        return 0.0


def results(
    copies: dict[tuple[str, str], list[Path]], seconds: int, gigabytes: float
) -> tuple[list[dict], bool]:
    """The rows of all notebooks (`results_of`), and whether all could be prepared.

    Raises CollectError where there is no row.
    """
    rows, failed = [], []
    for number in sorted({number for _, number in copies}):
        own = next(iter(sorted((notebook_folder() / "student").glob(f"{number}_*.ipynb"))), None)
        theirs = {who: paths for (who, nb), paths in copies.items() if nb == number}
        copies_there = sum(map(len, theirs.values()))
        count = f"{copies_there} {'copy' if copies_there == 1 else 'copies'}"
        if own is None:
            progress(f"notebook {number}: {count} left out, the course has no such notebook")
            continue
        progress(f"notebook {number}: {count} ...")
        try:
            rows += results_of(own, theirs, seconds, gigabytes)
        except CollectError as error:  # the other notebooks are tried all the same
            progress(str(error))
            failed.append(error)
    if not rows:
        raise failed[0] if failed else CollectError("the course has no exercises for these copies")
    return rows, not failed


def progress(text: str) -> None:
    """Print it beside the results."""
    print(text, file=sys.stderr, flush=True)


def results_of(
    own: Path, copies: dict[str, list[Path]], seconds: int, gigabytes: float
) -> list[dict]:
    """A row {"student", "notebook", "exercise", "result", "message"} for each exercise of each.

    `own` is the course's notebook. Raises CollectError where it cannot be prepared.
    """
    exercises = answers.exercises(own)
    rows: list[dict] = []
    if not exercises:
        return rows
    with Runner(own, seconds, gigabytes) as runner:
        for who, paths in copies.items():
            for name in exercises:
                result, message = runner.ask(name, paths[:COPIES])
                rows.append({
                    "student": who, "notebook": own.name[:2], "exercise": name,
                    "result": result, "message": printable(message),
                })  # fmt: skip
    return rows


class Runner:
    """`trial` for one notebook, in a process of its own: a result for each question.

    It is started anew after it died or gave no result in time. Whatever is run there, `ask` has a
    result in the end, and one answer's does not depend on another's.
    """

    def __init__(self, notebook: Path, seconds: int, gigabytes: float) -> None:
        self.notebook = notebook.resolve()
        self.seconds = seconds
        self.gigabytes = gigabytes
        self.mark = secrets.token_hex(16)
        self.process: subprocess.Popen[bytes] | None = None

    def __enter__(self) -> "Runner":
        self._start()
        return self

    def __exit__(self, *error: object) -> None:
        self._stop()

    def ask(self, check: str, paths: list[Path]) -> tuple[str, str]:
        """The result of a check, and a message: the answer is in one of these copies."""
        question = {
            "check": check, "paths": [str(path.absolute()) for path in paths],
            "seconds": self.seconds, "gigabytes": self.gigabytes,
        }  # fmt: skip
        while True:
            new = self.process is None
            try:
                if new:
                    self._start()
                with _empty_folder() as folder:
                    return self._result(question | {"folder": folder}, self.seconds + GRACE)
            except TimeoutError:
                failed = SLOW, f"stopped after {self.seconds} s"
            except EOFError as error:
                failed = DIED, f"it ended the process that runs the answers: {error}"
            except (CollectError, OSError, subprocess.TimeoutExpired) as error:
                failed = DIED, str(error)
            self._stop()
            if new:  # in an old one the answers before may have done the harm
                return failed

    def _start(self) -> None:
        """Prepare the notebook's names in a new process. Raises CollectError."""
        command = [sys.executable, "-m", "motiondiff_edu.course.trial", str(self.notebook)]
        package = str(Path(__file__).parents[2])  # this one, also where another is installed
        path = os.pathsep.join([package, *filter(None, [os.environ.get("PYTHONPATH")])])
        own = {"OMP_NUM_THREADS": "1", "MPLBACKEND": "Agg", "PYTHONPATH": path, MARK: self.mark}
        with tempfile.TemporaryFile() as told, _empty_folder() as folder:
            self.process = subprocess.Popen(
                command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=told,
                bufsize=0,
                cwd=folder,
                env=os.environ | own,
                start_new_session=True,
            )
            try:
                self._result({}, PREPARED)
            except BaseException as error:
                self._stop()
                if not isinstance(error, EOFError | TimeoutError):
                    raise
                told.seek(0)
                last = told.read().decode("utf-8", "replace").strip().splitlines()[-1:]
                why = last[0] if last else error
                raise CollectError(f"{self.notebook.name} cannot be prepared: {why}") from None

    def _result(self, question: dict, seconds: float) -> tuple[str, str]:
        """Ask, and wait for the result. Raises TimeoutError, or EOFError when the process ended.

        What is no result of this question is passed over.
        """
        assert self.process and self.process.stdin and self.process.stdout
        until = time.monotonic() + seconds
        token = secrets.token_hex(16)
        line = b"\n" + json.dumps(question | {"token": token}).encode() + b"\n"
        os.set_blocking(self.process.stdin.fileno(), False)  # it may have been stopped
        with contextlib.suppress(BrokenPipeError):  # how it ended is found below
            if self.process.stdin.write(line) != len(line):
                raise EOFError("it takes no questions")
        rest = b""
        while (left := until - time.monotonic()) > 0:
            if not select.select([self.process.stdout], [], [], min(left, 0.5))[0]:
                if self.process.poll() is None:
                    continue
                raise EOFError(answers.ending(self.process.returncode))
            new = os.read(self.process.stdout.fileno(), 2**16)
            if not new:
                raise EOFError(answers.ending(self.process.wait(GRACE)))
            *lines, rest = (rest + new).split(b"\n")
            rest = rest[-(2**16) :]
            for found in (answers.read_back(one, token) for one in lines):
                if found:
                    return found
        raise TimeoutError("it takes too long")

    def _stop(self) -> None:
        """End the process and, as far as they can be found, all that came of it."""
        if self.process is None:
            return
        with contextlib.suppress(OSError):
            os.killpg(self.process.pid, signal.SIGKILL)
        with contextlib.suppress(subprocess.TimeoutExpired):
            self.process.wait(GRACE)
        for stream in (self.process.stdin, self.process.stdout):
            if stream:
                stream.close()
        self.process = None
        _end_marked(self.mark.encode())


@contextlib.contextmanager
def _empty_folder() -> Iterator[str]:
    """A new folder, that is removed with all that was put there."""
    folder = tempfile.mkdtemp(prefix="motiondiff_collect_")
    try:
        yield folder
    finally:
        with contextlib.suppress(OSError, RecursionError):
            shutil.rmtree(folder)
        if os.path.lexists(folder):  # unlike shutil, rm removes folders however deep they lie
            subprocess.run(["rm", "-rf", "--", folder], stderr=subprocess.DEVNULL)


def _end_marked(mark: bytes) -> None:
    """On Linux, end the processes whose environment has this mark."""
    for _ in range(3):  # they may start others meanwhile
        for path in Path("/proc").glob("[0-9]*/environ"):
            with contextlib.suppress(OSError):
                if mark in path.read_bytes():
                    os.kill(int(path.parent.name), signal.SIGKILL)


def table(rows: list[dict]) -> str:
    """A line for each student, a sign for each exercise: + right, x wrong, . not attempted."""
    columns = list(dict.fromkeys((row["notebook"], row["exercise"]) for row in rows))
    students = sorted({row["student"] for row in rows})
    result = {(row["student"], row["notebook"], row["exercise"]): row["result"] for row in rows}
    width = min(WIDEST, max(map(len, students)))
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
        name = who if len(who) <= width else who[: width - 1] + "~"
        lines.append(f"{name:{width}}  {' '.join(groups)}  {right} of {len(columns)}")
    return "\n".join(["", *lines, "", "+ right   x wrong or failed   . not attempted", ""])


def mistakes(rows: list[dict], most: int = 12) -> str:
    """The messages that several people have, the commonest first."""
    counts = Counter(
        (row["notebook"], row["exercise"], row["message"])
        for row in rows
        if row["result"] not in (RIGHT, OPEN)
    )
    lines = [
        f"{count:3d} x  {number} {name}: {message}"
        for (number, name, message), count in counts.most_common(most)
        if count > 1
    ]
    return "\n".join(["Mistakes that several people made:", *(lines or ["none"]), ""])


def as_csv(rows: list[dict]) -> str:
    """The results as a table, a row for each exercise of each student."""
    text = io.StringIO()
    fields = ("student", "notebook", "exercise", "result", "message")
    writer = csv.DictWriter(text, fields, lineterminator="\n")
    writer.writeheader()
    writer.writerows({name: no_formula(row[name]) for name in fields} for row in rows)
    return text.getvalue()


def no_formula(text: str) -> str:
    """The text; with a quote before it where a spreadsheet would calculate it."""
    return f"'{text}" if text.startswith(("=", "+", "-", "@", "\t", "\r")) else text
