"""Show motions side by side on a page in the browser. Without --out the page is a temporary
file."""

import argparse
from pathlib import Path

from ..motion.arguments import check_there
from . import outputs

HELP = "show motions in the browser"
EXAMPLE = "play my_walk.bvh more.bvh"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of `play`."""
    outputs.add_file(parser, "motions", together=True)
    parser.add_argument("--out", type=Path, metavar="PAGE.html", help="where to save the page")
    parser.add_argument("--no-open", action="store_true", help="do not open the browser")
    outputs.add_overwrite(parser)


def run(args: argparse.Namespace) -> None:
    """Show the motion in a browser."""
    if args.out is not None:
        if args.out.suffix.lower() != ".html":
            raise ValueError(f"--out {args.out}: the page's name must end in .html")
        (args.out,) = outputs.output_paths(args.out, args.overwrite)
    paths = outputs.files(args.file)
    for path in paths:
        check_there(path)
    motions = [outputs.read(path, args) for path in paths]
    from .. import play

    play(motions, path=args.out, open_page=not args.no_open)
