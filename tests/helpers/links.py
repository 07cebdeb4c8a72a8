"""The links of notebooks and pages that lead to files."""

import json
import re
from pathlib import Path
from urllib.parse import unquote

LINK = re.compile(r'\]\(([^)\s]+)\)|(?:src|href)="([^"]+)"')


def texts(path: Path) -> list[str]:
    """The text of a page, or of a notebook's markdown cells."""
    if path.suffix == ".md":
        return [path.read_text(encoding="utf-8")]
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    return ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "markdown"]


def to_files(path: Path) -> list[str]:
    """The relative links in one file, without code blocks and without what follows a #."""
    found = []
    for text in texts(path):
        plain = re.sub(r"```.*?```|`[^`]*`", "", text, flags=re.DOTALL)
        found += [unquote((a or b).split("#")[0]) for a, b in LINK.findall(plain)]
    return [link for link in found if link and not re.match(r"\w+:", link)]


def dead(folder: Path) -> list[str]:
    """`file: link` for every relative link that leads nowhere in the folder."""
    paths = sorted(path for kind in ("*.ipynb", "*.md") for path in folder.rglob(kind))
    missing = []
    for path in paths:
        targets = {link: (path.parent / link).resolve() for link in to_files(path)}
        lost = [
            k
            for k, to in targets.items()
            if not (to.exists() and to.is_relative_to(folder.resolve()))
        ]
        missing += [f"{path.relative_to(folder)}: {link}" for link in lost]
    return missing
