"""The time of `import motiondiff_edu` compared with `import torch`.

Both run in turn in fresh processes; times are CPU seconds.

Run: python benchmarks/import_time.py [--repeats 15] [--out benchmarks/results/import_time.json]
"""

import argparse
import subprocess
import sys

import numpy as np
from records import record, show, write_records

COMMAND = "python -m benchmarks import"
MODULES = ("torch", "motiondiff_edu")
TIMED = "import time; start = time.process_time(); import {}; print(time.process_time() - start)"


def cpu_seconds(module: str) -> float:
    """CPU seconds of importing a module in a new process."""
    done = subprocess.run(
        [sys.executable, "-c", TIMED.format(module)], capture_output=True, text=True, check=True
    )
    return float(done.stdout)


def measure(repeats: int) -> dict[str, np.ndarray]:
    """Times of both modules in every repeat; the order changes each time.

    The first repeat only fills the disk cache.
    """
    times = {module: [] for module in MODULES}
    for repeat in range(repeats + 1):
        for module in MODULES[:: 1 if repeat % 2 else -1]:
            seconds = cpu_seconds(module)
            if repeat:
                times[module].append(seconds)
    return {module: np.array(values) for module, values in times.items()}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=15)
    parser.add_argument("--out", default="benchmarks/results/import_time.json")
    args = parser.parse_args()
    times = measure(args.repeats)
    records = [
        record(f"bench.import_{m}_s", values, unit="CPU s", command=COMMAND)
        for m, values in times.items()
    ]
    ratio = times["motiondiff_edu"] / times["torch"]
    records.append(record("bench.import_over_torch", ratio, unit="ratio", command=COMMAND))
    show(records)
    write_records(args.out, records)


if __name__ == "__main__":
    main()
