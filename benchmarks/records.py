"""Records of measured figures, in lists in JSON files.

Each is {name, value, low, high, seeds, unit, paper, command}.
"""

import json
from pathlib import Path

import numpy as np

from motiondiff_edu._files import replacing

KEYS = ("name", "value", "low", "high", "seeds", "unit", "paper", "command")


def record(
    name: str, values, *, unit: str, command: str, seeds=None, paper=None, center=np.median
) -> dict:
    """Summarise repeated measurements by their median and its 95 % bootstrap interval.

    `seeds` lists the repetitions (default 0..n-1); `paper` is the paper's own figure, or None.
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
    )


def write_records(path: str | Path, records: list[dict]) -> None:
    """Write records as JSON, to a temporary name first; raises ValueError where one lacks a key."""
    for one in records:
        if set(one) != set(KEYS):
            raise ValueError(
                f"record {one.get('name')!r} must have exactly the keys {', '.join(KEYS)}"
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
