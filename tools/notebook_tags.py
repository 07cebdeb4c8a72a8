"""Docstrings say `Notebook: 07` if that notebook uses what they describe.

This tool finds wrong tags, and corrects them.

    python tools/notebook_tags.py          # list them
    python tools/notebook_tags.py --mend   # take the wrong numbers out
A definition's own name must occur in the notebook; a module's tag needs the module's name, or one
of its public names.
"""

import argparse
import ast
import json
import re
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = ("motiondiff_edu", "data_synth")
TAG = re.compile(r"Notebooks?:\s*(\d\d(?:,\s*\d\d)*)")
ALONE = re.compile(r"(?:[ \t]*\n)*[ \t]*Notebooks?:\s*\d\d(?:,\s*\d\d)*\.?")
WIDTH = 100
DEFINITIONS = (ast.FunctionDef, ast.ClassDef)


CODE = re.compile(r"`[^`\n]+`")
A_WORD = re.compile(r"[a-z]+")  # a name that may be an ordinary word of a text


@cache
def texts_of(number: str) -> tuple[str, str]:
    """All of a notebook's text, and what of it is code; both empty without such a notebook."""
    found = sorted((ROOT / "notebooks").glob(f"{number}_*.ipynb"))
    cells = json.loads(found[0].read_text(encoding="utf-8"))["cells"] if found else []
    texts = [(cell["cell_type"], "".join(cell["source"])) for cell in cells]
    code = [text if kind == "code" else " ".join(CODE.findall(text)) for kind, text in texts]
    return "\n".join(text for _, text in texts), "\n".join(code)


def occurs(names: list[str], number: str) -> bool:
    """Whether a notebook uses one of the names.

    A word of its prose, as in "with a joystick", is no use of the function `joystick`.
    """
    whole, code = texts_of(number)
    return any(
        re.search(rf"\b{re.escape(name)}\b", code if A_WORD.fullmatch(name) else whole)
        for name in names
    )


def tagged(path: Path) -> Iterator[tuple[str, ast.Constant, list[str]]]:
    """Every docstring of a file: what it describes, its node, and the names to look for."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    public = [
        n.name for n in tree.body if isinstance(n, DEFINITIONS) and not n.name.startswith("_")
    ]
    stem = path.parent.name if path.stem == "__init__" else path.stem
    for node in ast.walk(tree):
        if not isinstance(node, (ast.Module, *DEFINITIONS)) or not ast.get_docstring(node):
            continue
        names = [stem, *public] if isinstance(node, ast.Module) else [node.name]
        yield getattr(node, "name", stem), node.body[0].value, names


def wrong_in(path: Path) -> list[tuple[str, ast.Constant, list[str]]]:
    """The wrong tags of a file: the definition, its docstring, and the wrong numbers."""
    found = []
    for name, docstring, names in tagged(path):
        numbers = [n for tag in TAG.findall(docstring.value) for n in re.findall(r"\d\d", tag)]
        wrong = [number for number in numbers if not occurs(names, number)]
        found += [(name, docstring, wrong)] if wrong else []
    return found


def files() -> list[Path]:
    return sorted(path for package in PACKAGES for path in (ROOT / package).rglob("*.py"))


def wrong_tags() -> list[str]:
    """`performers/walker.py: Walker: 00`, one for each wrong tag."""
    return [
        f"{path.relative_to(ROOT)}: {name}: {', '.join(wrong)}"
        for path in files()
        for name, _, wrong in wrong_in(path)
    ]


def mend(path: Path) -> None:
    """Take the wrong numbers out of a file's docstrings, and a tag that has none left."""
    lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
    # from the end, so that the lines of the others stay where they are
    for _, docstring, wrong in sorted(wrong_in(path), key=lambda one: -one[1].lineno):
        first, last = docstring.lineno - 1, docstring.end_lineno
        text = "".join(lines[first:last])

        def without(match: re.Match, wrong=wrong) -> str:
            left = [n for n in re.findall(r"\d\d", match[0]) if n not in wrong]
            start = match[0][: match[0].index("Notebook")]
            return f"{start}Notebook: {', '.join(left)}" if left else ""

        lines[first:last] = [
            within_width(line) for line in ALONE.sub(without, text).splitlines(True)
        ]
    path.write_text("".join(lines), encoding="utf-8")


def within_width(line: str) -> str:
    """Break a line that has become too long before its tag or its closing quotes."""
    indent, body = " " * (len(line) - len(line.lstrip())), line.rstrip("\n")
    for mark in ("Notebook: ", '"""'):
        if len(body) > WIDTH and mark in body[len(indent) + 3 :]:
            at = body.rindex(mark)
            return f"{body[:at].rstrip()}\n{indent}{body[at:]}\n"
    return line


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--mend", action="store_true", help="take the wrong numbers out")
    if parser.parse_args().mend:
        for path in files():
            if wrong_in(path):
                mend(path)
    wrong = wrong_tags()
    print("\n".join(wrong) or "every tag names a notebook that uses what it describes")
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main())
