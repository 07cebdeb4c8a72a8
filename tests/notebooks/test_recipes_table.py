"""Notebook 07's table of three recipes says what the recipes say."""

import re

import notebook_cells
import pytest

from motiondiff_edu.diffusion_dropout import P_D
from motiondiff_edu.modiff import MODIFF_PAPER, MODIFF_SMALL, MoDiffConfig
from motiondiff_edu.recipes.walker import WALKER, WALKER_PAPER, WALKER_PLAIN, WALKER_TRUNK


@pytest.fixture(scope="module")
def notebook() -> dict:
    (path,) = (p for p in notebook_cells.sources() if p.name.startswith("07_"))
    return notebook_cells.read(path)


@pytest.fixture(scope="module")
def table(notebook) -> dict[str, list[str]]:
    """{first column: the others}."""
    texts = [cell["source"] for cell in notebook_cells.markdown(notebook)]
    (text,) = (one for one in texts if "Three recipes side" in one)
    rows = [line.split("|")[1:-1] for line in text.splitlines() if line.startswith("|")]
    return {head.strip(): [one.strip() for one in rest] for head, *rest in rows[2:]}


def layers(config: MoDiffConfig) -> str:
    counts = (config.motion_layers, config.control_layers, config.cross_layers)
    return ", ".join(map(str, (*counts, config.decoder_layers)))


def test_the_paper_and_the_shipped_walker_are_as_the_recipes_are(table):
    paper, _, shipped = zip(*table.values(), strict=True)
    said = dict(zip(table, zip(paper, shipped, strict=True), strict=True))
    sizes = (MODIFF_PAPER, WALKER.config)
    assert said["width"] == tuple(str(one.width) for one in sizes)
    assert said["layers: motion, control, cross-modal, decoder"] == tuple(map(layers, sizes))
    assert said["optimiser, first rate"][0] == f"Adam, {WALKER_PAPER.lr:g}".replace("e-0", "e-")
    assert WALKER.optimizer == WALKER_TRUNK.optimizer == "muon" and WALKER_PAPER.optimizer == "adam"
    rates = [f"{one.lr * 1e3:g}e-3" for one in (WALKER_TRUNK, WALKER)]
    assert said["optimiser, first rate"][1] == f"Muon, {rates[0]}, then {rates[1]}"
    assert said["noise schedule"] == ("unspecified", f"*{WALKER.schedule}*")  # by MoDiff
    assert said["steps"][1] == f"{WALKER_TRUNK.steps:,}, then {WALKER.steps:,}"
    assert said["windows a step"] == (str(WALKER_PAPER.batch), str(WALKER.batch))
    noise = f"noise, up to {WALKER.past_noise:g} std"
    assert said["past"][1] == f"{noise}; diffusion dropout at the end"
    assert said["predicts"][1] == "eps, with the skip" and WALKER.config.skip
    assert WALKER.dropout == P_D and not WALKER_PLAIN.dropout and not WALKER_TRUNK.dropout
    assert WALKER.config.target == "eps"


def test_what_is_trained_in_the_notebook_is_as_its_cells_are(table, notebook):
    code = "\n".join(cell["source"] for cell in notebook_cells.code(notebook))
    live = {head: row[1] for head, row in table.items()}
    number = lambda pattern: re.search(pattern, code)[1]  # noqa: E731
    kinds = ("motion", "control", "cross", "decoder")
    assert live["width"] == number(r"width=(\d+)")
    counted = ", ".join(number(rf"{kind}_layers=(\d+)") for kind in kinds)
    assert live["layers: motion, control, cross-modal, decoder"] == counted
    steps = int(number(r"run.pick[(](\d+)"))
    assert live["steps"] == f"{steps:,}"
    assert live["windows a step"] == number(r"data_set.draw[(](\d+), generator")
    assert live["optimiser, first rate"] == "Muon, " + number(r"cosine_lr[(]([-e0-9]+)")
    assert live["noise schedule"] == "*leap*"
    assert "optimizer=MuonAndAdam(network)" in code and "leap_schedule(100)" in code
    assert live["predicts"] == "eps, with the skip" and live["past"] == "as it is"
    assert MODIFF_SMALL.target == "eps" and MODIFF_SMALL.skip
