"""Run answers to the exercises of one notebook, each in a process of its own with limits.

    python -m motiondiff_edu.course.trial NOTEBOOK

Each line of standard input is a question, each line of standard output a result (`answers`).

The notebook's own cells prepare the names once. For every question a fork of that process reads
the student's copies, runs what their cells before the answer define, and then the answer. The fork
has an empty folder, so many seconds by the clock of its parent and, on Linux, so much more memory.
Then the processes that it started end: on Linux all, elsewhere those of its group, so that one
that calls setsid lives on. Where Linux has Landlock, the fork writes in its folder alone (`fence`).
This keeps mistakes apart. It is no protection against malice: the code runs with the rights of who
runs this, can read what they can, and could change what the wrapper around it finds.
"""

import contextlib
import ctypes
import functools
import gc
import io
import json
import os
import resource
import signal
import sys
import tempfile
import time
import warnings
from collections.abc import Sequence
from pathlib import Path

from . import answers, fence
from .answers import DIED, FAILED, OPEN, RIGHT, SLOW, UNREADABLE, WRONG, Answer

NO_CELL = "its cell is gone"
NOT_REACHED = "its check was not reached"
PR_SET_CHILD_SUBREAPER = 36  # of Linux's prctl
RESULT = 3  # the one descriptor that an answer's process keeps


def told_of(answer: Answer, check: str, prepared: dict) -> tuple[str, str]:
    """Run an answer among the prepared names; (result, message).

    What is printed does not count. The answer is right when its last call of the check found so.
    """
    from .checks._report import STUBS, CheckFailed

    found = _recorded(check)
    try:
        with contextlib.redirect_stdout(io.StringIO()), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            names = _defined(answer.before, prepared)
            found.clear()
            exec(compile(answers.plain(answer.source), "answer", "exec"), names)
    except CheckFailed as error:
        return WRONG, _words(error).removeprefix(f"{check}: ")
    except NotImplementedError as error:
        return (OPEN, "") if _words(error) in STUBS else (FAILED, _named(error))
    except MemoryError:
        return DIED, "it needed more memory than is allowed"
    except BaseException as error:  # also SystemExit: it is the answer's
        return FAILED, _named(error)
    if not found:
        return OPEN, NOT_REACHED
    return (RIGHT, "") if found[-1] else (OPEN, "")


def _recorded(check: str) -> list[bool]:
    """For each call of the check from now on: whether it found the answer right."""
    from .checks import _report

    own = _report.REGISTRY[check]
    found: list[bool] = []

    @functools.wraps(own)
    def run(mine):
        found.append(False)
        own(mine)
        found[-1] = _report.FOUND.get(check) is True  # a stub returns, too

    _report.REGISTRY[check] = run
    return found


def _defined(statements: Sequence[str], prepared: dict) -> dict:
    """The prepared names, and beside them those that the statements define.

    A statement that fails is left out: the answer may not need it.
    """
    names = dict(prepared)
    for statement in statements:
        try:
            exec(compile(statement, "before", "exec"), names)
        except Exception:
            for name in answers.assigned(statement):  # none has a value of before
                names.pop(name, None)
    names |= prepared
    return names


def _named(error: BaseException) -> str:
    return f"{type(error).__name__}: {_words(error)}"


def _words(error: BaseException) -> str:
    try:
        return str(error)
    except BaseException:  # the answer's own kind of exception may do anything
        return "(its message cannot be read)"


def answered(question: dict, prepared: dict, handed_out: dict[str, Answer]) -> tuple[str, str]:
    """Read a student's copies, and run their answer to a check; (result, message)."""
    try:
        given = answers.of_copies([Path(path) for path in question["paths"]], handed_out)
    except answers.CopyError as error:
        return UNREADABLE, str(error)
    if question["check"] not in given:
        return OPEN, NO_CELL
    return told_of(given[question["check"]], question["check"], prepared)


def apart(question: dict, prepared: dict, handed_out: dict[str, Answer]) -> tuple[str, str]:
    """`answered` in a fork with limits; (result, message).

    Processes that the answer left behind end with it (`_end`).
    """
    # a file: a pipe would stay open in a process that the answer started and left behind
    with tempfile.TemporaryFile() as result:
        child = os.fork()
        if child == 0:
            try:
                _answer(result.fileno(), question, prepared, handed_out)
            finally:
                os._exit(0)
        code = _exit_code(child, question["seconds"])
        _end(child, reaped=code is not None)
        result.seek(0)
        found = answers.read_back(result.read(2**16), question["token"])
    if code is None:
        return SLOW, f"stopped after {question['seconds']} s"
    if code:
        return DIED, answers.ending(code)
    return found or (DIED, answers.ending(code))


def _answer(result: int, question: dict, prepared: dict, handed_out: dict[str, Answer]) -> None:
    """In the fork: answer the question, and write that to the descriptor `result`."""
    os.setsid()  # a group of its own, with all that the answer starts
    os.dup2(result, RESULT)
    os.closerange(RESULT + 1, 2**16)
    _silence()
    os.chdir(question["folder"])
    os.environ["TMPDIR"] = question["folder"]
    tempfile.tempdir = None  # looked up again
    _limit(question["gigabytes"])
    here = os.getpid()
    try:
        fence.keep_within(question["folder"])
        found = answered(question, prepared, handed_out)
    except OSError as error:
        found = DIED, str(error)
    if os.getpid() == here:  # and no fork that the answer made
        line = answers.written(question["token"], *found)
        os.ftruncate(RESULT, 0)
        os.pwrite(RESULT, line, 0)


def _exit_code(child: int, seconds: int) -> int | None:
    """The exit code of a child, below 0 for a signal; None for one that runs longer than this."""
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        ended, status = os.waitpid(child, os.WNOHANG)
        if ended:
            return os.waitstatus_to_exitcode(status)
        time.sleep(0.005)
    return None


def _end(child: int, reaped: bool) -> None:
    """End the child's group, and on Linux everything else that came of it.

    Linux gives orphans to this process (`_adopt`), also those that called setsid.
    """
    with contextlib.suppress(ProcessLookupError, PermissionError):  # nobody is left
        os.killpg(child, signal.SIGKILL)
    if not reaped:
        os.kill(child, signal.SIGKILL)  # it may have left its group
        os.waitpid(child, 0)
    until = time.monotonic() + 1  # some may be faster at forking than this is at ending them
    while time.monotonic() < until:
        try:
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass
        except ChildProcessError:
            return
        for orphan in _children():
            with contextlib.suppress(OSError):
                os.kill(orphan, signal.SIGKILL)
        time.sleep(0.002)


def _children() -> list[int]:
    """The children of this process, also those that have ended; none known except on Linux."""
    found = []
    for path in Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError):
            parent = path.read_bytes().rpartition(b")")[2].split()[1]
            found += [int(path.parent.name)] if int(parent) == os.getpid() else []
    return found


def _adopt() -> None:
    """On Linux, let the orphans below this process become its children."""
    if sys.platform == "linux":
        with contextlib.suppress(OSError, AttributeError):
            ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)


def _silence() -> None:
    """Nothing comes from standard input, and what is written to the terminal goes nowhere.

    That holds for an answer's own processes and for C code, too.
    """
    nowhere = os.open(os.devnull, os.O_RDWR)
    for stream in (0, 1, 2):
        os.dup2(nowhere, stream)
    os.close(nowhere)


def _limit(gigabytes: float) -> None:
    """So much for each file, no dumps, and on Linux so much memory more than now."""
    most = int(gigabytes * 2**30)
    _lower(resource.RLIMIT_FSIZE, most)
    _lower(resource.RLIMIT_CORE, 0)
    if sys.platform == "linux":
        pages = int(Path("/proc/self/statm").read_text().split()[0])
        _lower(resource.RLIMIT_AS, most + pages * resource.getpagesize())


def _lower(kind: int, most: int) -> None:
    """Lower a limit; the system allows none to be raised."""
    hard = resource.getrlimit(kind)[1]
    most = most if hard == resource.RLIM_INFINITY else min(most, hard)
    resource.setrlimit(kind, (most, most))


def prepared_names(notebook: Path) -> dict:
    """The names that the notebook's own cells define; all checks are loaded."""
    from .checks import load_all

    names: dict = {"__name__": "notebook"}
    with contextlib.redirect_stdout(io.StringIO()), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for source in answers.preparation(notebook):
            exec(compile(source, "preparation", "exec"), names)
    load_all()
    return names


def main() -> None:
    """Questions from standard input, results to standard output; nothing else goes there.

    A question without a check asks whether the names are prepared.
    """
    replies = os.dup(1)
    os.dup2(2, 1)
    _adopt()
    notebook = Path(sys.argv[1])
    names, handed_out = prepared_names(notebook), answers.of_copy(notebook)
    gc.freeze()  # else each fork copies what its garbage collector looks at
    for line in sys.stdin.buffer:
        try:
            question = json.loads(line)
            found = apart(question, names, handed_out) if "check" in question else (OPEN, "")
        except (ValueError, TypeError, KeyError):  # an empty line, or no question of `collect`
            continue
        os.write(replies, answers.written(question["token"], *found))


if __name__ == "__main__":
    main()
