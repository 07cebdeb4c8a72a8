"""The walker's departures: what differs is what the words say, and measures are those by hand."""

from dataclasses import asdict, replace

import numpy as np
import pytest
import torch

from motiondiff_edu.modiff import MODIFF_SMALL
from motiondiff_edu.performers.walker import Walker
from tools.results.sweep import run
from tools.results.walks import departures, scores
from tools.results.walks.departures import FULL, KINDS, QUICK, VARIANTS, recipe_of

SMALL = replace(QUICK, clips=3, steps=2, training=12)


@pytest.mark.parametrize("name", [name for name, one in VARIANTS.items() if one.rivals])
def test_a_variant_differs_from_its_rival_in_what_its_words_say(name):
    wanted = {
        "leap": {"schedule"},
        "muon": {"optimizer", "lr"},
        "muon-leap": {"schedule"},
        "past-noise": {"past_noise", "dropout"},
        "no-dropout": {"dropout"},
        "both": {"dropout"},
        "one-pose": {"config"},
    }
    (rival,) = VARIANTS[name].rivals
    own, other = (asdict(recipe_of(one, 0, FULL)) for one in (name, rival))
    assert {key for key in own if own[key] != other[key]} - {"name"} == wanted[name]


def test_the_base_is_modiff_at_the_shipped_width():
    base = recipe_of("base", 0, FULL)
    assert base.config == MODIFF_SMALL and base.config.target == "eps" and base.config.skip
    assert (base.optimizer, base.schedule, base.past_noise) == ("adam", "linear", 0.0)
    assert base.dropout == (0.0, 0.05, 0.1, 0.15, 0.2, 0.25) and base.batch == 64
    assert recipe_of("past-noise", 0, FULL).past_noise == 0.3


def test_measures_by_hand():
    """Root mean squares, differences, and ratios of means; the floor of skating is 0.02 m/s."""
    keys = sorted({key for how in KINDS.values() for key in how.rows})
    rows = {key: np.array([k, 9.0 * k]) for k, key in enumerate(keys, 1)}
    found = {one.name: one.value for one in scores.measures(KINDS, rows)}
    mean = {key: row.mean() for key, row in rows.items()}
    assert found["bone_rmse_cm"] == pytest.approx(np.sqrt(mean["bone"]))
    assert found["broken_over_whole"] == pytest.approx(np.sqrt(mean["bone_broken"] / mean["bone"]))
    assert found["adherence_excess_mps"] == pytest.approx(
        mean["adherence"] - mean["adherence_data"]
    )
    for name, own, other in (
        ("adherence_shuffled_over_own", "adherence_shuffled", "adherence"),
        ("finished_skating_over_data", "skating_clean", "skating_data"),
        ("diversity_over_data", "spread", "spread_data"),
        ("footsteps_robust_over_data", "steps", "steps_data"),
    ):
        assert found[name] == pytest.approx(mean[own] / mean[other]), name
    assert found["skating_mps"] == pytest.approx(mean["skating"])
    assert found["cleanup_moves_toes_cm"] == pytest.approx(100 * mean["toes_moved"])


def test_a_variant_is_trained_measured_and_set_beside_its_rival(tmp_path, monkeypatch):
    tiny = replace(MODIFF_SMALL, width=16, heads=2, hidden=24, cross_layers=1, decoder_layers=1)
    monkeypatch.setattr(departures, "BASE", replace(departures.BASE, config=tiny, batch=3))
    monkeypatch.setattr(departures, "STEPS", 2)
    sweep = departures.sweep(SMALL, tmp_path)
    rows = tmp_path / "rows"
    base = {one["name"]: one for one in run(sweep, "base", rows, "c")}
    walker = sweep.train("base", 0)  # continues the finished run
    assert isinstance(walker, Walker) and walker.card["recipe"]["optimizer"] == "adam"
    made = {one["name"]: one for one in run(sweep, "leap", rows, "c")}
    name = "walker-departures.{}.bone_rmse_cm"
    gained = made[name.format("leap") + "_minus_base"]["value"]
    assert gained == pytest.approx(
        made[name.format("leap")]["value"] - base[name.format("base")]["value"], rel=1e-2, abs=1e-2
    )
    assert base[name.format("base")]["seeds"]["steps"] == 2
    assert torch.get_num_threads() == 1
