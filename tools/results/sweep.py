"""Sweeps: named variants of one thing, trained with several seeds and measured on the same clips.

The rows (for each seed, each measure's numbers of all clips) are kept in one JSON file for each
variant, and what is there is neither trained nor measured again. Records are computed from rows:
each measure with its interval over seeds and clips, its value for each seed, and differences from
rival variants, on the same seeds and clips.
"""

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from motiondiff_edu._files import replacing

from .walks.scores import Kind, Measure, measures_over_seeds

Rows = Mapping[str, np.ndarray]  # by name: (clips,) of one seed, (seeds, clips) of a variant
RIVAL = "rival."  # begins the names of a rival's rows
GROUPS = "group"  # the row that says whose each clip is: its clips are drawn together


@dataclass(frozen=True)
class Variant:
    """What differs, in words; what `train` makes it of; and with which variants it is compared.

    `rivals`: {what a record's name calls the rival: the variant's name}.
    """

    words: str
    recipe: Any = None
    rivals: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Sweep:
    """Variants, and how they are trained and measured.

    `differences`: names have {} for the rival; their functions take the own rows and the rival's.
    `about`: the settings of a variant; rows of other settings are never mixed with its own.
    """

    name: str
    variants: Mapping[str, Variant]
    train: Callable[[str, int], Any]  # of a variant's name and a seed; continues, or only reads
    measure: Callable[[str, Any, int], Rows]  # of the name, what was trained, and the seed
    kinds: Mapping[str, Kind]
    differences: Mapping[str, Kind] = field(default_factory=dict)
    about: Callable[[str], dict] = lambda name: {}
    seeds: tuple[int, ...] = (0,)


def run(sweep: Sweep, name: str, folder: Path, command: str) -> list[dict]:
    """Train and measure what is missing of a variant, and return its records.

    Rows are kept in folder/NAME.json; a killed run continues with the seed that it was at.
    """
    path = folder / f"{name}.json"
    about = sweep.about(name)
    kept = read_rows(path, about) or about | {"seeds": {}}
    for seed in sweep.seeds:
        if str(seed) in kept["seeds"]:
            continue
        rows = sweep.measure(name, sweep.train(name, seed), seed)
        kept["seeds"][str(seed)] = {key: _short(row) for key, row in rows.items()}
        path.parent.mkdir(parents=True, exist_ok=True)
        with replacing(path) as aside:
            aside.write_text(json.dumps(kept) + "\n", encoding="utf-8")
    return records(sweep, name, folder, command)


def read_rows(path: Path, about: dict) -> dict:
    """The settings and rows of a variant, or nothing if it was not measured yet.

    Raises ValueError for rows of other settings: they must not be mixed with new ones.
    """
    if not path.is_file():
        return {}
    kept = json.loads(path.read_text(encoding="utf-8"))
    other = {key: kept.get(key) for key in about if kept.get(key) != about[key]}
    if other:
        raise ValueError(
            f"{path} was measured with {other}, not with { ({k: about[k] for k in other}) }: "
            "delete it, or restore these settings"
        )
    return kept


def records(sweep: Sweep, name: str, folder: Path, command: str) -> list[dict]:
    """The records of a variant from its rows; a rival that was not measured is left out."""
    kept = read_rows(folder / f"{name}.json", sweep.about(name))
    rows = _arrays(kept, kept["seeds"])
    groups = rows[GROUPS][0] if GROUPS in rows else None
    found = measures_over_seeds(sweep.kinds, rows, groups)
    if len(kept["seeds"]) > 1:
        for k, seed in enumerate(sorted(kept["seeds"])):
            for kind, how in sweep.kinds.items():
                one = float(how.value(*(rows[key][k : k + 1] for key in how.rows)))
                found.append(Measure(f"{kind}.seed{seed}", one, one, one, how.unit))
    for label, rival in sweep.variants[name].rivals.items():
        found += _differences(sweep, kept, label, rival, folder)
    about = {key: value for key, value in kept.items() if key != "seeds"}
    about |= {"trainings": len(kept["seeds"])}
    return [one.as_record(f"{sweep.name}.{name}.", about, command) for one in found]


def _differences(sweep: Sweep, kept: dict, label: str, rival: str, folder: Path) -> list[Measure]:
    """The differences from one rival, over the seeds that both have."""
    other = read_rows(folder / f"{rival}.json", sweep.about(rival))
    seeds = sorted(set(kept["seeds"]) & set(other.get("seeds", {})))
    if not seeds:
        print(f"{sweep.name}: there are no rows of {rival} to compare with")
        return []
    mine, theirs = _arrays(kept, seeds), _arrays(other, seeds)
    groups = mine[GROUPS][0] if GROUPS in mine else None
    for key in {key for how in sweep.differences.values() for key in how.rows}:
        if mine[key].shape != theirs[key].shape:
            raise ValueError(f"{sweep.name}: {rival} was measured on other clips: measure it anew")
    both = mine | {f"{RIVAL}{key}": row for key, row in theirs.items()}
    kinds = {
        name.format(label): replace(how, rows=(*how.rows, *(f"{RIVAL}{key}" for key in how.rows)))
        for name, how in sweep.differences.items()
    }
    return measures_over_seeds(kinds, both, groups)


def further(variants: Mapping[str, Variant], words: str, to: str = "base", **changes) -> Variant:
    """A variant with further changes of the recipe of `to`, with which it is compared."""
    return Variant(words, variants[to].recipe | changes, {to: to})


def tuned_rate(plan: Path, optimizer: str) -> float:
    """The rate of an optimiser that had the smallest validation loss of those in a plan.

    Raises ValueError where none was tried.
    """
    tried = json.loads(plan.read_text(encoding="utf-8"))["tried"].get(optimizer)
    if not tried:
        raise ValueError(f"{plan} has no rate for {optimizer}: try some, and note them there")
    return float(min(tried, key=tried.get))


def differences(kinds: Mapping[str, Kind]) -> dict[str, Kind]:
    """The difference of each measure from the rival's."""
    return {f"{name}_minus_{{}}": minus(kind) for name, kind in kinds.items()}


def minus(kind: Kind) -> Kind:
    """The difference of a measure from the rival's."""
    n = len(kind.rows)
    return Kind(kind.unit, kind.rows, lambda *x: kind.value(*x[:n]) - kind.value(*x[n:]))


def _arrays(kept: dict, seeds) -> dict[str, np.ndarray]:
    """Rows of several seeds, (seeds, clips) by name."""
    each = [kept["seeds"][key] for key in sorted(seeds)]
    return {
        key: np.array([one[key] for one in each], object if key == GROUPS else float)
        for key in each[0]
    }


def _short(row: np.ndarray) -> list:
    """Four digits of each number, None for NaN; words as they are."""
    values = np.atleast_1d(row).tolist()
    return [x if isinstance(x, str) else float(f"{x:.4g}") if np.isfinite(x) else None
            for x in values]  # fmt: skip
