"""A student's own copies of the notebooks. A copy is renewed only while it is unchanged.

A copy counts as changed when its cells differ from those handed out, in kind, text or outputs.
JupyterLab also writes into the metadata of a notebook that is only opened; that does not count.
"""

import hashlib
import json
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from .._files import replacing
from .anchors import for_jupyterlab
from .edition import edition_of
from .places import FolderError, program

RECORD = ".lab/handed_out.json"
PAGES = {".md", ".png", ".py"}  # of docs/; setup.py puts the same files into a wheel


@dataclass(frozen=True)
class Handout:
    """The result of `hand_out`: the copies that it renewed, and the old ones that it kept."""

    renewed: tuple[str, ...]
    kept: tuple[str, ...]


def student_files(notebooks: Path) -> dict[str, bytes]:
    """{name: content} of a student's files: the student edition, and the pages it links to.

    The pages go to docs/ below the copies, and the links of the notebooks follow them there. Links
    to headings are written as JupyterLab finds them (`anchors.py`).
    """
    edition = sorted((notebooks / "student").glob("*.ipynb"))
    found = {path.name: path.read_bytes().replace(b"../../docs/", b"docs/") for path in edition}
    docs = notebooks.parent / "docs"
    for path in sorted(docs.rglob("*")):
        name = path.relative_to(docs)
        hidden = any(part.startswith(".") for part in name.parts)
        if path.suffix in PAGES and not hidden:
            content = path.read_bytes()
            if path.suffix == ".md":  # notebooks lie just above the pages here
                content = content.replace(b"](../notebooks/", b"](../")
            found[f"docs/{name.as_posix()}"] = content
    pages = {Path(n).name: text.decode() for n, text in found.items() if n.endswith(".md")}
    for name, content in found.items():
        if name.endswith((".md", ".ipynb")):
            found[name] = for_jupyterlab(content.decode(), pages, own=Path(name).name).encode()
    return found


def digest(name: str, content: bytes) -> str:
    """SHA-256 of a page, or of a notebook's cells: their kind, text and outputs."""
    if name.endswith(".ipynb"):
        try:
            cells = json.loads(content)["cells"]
            seen = [[c["cell_type"], "".join(c["source"]), c.get("outputs", [])] for c in cells]
            content = json.dumps(seen, sort_keys=True).encode()
        except (ValueError, KeyError, TypeError):
            pass  # this is no notebook any more: compare its bytes
    return hashlib.sha256(content).hexdigest()


def read_record(mine: Path) -> dict[str, str]:
    """{name: digest} of the files handed out; empty when there is no readable record."""
    try:
        record = json.loads((mine / RECORD).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return record if isinstance(record, dict) else {}


def write_record(mine: Path, record: dict[str, str]) -> None:
    """Write what was handed out: the digest of each notebook."""
    with replacing(mine / RECORD) as aside:
        aside.write_text(json.dumps(record, indent=1, sort_keys=True) + "\n", encoding="utf-8")


@contextmanager
def written_in(mine: Path) -> Iterator[None]:
    """Turn a failed write into a FolderError that says where, why, and what to do."""
    try:
        mine.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=mine).close()
        yield
    except OSError as error:
        raise FolderError(
            f"your copies of the notebooks cannot be written to {mine} "
            f"({error.strerror or error}).\n"
            f"Start from a folder of your own, or name one: {program()} lab --folder FOLDER"
        ) from error


def write_whole(path: Path, content: bytes) -> None:
    """Write a file whole, or not at all."""
    with replacing(path) as aside:
        aside.write_bytes(content)


def hand_out(notebooks: Path, mine: Path) -> Handout:
    """Bring the copies in `mine` up to date, and say which old ones were kept.

    A missing copy is made. An old copy that is unchanged is replaced, or removed when the course no
    longer has it. A changed copy, or one of unknown origin, stays as it is. The folder of a class
    (`edition.py`) gets its notebooks alone, and no solutions where it has none.
    Raises FolderError when the folder is not writable, or the record of its class is damaged.
    """
    record = read_record(mine)
    renewed, kept = [], []
    now = edition_of(mine).of(student_files(notebooks))
    with written_in(mine):
        for name, content in now.items():
            path, new = mine / name, digest(name, content)
            there = digest(name, path.read_bytes()) if path.exists() else None
            if there is not None and there not in (new, record.get(name)):
                if record.get(name) != new:
                    kept.append(name)
                continue
            if there != new:
                write_whole(path, content)
                renewed += [name] if there is not None else []
            record[name] = new
        for name in sorted(set(record) - set(now)):
            path, old = mine / name, record.pop(name)
            if path.is_file() and digest(name, path.read_bytes()) == old:
                path.unlink()
        if record != read_record(mine):
            write_record(mine, record)
    return Handout(tuple(renewed), tuple(kept))


def make_fresh(notebooks: Path, mine: Path, name: str) -> Path | None:
    """Make a fresh copy of one notebook; return the path to which a changed one was moved.

    Raises FolderError when the folder is not writable.
    """
    content, path = edition_of(mine).of(student_files(notebooks))[name], mine / name
    aside = None
    new = digest(name, content)
    with written_in(mine):
        if path.exists() and digest(name, path.read_bytes()) != new:
            aside = free_name(path)
            path.rename(aside)
        if not path.exists():
            write_whole(path, content)
        write_record(mine, read_record(mine) | {name: new})
    return aside


def free_name(path: Path) -> Path:
    """The first of ..._mine, ..._mine_2, ... that is not taken."""
    count = 1
    while True:
        end = "_mine" if count == 1 else f"_mine_{count}"
        aside = path.with_name(path.stem + end + path.suffix)
        if not aside.exists():
            return aside
        count += 1
