"""Show motions side by side on a page in the browser."""

import argparse
from pathlib import Path

from . import outputs

HELP = "show motions in the browser"
EXAMPLE = "play my_walk.bvh more.bvh"


def arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", type=Path, nargs="+", help="motions: .bvh or .npz")
    parser.add_argument("--out", type=Path, metavar="PAGE.html", help="where to keep the page")
    parser.add_argument("--no-open", action="store_true", help="write the page, open nothing")
    outputs.add_overwrite(parser)


def run(given: argparse.Namespace) -> None:
    if given.out is not None:
        if given.out.suffix.lower() not in (".html", ".htm"):
            raise ValueError(f"--out {given.out}: the page's name ends in .html")
        (given.out,) = outputs.free_names(given.out.with_suffix(".html"), given.overwrite)
    motions = [outputs.reading(path) for path in given.file]
    from .. import play

    play(motions, path=given.out, open_page=not given.no_open)
