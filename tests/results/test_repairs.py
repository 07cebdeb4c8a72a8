"""What menders are measured by.

Holes as they should be, measures by hand, intervals over trainings and clips.
"""

from types import SimpleNamespace

import numpy as np
import pytest
import torch

from data_synth.imperfect import ARM, dead_joints, dropped_frames
from motiondiff_edu.beyond.back_with_known import masked_way_back
from motiondiff_edu.ddpm import cosine_schedule
from motiondiff_edu.metrics.bodies import bone_rmse
from motiondiff_edu.motion.root_frame import to_world
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.motion.skeleton import JOINTS
from motiondiff_edu.reconstruction import plain_way_back
from tools.results.repairs import both, repair
from tools.results.repairs import dropout as dropout_part
from tools.results.repairs import rivals as rivals_part
from tools.results.repairs.both import WINDOW, masked_window
from tools.results.repairs.repair import FAULTS
from tools.results.repairs.rivals import rivals
from tools.results.repairs.trials import as_given, names_of, without
from tools.results.walks.scores import measures_over_seeds
from tools.results.walks.trials import unseen


@pytest.fixture(scope="module")
def trials():
    return unseen(5, 2)


class Standing:
    """Predicts what its scaler has for a mean pose; counts its windows."""

    schedule = cosine_schedule(20)

    def __init__(self):
        self.config = SimpleNamespace(T_h=10, T_p=10, D=63, C=3, S=20)
        self.pose_scaler = Scaler(torch.linspace(-1, 1, 63), torch.full((63,), 0.5))
        self.control_scaler, self.asked = Scaler.nothing(3), 0

    def window_sampler(self, steps=None):
        def sample(past, control, generator):
            self.asked += 1
            return torch.zeros(len(past), 10, 63)

        return sample

    def denoiser(self, past, control):
        return lambda x, s: x / (1 - self.schedule.alpha_bar[s]).sqrt().view(-1, 1, 1).to(x)


def test_missing_joints_are_zero_once_standardised(trials):
    walker, broken = Standing(), without(trials.past, 0.3)
    past, known = as_given(walker, broken)
    lost = ~broken.known.all(1)
    assert (lost.sum(1) == round(0.3 * 21)).all() and len(
        {tuple(row) for row in lost}
    ) == 5  # others in each
    scaled = walker.pose_scaler.transform(past)
    assert (scaled[~known] == 0).all() and known.sum() == 5 * 10 * 3 * 15
    np.testing.assert_allclose(
        past[known].numpy(), trials.past.reshape(5, 10, 63)[known.numpy()], rtol=1e-5, atol=1e-6
    )


def test_gains_and_cost_by_hand():
    plain, dropout = {"bone": 9.0, "adherence": 0.5}, {"bone": 4.0, "adherence": 0.6}
    rows = {
        f"{side}_{past}_{row}": np.full((3, 6), value)
        for side, values in (("plain", plain), ("dropout", dropout))
        for past in ("complete", "missing")
        for row, value in values.items()
    }
    kinds = dropout_part.COMPARED | {"cost": dropout_part.COST}
    found = {one.name: one for one in measures_over_seeds(kinds, rows)}
    bone, control = (found[f"dropout_gain_{name}"] for name in dropout_part.MEASURES)
    assert (bone.value, bone.low, bone.high) == (pytest.approx(1.0),) * 3 and bone.unit == "cm"
    assert control.value == pytest.approx(-0.1) and control.unit == "m/s"
    assert found["dropout_missing_bone_cm"].value == pytest.approx(2)
    assert found["plain_complete_adherence_mps"].value == pytest.approx(0.5)
    assert found["cost"].value == pytest.approx(1.2)  # the larger of 2/3 and 6/5


def test_each_comparison_has_names_of_its_own(trials, monkeypatch):
    """The shipped pair beside the small pairs: no measure of one overwrites one of the other."""
    monkeypatch.setattr(dropout_part.checkpoints, "load", lambda path: path)
    monkeypatch.setattr(
        dropout_part,
        "measured",
        lambda walkers, trials, share: {
            row: np.full((len(walkers), 4), 1 + share + ("plain" in walkers[0]))
            for row in ("bone", "adherence")
        },
    )
    weights = {n: n for n in ("walker", "walker-plain", *names_of("plain"), *names_of("dropout"))}
    shipped, small = (
        {one.name: one.value for one in dropout_part.dropout_measures(pair, trials, weights)}
        for pair in (dropout_part.SHIPPED_PAIR, dropout_part.SMALL_PAIRS)
    )
    assert not set(shipped) & set(small) and len(shipped) == len(small)
    assert shipped["dropout_cost_complete"] == small["pairs_dropout_cost_complete"]
    assert shipped["dropout_cost_complete"] == pytest.approx(0.5**0.5)  # bones: roots of squares
    assert shipped["walker_plain_missing_adherence_mps"] == pytest.approx(2.3)
    assert small["dropout_complete_bone_cm"] == pytest.approx(1.0)


def test_errors_of_a_repair_count_what_was_missing(trials):
    broken = dropped_frames(trials.past, 3, 4)
    made = trials.past + 0.0
    made[:, 3:7] += [0.03, 0.0, 0.04]  # 5 cm off
    made[:, 0] += 9.0  # known frames are not looked at
    np.testing.assert_allclose(repair.squared_errors(made, trials.past, broken), 25.0)
    assert np.isnan(repair.squared_errors(made, trials.past, without(trials.past, 0.0))).all()


@pytest.fixture(autouse=True)
def few_clips(monkeypatch):
    monkeypatch.setattr(rivals_part, "CLIPS", 16)


def test_rivals_fill_what_they_can(trials):
    arm = rivals(dead_joints(trials.past, ARM), trials)
    assert set(arm) == {
        "ridge",
        "meanpose",
    }  # no straight line leads through a joint that is never seen
    lines = rivals(dropped_frames(trials.past, 3, 4), trials)["interpolation"]
    np.testing.assert_allclose(lines[:, 4], 0.6 * trials.past[:, 2] + 0.4 * trials.past[:, 7])
    hidden = [JOINTS.index(name) for name in ARM]
    errors = {
        name: np.linalg.norm((guess - trials.past)[:, :, hidden], axis=-1).mean()
        for name, guess in arm.items()
    }
    assert errors["ridge"] < errors["meanpose"]
    seen = np.delete(np.arange(21), hidden)
    np.testing.assert_allclose(arm["ridge"][:, :, seen], trials.past[:, :, seen], atol=1e-6)


def test_repairs_of_a_walker_that_stands_are_the_mean_pose(trials):
    size = repair.RepairSize(samples=2, rounds=1, steps=3)
    found = {f.name: f for f in repair.repair_measures("arm", Standing(), trials, size)}
    assert found["arm_paper_rmse_cm"].value == pytest.approx(found["arm_paper_one_rmse_cm"].value)
    broken = repair.FAULTS["arm"](trials.past)
    either = [
        repair.repaired(Standing(), trials, broken, size, way)
        for way in (plain_way_back, masked_way_back)
    ]
    np.testing.assert_allclose(*either, atol=1e-3)
    assert found["arm_rmse_over_ridge"].value == pytest.approx(
        found["arm_rmse_cm"].value / found["arm_rmse_ridge_cm"].value
    )


def test_the_pairs_are_shipped_names():
    assert names_of("plain") == ["mend-plain-0", "mend-plain-1", "mend-plain-2"]


def test_table_2_measures_what_was_repaired_and_what_was_walked(trials):
    """A walker that stands in the mean pose.

    Its bones are that pose's, the repaired window's are of both.
    """
    size = repair.RepairSize(samples=1, rounds=1, steps=3)
    frames = trials.truth.shape[1]
    windows = repair.repaired_windows([Standing()], trials, size)
    found, after = repair.table_2([Standing()], trials, size, windows, "standing_", keep=10)
    value = {one.name.removeprefix("table2_standing_"): one.value for one in found}
    mean = Standing().pose_scaler.mean.double().numpy().reshape(21, 3)
    stood = bone_rmse(np.broadcast_to(mean, (5, frames, 21, 3)))
    assert value["bone_whole_cm"] == pytest.approx(stood) == pytest.approx(value["bone_ge_cm"])
    np.testing.assert_allclose(after[0], np.broadcast_to(mean, (5, frames, 21, 3)), atol=1e-5)
    broken = without(trials.past, repair.SHARE)
    filled = np.where(broken.known[..., None], trials.past, mean)
    assert value["bone_re_paper_cm"] == pytest.approx(bone_rmse(filled), rel=1e-4)
    assert value["bone_re_cm"] == pytest.approx(
        bone_rmse(filled), rel=1e-3
    )  # its window under a mask is the mean, too
    assert value["bone_re_bones_cm"] != pytest.approx(value["bone_re_cm"], rel=1e-2)
    assert value["ratio"] == pytest.approx(max(stood, value["bone_re_cm"]) / stood)


def test_both_papers_repairs_are_scored_where_both_had_to_guess(trials, monkeypatch):
    """One way 3 cm off, the other 5 cm, each in its own frame.

    The pelvis, which one of them is told, is not scored.
    """
    side = np.array([0.0, 0.0, 0.03])

    def repaired(walker, few, broken, size, way):
        made = (
            few.past + side + [9.0, 0.0, 0.0] * (np.arange(21) == 0)[:, None]
        )  # the pelvis: anywhere
        return np.stack([made, few.past + 0.0])

    monkeypatch.setattr(both, "repaired", repaired)
    monkeypatch.setattr(
        both, "masked", lambda dancer, world, known, n, fill=None: (world + 5 / 3 * side)[None]
    )
    found = {one.name: one.value for one in both.both_measures(None, None, trials, repair.QUICK)}
    assert (
        found["arm.there_and_back.one_cm"] == pytest.approx(3)
        and found["arm.there_and_back.mean_cm"] < 3
    )
    assert found["frames.there_and_back.one_cm"] == pytest.approx(3)
    assert (
        found["frames.masked.one_cm"] == found["frames.masked_blended.mean_cm"] == pytest.approx(5)
    )


def test_walks_from_broken_pasts_are_over_those_from_whole_ones(trials, monkeypatch):
    """Bones 1 % too long after a broken past, half as much after a whole one: a ratio of two."""

    def stretched(walker, asked, share, frames, **how):
        return asked.truth * (1.01 if share else 1.005)

    monkeypatch.setattr(repair, "continued", stretched)
    windows = {"re": [trials.past]}
    found, _ = repair.table_2([None], trials, repair.QUICK, windows)
    value = {one.name: one.value for one in found}
    assert value["table2_ge_over_whole"] == pytest.approx(2, rel=1e-6)


def test_the_masking_network_sees_what_the_walker_sees():
    trials = unseen(3, 4)
    broken = FAULTS["frames"](trials.past)
    world, known = masked_window(trials, broken.known)
    assert (
        world.shape == (3, WINDOW, 21, 3) and known[:, 10:20].sum() == 3 * 10
    )  # the pelvis' path, ten frames on
    assert known[:, 3:7].sum() == 3 * 4
    whole = to_world(np.concatenate([trials.past[0], trials.truth[0]]), trials.control[0])
    np.testing.assert_allclose(world[0], whole[:WINDOW], atol=1e-9)
