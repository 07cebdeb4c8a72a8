"""Numbers, intervals and tables as Markdown has them."""


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

    A figure that was computed once, over all clips, has no interval.
    """
    if one is None or one["value"] is None:
        return "-"
    once = one["low"] == one["high"] == one["value"]
    return " ".join(
        [number(one["value"])]
        + [span(one)] * (not once)
        + [one["unit"]] * (unit and bool(one["unit"]))
    )


def table(head: list[str], rows: list[list[str]]) -> str:
    """A table with a head."""
    lines = ["| " + " | ".join(row) + " |" for row in (head, ["---"] * len(head), *rows)]
    return "\n".join(lines) + "\n"
