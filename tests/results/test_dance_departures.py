"""The dancer's departures: what differs is what the words say, a row goes on, differences are of
the same songs."""

import json
from dataclasses import asdict, replace
from functools import partial
from importlib.util import find_spec

import numpy as np
import pytest
import torch

from motiondiff_edu.baselines.transformer import DanceTransformer, TransformerConfig
from motiondiff_edu.mofusion import MoFusion, MoFusionConfig
from motiondiff_edu.performers.hearing_mofusion import HearingConfig
from motiondiff_edu.recipes.dancer import DANCER
from motiondiff_edu.recipes.mofusion import KINEMATIC
from tools.results import __main__ as command
from tools.results.dances import departures, timing
from tools.results.dances.departures import BASE, FULL, QUICK, VARIANTS, recipe_of
from tools.results.dances.parts import DanceSize
from tools.results.dances.scores import rows_of
from tools.results.intervals import interval
from tools.results.sweep import run
from tools.results.walks import scores
from tools.results.walks.parts import LINES, Walks

SIZES = {"widths": (16, 24), "S": 60}
SMALL = replace(QUICK, measured=DanceSize(songs=3, seeds=1, pieces=2, each=2))


@pytest.fixture
def tiny(monkeypatch):
    """The same variants with networks that train in no time, and intervals of few draws."""
    monkeypatch.setattr(scores, "interval", partial(interval, draws=30))
    small = partial(replace, **SIZES)
    monkeypatch.setattr(
        departures, "BASE", replace(departures.BASE, config=small(departures.BASE.config))
    )
    for name, variant in list(VARIANTS.items()):
        if config := variant.recipe.get("config"):
            layers = {"music_layers": min(config.music_layers, 1)}
            made = variant.recipe | {"config": small(config, **layers)}
            monkeypatch.setitem(VARIANTS, name, replace(variant, recipe=made))
    tuned = {"adam": 0.002, "muon": 0.003}
    monkeypatch.setattr(departures, "tuned_rate", lambda plan, optimizer: tuned[optimizer])


def records_of(name: str, folder) -> dict[str, dict]:
    """The records of one variant, at the small size, without the beginning of their names."""
    (folder / "runs").mkdir(exist_ok=True)
    sweep = replace(departures.sweep(SMALL, folder / "runs"), seeds=(0,))
    made = run(sweep, name, folder / "rows", "c")
    return {one["name"].removeprefix(f"dancer-departures.{name}."): one for one in made}


def test_each_variant_differs_from_its_rival_in_what_its_words_say(tiny):
    differing = {
        "muon": {"optimizer", "lr"},
        "x0": {"config"},
        "convolutions": {"config"},
        "changes": {"changes"},
        "toes": {"toes"},
        "ear": {"config", "ear"},
        "no-kinematics": {"kinematic"},
        "light-kinematics": {"kinematic"},
        "guidable": {"no_music"},
    }
    assert set(differing) | {"base"} == set(VARIANTS)
    lighter = [recipe_of(n, 0, FULL).kinematic for n in ("light-kinematics", "no-kinematics")]
    assert BASE.kinematic == KINEMATIC and lighter == [DANCER.kinematic, None]
    assert DANCER.kinematic.skeleton < KINEMATIC.skeleton / 10
    for name, wanted in differing.items():
        (rival,) = VARIANTS[name].rivals
        own, other = (asdict(recipe_of(n, 0, FULL)) for n in (name, rival))
        assert {key for key in own if own[key] != other[key]} - {"name"} == wanted, name
    toes = recipe_of("toes", 0, FULL).config
    assert isinstance(recipe_of("ear", 0, FULL).config, HearingConfig) and toes.target == "x0"


def test_a_variant_is_trained_measured_and_set_beside_its_rival(tiny, tmp_path, capsys):
    alone = records_of("x0", tmp_path)
    assert "there are no rows of muon to compare with" in capsys.readouterr().out
    assert not [name for name in alone if "minus" in name]
    base = records_of("muon", tmp_path)
    capsys.readouterr()
    again = records_of("x0", tmp_path)
    assert "step" not in capsys.readouterr().out, "it was trained again"
    assert {name: again[name] for name in alone} == alone
    for kind in ("bas_share", "bone_rmse_cm"):
        gained = again[f"{kind}_minus_muon"]["value"]
        assert gained == pytest.approx(again[kind]["value"] - base[kind]["value"], abs=2e-3)
    seeds = again["bas_share"]["seeds"]
    assert seeds["steps"] == 3 and seeds["songs"] == 3 and seeds["samples"] == 1
    assert seeds["rate"] == 0.003 and seeds["trainings"] == 1
    assert again["fid"]["low"] == again["fid"]["value"], "computed once, over all songs"


def test_the_papers_form_is_averaged_over_beats_within_the_clip():
    songs = departures.stage(SMALL.measured).songs
    dances, beats = songs.truth[:, 0, :100][None], songs.beats(100)
    found = rows_of(dances, beats)
    outside = [
        np.append(music, 7.0) for music in beats
    ]  # 2 s after the dance: nobody could meet it
    assert rows_of(dances, outside)["bas_music"] == pytest.approx(found["bas_music"])
    still = np.concatenate(
        [dances, np.repeat(dances[:, :, :1], 100, axis=2)]
    )  # one of two dances meets no beat
    assert rows_of(still, beats)["bas_music"] == pytest.approx(found["bas_music"] / 2)


def test_times_are_of_both_networks_and_the_unet_is_one(monkeypatch):
    small = TransformerConfig(width=16, heads=2, layers=1, music_layers=1, S=60)
    monkeypatch.setitem(timing.NETWORKS, "transformer", small)
    unet = MoFusionConfig(music_layers=1, target="x0", skip=False, **SIZES)
    monkeypatch.setitem(timing.NETWORKS, "unet", unet)
    found = {one["name"]: one for one in timing.time_records(2, "c")}
    assert len(found) == 2 * 7 and all(one["value"] > 0 for one in found.values())
    for what in ("step", "pass", "dance"):
        assert found[f"dance-time.unet.{what}_over_unet"]["value"] == 1
        mine = [found[f"dance-time.transformer.{what}_{end}"] for end in ("ms", "over_unet")]
        assert mine[0]["unit"] == "CPU ms" and mine[1]["unit"] == "ratio"
    for name, kind in {"unet": MoFusion, "transformer": DanceTransformer}.items():
        size = sum(p.numel() for p in kind(timing.NETWORKS[name]).parameters())
        assert found[f"dance-time.{name}.parameters"]["value"] == size
    assert torch.get_num_threads() >= 1


def test_the_transformer_that_is_timed_is_of_the_size_of_the_unet():
    kinds = {"unet": MoFusion, "transformer": DanceTransformer}
    unet, plain = (
        sum(p.numel() for p in kind(timing.NETWORKS[name]).parameters())
        for name, kind in kinds.items()
    )
    assert plain == pytest.approx(unet, rel=0.02)


def test_what_trains_is_run_when_asked_for_only():
    weights = {"dancer"}
    lines = {"walker": Walks("walker", "walker", 10)}
    plain = command.parts_of([], False, lines, weights)  # there are no weights of that walker
    assert set(plain) == {
        "dancer", "unheard", "footsteps", "dance-data", "attention", "dance-time",
        "course", "dance-ways", "ear",
    }  # fmt: skip
    full = command.parts_of([], True, {}, weights)
    assert set(plain) | {
        "dancer-departures.ear",
        "walker-departures.leap",
        "words-budget.bag",
    } <= set(full)
    assert not [name for name in full if name.startswith(("inbetween", "recordings", "real"))]
    both = command.parts_of([], False, {}, {"inbetweener", "unconditional"})
    assert {"inbetween", "inbetween-departures.ours"} <= set(both), "it trains nothing"
    rows = [f"dancer-departures.{name}" for name in VARIANTS]
    assert command.parts_of(["dancer-departures"], False, {}, weights) == rows
    some = ["dancer-departures.ear", "attention"]
    assert command.parts_of(some, False, {}, weights) == some
    assert "attention" not in command.parts_of([], False, {}, set())
    with pytest.raises(SystemExit, match="dancer-departures.w"):
        command.parts_of(["dancer-departures.w"], False, {}, weights)


def test_commands_of_records_name_parts_that_there_are(root):
    """What measured a record can measure it again."""
    for path in (root / "docs" / "results").glob("*.json"):
        if path.stem == "plain":  # it is a tool of its own
            assert find_spec("tools.journey")
            continue
        for one in json.loads(path.read_text(encoding="utf-8")):
            assert one["command"] == f"python -m tools.results --only {path.stem}", one["name"]
            assert command.parts_of([path.stem], False, LINES, set()) == [path.stem]
