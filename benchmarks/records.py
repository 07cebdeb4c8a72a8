"""Records of what was measured, in lists in JSON files.

Each is {name, value, low, high, seeds, unit, paper, command}. One of a benchmark also has
`machine`: the processor that it was timed on, and how many of its cores were free to use.
"""

import json
import os
import platform
import re
from pathlib import Path

import numpy as np

from motiondiff_edu._files import replacing

KEYS = ("name", "value", "low", "high", "seeds", "unit", "paper", "command")
CPU_INFO = Path("/proc/cpuinfo")  # Linux; elsewhere Python's own answer is taken


def record(
    name: str, values, *, unit: str, command: str, seeds=None, paper=None, center=np.median
) -> dict:
    """Summarise repeated measurements by their median and its 95 % bootstrap interval.

    `seeds` lists the repetitions (default 0..n-1); `paper` is the paper's own number, or None.
    """
    values = np.asarray(values, float).ravel()
    if not len(values) or not np.isfinite(values).all():
        raise ValueError(f"{name}: {len(values)} measurements, not all of them finite numbers")
    draws = np.random.default_rng(0).choice(values, (2000, len(values)))
    low, high = np.percentile(center(draws, axis=1), [2.5, 97.5])
    seeds = list(range(len(values)) if seeds is None else seeds)
    return dict(
        name=name,
        value=float(center(values)),
        low=float(low),
        high=float(high),
        seeds=seeds,
        unit=unit,
        paper=paper,
        command=command,
        machine=machine(),
    )


def machine() -> str:
    """The processor's name, and the number of cores that this process may use."""
    found = re.search(r"^model name\s*:\s*(.+)$", _cpu_info(), re.MULTILINE)
    name = found[1].strip() if found else platform.processor() or platform.machine()
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    return f"{name}, {cores} core{'s' * (cores != 1)}"


def _cpu_info() -> str:
    return CPU_INFO.read_text(encoding="utf-8") if CPU_INFO.is_file() else ""


def write_records(path: str | Path, records: list[dict]) -> None:
    """Write records as JSON, to a temporary name first; raises ValueError where one lacks a key."""
    for one in records:
        if set(one) - {"machine"} != set(KEYS):
            raise ValueError(
                f"record {one.get('name')!r} must have exactly the keys {', '.join(KEYS)}, and "
                "machine where it was timed"
            )
    with replacing(path) as aside:
        aside.write_text(json.dumps(records, indent=1) + "\n", encoding="utf-8")


def show(records: list[dict]) -> None:
    """Print one line a record."""
    for one in records:
        print(
            f"{one['name']:44s} {one['value']:9.3g}  [{one['low']:.3g}, "
            f"{one['high']:.3g}] {one['unit']}"
        )
