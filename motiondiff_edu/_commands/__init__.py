"""The verbs of the front door on the command line, one file each: `motiondiff-edu walk ...`.

A verb's module has HELP (one line), EXAMPLE, `arguments(parser)` and `run(given)`. What is slow
to import is imported within `run`, so that `--help` is there at once.
"""

import argparse
import sys
import warnings
from types import ModuleType

VERBS = ("walk", "dance", "inbetween", "reconstruct", "info", "convert", "play")
STOPPED = 130  # the exit code of a command that Ctrl-C ended


def run(module: ModuleType, given: argparse.Namespace) -> int:
    """Do what was asked, and return the exit status.

    What goes wrong for a reason is said in words, without a traceback.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("default", UserWarning)
            warnings.showwarning = _as_a_note
            module.run(given)
    except KeyboardInterrupt:
        print("\nstopped; no half-written file is left", file=sys.stderr)
        return STOPPED
    except BrokenPipeError:
        return 1
    except (ValueError, KeyError, OSError, ImportError, MemoryError) as error:
        print(f"{given.verb}: {_words(error)}", file=sys.stderr)
        return 1
    return 0


def _words(error: Exception) -> str:
    """What an exception says; a KeyError would put it into quotes."""
    if isinstance(error, MemoryError):
        return "there is not enough memory for this; try a shorter piece"
    if isinstance(error, KeyError) and error.args:
        return str(error.args[0])
    return str(error) or type(error).__name__


def _as_a_note(message, category, filename, lineno, file=None, line=None) -> None:
    """A warning for people: its words, not the line of code."""
    if not issubclass(category, (DeprecationWarning, FutureWarning)):
        print(f"note: {message}", file=sys.stderr)
