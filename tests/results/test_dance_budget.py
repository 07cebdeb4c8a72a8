"""Dancers at one budget.

What differs is what the table says, a row goes on, differences are of the same songs.
"""

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
from motiondiff_edu.recipes.ear import EAR
from tools.results import __main__ as command
from tools.results.dances import budget, timing
from tools.results.dances.budget import FULL, QUICK, VARIANTS, recipe_of
from tools.results.dances.parts import DanceSize
from tools.results.dances.scores import rows_of
from tools.results.intervals import interval
from tools.results.page.records import DANCES
from tools.results.sweep import run
from tools.results.walks import scores
from tools.results.walks.parts import LINES, Walks

TINY = MoFusionConfig(widths=(16, 24), music_layers=1, S=60, target="x0", skip=False)
SMALL = replace(QUICK, measured=DanceSize(songs=3, seeds=1, pieces=2, each=2))


@pytest.fixture
def tiny(monkeypatch):
    """The same variants with networks that train in no time, and intervals of few draws."""
    monkeypatch.setattr(scores, "interval", partial(interval, draws=30))
    transformer = TransformerConfig(width=16, heads=2, layers=1, music_layers=1, S=60)
    for name, variant in list(VARIANTS.items()):
        config, settings = variant.recipe
        changes = {"target": config.target, "C": config.C}
        if isinstance(config, HearingConfig):
            small = HearingConfig(
                **asdict(TINY) | changes, ear_width=EAR.config.width, ear_blocks=EAR.config.blocks
            )
        elif isinstance(config, TransformerConfig):
            small = replace(transformer, deterministic=config.deterministic, **changes)
        else:
            small = replace(
                TINY, skip=config.skip, music_layers=min(config.music_layers, 1), **changes
            )
        monkeypatch.setitem(VARIANTS, name, replace(variant, recipe=(small, settings)))


def base_of(name: str) -> str:
    """The variant that it is described as differing from: its first rival."""
    return next(iter(VARIANTS[name].rivals))


def records_of(name: str, folder) -> dict[str, dict]:
    """The records of one variant, at the small budget, without the beginning of their names."""
    made = run(budget.sweep(SMALL, folder / "runs"), name, folder / "rows", "c")
    return {one["name"].removeprefix(f"dance-budget.{name}."): one for one in made}


def test_each_variant_differs_from_its_base_in_what_its_words_say():
    differing = {
        "no-feet": {"loss_weights.toes"},
        "poses": {"loss_weights.changes"},
        "eps": {"config.target", "config.skip"},
        "eps-weighted": {"loss_weights.high_noise"},
        "v": {"config.target", "config.skip"},
        "constant": {"kinematic"},
        "alpha_bar": {"kinematic"},
        "snr": {"kinematic"},
        "slide": {"kinematic"},
        "cosine": {"snr"},
        "gain-noise": {"gain_noise"},
        "linear-music": {"config.music_layers"},
        "mfcc": {"config.C"},
        "regression": {"config.deterministic"},
    }
    for name, wanted in differing.items():
        own, base = (flat(asdict(recipe_of(n, FULL))) for n in (name, base_of(name)))
        assert own.keys() == base.keys()
        assert {k.split(".")[0] if k.startswith("kin") else k for k in own if own[k] != base[k]} - {
            "name"
        } == wanted
    kinds = [recipe_of(name, FULL).kinematic.over_time for name in ("constant", "alpha_bar", "snr")]
    assert kinds == ["constant", "alpha_bar", "snr"]
    assert set(differing) | {"x0", "transformer", "ear"} == set(VARIANTS)
    ear = recipe_of("ear", FULL)
    assert replace(ear, name="dance-budget.x0", config=recipe_of("x0", FULL).config, ear=None) == (
        recipe_of("x0", FULL)
    )
    assert (ear.ear.songs, ear.ear.seconds) == (ear.songs, ear.seconds)
    assert {rival for one in VARIANTS.values() for rival in one.rivals} <= set(VARIANTS)


def flat(tree: dict, above: str = "") -> dict:
    """{"config.target": ...}; kinematic weights are one thing, there or not."""
    found = {}
    for key, value in tree.items():
        if isinstance(value, dict) and key != "kinematic":
            found |= flat(value, f"{above}{key}.")
        else:
            found[above + key] = value
    return found


def test_the_transformer_is_of_the_size_of_the_unet():
    unet, plain = (
        sum(p.numel() for p in kind(VARIANTS[name].recipe[0]).parameters())
        for kind, name in ((MoFusion, "x0"), (DanceTransformer, "transformer"))
    )
    assert plain == pytest.approx(unet, rel=0.02)


def test_a_variant_is_trained_measured_and_set_beside_its_rivals(tiny, tmp_path, capsys):
    alone = records_of("alpha_bar", tmp_path)
    assert "there are no rows of x0 to compare with" in capsys.readouterr().out
    assert not [name for name in alone if "minus" in name]
    base = records_of("x0", tmp_path)
    capsys.readouterr()
    again = records_of("alpha_bar", tmp_path)
    assert "step" not in capsys.readouterr().out, "it was trained again"
    assert {name: again[name] for name in alone} == alone
    share = [found["bas_share"]["value"] for found in (again, base)]
    gained = again["bas_share_minus_x0"]
    assert gained["value"] == pytest.approx(share[0] - share[1], abs=2e-3)
    bones = [found["bone_rmse_cm"]["value"] for found in (again, base)]
    saved = again["bone_gain_over_x0"]["value"]
    assert saved == pytest.approx(1 - bones[0] / bones[1], abs=1e-3)
    seeds = gained["seeds"]
    assert seeds["trained_steps"] == 3 and seeds["songs"] == 3 and seeds["samples"] == 1
    assert seeds["dances"] == DANCES and seeds["trainings"] == 1
    assert again["fid"]["low"] == again["fid"]["value"], "computed once, over all songs"


@pytest.mark.parametrize("name", ["eps-weighted", "mfcc", "regression", "ear"])
def test_what_is_not_the_usual_network_is_trained_and_measured(tiny, tmp_path, name):
    found = {kind: one["value"] for kind, one in records_of(name, tmp_path).items()}
    assert found["fid"] > 0 and found["bone_rmse_cm"] > 0
    # a batch's rows may differ by rounding
    assert (found["multimodality"] < 1e-5) == (name == "regression")
    assert budget.stage("mfcc", SMALL).songs.mel.shape[2] == 22
    assert budget.stage("", SMALL).songs.mel.shape[2] == 80


def test_the_papers_form_is_averaged_over_beats_within_the_clip():
    songs = budget.stage("", SMALL).songs
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


def test_times_are_of_every_network_and_the_base_is_one(tiny):
    names = ("x0", "transformer", "regression")
    found = {one["name"]: one for one in timing.time_records(names, SMALL, 2, "c")}
    assert len(found) == 3 * 7 and all(one["value"] > 0 for one in found.values())
    for what in ("step", "pass", "dance"):
        assert found[f"dance-time.x0.{what}_over_x0"]["value"] == 1
        mine = [found[f"dance-time.transformer.{what}_{end}"] for end in ("ms", "over_x0")]
        assert mine[0]["unit"] == "CPU ms" and mine[1]["unit"] == "ratio"
    networks = {"x0": MoFusion, "transformer": DanceTransformer, "regression": DanceTransformer}
    for name, kind in networks.items():
        size = sum(p.numel() for p in kind(VARIANTS[name].recipe[0]).parameters())
        assert found[f"dance-time.{name}.parameters"]["value"] == size
    # fifty passes against one
    assert (
        found["dance-time.transformer.dance_ms"]["value"]
        > 3 * found["dance-time.regression.dance_ms"]["value"]
    )
    assert torch.get_num_threads() >= 1


def test_what_trains_is_run_when_asked_for_only():
    weights = {"dancer"}
    lines = {"walker": Walks("walker", "walker")}
    plain = command.parts_of([], False, lines, weights)  # there are no weights of that walker
    assert set(plain) == {
        "dancer", "unheard", "footsteps", "dance-data", "attention", "dance-time", "known-answer",
        "course", "guided", "ear",
    }  # fmt: skip
    full = command.parts_of([], True, {}, weights)
    assert set(plain) | {"dance-budget.v", "walker-departures.leap", "mend-map.05"} <= set(full)
    assert not [name for name in full if name.startswith(("inbetween", "recordings", "real"))]
    both = command.parts_of([], False, {}, {"inbetweener", "unconditional"})
    assert {"inbetween", "inbetween-departures.ours"} <= set(both), "it trains nothing"
    rows = [f"dance-budget.{name}" for name in VARIANTS]
    assert command.parts_of(["dance-budget"], False, {}, weights) == rows
    some = ["dance-budget.v", "attention"]
    assert command.parts_of(some, False, {}, weights) == some
    assert "attention" not in command.parts_of([], False, {}, set())
    with pytest.raises(SystemExit, match="dance-budget.w"):
        command.parts_of(["dance-budget.w"], False, {}, weights)


def test_commands_of_records_name_parts_that_there_are(root):
    """What measured a record can measure it again."""
    for path in (root / "docs" / "results").glob("*.json"):
        if path.stem == "plain":  # it is a tool of its own
            assert find_spec("tools.journey")
            continue
        for one in json.loads(path.read_text(encoding="utf-8")):
            assert one["command"] == f"python -m tools.results --only {path.stem}", one["name"]
            assert command.parts_of([path.stem], False, LINES, set()) == [path.stem]
