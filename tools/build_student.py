"""Make the student edition: notebooks/*.ipynb -> notebooks/student/*.ipynb.

A code cell tagged `solution` holds a function whose body has lines `# solution` ... `# end
solution`, then the call of its check. The student edition has `raise NotImplementedError("your
turn")` there, and then the solution, folded. Everything else stays. The same input gives the same
bytes.

    python tools/build_student.py            write, unless a file there was changed by hand
    python tools/build_student.py --force    write, also over files that were changed by hand
    python tools/build_student.py --check    write nothing; exit 1 when the edition is stale
"""

import argparse
import hashlib
import json
import re
import subprocess
import sys
from pathlib import Path

import notebook_cells
from notebook_cells import NOTEBOOKS, tags

from motiondiff_edu._files import replacing

REGION = re.compile(r"^( *)# solution *\n(.*?\n)\1# end solution *$", re.MULTILINE | re.DOTALL)
# a link out of the folder needs one more .. in notebooks/student
UPWARDS = re.compile(r'(\]\(|src="|href=")\.\./')
# in the edition's folder, not committed: {name: SHA-256} of what was written last
RECORD = ".generated.json"


class StudentError(ValueError):
    """A solution cell that cannot be made into a stub: which notebook and cell, and what to do."""


def stub(source: str, where: str) -> str:
    """The source with each solution region replaced by `raise NotImplementedError`."""
    regions = list(REGION.finditer(source))
    if (
        not regions
        or source.count("# solution") != len(regions)
        or source.count("# end solution") != len(regions)
    ):
        raise StudentError(
            f"{where}: a cell tagged `solution` needs `# solution` ... `# end solution`, one indent"
        )
    if any(not region[1] for region in regions):
        raise StudentError(
            f"{where}: the solution must be the body of a function, or Run All stops at the stub"
        )
    return REGION.sub(lambda region: f'{region[1]}raise NotImplementedError("your turn")', source)


def solution(source: str) -> str:
    """The solution as it is shown: without the markers and without the call of the check."""
    lines = [line for line in source.splitlines() if not re.match(r" *# (end )?solution *$", line)]
    return "\n".join(line for line in lines if not re.match(r"checks\.\w+\(", line)).strip()


def folded(source: str) -> str:
    return (
        "<details>\n<summary>Solution</summary>\n\n"
        f"```python\n{solution(source)}\n```\n\n</details>"
    )


def student(notebook: dict, name: str) -> dict:
    """The student edition of one notebook."""
    cells = []
    for index, cell in enumerate(notebook["cells"]):
        cell = {
            **cell,
            "metadata": {k: v for k, v in cell.get("metadata", {}).items() if k in ("tags", "alt")},
        }
        if cell["cell_type"] == "markdown":
            cells.append(cell | {"source": UPWARDS.sub(r"\1../../", cell["source"])})
            continue
        cell |= {"outputs": [], "execution_count": None}
        if "solution" not in tags(cell):
            cells.append(cell)
            continue
        source, identity = cell["source"], cell.get("id", f"cell-{index}")
        cell["metadata"] = {
            "tags": ["exercise" if tag == "solution" else tag for tag in tags(cell)]
        }
        cells.append(cell | {"source": stub(source, f"{name}, cell {index} ({identity})")})
        solution_cell = {
            "cell_type": "markdown",
            "id": f"{identity[:55]}-solution",
            "metadata": {},
            "source": folded(source),
        }
        cells.append(solution_cell)
    kernel = {"display_name": "Python 3 (ipykernel)", "language": "python", "name": "python3"}
    metadata = {"kernelspec": kernel, "language_info": {"name": "python"}}
    return {"cells": cells, "metadata": metadata, "nbformat": 4, "nbformat_minor": 5}


def text(notebook: dict) -> str:
    """The text of a notebook as Jupyter writes it.

    Sources are lists of lines, keys are sorted, and the indent is one space.
    """
    cells = [
        cell | {"source": cell["source"].splitlines(keepends=True)} for cell in notebook["cells"]
    ]
    return (
        json.dumps(notebook | {"cells": cells}, indent=1, ensure_ascii=False, sort_keys=True) + "\n"
    )


def edition(folder: Path) -> dict[Path, str]:
    """The files of folder/student: {path: text}."""
    paths = sorted(path for path in folder.glob("*.ipynb") if re.match(r"\d\d", path.name))
    return {
        folder / "student" / path.name: text(student(notebook_cells.read(path), path.name))
        for path in paths
    }


def stale(folder: Path) -> list[str]:
    """The files that are missing, changed or superfluous in folder/student."""
    wanted = edition(folder)
    there = set((folder / "student").glob("*.ipynb"))
    changed = [
        path
        for path, content in wanted.items()
        if path in there and path.read_text("utf-8") != content
    ]
    kinds = {
        "missing": set(wanted) - there,
        "changed": set(changed),
        "left over": there - set(wanted),
    }
    return [f"{path.name}: {kind}" for kind, paths in kinds.items() for path in sorted(paths)]


def digest(content: str | bytes) -> str:
    """SHA-256 of a file's content; git on Windows may write other line ends, which do not count."""
    raw = content.encode() if isinstance(content, str) else content
    return hashlib.sha256(raw.replace(b"\r\n", b"\n")).hexdigest()


def last_written(folder: Path) -> dict[str, str]:
    """{name: SHA-256} of what was written into folder/student last; empty where there is no
    record."""
    try:
        return json.loads((folder / "student" / RECORD).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}


def committed(path: Path) -> bool:
    """Whether git has this file exactly as it is. False without git, or outside of a repository."""
    command = ["git", "status", "--porcelain", "--ignored", "--", path.name]
    try:
        answer = subprocess.run(command, cwd=path.parent, capture_output=True, text=True)
    except OSError:
        return False
    return answer.returncode == 0 and not answer.stdout.strip()


def by_hand(folder: Path) -> list[Path]:
    """Files of folder/student that would be lost: not as written last, nor as they will be, nor
    committed."""
    last = last_written(folder)
    wanted = {path: digest(content) for path, content in edition(folder).items()}
    there = {
        path: digest(path.read_bytes()) for path in sorted((folder / "student").glob("*.ipynb"))
    }
    changed = [
        path
        for path, found in there.items()
        if found not in (last.get(path.name), wanted.get(path))
    ]
    return [path for path in changed if not committed(path)]


def write(folder: Path) -> int:
    """Write the edition, remove superfluous files, and return the number of notebooks."""
    wanted = edition(folder)
    (folder / "student").mkdir(exist_ok=True)
    for path in set((folder / "student").glob("*.ipynb")) - set(wanted):
        path.unlink()
    for path, content in wanted.items():
        with replacing(path) as aside:
            aside.write_text(content, encoding="utf-8", newline="\n")
    written = {path.name: digest(content) for path, content in wanted.items()}
    with replacing(folder / "student" / RECORD) as aside:
        aside.write_text(json.dumps(written, indent=1), encoding="utf-8")
    return len(wanted)


def refusal(paths: list[Path]) -> str:
    """The message when files would be lost."""
    return "\n".join(
        [
            "not written: these were changed by hand, and would be lost:",
            *(f"  {path.parent.name}/{path.name}" for path in paths),
            "Copy what you want to keep; then: make student FORCE=1 (or --force).",
            "Work in your own copies instead, which nothing overwrites: make lab.",
        ]
    )


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description="Make the student edition of the notebooks.")
    parser.add_argument(
        "--check", action="store_true", help="write nothing; exit 1 when the edition is stale"
    )
    parser.add_argument(
        "--force", action="store_true", help="also overwrite files that were changed by hand"
    )
    parser.add_argument("--folder", type=Path, default=NOTEBOOKS)
    options = parser.parse_args(arguments)
    try:
        if not options.check:
            if not options.force and (changed := by_hand(options.folder)):
                print(refusal(changed), file=sys.stderr)
                return 1
            print(f"{write(options.folder)} notebooks written to {options.folder.name}/student")
            return 0
        found = stale(options.folder)
    except StudentError as error:
        print(error, file=sys.stderr)
        return 1
    if found:
        print(
            "\n".join(["the student edition is stale; run: make student", *found]), file=sys.stderr
        )
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
