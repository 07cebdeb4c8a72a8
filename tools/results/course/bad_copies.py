"""Kinds of bad copies of notebook 02, beside right ones, for `motiondiff-edu collect`.

collect.survives    the share of kinds of bad copies after which a right copy is called right

hand_in(folder)                     two students for each kind: a bad copy, then a right one
collected(folder, out, ...)         what the command prints, and the rows of its CSV file
survivors(rows)                     after which kinds the right copy is right
"""

import csv
import json
import os
import socket
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np

from motiondiff_edu.course.collect import name_of, no_formula

from ..walks.scores import measure_of

NAME = "02_noise.ipynb"
EXERCISE = "constant_beta"
CALL = "checks.constant_beta(mine)"
RIGHT = f"def mine(S, left):\n    return 1 - left ** (2 / S)\n{CALL}"
WRONG = RIGHT.replace("2 / S", "1 / S")
REPORT = "from motiondiff_edu.course.checks import _report"
SECONDS = 2  # the limit that some kinds run into


def notebook(*sources: object) -> dict:
    """A notebook of these code cells."""
    return {"cells": [{"cell_type": "code", "source": one, "metadata": {}} for one in sources]}


def holding(*sources: object) -> Callable[[Path], None]:
    """A kind: a notebook of these cells."""
    return lambda path: path.write_text(json.dumps(notebook(*sources))) and None


def inside(*lines: str) -> Callable[[Path], None]:
    """A kind: these lines in the body of a wrong answer."""
    return holding(
        WRONG.replace("    return", "".join(f"    {one}\n" for one in lines) + "    return")
    )


def first(*lines: str) -> Callable[[Path], None]:
    """A kind: these lines above a wrong answer, in its cell."""
    return holding("\n".join([*lines, WRONG]))


def everywhere(call: str) -> Callable[[Path], None]:
    """A kind: this function of `os` for all descriptors n, and an end."""
    tried = f"for n in range(3, 64):\n    try: os.{call}\n    except OSError: pass"
    return holding("\n".join(["import os", tried, "os._exit(0)", CALL]))


def text(content: str | bytes) -> Callable[[Path], None]:
    """A kind: a file with this content."""
    return lambda path: path.write_bytes(
        content if isinstance(content, bytes) else content.encode()
    )


def link(to: str) -> Callable[[Path], None]:
    """A kind: a link."""
    return lambda path: path.symlink_to(to)


def folder(path: Path) -> None:
    """A folder that is called like the notebook."""
    path.mkdir()


def unreadable(path: Path) -> None:
    """A file that only root can read, and in it a wrong answer."""
    holding(WRONG)(path)
    path.chmod(0)


def listening(path: Path) -> None:
    """A socket."""
    here = Path.cwd()
    os.chdir(path.parent)  # the path of a socket must be short
    try:
        with socket.socket(socket.AF_UNIX) as one:
            one.bind(path.name)
    finally:
        os.chdir(here)


def huge(path: Path) -> None:
    """A file of 10 GB, of which none is on the disk."""
    with path.open("wb") as file:
        file.truncate(10 * 2**30)


def deep_folders(path: Path) -> None:
    """Folders in each other, 1500 deep, beside a wrong answer."""
    holding(WRONG)(path)
    here = Path.cwd()
    os.chdir(path.parent)
    try:
        for _ in range(1500):
            os.mkdir("d")
            os.chdir("d")
    finally:
        os.chdir(here)


FILES: dict[str, Callable[[Path], None]] = {
    "broken_link": link("nowhere"),
    "link_to_itself": link(NAME),
    "link_to_a_folder": link("."),
    "link_to_dev_zero": link("/dev/zero"),
    "link_to_dev_stdin": link("/dev/stdin"),
    "fifo": lambda path: os.mkfifo(path),  # Windows has none, but may import this
    "socket": listening,
    "folder": folder,
    "unreadable": unreadable,
    "huge": huge,
    "deep_folders": deep_folders,
    "empty": text(""),
    "no_json": text("{not json"),
    "cut_off": text(json.dumps(notebook(RIGHT))[:-5]),
    "bytes": text(bytes(range(256)) * 99),
    "utf16": text(json.dumps(notebook(RIGHT)).encode("utf-16")),
    "latin1": text('{"cells": "é"}'.encode("latin-1")),
    "deep_json": text('{"cells": ' + "[" * 100_000 + "]" * 100_000 + "}"),
    "long_number": text('{"cells": [' + "9" * 10_000 + "]}"),
    "a_list": text("[]"),
    "a_number": text("3"),
    "cells_null": text('{"cells": null}'),
    "cells_text": text('{"cells": "abc"}'),
    "cell_without_source": text('{"cells": [{"cell_type": "code"}]}'),
    "metadata_null": text('{"cells": [{"cell_type": "code", "source": "", "metadata": null}]}'),
    "source_a_number": holding(5),
    "source_of_numbers": holding([1, 2]),
    "surrogate": holding(WRONG + "\n'\ud800'"),
    "null_byte": holding(WRONG + "\n'\0'"),
    "half_way": holding("def mine(S, left:\n" + CALL),
    "deep_expression": holding("x = " + "-" * 50_000 + "1\n" + WRONG, WRONG),
    "deep_sum": holding("x = " + "+".join("1" * 50_000) + "\n" + WRONG),
    "deep_brackets": holding("x = " + "(" * 5_000 + ")" * 5_000 + "\n" + WRONG),
    "long_chain": holding("x = a" + ".b" * 50_000 + "\n" + WRONG),
}
LEFT_BEHIND = "import subprocess; subprocess.Popen(['sleep', '318.5'], start_new_session=True)"
ENDINGS: dict[str, Callable[[Path], None]] = {
    "exit_0": inside("import os; os._exit(0)"),
    "exit_3": inside("import os; os._exit(3)"),
    "system_exit": inside("raise SystemExit"),
    "kills_itself": inside("import os; os.kill(os.getpid(), 9)"),
    "kills_its_group": inside("import os; os.killpg(0, 15)"),
    "crash": inside("import ctypes; ctypes.string_at(0)"),
    "recursion": inside("return mine(S, left)"),
    "deep_crash": first(
        "import sys; sys.setrecursionlimit(10**9)",
        "class A: __getattr__ = lambda self, name: getattr(self, name)",
        "A().b",
    ),
    "memory": inside("x = bytearray(3 * 2**40)"),
    "kills_its_parent": inside(LEFT_BEHIND, "import os; os.kill(os.getppid(), 9)"),
    "stops_its_parent": inside("import os, signal; os.kill(os.getppid(), signal.SIGSTOP)"),
    "alarm_off": inside("import signal, time; signal.alarm(0)", "while True: time.sleep(9)"),
    "deaf": inside(
        "import signal, time",
        "for n in range(1, 31):",
        "    if n not in (signal.SIGKILL, signal.SIGSTOP): signal.signal(n, signal.SIG_IGN)",
        "time.sleep(99)",
    ),
    "stops_itself": inside("import os, signal; os.kill(os.getpid(), signal.SIGSTOP)"),
    "threads": inside("import threading, time", "threading.Timer(99, print).start()"),
    "new_session": inside(LEFT_BEHIND),
    "reads_the_input": inside("input()"),
    "no_message": first("class E(Exception):", "    def __str__(self): raise self", "raise E"),
    "long_message": first("raise ValueError('x' * 10**7)"),
    "odd_message": first("raise ValueError('\\x1b[2J\\r\\n\\u202e\\ud800')"),
    "formula": first(f"{REPORT}", "raise _report.CheckFailed('=HYPERLINK(\"x\")')"),
    "deep_leftovers": inside("import os", "for _ in range(1500): os.mkdir('d'); os.chdir('d')"),
    "removes_its_folder": inside("import os, shutil; shutil.rmtree(os.getcwd())"),
    "own_open": first("import os, json", "os._exit = os.write = os.pwrite = json.dumps = None"),
}  # fmt: skip
FOUND = f"_report.FOUND['{EXERCISE}'] = True"
TO_PARENT = (
    "import os\nfor n in range(64):\n"
    "    name = f'/proc/{os.getppid()}/fd/{n}'\n"
    "    try: os.write(os.open(name, os.O_WRONLY | os.O_NONBLOCK), b'{[1')\n"
    "    except OSError: pass"
)  # fmt: skip
FAKES: dict[str, Callable[[Path], None]] = {
    "prints_right": holding(f"print('{EXERCISE}: right. Yes.')\nif 0: {CALL}"),
    "prints_and_fails": first(f"print('{EXERCISE}: right. Yes.')"),
    "check_not_reached": holding(f"if 0: {CALL}"),
    "error_hidden": holding(WRONG.replace(CALL, f"try: {CALL}\nexcept Exception: pass")),
    "own_checks": holding(f"class checks: {EXERCISE} = print\nmine = '{EXERCISE}: right.'\n{CALL}"),
    "replaces_the_check": first(f"checks.{EXERCISE} = lambda mine: print('{EXERCISE}: right.')"),
    "replaces_in_registry": first(REPORT, f"_report.REGISTRY['{EXERCISE}'] = print"),
    "class_body": holding(f"class A:\n    {REPORT}\n    {FOUND}", f"if 0: {CALL}"),
    "class_body_and_wrong": holding(f"class A:\n    {REPORT}\n    {FOUND}", WRONG),
    "class_body_replaces": holding(f"class A:\n    checks.{EXERCISE} = print", WRONG),
    "old_result": everywhere("""write(n, b'["right", ""]')"""),
    "list_for_a_status": everywhere("""write(n, b'["x", ["right"], 5]')"""),
    "garbage_for_a_result": everywhere("write(n, bytes(9999))"),
    "closes_all": everywhere("close(n)"),
    "writes_to_its_parent": first(TO_PARENT),
}  # fmt: skip
KINDS = FILES | ENDINGS | FAKES
# of what ends or fakes an answer, the tests have these; `tools.results --only collect` has all of
# them, and those that run into a limit
TESTED = (
    "exit_0", "exit_3", "system_exit", "kills_itself", "crash", "kills_its_parent", "alarm_off",
    "new_session", "long_message", "odd_message", "formula", "removes_its_folder",
    "prints_right", "check_not_reached", "replaces_the_check", "class_body_and_wrong",
    "list_for_a_status", "closes_all",
)  # fmt: skip
QUICK = (*FILES, *TESTED)
WATCHED = (*list(FILES)[::8], *TESTED)  # after these a right copy must be right
# students' folders, where the name is bad as well
NAMES = {
    "formula": "=1+1",
    "odd_message": "\x1b[2J\n\r\t\u202e",
    "long_message": "x" * 200,
}
if sys.platform == "linux":  # other systems refuse it
    NAMES["surrogate"] = os.fsdecode(b"Ren\xe9")
BESIDE = "~right"


def student(kind: str) -> str:
    """The name of the folder of a kind."""
    return NAMES.get(kind, kind)


def shown(folder: str) -> str:
    """The name of a folder in the table."""
    return no_formula(name_of(folder))


def hand_in(
    class_folder: Path,
    kinds: Iterable[str] = tuple(KINDS),
    beside: Iterable[str] = tuple(KINDS),
) -> None:
    """For each kind a student with a bad copy; after those `beside`, one with a right copy."""
    for kind in kinds:
        (class_folder / student(kind)).mkdir(parents=True)
        KINDS[kind](class_folder / student(kind) / NAME)
        if kind not in beside:
            continue
        (class_folder / (student(kind) + BESIDE)).mkdir()
        holding(RIGHT)(class_folder / (student(kind) + BESIDE) / NAME)


def results(rows: list[dict]) -> dict[str, tuple[str, str]]:
    """{student, as it is in the table: (result, message) of the exercise}."""
    mine = [row for row in rows if row["exercise"] == EXERCISE]
    return {row["student"]: (row["result"], row["message"]) for row in mine}


def survivors(rows: list[dict], kinds: Iterable[str] = tuple(KINDS)) -> dict[str, bool]:
    """Of each kind, whether the right copy after it is called right."""
    found = results(rows)
    return {k: found.get(shown(student(k) + BESIDE), ("",))[0] == "right" for k in kinds}


def collected(folder: Path, out: Path) -> tuple[str, list[dict]]:
    """What `motiondiff-edu collect` prints of these copies, and the rows of its file.

    Raises RuntimeError where it fails. The copies are removed.
    """
    limits = ["--seconds", str(SECONDS), "--gigabytes", "1"]
    done = subprocess.run(
        [sys.executable, "-m", "motiondiff_edu", "collect", folder, "--out", out, *limits],
        capture_output=True,
        text=True,
    )
    subprocess.run(["rm", "-rf", folder])  # Python cannot remove folders that lie so deep
    if done.returncode:
        raise RuntimeError(done.stderr)
    with out.open(newline="", encoding="utf-8-sig") as file:
        return done.stdout, list(csv.DictReader(file))


def collect_records(command: str, quick: bool) -> list[dict]:
    """All records."""
    kinds = QUICK if quick else tuple(KINDS)
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / "handed_in"
        hand_in(folder, kinds)
        _, rows = collected(folder, Path(place) / "class.csv")
    kept = survivors(rows, kinds)
    for kind in (kind for kind, right in kept.items() if not right):
        print(f"the right copy beside this one is not right: {kind}")
    share = measure_of("survives", "share", np.mean, np.array(list(kept.values()), float))
    return [share.as_record("collect.", {"kinds": len(kinds)}, command)]
