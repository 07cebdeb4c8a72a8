"""Which notebooks a folder of copies holds: the whole course, or those that a class was given.

The folder of a class has a hidden record of it, and each of its notebooks says the same in its
metadata. So copies that are passed on without the record still get no solutions.
"""

import contextlib
import json
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path

from .._files import replacing
from .places import FolderError, NotebookError, find

RECORD = ".lab/class.json"
MARK = "motiondiff_class"  # in the metadata of a class's notebooks


@dataclass(frozen=True)
class Edition:
    """The notebooks of a folder by their numbers (none: all of them), with or without solutions."""

    notebooks: tuple[str, ...] = ()
    solutions: bool = True

    @property
    def first(self) -> str:
        """The number of the notebook that opens."""
        return min(self.notebooks, default="00")

    def find(self, folder: Path, number: str) -> Path:
        """The notebook of that number. Raises NotebookError if this edition does not have it."""
        if self.notebooks and number.zfill(2) not in self.notebooks:
            raise NotebookError(
                f"no notebook {number} in this class's copies; there are: "
                f"{', '.join(self.notebooks)}"
            )
        return find(folder, number)

    def of(self, files: dict[str, bytes]) -> dict[str, bytes]:
        """Those of a student's files that this edition has: {name: content}; pages all stay."""
        if self == Edition():
            return dict(files)
        kept = {}
        for name, content in files.items():
            if name.endswith(".ipynb"):
                if self.notebooks and name[:2] not in self.notebooks:
                    continue
                content = self._marked(content)
            kept[name] = content
        return kept

    def _marked(self, content: bytes) -> bytes:
        """A notebook of the student edition as the class gets it; hints always stay."""
        notebook = json.loads(content)
        if not self.solutions:
            notebook["cells"] = [
                cell for cell in notebook["cells"] if not cell.get("id", "").endswith("-solution")
            ]
        notebook["metadata"][MARK] = asdict(self)
        return (json.dumps(notebook, indent=1, ensure_ascii=False, sort_keys=True) + "\n").encode()


def class_edition(notebooks: Path, numbers: Iterable[str], solutions: bool) -> Edition:
    """The edition of a class. Raises NotebookError for a number that is no notebook."""
    found = {find(notebooks / "student", number).name[:2] for number in numbers}
    return Edition(tuple(sorted(found)), solutions)


def edition_of(mine: Path) -> Edition:
    """What the folder of copies was made as. Raises FolderError where its record is damaged."""
    path = mine / RECORD
    try:
        return _read(json.loads(path.read_text(encoding="utf-8")))
    except (FileNotFoundError, NotADirectoryError):
        return _edition_of_copies(mine)
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise FolderError(
            f"{path} does not say which notebooks your class was given. Ask for a new copy of "
            f"the folder, or remove that file: the notebooks say it as well."
        ) from error


def _read(record: dict) -> Edition:
    """An edition from JSON. Raises KeyError and TypeError where it is none."""
    numbers, solutions = record["notebooks"], record["solutions"]
    if not all(isinstance(n, str) for n in numbers) or not isinstance(solutions, bool):
        raise TypeError
    return Edition(tuple(numbers), solutions)


def _edition_of_copies(mine: Path) -> Edition:
    """What the notebooks in a folder say of their class; the whole course if none says anything."""
    for path in sorted(mine.glob("[0-9][0-9]_*.ipynb")):
        with contextlib.suppress(OSError, ValueError, KeyError, TypeError):
            return _read(json.loads(path.read_text(encoding="utf-8"))["metadata"][MARK])
    return Edition()


def write_edition(mine: Path, edition: Edition) -> None:
    """Note in the folder of copies what it holds."""
    with replacing(mine / RECORD) as aside:
        aside.write_text(json.dumps(asdict(edition)) + "\n", encoding="utf-8")
