"""Table 2: the trials, the rows, their measures, and the page."""

import json
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
from small_movers import PLANNED, mover_of, scaler_of

from motiondiff_edu.motion.moving_frame import to_features
from motiondiff_edu.motion.skeleton import MIRROR
from motiondiff_edu.performers.mover import Mover
from motiondiff_edu.performers.networks import network
from motiondiff_edu.pretrained.judges import judges
from motiondiff_edu.recipes.mover import MOVER
from tools.results.sweep import run
from tools.results.words import budget, edits, looking, parts, rows, scores, trials


@pytest.fixture(scope="module")
def some() -> trials.Trials:
    return trials.unseen(40)


@pytest.fixture(scope="module")
def mover(some) -> Mover:
    return mover_of(PLANNED, scaler_of(to_features(some.truth[0])), card={"name": "tiny"})


@pytest.fixture(scope="module")
def panel(some) -> scores.Panel:
    return scores.Panel(judges(), some)


def by_name(measures) -> dict[str, float]:
    return {one.name: one.value for one in measures}


def test_the_data_are_right_and_the_shuffled_data_are_not(some):
    data, mixed = (
        by_name(scores.recognised(some, made)) for made in (some.truth, rows.shuffled(some, 0))
    )
    assert data["action_accuracy"] > 0.95 and data["side_accuracy"] == 1
    assert mixed["action_accuracy"] < 0.4
    assert data["order_accuracy"] == 1 and data["count_accuracy"] > 0.9


def test_retrieval_of_the_data_is_that_of_the_data(some, panel):
    found = by_name(scores.retrieved(panel, panel.row(some.truth)))
    assert found["r_precision_top3_over_real"] == 1 and found["mm_dist_over_real"] == 1
    assert found["fid"] < 1e-3 and found["r_precision_top1"] > 0.9
    mixed = by_name(scores.retrieved(panel, panel.row(rows.shuffled(some, 0))))
    assert mixed["r_precision_top3"] < 0.3 and mixed["mm_dist_over_real"] > 2


def test_a_pair_differs_in_one_thing_and_the_data_are_nearer_to_their_own(some, panel):
    pairs = trials.minimal_pairs(some)
    assert {pair.kind for pair in pairs} == set(trials.KINDS)
    assert all(pair.own != pair.other for pair in pairs)
    counts = [pair for pair in pairs if pair.kind == "side"]
    assert all(
        sorted(pair.own.replace("left", "right").split())
        == sorted(pair.other.replace("left", "right").split())
        for pair in counts
    )
    found = by_name(scores.pairs(panel, panel.row(some.truth)))
    assert found["minimal_pair"] > 0.9
    mixed = by_name(scores.pairs(panel, panel.row(rows.shuffled(some, 0))))
    assert mixed["minimal_pair"] < 0.7


def test_bodies_by_hand(some):
    longer = [one * np.array([1.0, 1.1, 1.0]) for one in some.truth]
    data, tall = (by_name(scores.bodies(some, made)) for made in (some.truth, longer))
    assert data["bone_rmse_cm"] < 0.01 and 1 < tall["bone_rmse_cm"] < 5
    assert data["speed_over_data"] == 1 < tall["speed_over_data"] < 1.1
    slow = replace(some, truth=[one[::2] for one in some.truth])
    assert by_name(scores.bodies(slow, some.truth))["speed_over_data"] == pytest.approx(0.5, 0.05)
    drifting = [one + 0.01 * np.arange(len(one))[:, None, None] * [1, 0, 0] for one in some.truth]
    slide = by_name(scores.bodies(some, drifting))["skating_mps"]
    assert slide == pytest.approx(0.2, abs=0.02)


def test_eyes_and_rules_are_compared_by_hand():
    """Ten clips: four walk, of which the rules miss one; nothing else is ever there."""
    walk = ("walk", "", 1)
    left, right = ("kick", "left", 2), ("kick", "right", 3)
    eyes = [[walk]] * 4 + [[]] * 6
    rules = [[walk]] * 3 + [[]] * 7
    found = by_name(looking.kappas([[*one, left] for one in eyes], [[*one, left] for one in rules]))
    cells = 10 * len(looking.VERBS)
    same, by_chance = 1 - 1 / cells, (14 * 13 + (cells - 14) * (cells - 13)) / cells**2
    assert found["kappa"] == pytest.approx((same - by_chance) / (1 - by_chance))
    sides = [[walk, left], [walk, right], [walk, left], [walk, right]] * 9
    found = by_name(looking.kappas(sides, [[walk, one] for one in (left, right, right, left)] * 9))
    assert found["kappa"] == 1 and found["side_kappa"] == 0
    assert found["count_kappa"] == 0
    assert by_name(looking.share_the_same(eyes, rules)) == {"all_the_same": 0.9}


def test_what_was_looked_at_is_complete_and_in_the_recognisers_words():
    record = json.loads(looking.LOOKED_AT.read_text())
    clips = looking.sorted_clips(record["clips"])
    assert len(clips) == looking.CLIPS
    acts = [tuple(act) for _, seen in clips for act in seen]
    assert {verb for verb, _, _ in acts} == set(looking.VERBS)
    assert {side for _, side, _ in acts} == {"left", "right", "both", ""}
    assert {count for _, _, count in acts} >= {1, 2, 3, 4}
    with pytest.raises(ValueError, match="without a gap"):
        looking.sorted_clips({"0": [], "2": []})


def test_only_motions_of_the_weights_that_were_looked_at_are_compared(mover, monkeypatch, tmp_path):
    record = {"weights": "these", "clips": {str(k): [["walk", "", 1]] for k in range(6)}}
    (tmp_path / "looked_at.json").write_text(json.dumps(record))
    monkeypatch.setattr(looking, "LOOKED_AT", tmp_path / "looked_at.json")
    monkeypatch.setattr(looking, "CLIPS", 6)
    assert looking.looked_at_measures(mover, "others") == []
    made = looking.motions(mover)
    monkeypatch.setattr(looking, "motions", lambda mover: made)
    found = by_name(looking.looked_at_measures(mover, "these"))
    rules = [looking.as_seen(looking.actions(one)) for one in made]
    assert found["all_the_same"] == np.mean([one == [("walk", "", 1)] for one in rules])
    again = record | {"again": {"2": [["walk", "", 1]], "5": [["jump", "", 1]]}}
    (tmp_path / "looked_at.json").write_text(json.dumps(again))
    twice = by_name(looking.looked_at_measures(mover, "these"))["twice_kappa"]
    assert 0.4 < twice < 0.6  # of two acts each, one is the same
    assert [len(one) for one in made] == trials.unseen(6, seed=looking.SEED).frames


def test_a_sheet_has_all_poses(some):
    left, right = looking.sheet(some.truth[0], "clip").axes
    assert len(left.collections) == -(-len(some.truth[0]) // looking.EVERY)
    assert right.get_title().startswith("path")


def test_sides_are_confused_in_a_mirror_and_nowhere_else(some):
    twins = [one[:, MIRROR] * np.array([-1.0, 1.0, 1.0]) for one in some.truth]
    data, wrong = (by_name(scores.sides(some, made)) for made in (some.truth, twins))
    assert data["side_confused"] == 0 and data["asked_left_shown_left"] > 0.85
    assert wrong["side_confused"] > 0.85 and wrong["asked_left_shown_right"] > 0.85
    nothing = [np.repeat(one[:1], len(one), 0) for one in some.truth]
    assert np.isnan(by_name(scores.sides(some, nothing))["side_confused"])
    for found in (data, wrong):
        shares = [found[f"asked_right_shown_{one}"] for one in scores.SHOWN]
        assert sum(shares) == pytest.approx(1)


def test_a_copy_is_no_distance_from_the_training(some):
    first = first_of(some, 12)
    sketches = [rows.sketch(one) for one in some.truth]
    zero = scores.to_nearest(first.truth, sketches)
    copied = by_name(scores.nearest_training(zero, zero))
    assert copied["nearest_training_m"] == pytest.approx(0, abs=2e-3)
    far = scores.to_nearest(first.truth, sketches[12:])
    others = by_name(scores.nearest_training(far, far))
    assert others["nearest_training_m"] > 0.05 and others["nearest_training_over_data"] == 1
    one, every = sketches[0], np.stack([one[:10].ravel() for one in sketches[1:] if len(one) > 9])
    apart = every.reshape(len(every), 10, 21, 3) - one[:10]
    wanted = np.sqrt((apart**2).sum(-1).mean((1, 2))).min()
    assert scores.nearest(one[:10], every) == pytest.approx(wanted, rel=1e-4)


def first_of(some: trials.Trials, n: int) -> trials.Trials:
    parts = ("sentences", "captions", "plain", "truth")
    return replace(some, **{part: getattr(some, part)[:n] for part in parts})


def test_the_variety_of_the_data_is_that_of_the_data(some):
    few = first_of(some, 3)
    data = [few.second(k) for k in (1, 2, 3)]
    same = by_name(scores.multimodality(judges()[:1], data, data))
    assert same["multimodality_over_data"] == 1 and same["multimodality"] > 0.01
    stuck = by_name(scores.multimodality(judges()[:1], [few.truth] * 3, data))
    assert stuck["multimodality"] == pytest.approx(0, abs=1e-6)


def test_a_network_makes_one_motion_for_each_caption_as_long_as_the_data(some, mover):
    few = first_of(some, 5)
    made = rows.performed(mover, steps=2)(few, 0)
    assert [len(one) for one in made] == few.frames
    again = rows.performed(mover, steps=2)(few, 0)
    other = rows.performed(mover, steps=2)(few, 1)
    assert all(np.array_equal(a, b) for a, b in zip(made, again, strict=True))
    assert not np.array_equal(made[0], other[0])
    assert [len(one) for one in rows.noise(mover)(few, 0)] == few.frames


def test_a_caption_that_is_refused_counts_as_the_empty_text(some, mover):
    few = replace(first_of(some, 2), captions=["does a cartwheel", "walks"])
    assert rows.understood("does a cartwheel", mover) == () != rows.understood("walks", mover)
    assert len(rows.performed(mover, steps=2)(few, 0)) == 2
    held = trials.unseen(12, new_verbs=True)
    assert held.captions != held.plain and len(judges()[0].of_texts(held.plain)) == 12


def test_batches_have_one_length_and_all_indices():
    frames = [40, 48, 40, 48, 40]
    found = rows.by_length(frames)
    assert sorted(k for _, members in found for k in members) == [0, 1, 2, 3, 4]
    assert all(frames[k] == n for n, members in found for k in members)


def test_the_nearest_caption_is_that_of_a_training_clip():
    training = rows.TrainingClips(clips=20)
    texts = [training.captions[30], training.captions[101]]
    found = training.nearest_caption(trials.Trials([], texts, texts, [], 0))
    for text, positions in zip(texts, found, strict=True):
        near = [np.abs(rows.sketch(positions)[:8] - one[:8]).max() for one in training.sketches]
        owner = int(np.argmin(near))
        assert near[owner] == 0 and text in training.captions[4 * owner : 4 * owner + 4]
    assert len(training.sketches) == 40 and len(training.captions) == 160


def test_edits_ask_for_other_arms_and_the_same_legs():
    found = edits.edit_trials(6)
    assert len(found) == 6
    for one in found:
        (phrase,) = one.sentence
        assert phrase.legs.verb in edits.ON_THE_WAY and phrase.arms is not None
        assert edits.kept_error(one, one.positions) == 0
    assert np.mean([edits.shows(one, one.positions) for one in found]) < 0.5


def test_an_edit_that_gives_the_motion_back_keeps_everything_and_changes_nothing(
    monkeypatch, mover
):
    some = edits.edit_trials(3)
    monkeypatch.setattr(
        edits,
        "edited",
        lambda m, trial, seed, strength, masked=False: (
            trial.positions if strength < 1 else trial.positions + 0.1
        ),
    )
    found = by_name(edits.edit_measures(mover, some))
    assert found["edit_keeps_over_resampled"] == 0
    assert found["edit_changes"] == found["edit_changes_before"]


def test_all_records_are_made(monkeypatch, mover):
    size = replace(parts.WORD_QUICK, trials=40, held_out=40, texts=2, each=2, edits=2, training=8)
    studio = parts.Studio(size, {"mover": __file__})
    monkeypatch.setattr(parts, "judges", lambda: judges()[:1])
    monkeypatch.setattr(scores, "REPLICATIONS", 2)
    monkeypatch.setattr(parts.Studio, "mover", lambda self, name: mover)
    monkeypatch.setattr(parts, "weights_digest", lambda path: "0")
    # in this process: `test_the_nearest_caption_is_that_of_a_training_clip` has the real ones
    monkeypatch.setattr(rows, "ProcessPoolExecutor", lambda **_: ThreadPoolExecutor(1))
    asked = []

    def performed(mover, weight=1.0, steps=None):
        asked.append((weight, steps))
        return rows.performed(mover, weight, 2)

    monkeypatch.setattr(parts, "performed", performed)
    records = {one["name"]: one for one in parts.word_records(studio, "python -m x")}
    wanted = {"words.heldout_action_accuracy", "words.wording_minimal_pair", "words.edit_changes"}
    wanted |= {"words.guided.mm_dist", "words.nearest.r_precision_top3", "words.data.fid"}
    wanted |= {
        "words.steps50.fid",
        "words.multimodality_over_data",
        "words.nearest_training_over_data",
    }
    assert wanted <= set(records)
    steps = {name: records[name]["seeds"]["steps"] for name in ("words.fid", "words.steps50.fid")}
    assert steps == {"words.fid": 10, "words.steps50.fid": 50}
    assert [way for way in asked if way[1]] == [(1.0, 50)] and (parts.GUIDANCE, None) in asked


def test_a_choice_is_trained_and_measured(some, tmp_path, monkeypatch):
    monkeypatch.setattr(budget, "SMALL", replace(budget.SMALL, config=replace(PLANNED, words=())))
    few = first_of(some, 6)
    panel = scores.Panel(judges()[:1], few)
    monkeypatch.setattr(scores, "r_precision", lambda *x: (0.1, 0.2, 0.3))  # too few for pools
    sweep = budget.sweep(budget.QUICK, tmp_path / "runs", panel)
    found = run(sweep, "no-kinematic", tmp_path, "python -m x")
    records = {one["name"].removeprefix("words-budget.no-kinematic."): one for one in found}
    one = records["action_accuracy"]
    assert one["low"] <= one["value"] <= one["high"] and one["seeds"]["trainings"] == 2
    bones = [records[f"bone_rmse_cm.seed{k}"]["value"] for k in (0, 1)]
    assert min(bones) > 1 and bones[0] != bones[1]
    assert records["r_precision_top3"]["value"] == pytest.approx(0.3)
    for kind in ("minimal_pair", "minimal_pair.side", "fid", "skating_mps"):
        assert np.isfinite(records[kind]["value"])


def test_the_choices_differ_from_the_recipe_as_they_say():
    for name, variant in budget.VARIANTS.items():
        recipe = budget.recipe_of(name, 2, budget.FULL)
        assert recipe.seed == 2 and recipe.steps == budget.SMALL.steps
        same = replace(recipe, name="mover", seed=0)
        assert (same == budget.SMALL) == (not variant.recipe)
    lengths = {"steps": MOVER.steps, "plan_steps": MOVER.plan_steps, "frames": MOVER.frames}
    assert replace(budget.SMALL, config=MOVER.config, **lengths) == MOVER
    bag = budget.recipe_of("bag", 0, budget.FULL).config
    assert type(network(bag)).__name__ == "BagMoFusion" and bag.widths == budget.SIZES.widths
    alone = budget.recipe_of("no-timeline", 0, budget.FULL).config
    assert alone.D == 66 and type(network(alone)).__name__ == "TextMoFusion"
