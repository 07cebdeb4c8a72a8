"""The ladder: one choice a cell, measures by hand, and no cell is trained twice."""

import json
from dataclasses import asdict

import numpy as np
import pytest

from tools.results.walks import ladder, ladder_page

SMALL = ladder.Size(clips=2, seconds=0.5, training=2, budget=0.001)


def differences(name: str) -> set[str]:
    """The fields in which a cell's recipe is unlike its base's."""
    mine, base = (vars(ladder.CELLS[one].recipe) for one in (name, ladder.CELLS[name].base))
    return {key for key in mine if mine[key] != base[key]} - {"name"}


@pytest.mark.parametrize("name", [n for n, cell in ladder.CELLS.items() if cell.base])
def test_a_cell_differs_from_its_base_in_one_choice(name):
    """Or in its budget; dropout instead of past noise is the one exchange."""
    found, cell = differences(name), ladder.CELLS[name]
    if name == "ours-dropout":
        assert found == {"past_noise", "dropout"}
    elif name == "printed-longer":
        assert not found and cell.budget == 4
    elif name == "printed-rate":
        assert not found and cell.tuned
    else:
        assert len(found) == 1, found


def test_the_printed_recipe_is_the_papers():
    """MoDiff IV-A: Adam, 5e-5, batch 64, diffusion dropout, eps, nothing of ours."""
    recipe = ladder.PRINTED
    assert (recipe.optimizer, recipe.lr, recipe.batch) == ("adam", 5e-5, 64)
    assert (recipe.noises, recipe.past_noise, recipe.held_control) == (1, 0, 0)
    assert (recipe.config.target, recipe.config.skip) == ("eps", False)
    assert recipe.dropout == (0.0, 0.05, 0.1, 0.15, 0.2, 0.25) and recipe.schedule == "linear"
    assert set(asdict(recipe.loss_weights).values()) == {0}
    assert not any(ladder.CELLS[name].tuned for name in ("printed", "printed-longer"))


def test_steps_are_the_budget_over_the_pace(tmp_path):
    plan = ladder.Plan(tmp_path / "plan.json", pace={"ours": 40.0, "printed-longer": 50.0})
    plan.rates = {"ours-muon": 3e-3}
    recipe = plan.recipe("ours", 2, ladder.FULL)
    assert (recipe.steps, recipe.seed, recipe.lr) == (15_000, 2, 3e-3)
    longer = plan.recipe("printed-longer", 0, ladder.FULL)
    assert (longer.steps, longer.lr) == (48_000, 5e-5)
    plan.write()
    assert ladder.Plan.read(plan.path) == plan


def test_the_records_of_pace_and_rates_have_no_name_in_common(tmp_path):
    plan = ladder.Plan(tmp_path / "plan.json", {"ours": 40.0}, {"ours-muon": 3e-3})
    names = [
        [one["name"] for one in ladder.plan_records(plan, row, "c")] for row in ("pace", "rates")
    ]
    assert names == [["ladder.plan.ours.step_ms"], ["ladder.plan.ours-muon.rate"]]


def rows(values: list[float]) -> dict[str, list[float]]:
    keys = ("bone", "bone_broken", "adherence", "adherence_data", "skating")
    return {key: [k * value for value in values] for k, key in enumerate(keys, 1)}


def test_measures_of_a_cell_by_hand(tmp_path):
    """Two seeds, two walks: root mean squares, differences of means, and those minus the base's."""
    for name, scale in (("ours", 1.0), ("ours-adam", 4.0)):
        seeds = {"0": rows([scale, scale]), "1": rows([9 * scale, 9 * scale])}
        kept = {"steps": 7, "rate": 0.1, "seeds": seeds}
        (tmp_path / f"{name}.json").write_text(json.dumps(kept))
    records = ladder.ladder_records(
        "ours-adam", tmp_path / "ours-adam.json", tmp_path / "ours.json", "c"
    )
    found = {one["name"].removeprefix("ladder.ours-adam."): one for one in records}
    assert found["bone_rmse_cm"]["value"] == pytest.approx(np.sqrt(20), rel=1e-4)
    assert found["bone_rmse_cm.seed1"]["value"] == pytest.approx(6)
    assert found["bone_rmse_cm_minus_base"]["value"] == pytest.approx(np.sqrt(5), rel=1e-4)
    assert found["adherence_excess_mps"]["value"] == pytest.approx(-20)  # 3 x 20 - 4 x 20
    assert found["broken_over_whole"]["value"] == pytest.approx(np.sqrt(2), rel=1e-4)
    assert found["skating_mps"]["low"] < found["skating_mps"]["value"] == pytest.approx(100)
    assert found["skating_mps"]["seeds"]["trainings"] == 2


def test_a_cell_is_trained_measured_and_not_trained_again(tmp_path, monkeypatch):
    monkeypatch.setattr(ladder, "SEEDS", 1)
    tiny = {n: ladder.CELLS[n] for n in ("ours", "printed")}
    monkeypatch.setattr(ladder, "CELLS", tiny)
    monkeypatch.setattr(ladder, "RATES", {"muon": (1e-3, 3e-3), "adam": (1e-3,)})
    monkeypatch.setattr(ladder, "rows_of", lambda walker, trials, seed: rows_now(walker))

    def rows_now(walker):
        made = rows([float(walker.model.head[1].bias.square().sum()), 1.0])
        return {key: np.array(values) for key, values in made.items()}

    records = ladder.measure("ours", tmp_path, tmp_path / "runs", SMALL, "c")
    plan = ladder.Plan.read(tmp_path / "plan.json")
    assert set(plan.pace) == set(tiny) and set(plan.tried["ours-muon"]) == {"0.001", "0.003"}
    tried = plan.tried["ours-muon"]
    assert plan.rates["ours-muon"] == float(min(tried, key=tried.get))
    monkeypatch.setattr(ladder, "train", lambda *args: pytest.fail("trained again"))
    again = ladder.measure("ours", tmp_path, tmp_path / "runs", SMALL, "c")
    assert again == records and records[0]["seeds"]["rate"] == plan.rates["ours-muon"]


def test_the_section_shows_what_was_measured_and_names_what_was_not(tmp_path):
    made = {}
    for name in ("ours", "ours-adam"):
        for kind in ladder.MEASURES:
            for key in (kind, f"{kind}.seed0", f"{kind}_minus_base"):
                full = f"ladder.{name}.{key}"
                about = {"steps": 7, "rate": 0.1, "trainings": 1, "clips": 2}
                made[full] = {"name": full, "value": 0.5, "low": 0.4, "high": 0.6, "unit": "cm",
                              "seeds": about}  # fmt: skip
    ladder_page.draw(made, tmp_path)
    text = ladder_page.section(made, tmp_path)
    assert "| ours: Adam instead of Muon | 7 | 0.1 |" in text and "`printed`" in text
    assert "results/ladder.png" in text and (tmp_path / "ladder.png").stat().st_size > 10_000
    assert "| Muon | 0.5 [0.4, 0.6] | - |" in text
    assert ladder_page.section({}, tmp_path) == ""
