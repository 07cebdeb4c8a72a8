"""docs/RESULTS.md and docs/RESULTS_ALL.md, from template.md beside this file and all records.

The template is Markdown. In it, `{{name}}` is a record's value, interval and unit, `{{value name}}`
the value alone, `{{percent name}}` the value times 100, and `{{about name key}}` a setting of its
measurement. A block `table` is a table: its first line is `corner | words => pattern | ...`, the
others are rows. A row `words => key` has the records whose names are the columns' patterns with the
key in the place of `*` (a pattern that ends in `@setting` shows that setting; an empty key is
written as two quotes). A row `words | cell | ...` is written as it is. For blocks `goals` and
`claims`, see goals.py and claims.py.
"""

import re
from collections.abc import Iterator
from pathlib import Path

from motiondiff_edu._files import replacing

from . import claims, goals, pictures
from .records import by_name, cell, number, read_files, table

TEMPLATE = Path(__file__).with_name("template.md")
BLOCK = re.compile(r"^```(table|goals|claims)\n(.*?)^```\n", re.M | re.S)
PLACE = re.compile(r"\{\{([^{}]+)\}\}")
VERBS = ("value", "percent", "about")


def render(docs: Path, benchmarks: Path = Path("benchmarks/results")) -> list[str]:
    """Write both pages beside the records. Returns the records that the template misses."""
    files = read_files(docs / "results", benchmarks)
    records = by_name(files)
    pictures.draw(records, docs / "results")
    template = TEMPLATE.read_text(encoding="utf-8")
    for name, text in (
        ("RESULTS.md", page(template, records)),
        ("RESULTS_ALL.md", all_records(template, files)),
    ):
        with replacing(docs / name) as aside:
            aside.write_text(text, encoding="utf-8")
    return [name for name in names_in(template) if name not in records]


def page(template: str, records: dict[str, dict]) -> str:
    """The template with the records in their places; a dash where there is no such record."""
    texts = {}
    for kind, block in BLOCK.findall(template):
        if kind != "table":
            texts |= _places(kind, block, records)

    def block(found: re.Match) -> str:
        return _table(found[2], records) if found[1] == "table" else ""

    def place(found: re.Match) -> str:
        return texts.get(found[1]) or _inline(found[1], records)

    return PLACE.sub(place, BLOCK.sub(block, template))


def all_records(template: str, files: dict[str, list[dict]]) -> str:
    """The goals, then a table for each file of records."""
    every = [goal for kind, block in BLOCK.findall(template) if kind == "goals"
             for goal in goals.read_goals(block)]  # fmt: skip
    text = "# All results\n\n## The goals\n\n" + goals.goals_table(every, by_name(files))
    for file, records in files.items():
        rows = [[f"`{one['name']}`", cell(one), one["unit"]] for one in records]
        made = sorted({f"`{one['command']}`" for one in records} | {
            one["machine"] for one in records if "machine" in one})  # fmt: skip
        text += f"\n## {file}\n\n{'; '.join(made)}\n\n"
        text += table(["record", "value [95 % interval]", "unit"], rows)
    return text


def names_in(template: str) -> Iterator[str]:
    """The records that a template names; of a row or a column of a table, see `stars_in`."""
    for kind, block in BLOCK.findall(template):
        if kind == "goals":
            yield from (goal.name for goal in goals.read_goals(block))
        if kind == "claims":
            yield from (name for claim in claims.read_claims(block) for name in claim.names)
    texts = {key for kind in ("goals", "claims") for key in _places(kind, "", {})}
    for place in PLACE.findall(template):
        if place not in texts:
            yield _parts(place)[1]


def stars_in(template: str) -> Iterator[tuple[str, list[str]]]:
    """Each row and each column of the tables, in words, with the records that it could show."""
    for kind, block in BLOCK.findall(template):
        if kind == "table":
            columns, rows = _pattern_rows(block)
            keys = {words: key for words, key in rows if isinstance(key, str)}
            for words, key in keys.items():
                yield words, [_name(pattern, key) for _, pattern in columns]
            for words, pattern in columns:
                yield words, [_name(pattern, key) for key in keys.values()]


def _places(kind: str, block: str, records: dict[str, dict]) -> dict[str, str]:
    if kind == "goals":
        return goals.places(goals.read_goals(block), records)
    return claims.places(claims.read_claims(block), records)


def _parts(place: str) -> tuple[str, str, str]:
    """Verb, record and setting of a place."""
    words = place.split()
    verb = words.pop(0) if words[0] in VERBS else ""
    return verb, words[0], " ".join(words[1:])


def _inline(place: str, records: dict[str, dict]) -> str:
    verb, name, setting = _parts(place)
    one = records.get(name)
    if one is None or verb == "":
        return cell(one, unit=True)
    if verb == "about":
        return _setting(one, setting)
    return number(one["value"] * (100 if verb == "percent" else 1))


def _setting(record: dict, key: str) -> str:
    value = record["seeds"].get(key, "-")
    return f"{value:g}" if isinstance(value, float) else str(value)


def _pattern_rows(block: str) -> tuple[list, list]:
    """Columns (words, pattern), and rows (words, key), or (words, cells) of one that is written."""
    head, *lines = block.splitlines()
    columns = [tuple(part.split(" => ")) for part in head.split(" | ")[1:]]
    rows = []
    for line in lines:
        words, *cells = line.split(" | ")
        rows.append((words, cells) if cells else tuple(words.split(" => ")))
    return columns, rows


def _name(pattern: str, key: str) -> str:
    return pattern.split("@")[0].replace("*", key.strip('"'))


def _table(block: str, records: dict[str, dict]) -> str:
    columns, rows = _pattern_rows(block)

    def shown(pattern: str, key: str) -> str:
        one = records.get(_name(pattern, key))
        setting = pattern.partition("@")[2]
        return _setting(one, setting) if one and setting else cell(one)

    made = [
        [words, *(key if isinstance(key, list) else [shown(p, key) for _, p in columns])]
        for words, key in rows
    ]
    corner = block.splitlines()[0].split(" | ")[0]
    return table([corner, *(words for words, _ in columns)], made)
