"""The seconds that the shipped mover takes for four answers to a sentence.

Four motions of 6 s, as the prompt box of notebook 16 asks for them, on the threads that torch takes
by itself. The first answer, which also reads the weights, is not counted.

Run: python benchmarks/mover.py [--repeats 7] [--out benchmarks/results/mover.json]
"""

import argparse
import time

from records import record, show, write_records

import motiondiff_edu as md
from motiondiff_edu.performers.mover import Mover
from motiondiff_edu.widgets.prompt import ANSWERS, SENTENCE

COMMAND = "python -m benchmarks mover"
SECONDS = 6.0


def seconds(mover: Mover, seed: int) -> float:
    """Wall-clock seconds of one answer."""
    began = time.perf_counter()
    mover.act(SENTENCE, seconds=SECONDS, samples=ANSWERS, seed=seed, progress=False)
    return time.perf_counter() - began


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=7)
    parser.add_argument("--out", default="benchmarks/results/mover.json")
    args = parser.parse_args()
    mover = md.load("mover")
    _first, *times = [seconds(mover, seed) for seed in range(args.repeats + 1)]
    records = [record("bench.mover_seconds", times, unit="s", command=COMMAND)]
    show(records)
    write_records(args.out, records)


if __name__ == "__main__":
    main()
