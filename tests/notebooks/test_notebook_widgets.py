"""What a reader does after Run All: press Walk in notebook 00, move a slider in notebook 07.

Names may be reused.

A button's error reaches nobody: the kernel swallows it. So the cells are run here, with a walker
that stands still, and the widgets are used afterwards.
"""

import ast
from dataclasses import dataclass

import notebook_cells
import pytest
import torch

from motiondiff_edu import rollout


def standing_still(walker, past, control, **options) -> torch.Tensor:
    """Instead of `rollout.generate`: the last pose again and again."""
    frames = control.shape[-2] - past.shape[-2]
    return past[..., -1:, :].repeat_interleave(frames, dim=-2)


def needed(cells: list[dict], last: str) -> list[dict]:
    """The cells up to the one that binds `last`, without those whose values nobody asks for."""
    kept, asked = [], {last}
    for cell in reversed(cells):
        names = names_of(cell["source"])
        if (names.bound | names.changed) & asked:
            kept.insert(0, cell)
            asked = (asked - names.bound) | names.read
    return kept


@dataclass(frozen=True)
class Names:
    """Names that a cell reads from cells before, that it binds, and whose values it changes."""

    read: set[str]
    bound: set[str]
    changed: set[str]


def names_of(source: str) -> Names:
    """The names of a cell."""
    read: set[str] = set()
    bound: set[str] = set()
    changed: set[str] = set()
    for statement in ast.parse(source).body:
        nodes = list(ast.walk(statement))
        loaded = {n.id for n in nodes if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Load)}
        read |= loaded - bound
        stored = {n.id for n in nodes if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)}
        stored |= {n.name for n in nodes if isinstance(n, ast.FunctionDef | ast.ClassDef)}
        imported = [n for n in nodes if isinstance(n, ast.alias)]
        bound |= stored | {(n.asname or n.name).split(".")[0] for n in imported}
        changed |= {
            n.value.id
            for n in nodes
            if isinstance(n, ast.Subscript | ast.Attribute)
            and isinstance(n.value, ast.Name)
            and isinstance(n.ctx, ast.Store)
        }
    return Names(read, bound, changed - bound)


@pytest.fixture
def run_for(monkeypatch, tmp_path):
    """Run the cells of a notebook that a name needs; all names afterwards."""
    monkeypatch.chdir(tmp_path)  # notebook 00 writes its walks beside itself
    monkeypatch.setenv("MOTIONDIFF_DEMO", "1")
    monkeypatch.setattr(rollout, "generate", standing_still)

    def run(number: str, name: str) -> dict:
        path = next(path for path in notebook_cells.sources() if path.name.startswith(number))
        cells = needed(notebook_cells.code(notebook_cells.read(path)), name)
        return notebook_cells.run(cells, {"display": lambda *shown: None}, path.stem)

    return run


def test_only_cells_that_are_needed_are_run():
    sources = ["import a as b", "c = b(1)", "d = 2", "e = {}", "e[1] = c", "def f():\n    return e"]
    cells = [{"source": source} for source in sources]
    kept = [cell["source"] for cell in needed(cells, "f")]
    assert kept == [source for source in sources if source != "d = 2"]
    assert needed(cells, "d") == [cells[2]]
    again = [{"source": source} for source in ("x = 1", "y = x", "x = 3", "x = x + 1", "z = x")]
    assert needed(again, "z") == again[2:]


def test_the_walk_button_of_notebook_00(run_for):
    names = run_for("00", "go")
    before = names["player"].roots
    names["pad"].preset, names["dice"].value = "circle", 3
    names["go"].press()
    after = names["player"].scene["figures"][0]["frames"]
    assert names["player"].roots != before
    # half a second before, half a second to rest
    assert after == len(names["pad"].control()) + 20
    assert names["go"].said.value == f"{names['pad'].seconds:.1f} seconds walked"
    names["pad"].points = torch.zeros(0, 2).numpy()
    names["go"].press()
    assert names["go"].said.value == "Draw a path first, or choose one."


def test_the_sliders_of_notebook_07(run_for):
    names = run_for("07", "controls")
    controls = names["controls"].controls
    before = names["player"].roots
    controls["forward"].value, controls["yaw"].value = 2.0, -1.0
    assert names["player"].scene["figures"][0]["frames"] == 90
    assert names["player"].roots != before
    names["controls"].children[-1].click()
    assert names["controls"].values() == {"forward": 1.0, "left": 0.0, "yaw": 0.8}
    assert names["player"].roots == before
