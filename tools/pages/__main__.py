"""Write the pages from executed notebooks.

    python -m tools.pages build/executed build/pages

`make pages` runs the notebooks first. Opens from a folder, a USB stick or any static host.
"""

import argparse
import html
import json
import re
import shutil
from pathlib import Path

from motiondiff_edu._files import replacing

from . import cells, font, index

STYLE = Path(__file__).with_name("style.css")
DOCS = (
    "RESULTS", "RESULTS_ALL", "EQUATIONS", "NOTATION", "GLOSSARY", "QUESTIONS", "CAPSTONE",
    "TEACHING", "PILOT", "USING", "FROM_OTHERS", "EXTENDING", "INSTALL", "BLENDER",
)  # fmt: skip

PAGE = """<!doctype html>
<html lang="en">
<head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}</title><style>{style}</style></head>
<body>
<nav aria-label="course">{links}</nav>
<main>
{body}
</main>
</body>
</html>
"""
OPENING = (
    "<h1>motiondiff_edu</h1><p>Two papers on human-motion diffusion, taken apart and put together "
    "again: MoDiff walks under velocity control, MoFusion dances to music and moves to words. "
    "These pages are the executed notebooks. They need no network; the notebooks themselves "
    "(<code>make lab</code>) have the exercises and all controls.</p>"
)
API = '<p>The library: <a href="api/index.html">its modules, functions and classes</a>.</p>'


def write(path: Path, title: str, body: str, links: str) -> None:
    style = STYLE.read_text("utf-8") + font.style(body)
    page = PAGE.format(title=html.escape(title), style=style, links=links, body=body)
    path.parent.mkdir(parents=True, exist_ok=True)
    with replacing(path) as part:
        part.write_text(page, "utf-8")


def around(entries: list[index.Entry], i: int) -> str:
    """Links to the notebook before, the index and the one after."""
    before = f'<a href="{entries[i - 1].name}.html">← {entries[i - 1].number}</a>' if i else ""
    last = i + 1 == len(entries)
    after = "" if last else f'<a href="{entries[i + 1].name}.html">{entries[i + 1].number} →</a>'
    return f'<span>{before}</span><a href="index.html">all notebooks</a><span>{after}</span>'


def pages(executed: Path, target: Path) -> list[Path]:
    """Write a page for each notebook, the docs they link to, and the index; return all paths."""
    names = sorted(path for path in executed.glob("*.ipynb") if re.match(r"\d\d_", path.name))
    if not names:
        raise SystemExit(f"there are no executed notebooks in {executed}; `make pages` makes them")
    read = {path.stem: json.loads(path.read_text("utf-8")) for path in names}
    entries = [index.entry(name, notebook) for name, notebook in read.items()]
    written = []
    for i, (name, notebook) in enumerate(read.items()):
        try:
            body = cells.of_notebook(notebook)
        except ValueError as error:
            raise SystemExit(f"{name}: {error}") from error
        written.append(target / f"{name}.html")
        write(written[-1], f"{entries[i].number} {entries[i].title}", body, around(entries, i))
    for name in DOCS:
        source = Path("docs") / f"{name}.md"
        body = cells.of_markdown(source.read_text("utf-8"))
        body = re.sub(r'href="\.\./notebooks/(\w+)\.ipynb', r'href="../\1.html', body)
        body = re.sub(r'href="(\d\d_\w+\.html)', r'href="../\1', body)
        written.append(target / "docs" / f"{name}.html")
        write(written[-1], name, body, '<a href="../index.html">all notebooks</a>')
        copy_pictures(body, target / "docs")
    written.append(target / "index.html")
    needs = "<h2>What needs what</h2>" + index.graph(entries)
    opening = OPENING + (API if (target / "api" / "index.html").is_file() else "")
    write(written[-1], "motiondiff_edu", opening + index.cards(entries) + needs, "")
    return written


def copy_pictures(body: str, target: Path) -> None:
    """Copy the pictures of a page of the docs beside it."""
    for name in re.findall(r'src="([\w./-]+)"', body):
        source = Path("docs") / name
        if source.is_file():
            (target / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source, target / name)


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m tools.pages", description=__doc__)
    parser.add_argument("executed", type=Path)
    parser.add_argument("target", type=Path)
    chosen = parser.parse_args()
    from . import api  # pdoc, which only this needs

    api.write(chosen.target / "api")
    written = pages(chosen.executed, chosen.target)
    size = sum(path.stat().st_size for path in written) / 1e6
    print(f"{len(written)} pages, {size:.0f} MB: open {chosen.target / 'index.html'}")


if __name__ == "__main__":
    main()
