"""The first page: each notebook with a picture, and which needs which."""

import html
import re
from dataclasses import dataclass

WIDTH, ROW = 880, 64  # pixels of the graph
BOX = (150, 40)


@dataclass(frozen=True)
class Entry:
    """What the index says of a notebook."""

    number: str
    name: str  # of its file, without the ending
    title: str
    question: str
    needs: tuple[str, ...]  # numbers
    picture: str  # a data URL, or empty


def entry(name: str, notebook: dict) -> Entry:
    """Title, first lines, prerequisites and first picture of an executed notebook."""
    opening = "".join(notebook["cells"][0]["source"])
    title = re.search(r"^# (?:\d\d )?(.+)$", opening, re.M)[1]
    rest = [plain(line) for line in opening.splitlines()[1:] if line.strip()]
    return Entry(name[:2], name, title, rest[0] if rest else "", needs(opening), picture(notebook))


def plain(line: str) -> str:
    """A line of Markdown without marks: of links their words, and no stars, underlines, ticks."""
    words = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", line)
    return re.sub(r"[*`]|\b_|_\b", "", words).strip()


def needs(opening: str) -> tuple[str, ...]:
    """The numbers of the notebooks in "It needs notebooks 01 to 03 and 07"."""
    line = re.search(r"\*\*It needs\*\*(.+?)(?:\*\*|\n\n|$)", opening, re.S)
    if not line:
        return ()
    found: list[str] = []
    for first, last in re.findall(r"\b(\d\d)\b(?:\s+to\s+(\d\d)\b)?", line[1]):
        found += [f"{n:02d}" for n in range(int(first), int(last or first) + 1)]
    return tuple(dict.fromkeys(found))


def picture(notebook: dict) -> str:
    """The first picture of a notebook, as a data URL."""
    for cell in notebook["cells"]:
        for output in cell.get("outputs", []):
            png = output.get("data", {}).get("image/png")
            if png:
                return "data:image/png;base64," + "".join(png).replace("\n", "")
    return ""


def lacking(entries: list[Entry]) -> dict[str, tuple[str, ...]]:
    """What each notebook needs directly: without what its own prerequisites need already."""
    needs = {one.number: [n for n in one.needs if n < one.number] for one in entries}
    every: dict[str, set[str]] = {}
    for number in sorted(needs):
        every[number] = set(needs[number]).union(*(every.get(n, set()) for n in needs[number]))
    return {
        number: tuple(
            n for n in direct if not any(n in every.get(other, set()) for other in direct)
        )
        for number, direct in needs.items()
    }


def levels(entries: list[Entry]) -> dict[str, int]:
    """How many notebooks come one after the other before each."""
    depth: dict[str, int] = {}
    for number, direct in sorted(lacking(entries).items()):
        depth[number] = 1 + max((depth.get(n, 0) for n in direct), default=-1)
    return depth


def graph(entries: list[Entry]) -> str:
    """An SVG picture: each notebook below those that it needs."""
    depth, direct = levels(entries), lacking(entries)
    rows: dict[int, list[Entry]] = {}
    for one in entries:
        rows.setdefault(depth[one.number], []).append(one)
    place = {}
    for row, ones in rows.items():
        for i, one in enumerate(ones):
            place[one.number] = (WIDTH * (i + 1) / (len(ones) + 1), ROW * (row + 0.5))
    w, h = BOX
    lines = [
        f'<path d="M{place[n][0]:.0f} {place[n][1] + h / 2:.0f} '
        f'L{place[one.number][0]:.0f} {place[one.number][1] - h / 2:.0f}"/>'
        for one in entries
        for n in direct[one.number]
        if n in place
    ]
    boxes = []
    for one in entries:
        x, y = place[one.number]
        words = html.escape(_short(one.title))
        boxes.append(
            f'<a href="{one.name}.html"><rect x="{x - w / 2:.0f}" y="{y - h / 2:.0f}" width="{w}" '
            f'height="{h}" rx="6"/><text x="{x:.0f}" y="{y - 3:.0f}">{one.number}</text>'
            f'<text class="small" x="{x:.0f}" y="{y + 13:.0f}">{words}</text></a>'
        )
    height = ROW * (max(rows) + 1)
    told = "; ".join(
        f"{one.number} needs {', '.join(direct[one.number]) or 'nothing'}" for one in entries
    )
    return (
        f'<svg class="graph" viewBox="0 0 {WIDTH} {height}" role="img" '
        f'aria-label="{html.escape(told)}">{"".join(lines)}{"".join(boxes)}</svg>'
    )


def _short(title: str, most: int = 24) -> str:
    head = re.split(r"[:,]", title)[0]
    return head if len(head) <= most else head[: most - 1].rsplit(" ", 1)[0] + " …"


def cards(entries: list[Entry]) -> str:
    """A list of all notebooks with picture, title and question."""
    items = []
    for one in entries:
        image = f'<img alt="" loading="lazy" src="{one.picture}">' if one.picture else ""
        items.append(
            f'<li><a href="{one.name}.html">{image}<b>{one.number} {html.escape(one.title)}</b></a>'
            f"<p>{html.escape(one.question)}</p></li>"
        )
    return f'<ol class="cards">{"".join(items)}</ol>'
