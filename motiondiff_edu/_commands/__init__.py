"""The verbs that work with motions on the command line, one file each: `motiondiff-edu walk ...`.

A verb's module has HELP (one line), EXAMPLE, `arguments(parser)` and `run(args)`. Its docstring is
the description that `--help` shows. Slow imports stand inside `run`, so that `--help` is fast.
"""

import argparse
import sys
import traceback
import warnings
from types import ModuleType

from . import outputs

VERBS = ("walk", "dance", "act", "inbetween", "reconstruct", "edit", "info", "convert", "play")
OURS = __name__.split(".")[0]
STOPPED = 130  # the exit code of a command that Ctrl-C ended


def run(module: ModuleType, args: argparse.Namespace) -> int:
    """Run one verb, and return the exit status.

    An expected error is printed as one message, without a traceback; any other is a bug of the
    program and keeps its traceback. A verb that returns nothing has succeeded.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("default", UserWarning)
            warnings.showwarning = _as_a_note
            outputs.check_arguments(args)
            return _each(module, args) if "ending" in args else module.run(args) or 0
    except KeyboardInterrupt:
        print("\nstopped; no incomplete file is left", file=sys.stderr)
        return STOPPED
    except BrokenPipeError:
        raise
    except Exception as error:
        if not expected(error):
            raise
        print(f"{args.verb}: {message(error)}", file=sys.stderr)
        return 1


def _each(module: ModuleType, args: argparse.Namespace) -> int:
    """Run a verb for each of its files; one that fails is told and costs no other its result."""
    jobs, faulty = outputs.one_by_one(args), 0
    for job in jobs:
        try:
            module.run(job)
        except Exception as error:
            if len(jobs) == 1 or not expected(error):
                raise
            outputs.say(f"left out: {job.file}: {message(error)}")
            faulty += 1
    if faulty:
        raise ValueError(f"{faulty} of {len(jobs)} files were left out")
    return 0


def expected(error: Exception) -> bool:
    """Whether an error is for the user: a class of this project, raised by it, or from outside.

    A ValueError that numpy or torch raised in the middle of our work is a bug, and so is a KeyError
    without words.
    """
    if isinstance(error, (OSError, ImportError, MemoryError)):
        return True
    if type(error).__module__.split(".")[0] == OURS:
        return True
    *_, (frame, _) = traceback.walk_tb(error.__traceback__)
    raised_here = frame.f_globals.get("__name__", "").split(".")[0] in (OURS, "data_synth")
    words = isinstance(error, ValueError) or " " in message(error)
    return raised_here and words and isinstance(error, (ValueError, KeyError))


def message(error: Exception) -> str:
    """The message of an exception; `str` of a KeyError would put it into quotes."""
    if isinstance(error, MemoryError):
        return "there is not enough memory for this; try a shorter motion or song"
    if isinstance(error, ModuleNotFoundError):
        return (
            f"{error.name} is not installed for {sys.executable}. From a clone use make, or "
            f".venv/bin/python -m {OURS}; elsewhere install the package with pip"
        )
    if isinstance(error, KeyError) and error.args:
        return str(error.args[0])
    return str(error) or type(error).__name__


def _as_a_note(message, category, filename, lineno, file=None, line=None) -> None:
    """Print a warning as its message alone, without the line of code."""
    if not issubclass(category, (DeprecationWarning, FutureWarning)):
        print(f"note: {message}", file=sys.stderr)
