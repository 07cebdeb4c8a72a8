"""Records by name, and how their numbers are written."""

import json
from pathlib import Path

NO_UNIT = ("", "ratio", "share", "kappa", "distance")


def read_files(*folders: Path) -> dict[str, list[dict]]:
    """The records of each JSON file of the folders, by the file's name without its ending."""
    paths = sorted(path for folder in folders for path in folder.glob("*.json"))
    return {path.stem: json.loads(path.read_text(encoding="utf-8")) for path in paths}


def by_name(files: dict[str, list[dict]]) -> dict[str, dict]:
    """All records by name.

    Raises ValueError for a name that is in two files, because one of the files must be old.
    """
    found, where = {}, {}
    for file, records in files.items():
        for one in records:
            if one["name"] in found:
                raise ValueError(
                    f"{one['name']} is in {where[one['name']]}.json and in {file}.json: "
                    "delete the older file"
                )
            found[one["name"]], where[one["name"]] = one, file
    return found


def number(x: float | None) -> str:
    """Three digits; a dash where there is none."""
    if x is None:
        return "-"
    if abs(x) < 1e-9:
        return "0"
    return f"{x:.0f}" if abs(x) >= 100 else f"{x:.3g}"


def interval(record: dict) -> str:
    """[low, high]; nothing for a number without one, or where both are written as the number is."""
    low, high = (number(record[side]) for side in ("low", "high"))
    return "" if low == "-" or low == high == number(record["value"]) else f"[{low}, {high}]"


def cell(record: dict | None, unit: bool = False) -> str:
    """Value and interval, and the unit where it is wanted and there is one."""
    if record is None or record["value"] is None:
        return "-"
    parts = [number(record["value"]), interval(record)]
    parts += [record["unit"]] * (unit and record["unit"] not in NO_UNIT)
    return " ".join(filter(None, parts))


def table(head: list[str], rows: list[list[str]]) -> str:
    """A table in Markdown."""
    return "".join(f"| {' | '.join(row)} |\n" for row in (head, ["---"] * len(head), *rows))
