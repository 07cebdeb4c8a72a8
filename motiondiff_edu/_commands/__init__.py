"""The verbs that work with motions on the command line, one file each: `motiondiff-edu walk ...`.

A verb's module has HELP (one line), EXAMPLE, `arguments(parser)` and `run(args)`. Its docstring is
the description that `--help` shows. Slow imports stand inside `run`, so that `--help` is fast.
"""

import argparse
import sys
import warnings
from types import ModuleType

VERBS = ("walk", "dance", "inbetween", "reconstruct", "info", "convert", "play")
STOPPED = 130  # the exit code of a command that Ctrl-C ended


def run(module: ModuleType, args: argparse.Namespace) -> int:
    """Run one verb, and return the exit status.

    An expected error is printed as one message, without a traceback.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("default", UserWarning)
            warnings.showwarning = _as_a_note
            module.run(args)
    except KeyboardInterrupt:
        print("\nstopped; no incomplete file is left", file=sys.stderr)
        return STOPPED
    except BrokenPipeError:
        return 1
    except (ValueError, KeyError, OSError, ImportError, MemoryError) as error:
        print(f"{args.verb}: {_message(error)}", file=sys.stderr)
        return 1
    return 0


def _message(error: Exception) -> str:
    """The message of an exception; `str` of a KeyError would put it into quotes."""
    if isinstance(error, MemoryError):
        return "there is not enough memory for this; try a shorter motion or song"
    if isinstance(error, KeyError) and error.args:
        return str(error.args[0])
    return str(error) or type(error).__name__


def _as_a_note(message, category, filename, lineno, file=None, line=None) -> None:
    """Print a warning as its message alone, without the line of code."""
    if not issubclass(category, (DeprecationWarning, FutureWarning)):
        print(f"note: {message}", file=sys.stderr)
