"""A recipe becomes a walker and a card.

A killed training goes on, and with other settings it is refused.
"""

import itertools
from dataclasses import replace
from pathlib import Path

import pytest
import torch
from budget import BUDGET, train_for

from motiondiff_edu.diffusion_dropout import P_D, Dropout
from motiondiff_edu.modiff import MODIFF_SMALL, MoDiff
from motiondiff_edu.pretrained.checkpoints import load, save
from motiondiff_edu.recipes import __main__ as command
from motiondiff_edu.recipes import walker as train_module
from motiondiff_edu.recipes.training import commit_of, notes_of
from motiondiff_edu.recipes.walker import (
    RECIPES,
    SHIPPED,
    WALKER_TRUNK,
    WalkerRecipe,
    prepared,
    train,
    training_clips,
)

TINY = replace(MODIFF_SMALL, width=16, heads=2, hidden=24, T_p=5)
SHORT = WalkerRecipe("short", TINY, steps=6, batch=3, clips=2, seconds=2.0, reversed_share=1.0)


def quiet(_: str) -> None:
    pass


def test_the_data_hold_every_clip_four_times_when_all_are_reversed():
    clips = training_clips(SHORT)
    assert len(clips) == 2 * 2 * 2 and {len(clip) for clip in clips} == {40}
    assert len(training_clips(replace(SHORT, reversed_share=0.0))) == 4


def test_a_recipe_becomes_a_walker_with_its_card(tmp_path: Path):
    walker = train(SHORT, tmp_path / "run", log=quiet)
    card = load(save(walker, tmp_path / "short.safetensors")).card
    assert card["name"] == "short" and card["target"] == "eps" and card["recipe"]["steps"] == 6
    assert card["frames"] == 8 * 40 and card["minutes"] >= 0 and card["final_loss"] > 0
    (sitting,) = card["sittings"]
    assert (
        sitting["from_step"] == 0
        and sitting["commit"]
        and sitting["threads"] == torch.get_num_threads()
    )
    assert card["parameters"] == sum(p.numel() for p in walker.model.parameters())


def test_what_a_training_begins_with_is_the_recipes():
    """Its noise schedule, its seed's first weights, its dropout."""
    clips = training_clips(SHORT)
    leap, linear = (prepared(replace(SHORT, schedule=one), clips) for one in ("leap", "linear"))
    assert leap.schedule.name.startswith("leap") and linear.schedule.name.startswith("linear")
    assert not torch.equal(leap.schedule.beta, linear.schedule.beta)
    assert torch.equal(leap.model.future_in.weight, linear.model.future_in.weight)
    other = prepared(replace(SHORT, seed=1, dropout=P_D), clips)
    assert not torch.equal(other.model.future_in.weight, leap.model.future_in.weight)
    assert other.dropout.schedule is other.schedule and leap.dropout is None


LIKE_SHIPPED = replace(WALKER_TRUNK, config=TINY, steps=8, batch=3, clips=2, seconds=2.0)


class Killed(Exception):
    pass


def kill_at(step: int, monkeypatch):
    """Let the training die in the middle of this step, once."""

    usual, calls = train_module.training_loss, iter(range(step))

    def dying(*given, **options):
        if next(calls, None) is None:
            raise Killed
        return usual(*given, **options)

    monkeypatch.setattr(train_module, "training_loss", dying)


@pytest.mark.parametrize("step", [4, 7])
def test_a_killed_training_goes_on_where_it_was_saved(tmp_path: Path, monkeypatch, step: int):
    """What is shipped, in small: past noise, the leap, Muon."""
    whole = train(LIKE_SHIPPED, tmp_path / "whole", log=quiet)
    with monkeypatch.context() as patch:
        kill_at(step, patch)
        with pytest.raises(Killed):
            train(LIKE_SHIPPED, tmp_path / "killed", log=quiet)
    again = train(LIKE_SHIPPED, tmp_path / "killed", log=quiet)
    for name, weight in whole.model.state_dict().items():
        assert torch.equal(weight, again.model.state_dict()[name]), name
    assert [sitting["from_step"] for sitting in again.card["sittings"]] == [0, step]
    assert again.card["final_loss"] == whole.card["final_loss"] > 0


def test_a_training_with_diffusion_dropout_is_another_and_goes_on_bit_for_bit(
    tmp_path: Path, monkeypatch
):
    dropped = replace(SHORT, dropout=(0.0, 0.5, 1.0), dropout_start=0.5, steps=8)
    whole = train(dropped, tmp_path / "whole", log=quiet)
    plain = train(replace(dropped, dropout=()), tmp_path / "plain", log=quiet)
    assert whole.card["recipe"]["dropout"] and not plain.card["recipe"]["dropout"]
    pairs = zip(whole.model.parameters(), plain.model.parameters(), strict=True)
    assert not all(torch.equal(a, b) for a, b in pairs)
    with monkeypatch.context() as patch:
        kill_at(7, patch)
        with pytest.raises(Killed):
            train(dropped, tmp_path / "killed", log=quiet)
    again = train(dropped, tmp_path / "killed", log=quiet)
    assert [sitting["from_step"] for sitting in again.card["sittings"]] == [0, 7]
    pairs = zip(whole.model.parameters(), again.model.parameters(), strict=True)
    assert all(torch.equal(a, b) for a, b in pairs)


def test_dropout_rises_within_a_training_when_its_time_has_come(tmp_path: Path, monkeypatch):
    """Four steps, dropout from the second on: it noises no past at first, and later every past.

    The paper's training, and the default, begin half way.
    """
    usual, seen = Dropout.__call__, []

    def watched(self, past, s, generator):
        after = usual(self, past, s, generator)
        seen.append((after != past).flatten(1).any(1).float().mean().item())
        return after

    monkeypatch.setattr(Dropout, "__call__", watched)
    train(
        replace(SHORT, dropout=(0.0, 1.0), dropout_start=0.25, steps=4), tmp_path / "run", log=quiet
    )
    assert seen[:4] == [0.0, 1.0, 1.0, 1.0]  # what follows is the final loss


def test_a_recipe_that_begins_with_another_continues_its_network(tmp_path: Path):
    first = train(SHORT, tmp_path / "first", log=quiet)
    later = replace(SHORT, name="later", begins_with="short", steps=1, lr=0.0)
    walker = train(later, tmp_path / "later", log=quiet, first=first.model)
    for one, other in zip(first.model.parameters(), walker.model.parameters(), strict=True):
        assert torch.equal(one, other)
    assert walker.card["first"] == train(later, tmp_path / "later", first=first.model).card["first"]
    with pytest.raises(ValueError, match="later begins with the network of short: pass it"):
        train(later, tmp_path / "other", log=quiet)
    with pytest.raises(ValueError, match="short begins with a fresh network"):
        train(SHORT, tmp_path / "other", log=quiet, first=first.model)
    with pytest.raises(ValueError, match="begun with first = "):
        train(later, tmp_path / "later", log=quiet, first=MoDiff(TINY))


def test_walker_and_its_plain_twin_differ_in_dropout_alone():
    walker, plain = RECIPES["walker"], RECIPES["walker-plain"]
    assert walker.dropout == P_D and walker.dropout_start == 0 and not plain.dropout
    fields = ("name", "dropout", "dropout_start")
    alike = replace(walker, **{name: getattr(plain, name) for name in fields})
    assert alike == plain and RECIPES[plain.begins_with].dropout == ()


def test_what_a_recipe_begins_with_is_trained_before_it(tmp_path: Path, monkeypatch):
    later = replace(SHORT, name="later", begins_with="short", steps=1)
    monkeypatch.setattr(command, "RECIPES", {"short": SHORT, "later": later})
    command.build("later", tmp_path / "later.safetensors", tmp_path / "out.safetensors")
    assert load(tmp_path / "out.safetensors").card["name"] == "later"
    assert notes_of(tmp_path / "short.safetensors")


def test_a_run_is_continued_with_its_own_settings_and_data_or_not_at_all(tmp_path: Path):
    walker = train(SHORT, tmp_path / "run", log=quiet)
    again = train(SHORT, tmp_path / "run", log=quiet)  # nothing is left to do
    assert again.card == walker.card
    with pytest.raises(ValueError, match="begun with lr = 0.004, not 0.1"):
        train(replace(SHORT, lr=0.1), tmp_path / "run", log=quiet)
    with pytest.raises(ValueError, match="begun with data = "):
        train(SHORT, tmp_path / "run", clips=training_clips(replace(SHORT, data_seed=2)), log=quiet)


def test_muon_and_adam_make_different_walkers(tmp_path: Path):
    one, other = (
        train(replace(SHORT, optimizer=name), tmp_path / name, log=quiet).model.future_in.weight
        for name in ("muon", "adam")
    )
    assert not torch.equal(one, other)


def ticking(per_call: float = 0.01):
    """A clock that goes on by as much each time it is read, however fast the machine is."""
    readings = itertools.count()
    return lambda: per_call * next(readings)


def test_a_budget_of_seconds_is_kept():
    recipe = replace(BUDGET, config=replace(TINY, target="x0", skip=False), batch=3)
    clips = training_clips(SHORT)
    walker, steps = train_for(0.4, clips, recipe, ticking())
    # each step reads the clock twice, for its rate and for its end; the first reading is the start
    assert steps == 20 and walker.config.target == "x0"
    assert train_for(0.8, clips, recipe, ticking())[1] == 40


def test_dropout_rises_with_the_seconds_of_a_budget(monkeypatch):
    usual, seen = Dropout.__call__, []

    def watched(self, past, s, generator):
        seen.append((self.done, self.rate(self.done)))
        return usual(self, past, s, generator)

    monkeypatch.setattr(Dropout, "__call__", watched)
    recipe = replace(BUDGET, config=TINY, batch=3, dropout=(0.0, 1.0), dropout_start=0.25)
    train_for(0.5, training_clips(SHORT), recipe, ticking())
    done = [share for share, _ in seen]
    assert done == sorted(done) and done[0] < 0.1 and done[-1] > 0.9
    assert all(rate == float(share >= 0.25) for share, rate in seen)


def test_what_is_shipped_has_a_recipe_and_the_papers_one_is_the_papers():
    pairs = [f"mend-{kind}-{k}" for k in range(3) for kind in ("plain", "dropout")]
    walkers = ["walker", "walker-plain", "walker-printed"]
    assert [recipe.name for recipe in SHIPPED] == [*walkers, *pairs]
    assert all(RECIPES[name].dropout == (P_D if "dropout" in name else ()) for name in pairs)
    paper = RECIPES["walker-paper"]
    assert (paper.optimizer, paper.lr, paper.batch, paper.config.width) == ("adam", 5e-5, 64, 256)
    assert paper.past_noise == 0 and paper.schedule == "linear"
    assert paper.config.target == "eps" and not paper.config.skip
    assert paper.dropout == P_D and paper.held_control == 0
    same = replace(paper, name="walker-printed", config=RECIPES["walker-printed"].config)
    assert replace(same, steps=12_000, clips=720) == RECIPES["walker-printed"]


def test_the_commit_of_a_folder_that_is_no_checkout(tmp_path: Path):
    assert commit_of(tmp_path) == "not in a checkout"


def test_the_printed_recipe_is_the_papers():
    """MoDiff IV-A: Adam, 5e-5, batch 64, diffusion dropout, eps, nothing of ours."""
    recipe = RECIPES["walker-printed"]
    assert (recipe.optimizer, recipe.lr, recipe.batch) == ("adam", 5e-5, 64)
    assert (recipe.past_noise, recipe.held_control, recipe.schedule) == (0, 0, "linear")
    assert (recipe.config.target, recipe.config.skip, recipe.dropout) == ("eps", False, P_D)
