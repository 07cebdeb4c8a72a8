"""The ladder: one choice a rung, the printed recipe is the paper's, steps are the budget's."""

from dataclasses import asdict

import numpy as np
import pytest

from tools.results.page import pictures
from tools.results.walks import ladder
from tools.results.walks.scores import measures


def differences(name: str) -> set[str]:
    """The fields in which a rung's recipe is unlike its base's."""
    base = ladder.VARIANTS[name].rivals["base"]
    mine, other = (vars(ladder.VARIANTS[one].recipe.recipe) for one in (name, base))
    return {key for key in mine if mine[key] != other[key]} - {"name"}


@pytest.mark.parametrize("name", [n for n, one in ladder.VARIANTS.items() if one.rivals])
def test_a_rung_differs_from_its_base_in_one_choice(name):
    """Or in its budget or rate; dropout instead of past noise is the one exchange."""
    found, rung = differences(name), ladder.VARIANTS[name].recipe
    if name == "ours-dropout":
        assert found == {"past_noise", "dropout"}
    elif name == "ours-both-light":
        assert found == {"noised_past_weight"}
    elif name == "printed-longer":
        assert not found and rung.budget == 4
    elif name == "printed-rate":
        assert not found and rung.rate
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
    assert not any(ladder.VARIANTS[name].recipe.rate for name in ("printed", "printed-longer"))


def test_steps_are_the_budget_over_the_pace_and_rates_those_that_were_chosen():
    ours, longer = (ladder.recipe_of(name, 2, ladder.FULL) for name in ("ours", "printed-longer"))
    assert (ours.steps, ours.seed, ours.lr) == (round(600_000 / 55.57), 2, 0.01)
    assert (longer.steps, longer.lr) == (round(4 * 600_000 / 60.99), 5e-5)
    about = ladder.sweep(ladder.FULL, None).about("ours")
    assert about["network"] == "width 64, feed-forward 128, layers 1/1/2/2"


def test_a_rung_without_a_pace_says_what_to_add(monkeypatch):
    monkeypatch.setitem(ladder.VARIANTS, "new", ladder.out("something new"))
    with pytest.raises(ValueError, match="no pace of new: add the CPU-milliseconds"):
        ladder.recipe_of("new", 0, ladder.FULL)


def test_measures_of_a_rung_by_hand():
    """Root mean squares, differences and ratios of means."""
    keys = ("bone", "bone_broken", "adherence", "adherence_data", "skating")
    rows = {key: np.array([k, 9.0 * k]) for k, key in enumerate(keys, 1)}
    found = {one.name: one.value for one in measures(ladder.KINDS, rows)}
    assert found["bone_rmse_cm"] == pytest.approx(np.sqrt(5))
    assert found["adherence_excess_mps"] == pytest.approx(-5)
    assert found["broken_over_whole"] == pytest.approx(np.sqrt(2))
    assert found["skating_mps"] == pytest.approx(25)


def test_a_rung_is_trained_and_its_walks_are_measured(tmp_path, monkeypatch):
    """The walks are the data's own, and after a past with holes their bones are 1 % too long."""
    size = ladder.Size(clips=3, seconds=0.5, training=2, budget=0.001)
    sweep = ladder.sweep(size, tmp_path)
    walker = sweep.train("printed", 1)
    assert walker.card["recipe"]["seed"] == 1 and walker.card["recipe"]["lr"] == 5e-5

    def continued(walker, trials, share, frames, seed):
        return trials.truth[:, :frames] * (1.01 if share else 1.0)

    monkeypatch.setattr(ladder, "continued", continued)
    rows = sweep.measure("printed", walker, 1)
    assert set(rows) == {key for kind in ladder.KINDS.values() for key in kind.rows}
    assert all(row.shape == (3,) for row in rows.values())
    assert rows["bone"].max() < 1e-6 < rows["bone_broken"].min()
    np.testing.assert_allclose(rows["adherence"], rows["adherence_data"])


def test_the_pictures_are_drawn_of_what_was_measured(tmp_path):
    some = {
        name: {"value": 0.5, "low": 0.4, "high": 0.6}
        for kind in pictures.RUNG_MEASURES.values()
        for name in (f"ladder.ours.{kind}.seed0", f"ladder.printed.{kind}.seed1")
    }
    pictures.draw(some, tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["ladder.png"]
    assert (tmp_path / "ladder.png").stat().st_size > 10_000
    pictures.draw({}, tmp_path / "nowhere")
