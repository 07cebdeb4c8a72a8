"""The measures of walks, with the data itself as the walker: no error, ratios of one."""

import json
import sys
from pathlib import Path

import numpy as np
import pytest
from gaits import control_of, gait, rest_pose

sys.path.insert(
    0, str(Path(__file__).parents[2])
)  # tools and benchmarks are of the checkout, not of the package

from motiondiff_edu.metrics.walks import footsteps, heel_speed  # noqa: E402
from tools.results.__main__ import weights_of  # noqa: E402
from tools.results.page import cards
from tools.results.walks import steps_table  # noqa: E402
from tools.results.walks.scores import diversity, score  # noqa: E402

CONTROL = np.stack(
    [
        control_of(7, v, 0.0, w)
        for v, w in ((1.0, 0.3), (1.3, -0.2), (0.7, 0.0), (1.6, 0.1), (0.5, 0.9))
    ]
)
WALKS = np.stack([gait(control) for control in CONTROL])


def values(measures):
    return {measure.name: measure.value for measure in measures}


def test_the_data_as_a_walker_has_no_excess_and_follows_only_its_own_control():
    slow = CONTROL - [0.01, 0, 0]  # data that are off by 1 cm/s, so that a ratio exists
    found = values(score(WALKS, slow, WALKS))
    assert found["adherence_excess_mps"] == 0 and found["adherence_mps"] == pytest.approx(0.01)
    assert found["adherence_shuffled_over_own"] > 20
    assert found["skating_over_data"] == pytest.approx(0.5)  # 0.01 m/s over the floor of 0.02
    assert found["drift_adherence_ratio"] == pytest.approx(1)


def test_a_walker_that_gets_worse_drifts_and_one_that_slides_skates():
    still = np.tile(rest_pose(), (5, 140, 1, 1))
    told = np.zeros((5, 140, 3))
    noise = (
        np.random.default_rng(2).normal(0, 1, still.shape)
        * np.linspace(0.0005, 0.002, 140)[:, None, None]
    )
    found = values(score(still + noise, told, still))
    assert found["drift_ratio"] >= found["drift_bone_ratio"] > 1.8
    carried = values(score(WALKS, CONTROL + [0.1, 0.0, 0.0], WALKS))
    assert carried["skating_over_data"] == pytest.approx(
        1
    )  # the data are judged under the same control
    assert values(score(WALKS + [0, 0.1, 0], CONTROL, WALKS))["planted_share"] == 0


def test_the_spread_of_the_data_over_itself_is_one():
    drawn = np.random.default_rng(3).normal(size=(4, 3, 30, 21, 3))
    assert values(diversity(2 * drawn, drawn))["diversity_over_data"] == pytest.approx(2)


def test_the_rows_of_the_step_table_are_those_of_the_metric():
    control = np.tile(control_of(6), (3, 1, 1))
    poses = np.stack([gait(c, phase=p) for c, p in zip(control, (0.1, 0.4, 0.7), strict=True)])
    poses = poses + np.random.default_rng(4).normal(0, 0.001, poses.shape)
    expected = footsteps(list(heel_speed(poses, control)))
    found = steps_table.tables(poses, control)
    np.testing.assert_allclose(steps_table.curve(found), expected.counts)
    np.testing.assert_allclose(
        steps_table.row(found),
        [expected.count, expected.v95, expected.mean_s, expected.std_s],
        rtol=1e-9,
    )


def test_a_card_tells_only_measures_of_its_own_weights(tmp_path):
    record = {"name": "walker.bone_rmse_cm", "value": 0.2, "seeds": {"weights": "abc"}}
    (tmp_path / "walker.json").write_text(json.dumps([record]))
    assert cards.metrics(tmp_path, "walker", "abc") == {"bone_rmse_cm": 0.2}
    assert (
        cards.metrics(tmp_path, "walker", "other")
        == {}
        == cards.metrics(tmp_path, "walker-plain", "abc")
    )


def test_weights_to_measure_are_given_by_name_and_file(tmp_path):
    (tmp_path / "w.safetensors").touch()
    assert weights_of([f"mine={tmp_path}/w.safetensors"]) == {"mine": tmp_path / "w.safetensors"}
    with pytest.raises(SystemExit, match="NAME=FILE"):
        weights_of(["mine"])
