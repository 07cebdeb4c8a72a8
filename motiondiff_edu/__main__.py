"""The command line: `motiondiff-edu lab`, or `python -m motiondiff_edu lab`.

A new verb is one module and one line in VERBS. The module has
    HELP               one line that says what the verb does
    EXAMPLE            one command, without the program's name
    arguments(parser)  adds the verb's own arguments
    run(chosen)        runs it, and returns the exit status
It imports nothing heavy before `run`. With PASSES_OPTIONS_ON = "JupyterLab" the verb also accepts
options that are not its own; `chosen.options` holds them for the program of that name.

An error that is for the user is printed as a message; any other is a bug of the program, and keeps
its traceback (`_commands.expected`).
"""

import argparse
import importlib
import io
import os
import sys
from contextlib import suppress

from . import __version__, _commands
from .course.places import program

VERBS = {name: f"_commands.{name}" for name in _commands.VERBS} | {
    "lab": "course.lab",
    "demo": "course.demo",
    "doctor": "course.doctor",
    "collect": "course.collect",
    "handout": "course.handout",
    "export": "course.export",
}


def parser_of(verbs: dict) -> argparse.ArgumentParser:
    """The parser of the whole command line; each verb has its arguments and an example."""
    parser = argparse.ArgumentParser(
        prog=program(),
        description="Human-motion diffusion: the course, and the library.",
        allow_abbrev=False,
    )
    parser.add_argument("--version", action="version", version=f"motiondiff_edu {__version__}")
    commands = parser.add_subparsers(dest="verb", metavar="VERB")
    for name, verb in verbs.items():
        further = getattr(verb, "PASSES_OPTIONS_ON", "")
        about = f"{verb.HELP[0].upper()}{verb.HELP[1:]}."
        about = verb.__doc__ if name in _commands.VERBS else about
        command = commands.add_parser(
            name,
            help=verb.HELP,
            description=about + (f" Further options go to {further}." if further else ""),
            formatter_class=argparse.RawDescriptionHelpFormatter,
            epilog=f"example: {program()} {verb.EXAMPLE}",
            allow_abbrev=False,
        )
        verb.arguments(command)
        command.set_defaults(parser=command)
    return parser


def imported() -> tuple[dict, dict]:
    """The modules of the verbs, and the errors of those that cannot be imported."""
    verbs, broken = {}, {}
    for name, module in VERBS.items():
        try:
            verbs[name] = importlib.import_module(f"motiondiff_edu.{module}")
        except ImportError as error:
            broken[name] = error
    return verbs, broken


def main(arguments: list[str] | None = None) -> int:
    """Run one verb; returns the exit status, also where Ctrl-C or a closed pipe ends it."""
    if isinstance(sys.stdout, io.TextIOWrapper) and sys.stdout.errors == "strict":
        # the name of a file that is no UTF-8 is printed with the bytes that it has
        sys.stdout.reconfigure(errors="surrogateescape")
    try:
        return _run(arguments)
    except KeyboardInterrupt:
        print("\nstopped", file=sys.stderr)
        return _commands.STOPPED
    except BrokenPipeError:
        # what is still to be written has no reader, and Python would complain about it at its end
        with suppress(OSError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1


def _run(arguments: list[str] | None) -> int:
    verbs, broken = imported()
    asked = (sys.argv[1:] if arguments is None else arguments)[:1]
    for error in (broken[name] for name in asked if name in broken):
        print(_commands.message(error), file=sys.stderr)
        return 1
    parser = parser_of(verbs)
    chosen, further = parser.parse_known_args(arguments)
    if chosen.verb is None:
        parser.print_help()
        return 2
    verb = verbs[chosen.verb]
    chosen.options = further
    if chosen.options and not getattr(verb, "PASSES_OPTIONS_ON", ""):
        unknown = [one for one in chosen.options if one.startswith("-")]
        why = (
            f"it has no option {unknown[0]}; --help lists those that it has"
            if unknown
            else "a sentence or name of several words is put into quotes"
        )
        chosen.parser.error(f"{chosen.verb} does not know {' '.join(chosen.options)}; {why}")
    return _commands.run(verb, chosen)


if __name__ == "__main__":
    sys.exit(main())
