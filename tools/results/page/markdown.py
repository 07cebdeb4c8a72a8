"""Numbers, intervals and tables in Markdown."""

import re

from .words import label


def number(x: float | None) -> str:
    """Three digits; a dash where there is none."""
    if x is None or isinstance(x, str):
        return x or "-"
    if abs(x) < 1e-9:
        return "0"
    return f"{x:.0f}" if abs(x) >= 100 else f"{x:.3g}"


def span(one: dict) -> str:
    """The interval of a record; a dash where there is none."""
    return "-" if one["low"] is None else f"[{number(one['low'])}, {number(one['high'])}]"


def cell(one: dict | None, unit: bool = True) -> str:
    """Value, interval and unit of a record.

    A measure that was computed once, over all clips, has no interval. Ratios and shares have no
    unit.
    """
    if one is None or one["value"] is None:
        return "-"
    once = one["low"] == one["high"] == one["value"]
    return " ".join(
        [number(one["value"])]
        + [span(one)] * (not once)
        + [one["unit"]] * (unit and one["unit"] not in ("", "ratio", "share"))
    )


def table(head: list[str], rows: list[list[str]]) -> str:
    """A table with a head; a heading or a row's name that is only a key gets its words."""
    named = [[label(row[0]), *row[1:]] for row in rows]
    lines = [
        "| " + " | ".join(row) + " |" for row in (map(label, head), ["---"] * len(head), *named)
    ]
    return "\n".join(lines) + "\n"


def folded(section: str, summary: str, tables: int = 1) -> str:
    """A section whose text after `tables` tables is folded; unchanged if there is no more text."""
    ends = [found.end() for found in re.finditer(r"(?:^\|.*\n)+", section, re.M)]
    if len(ends) <= tables:
        return section
    open_part, rest = section[: ends[tables - 1]], section[ends[tables - 1] :].strip("\n")
    return f"{open_part}\n<details><summary>{summary}</summary>\n\n{rest}\n\n</details>\n"
