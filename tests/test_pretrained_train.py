"""A recipe becomes a walker and a card; a killed training goes on, and with other settings it is refused."""

from dataclasses import replace
from pathlib import Path

import pytest
import torch

from motiondiff_edu.checkpoints import load_walker, save_walker
from motiondiff_edu.modiff import MODIFF_SMALL
from motiondiff_edu.pretrained.budget import train_for
from motiondiff_edu.pretrained.recipes import RECIPES, SHIPPED, Recipe
from motiondiff_edu.pretrained.train import commit_of, train, training_clips

TINY = replace(MODIFF_SMALL, width=16, heads=2, hidden=24, T_p=5)
SHORT = Recipe("short", TINY, steps=6, batch=3, clips=2, seconds=2.0, reversed_share=1.0)


def quiet(_: str) -> None:
    pass


def test_the_data_hold_every_clip_four_times_when_all_are_reversed():
    clips = training_clips(SHORT)
    assert len(clips) == 2 * 2 * 2 and {len(clip) for clip in clips} == {40}
    assert len(training_clips(replace(SHORT, reversed_share=0.0))) == 4


def test_a_recipe_becomes_a_walker_with_its_card(tmp_path: Path):
    walker = train(SHORT, tmp_path / "run", log=quiet)
    card = load_walker(save_walker(walker, tmp_path / "short.safetensors")).card
    assert card["name"] == "short" and card["target"] == "eps" and card["recipe"]["steps"] == 6
    assert card["frames"] == 8 * 40 and card["minutes"] >= 0 and card["final_loss"] > 0
    assert card["commit"] and "threads" in card["machine"]


def test_a_training_goes_on_where_it_was_saved(tmp_path: Path):
    whole = train(SHORT, tmp_path / "whole", log=quiet)
    again = train(SHORT, tmp_path / "whole", log=quiet)  # nothing is left to do
    for name, weight in whole.model.state_dict().items():
        assert torch.equal(weight, again.model.state_dict()[name])
    with pytest.raises(ValueError, match="begun with lr = 0.002, and 0.1 is asked for"):
        train(replace(SHORT, lr=0.1), tmp_path / "whole", log=quiet)


def test_muon_and_adam_make_different_walkers(tmp_path: Path):
    one, other = (
        train(replace(SHORT, optimizer=name), tmp_path / name, log=quiet).model.future_in.weight
        for name in ("muon", "adam")
    )
    assert not torch.equal(one, other)


def test_a_budget_of_seconds_is_kept():
    walker, steps = train_for(1.0, training_clips(SHORT), replace(TINY, target="x0", skip=False), batch=3)
    assert steps >= 1 and walker.config.target == "x0"


def test_what_is_shipped_has_a_recipe_and_the_papers_one_is_the_papers():
    assert [recipe.name for recipe in SHIPPED] == ["walker-x0", "walker-eps"]
    paper = RECIPES["walker-paper"]
    assert (paper.optimizer, paper.lr, paper.batch, paper.config.width) == ("adam", 5e-5, 64, 256)
    assert paper.jitter == paper.metres == paper.near == paper.high_noise == paper.bf16_share == 0


def test_the_commit_of_a_folder_that_is_no_checkout(tmp_path: Path):
    assert commit_of(tmp_path) == "not in a checkout"
