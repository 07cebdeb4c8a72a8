"""A mover's training: eq. 4 with what the recipe names, resumed after a kill, with a card."""

import copy
from dataclasses import replace

import numpy as np
import pytest
import torch

from motiondiff_edu.conditions.word_encoder import NOTHING, PADDING
from motiondiff_edu.ddpm import cosine_schedule, draw, q_sample
from motiondiff_edu.kinematic_loss import kinematic_parts
from motiondiff_edu.motion import moving_frame
from motiondiff_edu.motion.moving_frame import D
from motiondiff_edu.motion.skeleton import TOES
from motiondiff_edu.performers.mover import Mover
from motiondiff_edu.performers.planned_mofusion import PlannedConfig, PlannedMoFusion
from motiondiff_edu.performers.text_mofusion import TextMoFusion, TextMoFusionConfig
from motiondiff_edu.recipes.mofusion import KINEMATIC
from motiondiff_edu.recipes.mover import (
    MOVER,
    MOVER_PLAIN,
    MoverRecipe,
    loss_of,
    plan_loss_of,
    toes_moved,
    train_mover,
    train_planner,
    training_clips,
    without_some,
)
from motiondiff_edu.recipes.training import Provenance

SIZES = {"widths": (16, 24), "heads": 2, "C": 20, "S": 20, "word_layers": 1}
TINY = TextMoFusionConfig(**SIZES)
SHORT = MoverRecipe("tiny", TINY, steps=6, clips=10, frames=200)
PLAIN = replace(SHORT, kinematic=None, metres=0.0)


@pytest.fixture(scope="module")
def planned():
    return training_clips(SHORT.clips, SHORT.data_seed)


@pytest.fixture(scope="module")
def windows(planned):
    return planned.without_timeline()


def quiet(line: str) -> None:
    pass


@pytest.mark.parametrize("metres", [0.0, 1.0])
@pytest.mark.parametrize("kinematic", [None, SHORT.kinematic], ids=["plain", "kinematic"])
@pytest.mark.parametrize("toes", [0.0, 0.2])
def test_the_loss_is_equation_4(windows, toes, kinematic, metres):
    """By hand: squared errors of x0_hat, of its changes, and of the toes' changes in the world;
    and L_k, weighted by alpha_bar. The generator's own draws are in their order."""
    torch.manual_seed(3)
    config = replace(TINY, words=windows.words)
    model, schedule = TextMoFusion(config).eval(), cosine_schedule(20)
    torch.nn.init.normal_(model.unet.out.weight, std=0.1)
    recipe = replace(SHORT, toes=toes, kinematic=kinematic, metres=metres)
    found = loss_of(recipe, windows, schedule)(model, torch.Generator().manual_seed(4))
    generator = torch.Generator().manual_seed(4)
    x0, ids, planted = windows.draw(SHORT.frames, generator)
    left_out = without_some(ids, recipe.no_text, generator)
    s = torch.randint(1, 21, (len(x0),), generator=generator)
    x_s = q_sample(x0, s, schedule, draw(x0, generator))
    x0_hat = model(x_s, s, model.listen(left_out))
    std = windows.scaler.std
    error = (std**metres / (std**metres).mean()).sqrt() * (x0 - x0_hat)
    wanted = error.square().mean() + 5 * error.diff(dim=1).square().mean()
    steps = moving_frame.moves((x0 - x0_hat) * std)[:, :, list(TOES)]
    wanted = wanted + toes / toes_moved(windows) * steps.square().mean()
    if kinematic:
        parts = kinematic_parts(x0_hat, x0, moving_frame.body_of(windows.scaler), planted)
        L_k = 400 * parts["skeleton"] + 5 * parts["asymmetry"] + 1 * parts["slide"]
        wanted = wanted + (schedule.alpha_bar[s].float() * L_k).mean()
        assert parts["slide"].max() > 0
    torch.testing.assert_close(found, wanted)


def test_each_departure_changes_the_loss(windows):
    torch.manual_seed(3)
    model = TextMoFusion(replace(TINY, words=windows.words)).eval()

    def loss(**changes):
        loss_fn = loss_of(replace(SHORT, **changes), windows, cosine_schedule(20))
        return loss_fn(model, torch.Generator().manual_seed(4)).item()

    whole = loss()
    assert loss(kinematic=None) < whole and loss(no_text=1.0) != whole != loss(metres=0.0)
    assert loss(toes=0.0) < whole and loss(changes=0.0) < whole
    times = [
        loss(kinematic=replace(SHORT.kinematic, over_time=name))
        for name in ("none", "constant", "alpha_bar", "snr")
    ]
    assert len(set(times)) == 4 and times[2] == whole
    assert toes_moved(windows) > 1e-4


def test_a_share_of_the_texts_is_left_out():
    ids = torch.randint(2, 9, (2000, 4))
    kept = without_some(ids, 0.25, torch.Generator().manual_seed(0))
    empty = (kept == torch.tensor([NOTHING, PADDING, PADDING, PADDING])).all(1)
    assert 0.2 < empty.float().mean() < 0.3 and torch.equal(kept[~empty], ids[~empty])


def test_a_killed_training_continues_and_ends_like_one_in_one_go(windows, tmp_path):
    whole = train_mover(SHORT, tmp_path / "whole.safetensors", windows, log=quiet)
    assert isinstance(whole, Mover) and whole.config.words == windows.words
    assert whole.card["clips"] == 10 and whole.card["recipe"]["frames"] == 200

    class Killed(Exception):
        pass

    seen = []

    def until(line: str) -> None:
        seen.append(line)
        if len(seen) == 4:
            raise Killed

    run = tmp_path / "killed.safetensors"
    with pytest.raises(Killed):
        train_mover(SHORT, run, windows, log=until)
    resumed = train_mover(SHORT, run, windows, log=quiet)
    assert len(resumed.card["sittings"]) == 2
    for (name, a), (_, b) in zip(
        whole.model.state_dict().items(), resumed.model.state_dict().items(), strict=True
    ):
        assert np.allclose(a, b, atol=1e-6), name


def test_a_network_that_plans_learns_both_and_each_has_its_own_loss(planned):
    """By hand: the mean square of the timeline's x0_hat, and the squares of the motion's with a
    clean plan."""
    torch.manual_seed(3)
    config = tiny_plan(planned)
    model, schedule = PlannedMoFusion(config).eval(), cosine_schedule(20)
    recipe = replace(PLAIN, config=config, changes=0.0, toes=0.0)
    found = loss_of(recipe, planned, schedule)(model, seeded())
    generator, wanted = seeded(), 0.0
    x0, ids, _ = planned.draw(SHORT.frames, generator)
    torch.rand(len(ids), generator=generator)
    heard = model.listen(ids)
    motion, plan = x0[..., :D], x0[..., D:]
    for clean, out in (
        (plan, lambda x_s, s: model.planner(x_s, s, heard.plan)),
        (motion, lambda x_s, s: model(x_s, s, heard, plan)),
    ):
        s = torch.randint(1, 21, (len(x0),), generator=generator)
        x_s = q_sample(clean, s, schedule, draw(clean, generator))
        wanted = wanted + (clean - out(x_s, s)).square().mean()
    torch.testing.assert_close(found, wanted)
    found.backward()
    assert all(p.grad is not None for p in model.planner.words.parameters())
    assert all(p.grad is not None for p in model.performer.words.parameters())


def test_the_network_for_timelines_alone_has_its_own_part_of_the_loss(planned):
    """By hand: the mean square of the timeline's x0_hat."""
    torch.manual_seed(3)
    planner, schedule = PlannedMoFusion(tiny_plan(planned)).planner.eval(), cosine_schedule(20)
    found = plan_loss_of(replace(SHORT, no_text=0.5), planned, schedule)(planner, seeded())
    generator = seeded()
    x0, ids, _ = planned.draw(SHORT.frames, generator)
    ids = without_some(ids, 0.5, generator)
    plan = x0[..., D:]
    s = torch.randint(1, 21, (len(x0),), generator=generator)
    x_s = q_sample(plan, s, schedule, draw(plan, generator))
    wanted = (plan - planner(x_s, s, planner.listen(ids))).square().mean()
    torch.testing.assert_close(found, wanted)


def test_the_network_for_timelines_is_trained_further_and_the_other_stays(planned, tmp_path):
    recipe = replace(SHORT, config=tiny_plan(planned), steps=2)
    run = tmp_path / "whole.safetensors"
    both = train_mover(recipe, run, planned, log=quiet)
    longer = replace(recipe, plan_steps=4)
    whole = train_mover(longer, run, planned, log=quiet)
    assert same(both.model.performer, whole.model.performer)
    assert not same(both.model.planner, whole.model.planner)
    assert whole.card["planner"]["sittings"][0]["from_step"] == 0 and "planner" not in both.card
    assert [one["from_step"] for one in whole.card["sittings"]] == [0], "trained once"
    assert whole.card["recipe"]["plan_steps"] == 4
    assert whole.card["final_loss"] != both.card["final_loss"]

    def until(line: str) -> None:
        if line.startswith("tiny-planner 3/"):
            raise KeyboardInterrupt

    run = tmp_path / "killed.safetensors"
    with pytest.raises(KeyboardInterrupt):
        train_mover(longer, run, planned, log=until)
    resumed = train_mover(longer, run, planned, log=quiet)
    assert same(resumed.model, whole.model)
    assert [one["from_step"] for one in resumed.card["planner"]["sittings"]] == [0, 3]


def test_the_further_training_begins_with_the_trained_network(planned, tmp_path):
    """With a rate of almost zero nothing changes; another first run is not mixed in."""
    recipe = replace(SHORT, config=tiny_plan(planned), steps=2)
    both = train_mover(recipe, tmp_path / "run.safetensors", planned, log=quiet)
    provenance = Provenance({}, {}, "clips")
    loss_fn = plan_loss_of(recipe, planned, both.schedule)
    still = replace(recipe, plan_steps=2, lr=1e-9)
    kept = copy.deepcopy(both.model)
    train_planner(still, tmp_path / "one.safetensors", both.model, loss_fn, provenance, quiet)
    assert same(both.model, kept)
    with torch.no_grad():
        both.model.planner.words.embed.weight.add_(1)
    with pytest.raises(ValueError, match="begins_with"):
        train_planner(still, tmp_path / "one.safetensors", both.model, loss_fn, provenance, quiet)


def test_only_a_network_that_makes_timelines_is_trained_on_them_alone(planned, tmp_path):
    with pytest.raises(ValueError, match="tiny has plan_steps, and its network makes no timelines"):
        train_mover(replace(SHORT, plan_steps=1), tmp_path / "run", planned, log=quiet)
    assert not (tmp_path / "run").exists()


def tiny_plan(windows) -> PlannedConfig:
    return PlannedConfig(**SIZES, words=windows.words, plan_widths=(8, 16))


def same(a: torch.nn.Module, b: torch.nn.Module) -> bool:
    pairs = zip(a.state_dict().values(), b.state_dict().values(), strict=True)
    return all(torch.allclose(x, y, atol=1e-6) for x, y in pairs)


def test_a_network_for_motions_alone_is_not_shown_the_timelines(planned, windows, tmp_path):
    narrow = replace(SHORT, steps=2)
    trained = train_mover(narrow, tmp_path / "narrow.safetensors", planned, log=quiet)
    assert trained.motion_scaler.mean.shape == (D,)
    torch.testing.assert_close(trained.motion_scaler.std, windows.scaler.std[:D])
    assert trained.act("walks", seconds=2, steps=2, progress=False, tries=1).positions.shape == (
        40,
        21,
        3,
    )
    x, wide = windows.draw(400, seeded()), planned.draw(400, seeded())
    torch.testing.assert_close(x[0], wide[0][..., :D])
    assert all(torch.equal(a, b) for a, b in zip(x[1:], wide[1:], strict=True))


def seeded() -> torch.Generator:
    return torch.Generator().manual_seed(4)


def test_the_shipped_recipes_differ_in_the_kinematic_losses_alone():
    assert replace(MOVER, name="mover-plain", kinematic=None) == MOVER_PLAIN
    assert MOVER.no_text == 0.1 and MOVER.kinematic == replace(KINEMATIC, slide=1.0)
