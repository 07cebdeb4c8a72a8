"""docs/EQUATIONS.md is true: each numbered item of both papers once.

Functions, notebooks, tests exist; both ways.
"""

import ast
import importlib
import inspect
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
PAGE = (ROOT / "docs" / "EQUATIONS.md").read_text(encoding="utf-8")
NUMBERED = [
    *(f"eq. {n}" for n in range(1, 13)),
    "Alg. 1",
    "Alg. 2",
    *(f"Fig. {n}" for n in range(1, 7)),
]
NUMBERED += ["Table I", "Table II"]
NUMBERED_MOFUSION = [
    *(f"eq. {n}" for n in range(1, 11)),
    *(f"Fig. {n}" for n in range(1, 7)),
    "Table 1",
    "Table 2",
]
KINDS = {"eq": "eq. {}", "Alg": "Alg. {}", "Fig": "Fig. {}"}


def rows(paper: str) -> list[list[str]]:
    """The table below the paper's heading: item, what, functions, notebooks, tests."""
    section = re.search(rf"^## {paper}.*?\n(.*?)(?=^## |\Z)", PAGE, re.M | re.S)[1]
    lines = [line for line in section.splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[2:]]


MODIFF, MOFUSION = rows("MoDiff"), rows("MoFusion")
PAPERS = {"MoDiff": MODIFF, "MoFusion": MOFUSION}
DONE = [(paper, *row) for paper, table in PAPERS.items() for row in table if "not yet" not in row]


def ticked(cell: str) -> list[str]:
    return re.findall(r"`([^`]+)`", cell)


def items(docstring: str, paper: str) -> set[str]:
    """What the `Source:` of a docstring names.

    `Source: MoDiff eq. 1-2, Alg. 1` -> eq. 1, eq. 2, Alg. 1.
    """
    found = set()
    for source in re.findall(r"Source:(.*?)(?=Notebooks?:|\n\s*\n|\Z)", docstring or "", re.S):
        for part in re.findall(rf"{paper}(.*?)(?=MoDiff|MoFusion|\Z)", source, re.S):
            for kind, numbers in re.findall(r"\b(eq|Alg|Fig)\.\s*([\d, and-]+)", part):
                for first, last in re.findall(r"(\d+)(?:-(\d+))?", numbers):
                    found |= {
                        KINDS[kind].format(n) for n in range(int(first), int(last or first) + 1)
                    }
            for numbers in re.findall(r"\bTables?\s+((?:[IV]+|\d+)(?: and (?:[IV]+|\d+))*)", part):
                found |= {f"Table {n}" for n in numbers.split(" and ")}
    return found


def spoken(text: str) -> set[str]:
    """The items that prose names: `equations 3, 9 and 11`, `Algorithm 2`."""
    short = {
        r"\b[Ee]q(?:uation)?s?\.? +(?=\d)": "eq. ",
        r"\bAlgorithms? +": "Alg. ",
        r"\bFigures? +": "Fig. ",
    }
    for long, brief in short.items():
        text = re.sub(long, brief, text)
    return items(f"Source: MoDiff {text}", "MoDiff") | items(f"Source: MoFusion {text}", "MoFusion")


def resolve(name: str):
    module, _, attribute = f"motiondiff_edu.{name}".rpartition(".")
    return getattr(importlib.import_module(module), attribute)


def test_items_are_read_out_of_a_source_line():
    text = (
        "Noise. Source: MoDiff eq. 1-2, Alg. 1 (which errs), Tables I and II; MoFusion eq. "
        "8-9.  Notebook: 02, 03"
    )
    assert items(text, "MoDiff") == {"eq. 1", "eq. 2", "Alg. 1", "Table I", "Table II"}
    assert items(text, "MoFusion") == {"eq. 8", "eq. 9"}


def test_every_numbered_item_is_listed_once():
    assert [row[0] for row in MODIFF] == NUMBERED
    assert [row[0] for row in MOFUSION] == NUMBERED_MOFUSION


def test_a_row_is_all_not_yet_or_all_there():
    for row in MODIFF + MOFUSION:
        waiting = [cell == "not yet" for cell in row[2:]]
        assert len(row) == 5 and all(row) and len(set(waiting)) == 1, row


@pytest.mark.parametrize("row", DONE, ids=lambda row: f"{row[0]} {row[1]}")
def test_functions_exist_and_carry_the_item(row):
    paper, item, _, functions = row[:4]
    assert ticked(functions)
    for name in ticked(functions):
        function = resolve(name)
        told = items(inspect.getdoc(function), paper) | items(
            inspect.getmodule(function).__doc__, paper
        )
        assert item in told, f"the docstring of {name} does not say `Source: {paper} {item}`"


@pytest.mark.parametrize("row", DONE, ids=lambda row: f"{row[0]} {row[1]}")
def test_notebooks_exist_and_use_a_function_or_name_the_item(row):
    names = [name.rpartition(".")[2] for name in ticked(row[3])]
    for number in re.findall(r"\d\d", row[4]):
        found = sorted((ROOT / "notebooks").glob(f"{number}*.ipynb"))
        assert len(found) == 1, f"there is no notebook {number}"
        text = found[0].read_text(encoding="utf-8")
        assert row[1] in spoken(text) or any(re.search(rf"\b{name}\b", text) for name in names), (
            f"notebook {number} neither uses {names} nor names {row[1]}"
        )


@pytest.mark.parametrize("row", DONE, ids=lambda row: f"{row[0]} {row[1]}")
def test_tests_exist(row):
    assert ticked(row[5])
    for name in ticked(row[5]):
        file, _, function = name.partition("::")
        text = (ROOT / "tests" / file).read_text(encoding="utf-8")
        assert re.search(rf"^def {function}\(" if function else r"^def test_", text, re.M), name


def documented() -> list[tuple[str, str]]:
    """Public functions and classes of the library.

    (dotted name below the package, its own docstring).
    """
    package, found = ROOT / "motiondiff_edu", []
    for path in sorted(package.rglob("*.py")):
        parts = path.relative_to(package).with_suffix("").parts
        inside = [part for part in parts if part != "__init__"]
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.FunctionDef | ast.ClassDef) and not node.name.startswith("_"):
                found.append((".".join([*inside, node.name]), ast.get_docstring(node) or ""))
    return found


def test_names_of_every_folder_are_compared():
    names = {name for name, _ in documented()}
    assert {"ddpm.q_sample", "metrics.dances.music_alignment", "viz.walks.footstep_curves"} < names
    assert {name.split(".")[0] for name in names} > {"beyond", "performers", "motion", "course"}


@pytest.mark.parametrize("paper, table", PAPERS.items())
def test_no_source_line_is_missing_from_the_page(paper, table):
    listed = {(name, row[0]) for row in table for name in ticked(row[2])}
    kept = [(name, item) for name, text in documented() for item in items(text, paper)]
    assert kept and [f"{name}: {item}" for name, item in kept if (name, item) not in listed] == []
