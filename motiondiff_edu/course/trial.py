"""Run answers to the exercises of one notebook, each in a process of its own with limits.

    python -m motiondiff_edu.course.trial NOTEBOOK results.json < answers.json

The notebook's own cells prepare the names once; every answer then runs in a fork of that process,
which may take so many seconds and, on Linux, so much more memory. What the reader's cells before
it define is there as well. This keeps one answer's mistakes away from the others. It is no
protection against malice: the code runs with the rights of who runs this.
"""

import contextlib
import io
import json
import os
import re
import resource
import signal
import sys
import tempfile
import warnings
from collections.abc import Sequence
from pathlib import Path

from . import answers
from .answers import DIED, FAILED, OPEN, RIGHT, SLOW, WRONG, Answer

LONGEST = 500  # characters of a message: a table shows its beginning


def told_of(answer: Answer, check: str, prepared: dict) -> tuple[str, str]:
    """Run an answer among the prepared names; (status, message)."""
    from .checks._report import STUBS, CheckFailed

    said = io.StringIO()
    try:
        with contextlib.redirect_stdout(said), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            names = _defined(answer.before, prepared)
            exec(compile(answers.plain(answer.source), "answer", "exec"), names)
    except CheckFailed as error:
        return WRONG, str(error).removeprefix(f"{check}: ")
    except NotImplementedError as error:
        return (OPEN, "") if str(error) in STUBS else (FAILED, _named(error))
    except MemoryError:
        return DIED, "it needed more memory than is allowed"
    except BaseException as error:  # also SystemExit: it is the answer's
        return FAILED, _named(error)
    if re.search(rf"^{check}: right\.", said.getvalue(), re.M):
        return RIGHT, ""
    return OPEN, ""


def _defined(statements: Sequence[str], prepared: dict) -> dict:
    """The prepared names, and beside them those that the statements define.

    A statement that fails is left out: the answer may not need it.
    """
    names = dict(prepared)
    for statement in statements:
        with contextlib.suppress(Exception):
            exec(compile(statement, "before", "exec"), names)
    names |= prepared
    return names


def _named(error: BaseException) -> str:
    return f"{type(error).__name__}: {error}"


def apart(answer: Answer, check: str, prepared: dict, seconds: int, gigabytes: float):
    """`told_of` in a fork with limits; (status, message).

    Processes that the answer left behind end with it.
    """
    # a file: a pipe would stay open in a process that the answer started and left behind
    with tempfile.TemporaryFile() as result:
        child = os.fork()
        if child == 0:
            os.setsid()  # a group of its own, with all that the answer starts
            _silence()
            _limit(seconds, gigabytes)
            here = os.getpid()
            with contextlib.suppress(BaseException):
                status, words = told_of(answer, check, prepared)
                if os.getpid() == here:  # and no fork that the answer made
                    os.write(result.fileno(), json.dumps([status, _short(words)]).encode())
            os._exit(0)
        _, status = os.waitpid(child, 0)
        with contextlib.suppress(ProcessLookupError, PermissionError):  # nobody is left
            os.killpg(child, signal.SIGKILL)
        result.seek(0)
        written = result.read()
    if written:
        return tuple(json.loads(written))
    if os.WIFSIGNALED(status) and os.WTERMSIG(status) in (signal.SIGALRM, signal.SIGXCPU):
        return SLOW, f"stopped after {seconds} s"
    return DIED, "the process ended: out of memory, or the interpreter crashed"


def _short(words: str) -> str:
    """The beginning of a message, with ? for what UTF-8 cannot write."""
    cut = words if len(words) <= LONGEST else words[:LONGEST] + " ..."
    return cut.encode("utf-8", "replace").decode("utf-8")


def _silence() -> None:
    """What the answer's own processes, or C code, write to the terminal goes nowhere."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.dup2(nowhere, 2)


def _limit(seconds: int, gigabytes: float) -> None:
    """So much time, by the clock, and on Linux so much memory more than now."""
    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    signal.alarm(seconds)
    pages = int(Path("/proc/self/statm").read_text().split()[0]) if sys.platform == "linux" else 0
    used = pages * resource.getpagesize()
    if used:
        most = int(used + gigabytes * 2**30)
        resource.setrlimit(resource.RLIMIT_AS, (most, most))


def main() -> None:
    """Answers from standard input, results to a file, as JSON."""
    given = json.load(sys.stdin)
    namespace: dict = {"__name__": "notebook"}
    with contextlib.redirect_stdout(io.StringIO()), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for source in answers.preparation(Path(sys.argv[1])):
            exec(compile(source, "preparation", "exec"), namespace)
    limits = given["seconds"], given["gigabytes"]
    results = [
        apart(Answer(one["source"], tuple(one["before"])), one["check"], namespace, *limits)
        for one in given["answers"]
    ]
    Path(sys.argv[2]).write_text(json.dumps(results), encoding="utf-8")


if __name__ == "__main__":
    main()
