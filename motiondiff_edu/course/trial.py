"""Run answers to the exercises of one notebook, each in a process of its own with limits.

    python -m motiondiff_edu.course.trial NOTEBOOK < answers.json > results.json

The notebook's own cells prepare the names once; every answer then runs in a fork of that process,
which may take so many seconds and so much more memory. This keeps one answer's mistakes away from
the others. It is no protection against malice: the code runs with the rights of who runs this.
"""

import contextlib
import io
import json
import os
import re
import resource
import signal
import sys
import warnings
from pathlib import Path

from . import answers
from .answers import DIED, FAILED, OPEN, RIGHT, SLOW, WRONG


def tried(source: str, check: str, namespace: dict) -> tuple[str, str]:
    """Run an exercise cell; (status, message)."""
    from .checks._report import STUBS, CheckFailed

    said = io.StringIO()
    try:
        with contextlib.redirect_stdout(said), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            exec(compile(source, "answer", "exec"), dict(namespace))
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


def _named(error: BaseException) -> str:
    return f"{type(error).__name__}: {error}"


def apart(source: str, check: str, namespace: dict, seconds: int, gigabytes: float):
    """`tried` in a fork with limits; (status, message)."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reading)
        _limit(seconds, gigabytes)
        with contextlib.suppress(BaseException):
            result = json.dumps(tried(source, check, namespace)).encode()
            os.write(writing, result[:60_000])
        os._exit(0)
    os.close(writing)
    with os.fdopen(reading, "rb") as pipe:
        answer = pipe.read()
    _, status = os.waitpid(child, 0)
    if answer:
        return tuple(json.loads(answer))
    if os.WIFSIGNALED(status) and os.WTERMSIG(status) in (signal.SIGALRM, signal.SIGXCPU):
        return SLOW, f"stopped after {seconds} s"
    return DIED, "the process ended: out of memory, or the interpreter crashed"


def _limit(seconds: int, gigabytes: float) -> None:
    """So much time, by the clock, and so much memory more than now."""
    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    signal.alarm(seconds)
    pages = int(Path("/proc/self/statm").read_text().split()[0]) if sys.platform == "linux" else 0
    used = pages * resource.getpagesize()
    if used:
        most = int(used + gigabytes * 2**30)
        resource.setrlimit(resource.RLIMIT_AS, (most, most))


def main() -> None:
    """Answers from standard input, results to standard output, as JSON."""
    given = json.load(sys.stdin)
    namespace: dict = {"__name__": "notebook"}
    with contextlib.redirect_stdout(io.StringIO()), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for source in answers.preparation(Path(sys.argv[1])):
            exec(compile(source, "preparation", "exec"), namespace)
    limits = given["seconds"], given["gigabytes"]
    results = [apart(one["source"], one["check"], namespace, *limits) for one in given["answers"]]
    json.dump(results, sys.stdout)


if __name__ == "__main__":
    main()
