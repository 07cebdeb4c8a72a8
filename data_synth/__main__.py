"""Write synthetic motion and music as files.

`python -m data_synth walks | dances | songs | actions --out FOLDER`
"""

import argparse
import sys

from .actions import write as write_actions
from .dancing import write as write_dances
from .music import write as write_songs
from .walking import write as write_walks

KINDS = {
    "walks": write_walks.main,
    "dances": write_dances.main,
    "songs": write_songs.main,
    "actions": write_actions.main,
}


def main(arguments: list[str] | None = None) -> None:
    """Write the data that the first word names; `data_synth.<kind>.write` reads the rest."""
    parser = argparse.ArgumentParser(
        prog="python -m data_synth", description=__doc__, add_help=False
    )
    parser.add_argument("kind", choices=list(KINDS), nargs="?", help="what to write")
    given, rest = parser.parse_known_args(arguments)
    if given.kind is None:
        parser.print_usage()
        print("for example: python -m data_synth walks --out walks --clips 4")
        sys.exit(0 if "--help" in rest or "-h" in rest else 2)
    KINDS[given.kind](rest)


if __name__ == "__main__":
    main()
