"""The time of `import motiondiff_edu` compared with `import torch`.

The package imports its parts at their first use, so the first `md.read_motion` and `md.load` are
timed as well. All run in turn in fresh processes; times are CPU seconds.

Run: python benchmarks/import_time.py [--repeats 15] [--out benchmarks/results/import_time.json]
"""

import argparse
import subprocess
import sys

import numpy as np
from records import record, show, write_records

COMMAND = "python -m benchmarks import"
STATEMENTS = {
    "torch": "import torch",
    "motiondiff_edu": "import motiondiff_edu",
    "front_door": "import motiondiff_edu as md; md.read_motion; md.load",
}
TIMED = "import time; start = time.process_time(); {}; print(time.process_time() - start)"


def cpu_seconds(statement: str) -> float:
    """CPU seconds of a statement in a new process."""
    done = subprocess.run(
        [sys.executable, "-c", TIMED.format(statement)], capture_output=True, text=True, check=True
    )
    return float(done.stdout)


def measure(repeats: int) -> dict[str, np.ndarray]:
    """Times of all statements in every repeat; the order changes each time.

    The first repeat only fills the disk cache.
    """
    times = {name: [] for name in STATEMENTS}
    for repeat in range(repeats + 1):
        for name in list(STATEMENTS)[:: 1 if repeat % 2 else -1]:
            seconds = cpu_seconds(STATEMENTS[name])
            if repeat:
                times[name].append(seconds)
    return {name: np.array(values) for name, values in times.items()}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=15)
    parser.add_argument("--out", default="benchmarks/results/import_time.json")
    args = parser.parse_args()
    times = measure(args.repeats)
    records = [
        record(f"bench.import_{name}_s", values, unit="CPU s", command=COMMAND)
        for name, values in times.items()
    ]
    for name, timed in (("import", "motiondiff_edu"), ("front_door", "front_door")):
        values = times[timed] / times["torch"]
        records.append(record(f"bench.{name}_over_torch", values, unit="ratio", command=COMMAND))
    show(records)
    write_records(args.out, records)


if __name__ == "__main__":
    main()
