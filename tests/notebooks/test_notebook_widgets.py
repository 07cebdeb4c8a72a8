"""What a reader does after Run All: press Walk in notebook 00, move a slider in notebook 07.

Names may be reused.

A button's error reaches nobody: the kernel swallows it. So the cells are run here, with a walker
that stands still, and the widgets are used afterwards.
"""

import notebook_cells
import pytest
import torch

from motiondiff_edu import rollout
from motiondiff_edu.beyond.footholds import FootholdMoDiff


def standing_still(walker, past, control, **options) -> torch.Tensor:
    """Instead of `rollout.generate`: the last pose again and again.

    Who listens to the gate hears ten calls a frame.
    """
    frames = control.shape[-2] - past.shape[-2]
    if isinstance(getattr(walker, "model", None), FootholdMoDiff):
        for _ in range(10 * frames):
            walker.fast.model.gate(torch.zeros(1, walker.config.T_p, walker.config.width))
    return past[..., -1:, :].repeat_interleave(frames, dim=-2)


@pytest.fixture
def run_all(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)  # notebook 00 writes its walks beside itself
    monkeypatch.setenv("MOTIONDIFF_DEMO", "1")
    monkeypatch.setattr(rollout, "generate", standing_still)

    def run(number: str) -> dict:
        path = next(path for path in notebook_cells.sources() if path.name.startswith(number))
        space = {"display": lambda *shown: None}
        return notebook_cells.run(notebook_cells.code(notebook_cells.read(path)), space, path.stem)

    return run


def test_the_walk_button_of_notebook_00(run_all):
    names = run_all("00")
    frames = names["player"].scene["figures"][0]["frames"]
    names["pad"].preset, names["dice"].value = "circle", 3
    names["go"].button.click()
    after = names["player"].scene["figures"][0]["frames"]
    assert (
        after != frames and after == len(names["pad"].control()) + 20
    )  # half a second before, half a second to rest
    assert names["go"].said.value == f"{names['pad'].seconds:.1f} seconds walked"
    names["pad"].points = torch.zeros(0, 2).numpy()
    names["go"].button.click()
    assert names["go"].said.value == "Draw a path first, or choose one."


def test_the_sliders_of_notebook_07(run_all):
    names = run_all("07")
    controls = names["controls"].controls
    before = names["player"].roots
    controls["forward"].value, controls["yaw"].value = 2.0, -1.0
    assert names["player"].scene["figures"][0]["frames"] == 90
    assert names["player"].roots != before
    names["controls"].children[-1].click()
    assert names["controls"].values() == {"forward": 1.0, "left": 0.0, "yaw": 0.8}
    assert names["player"].roots == before
