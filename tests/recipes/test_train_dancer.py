"""Dancers' recipes: a small one is trained, killed and continued.

What comes of it dances, and its card tells how.
"""

from dataclasses import replace
from pathlib import Path

import pytest
import torch

from data_synth.dancing.performance import DANCES_A_SEED, dances_to
from motiondiff_edu.beyond.classifier_free import without
from motiondiff_edu.conditions.music import log_mel
from motiondiff_edu.ddpm import cosine_schedule
from motiondiff_edu.performers.ear import EarConfig
from motiondiff_edu.performers.networks import network
from motiondiff_edu.pretrained.checkpoints import load
from motiondiff_edu.recipes import __main__ as command
from motiondiff_edu.recipes.dancer import (
    DANCE_RECIPES,
    DANCER,
    DANCER_PLAIN,
    HEARING,
    REGRESSED,
    UNCONDITIONAL,
    DanceRecipe,
    loss_of,
    train_dancer,
    training_windows,
)
from motiondiff_edu.recipes.ear import EarRecipe, ear_of, ear_within
from motiondiff_edu.recipes.songs import training_songs

SIZES = {"steps": 6, "songs": 2, "seconds": 8.0, "batch": 3, "frames": 40}
SMALL_EAR = {"ear_width": 16, "ear_blocks": 1}
EARS = EarRecipe(
    config=EarConfig(width=16, blocks=1),
    steps=4,
    frames=(40, 60),
    batch=2,
    songs=2,
    seconds=8.0,
    data_seed=5,  # other songs than those danced to: they have another scaler
)
TINY = replace(
    DANCER,
    name="tiny",
    config=replace(DANCER.config, widths=(16, 24), music_layers=1, S=20, **SMALL_EAR),
    ear=EARS,
    **SIZES,
)


@pytest.fixture(scope="module")
def windows():
    return training_windows(TINY)


def test_data_are_songs_and_dances_to_them(windows):
    assert windows.n == 40 and len(windows) >= 2 * 2 * 7
    assert windows.mel.shape[1] == 80 and torch.isfinite(windows.mel).all()
    assert training_windows(replace(TINY, steps=7)) is windows  # the same data: shared
    other = training_windows(replace(TINY, data_seed=2))
    assert other.dances.shape != windows.dances.shape or not torch.equal(
        other.dances, windows.dances
    )
    again = training_windows(TINY)
    assert (
        again is not windows
        and torch.equal(again.dances, windows.dances)
        and torch.equal(again.mel, windows.mel)
    )
    once = training_windows(replace(TINY, dances=1))
    assert len(windows) == 2 * len(once) and torch.equal(once.mel, windows.mel)


def test_every_dance_has_its_own_song(windows):
    songs = list(training_songs(2, TINY.data_seed, TINY.seconds))
    _, last = list(dances_to(songs, TINY.data_seed * DANCES_A_SEED, TINY.dances))[-1]
    mel = windows.mel_scaler.transform(log_mel(torch.from_numpy(songs[-1].audio).float(), 16_000))
    torch.testing.assert_close(windows.mel[-len(mel) :], mel)
    danced = torch.from_numpy(last.positions).float()
    torch.testing.assert_close(windows.dances[-len(danced) :], danced)
    assert windows.song_starts[-1] >= len(windows.mel) - len(mel)


@pytest.fixture(scope="module")
def whole(windows, tmp_path_factory):
    """Trained in one go."""
    path = tmp_path_factory.mktemp("whole") / "whole.safetensors"
    return train_dancer(TINY, path, windows, log=lambda line: None)


def test_a_killed_training_continues_bit_for_bit(whole, windows, tmp_path: Path):

    def stop(line: str) -> None:
        if " 3/6" in line:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        train_dancer(TINY, tmp_path / "killed.safetensors", windows, log=stop)
    again = train_dancer(TINY, tmp_path / "killed.safetensors", windows, log=lambda line: None)
    assert all(
        torch.equal(a, b)
        for a, b in zip(whole.model.parameters(), again.model.parameters(), strict=True)
    )
    assert [sitting["from_step"] for sitting in again.card["sittings"]] == [0, 3]
    with pytest.raises(ValueError, match="begun with lr"):
        train_dancer(
            replace(TINY, lr=1e-4), tmp_path / "killed.safetensors", windows, log=lambda line: None
        )


def test_what_a_recipe_says_reaches_the_training(whole, windows, monkeypatch):
    assert torch.equal(whole.schedule.alpha_bar, cosine_schedule(20).alpha_bar)
    torch.manual_seed(0)
    model = network(TINY.config)

    def loss(**changed) -> float:
        recipe = replace(TINY, **changed)
        return loss_of(recipe, windows, whole.schedule)(
            model, torch.Generator().manual_seed(0)
        ).item()

    plain = {"kinematic": None, "batch": 2, "no_music": 0.9}
    plain |= {"changes": 0.0, "toes": 0.0}
    for name, value in plain.items():
        assert loss(**{name: value}) != loss(), name
    never = 1e-12  # it draws as many random numbers
    monkeypatch.setattr(model, "listen", lambda *music, own=model.listen: without(own(*music)))
    silent = loss(no_music=never)
    monkeypatch.undo()
    assert loss(no_music=1.0) == pytest.approx(silent) != pytest.approx(loss(no_music=never))


def test_the_ear_is_that_of_its_own_training(windows, tmp_path: Path):
    said = []
    trained = train_dancer(TINY, tmp_path / "one.safetensors", windows, log=said.append)
    assert len(list(tmp_path.glob("ear-*.run.safetensors"))) == 1
    own = ear_of(TINY.ear, tmp_path, log=lambda line: None)  # trained already: only read
    assert trained.card["ear"] == own.card and own.card["songs"] == TINY.ear.songs
    ear = own.hearing(windows.mel_scaler)
    assert not torch.allclose(ear.music.project.bias, own.ear.music.project.bias)
    for a, b in zip(trained.model.ear.parameters(), ear.parameters(), strict=True):
        torch.testing.assert_close(a, b, rtol=0, atol=1e-6)  # an average of equal weights
    train_dancer(replace(TINY, name="two"), tmp_path / "two.safetensors", windows, log=said.append)
    assert len(list(tmp_path.glob("ear-*"))) == 1
    train_dancer(
        replace(TINY, ear=replace(TINY.ear, seed=1)),
        tmp_path / "three.safetensors", windows, log=said.append,
    )  # fmt: skip
    assert len(list(tmp_path.glob("ear-*"))) == 2


def test_an_ear_can_be_taken_over(whole, windows, tmp_path: Path):
    ear = ear_within(whole)
    assert ear.card == whole.card["ear"] | {"taken_over": True}
    other = replace(TINY, name="other", seed=3)
    run = tmp_path / "b" / "two.safetensors"
    second = train_dancer(other, run, windows, log=lambda line: None, ear=ear)
    assert not list(run.parent.glob("ear-*"))  # none was trained
    assert second.card["ear"]["taken_over"]
    for a, b in zip(second.model.ear.parameters(), whole.model.ear.parameters(), strict=True):
        torch.testing.assert_close(a, b, rtol=0, atol=1e-6)
    wider = replace(TINY, config=replace(TINY.config, ear_width=32), ear=replace(
        EARS, config=EarConfig(width=32, blocks=1)
    ))  # fmt: skip
    with pytest.raises(ValueError, match="tiny needs an ear with .*width=32"):
        train_dancer(wider, run, windows, ear=ear)
    with pytest.raises(ValueError, match="unconditional has no ear"):
        train_dancer(UNCONDITIONAL, run, windows, ear=ear)
    mine = DanceRecipe("mine", TINY.config, steps=1)
    with pytest.raises(ValueError, match="mine needs an ear: pass `ear`"):
        train_dancer(mine, run.with_name("three.safetensors"), windows)
    with pytest.raises(ValueError, match="MoFusion has no ear"):
        ear_within(load("unconditional"))


def test_recipes_that_cannot_be_trained_are_refused():
    with pytest.raises(ValueError, match="regression cannot be guided"):
        replace(REGRESSED, no_music=0.1)
    with pytest.raises(ValueError, match="its network has an ear with"):
        replace(TINY, ear=replace(EARS, config=EarConfig()))
    with pytest.raises(ValueError, match="pass ear=None"):
        replace(TINY, config=UNCONDITIONAL.config)
    with pytest.raises(ValueError, match="music_layers must be 1 or more"):
        replace(HEARING, music_layers=0)


def test_the_command_trains_a_recipe_into_a_file(monkeypatch, tmp_path: Path, capsys):
    small = replace(
        REGRESSED,
        config=replace(REGRESSED.config, width=16, heads=2, layers=1, music_layers=1, **SMALL_EAR),
        ear=EARS,
        **SIZES,
    )
    monkeypatch.setitem(command.DANCE_RECIPES, "regression", small)
    arguments = [
        "pretrained",
        "regression",
        "--runs",
        str(tmp_path / "runs"),
        "--out",
        str(tmp_path),
    ]
    monkeypatch.setattr("sys.argv", arguments)
    command.main()
    assert "wrote" in capsys.readouterr().out
    monkeypatch.setattr("sys.argv", [*arguments, "--ear", "unconditional"])
    with pytest.raises(SystemExit):
        command.main()
    assert "--ear unconditional: MoFusion has no ear" in capsys.readouterr().err
    dancer = load(tmp_path / "regression.safetensors")
    assert (
        dancer.card["recipe"]["steps"] == 6
        and dancer.card["target"] == "x0"
        and dancer.card["windows"] > 0
    )
    mel = torch.zeros(1, 70, 80)
    assert dancer.dance_mel(mel, 40).shape == (1, 40, 21, 3)
    taken = ["--ear", str(tmp_path / "regression.safetensors"), "--runs", str(tmp_path / "again")]
    monkeypatch.setattr("sys.argv", ["pretrained", "regression", *taken, "--out", str(tmp_path)])
    command.main()
    assert not list((tmp_path / "again").glob("ear-*"))
    assert load(tmp_path / "regression.safetensors").card["ear"]["taken_over"]
    assert "wrote" in capsys.readouterr().out


def test_with_and_without_kinematic_losses_all_else_is_alike():
    assert DANCER.kinematic and not DANCER_PLAIN.kinematic
    assert replace(DANCER_PLAIN, name="dancer", kinematic=DANCER.kinematic) == DANCER
    assert DANCER.kinematic.over_time == "alpha_bar"  # the paper's
    assert set(DANCE_RECIPES) == {
        "dancer",
        "dancer-plain",
        "regression",
        "dancer-full",
        "unconditional",
    }
