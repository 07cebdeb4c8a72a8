"""Recordings: windows, continuations and in-betweens, and their records."""

import shutil
import warnings
from dataclasses import replace
from functools import partial
from operator import call
from types import SimpleNamespace

import numpy as np
import pytest
import torch

import motiondiff_edu as md
from data_synth.walking import walk
from motiondiff_edu.baselines.interpolation import linear
from motiondiff_edu.conditions.control import constant_control
from motiondiff_edu.editing.masks import keyframes
from motiondiff_edu.metrics.keyframes import unknown_error
from motiondiff_edu.motion.formats.bvh.write import write_bvh
from motiondiff_edu.recipes.inbetweener import INBETWEENER
from tools.results import __main__ as results
from tools.results.intervals import interval
from tools.results.recordings import continuations, inbetweens, persons, reconstructions, trainings
from tools.results.recordings.windows import (
    FULL,
    QUICK,
    RecordedSize,
    held_out,
    person_of,
    recorded,
    trials,
)
from tools.results.sweep import run
from tools.results.walks import scores as walk_scores
from tools.results.walks.scores import measures
from tools.results.words import parts as words

RANGE = {"low": [-0.5, -0.5, -1.0], "high": [0.9, 0.5, 1.0]}


@pytest.fixture(scope="module")
def walker():
    return md.load("walker")


@pytest.fixture(scope="module")
def walks(tmp_path_factory):
    """Two walks of 14 and 7 s, a short one, and a file that is none."""
    walks = tmp_path_factory.mktemp("walks")
    for k, seconds in enumerate((14.0, 7.0, 3.0)):
        clip = walk(constant_control(1.1, seconds=seconds), seed=k)
        write_bvh(walks / f"walk{k}.bvh", clip.world())
    (walks / "broken.bvh").write_text("HIERARCHY\n")
    return walks


@pytest.fixture
def folder(walks, tmp_path, monkeypatch):
    """A copy of them, as if they were the recordings."""
    shutil.copytree(walks, tmp_path / "bvh")
    monkeypatch.setenv("MOTIONDIFF_REAL_DATA", str(tmp_path))
    return tmp_path


def test_windows_are_of_six_seconds_and_their_control_is_within_the_range(folder):
    found = list(continuations.windows(FULL, RANGE))
    assert [one.source for one in found] == [*["walk0.bvh"] * 3, "walk1.bvh"]
    assert all(len(one.given) == 40 and one.control.shape == (80, 3) for one in found)
    assert all(one.control[0, 0] == pytest.approx(0.9) for one in found)
    assert len(list(continuations.windows(RecordedSize(each=1), RANGE))) == 2


def test_what_is_given_of_a_window_does_not_know_what_comes_next(folder, monkeypatch):
    def turned(*arguments):
        for source, motion in recorded(*arguments):
            later = motion.positions.copy()
            later[40:] = later[40:, :, [2, 1, 0]] * [1.0, 1.0, -1.0]  # it goes on to the side
            yield source, md.Motion(later)

    plain = list(continuations.windows(FULL, RANGE))
    monkeypatch.setattr(continuations, "recorded", turned)
    other = list(continuations.windows(FULL, RANGE))
    for one, again in zip(plain, other, strict=True):
        np.testing.assert_array_equal(one.control, again.control)
        np.testing.assert_array_equal(one.given.path(), again.given.path())


def test_a_window_is_continued_as_walk_continues_it(walker, folder):
    window = next(continuations.windows(FULL, walker.card["control_range"]))
    cleaned, plain = continuations.continued(walker, window).values()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        wanted = walker.walk(window.given, window.control, progress=False)
    np.testing.assert_allclose(cleaned.world, wanted.positions, atol=1e-4)
    assert 1e-4 < np.linalg.norm(plain.world - wanted.positions, axis=-1).mean() < 0.02
    source = md.read_motion(folder / "bvh" / "walk0.bvh")
    np.testing.assert_allclose(window.next, source.positions[40:120], atol=1e-9)
    own = continuations.row_of_recording(window)
    assert own["seam"] < 1.1 and own["past"] < 1.3 and own["skating"] < 0.03
    row = continuations.row_of(window, cleaned)
    assert row["seam"] < 1.1 and row["skating"] < 0.1 and row["adherence"] < 0.1
    assert row["depth"] == pytest.approx(100 * max(0.0, -wanted.positions[..., 1].min()), abs=0.01)


def test_records_are_made(walker, folder, monkeypatch):
    monkeypatch.setattr(persons, "DRAWS", 2)
    monkeypatch.setattr(persons, "STEPS", 2)
    monkeypatch.setattr(continuations, "STEPS", 2)
    measured = walker, "0", QUICK, "python -m x"
    made = [*continuations.recorded_records(*measured), *persons.person_records(*measured)]
    records = {one["name"]: one for one in made}
    assert records["real.blended_share"]["seeds"]["windows"] == 2
    assert 0 < records["real.seam_over_motion"]["value"] < 1.1
    assert 0 < records["real.recording.seam_over_motion"]["value"] < 1.1
    assert records["real.seam_over_motion"]["seeds"]["persons"] == 2
    assert "real.recording.continuation_adherence_mps" not in records
    assert 0 <= records["real.style_kept"]["value"] <= 1
    assert records["real.continuation_diversity_over_synthetic"]["value"] > 0.1
    kinds = {f"real.{kind}" for kind in continuations.KINDS}
    assert kinds <= set(records) and {f"real.unblended.{k[5:]}" for k in kinds} <= set(records)


@pytest.fixture(scope="module")
def filled():
    """A walk of six seconds with a keyframe a second: the truth once, and once beside it."""
    truth = walk(constant_control(1.1, seconds=6.0), seed=5).world()
    known = keyframes(len(truth), 20)
    lines = linear(truth, known)
    samples = np.stack([truth, lines])
    again = np.array([False, True])
    return truth, known, inbetweens.Filled(samples, samples[::-1], again, lines, lines)


def test_a_row_compares_with_the_better_interpolation(filled):
    truth, known, one = filled
    row = inbetweens.row_of(one, truth, known)
    assert row["raw_one"] == 0 and row["one"] == pytest.approx(1)
    assert row["mean"] == row["raw_mean"] == pytest.approx(0.5)
    # half as far from the truth as the lines on average, and that far from each other
    assert row["energy"] == pytest.approx(0.5 - 0.5, abs=1e-9)
    assert row["again"] == 0.5 and row["raw_fastest"] == pytest.approx(1)
    assert row["raw_skating"] == pytest.approx(1) or row["raw_skating"] < 1
    assert row["skating"] > 3, "feet of straight lines slide"


def test_a_glide_that_another_draw_mends_counts_as_drawn_again(monkeypatch):
    walked = walk(constant_control(1.1, seconds=6.0), seed=5)
    truth, known = walked.world(), keyframes(120, 20)
    glide = np.tile(truth[:1], (120, 1, 1)) + (truth[:, :1] - truth[:1, :1]) * [1, 0, 1]
    draws = iter([np.stack([truth, glide]), truth[None]])
    monkeypatch.setattr(inbetweens, "clean_samples", lambda made, *_: made)
    filler = SimpleNamespace(fill=lambda *_, **__: next(draws))
    one = inbetweens.filled(filler, md.Motion(truth, 20.0), known, 2)
    assert one.again.tolist() == [False, True] and np.array_equal(one.made[1], truth)


def test_columns_know_whose_a_window_is_and_which_are_walks():
    sources = ["cmu_02_01.bvh", "cmu_05_06_dance.bvh", "cmu_005_12.bvh"]
    names = ("mean", "one", "energy", "skating", "fastest", "depth")
    rows = [
        {name: float(k) for name in (*names, *(f"raw_{n}" for n in names), "again")}
        for k in (1, 2, 4)
    ]
    found = inbetweens.columns(rows, sources)
    assert found["group"].tolist() == ["2", "5", "5"]
    made = {one.name: one for one in measures(inbetweens.KINDS, found, found["group"])}
    assert made["inbetween_walks_over_interpolation"].value == 1
    assert made["inbetween_raw_others_over_interpolation"].value == 3
    assert made["inbetween_over_interpolation"].value == 2
    ends = made["inbetween_fallback_share"]
    assert (ends.low, ends.high) == (1, 3), "two persons, of whom one has two windows"


def test_in_betweens_of_windows_are_measured(folder, monkeypatch):
    monkeypatch.setattr(inbetweens, "STEPS", 2)
    inbetweener = md.load("inbetweener")
    made = inbetweens.inbetween_records(inbetweener, "0", QUICK, "python -m x")
    records = {one["name"]: one for one in made}
    assert records["real.inbetween_over_interpolation"]["value"] > 0
    assert records["real.gap40.inbetween_one_over_interpolation"]["seeds"]["windows"] == 3
    assert records["real.inbetween_walks_over_interpolation"]["value"] is None  # by their names


def test_on_all_cores_the_numbers_are_the_same(folder, monkeypatch):
    # workers are other processes, which draw as often as usual
    monkeypatch.setattr(walk_scores, "interval", interval)
    inbetweener, windows = md.load("inbetweener"), inbetweens.windows_of(QUICK)
    studio = words.Studio(replace(words.WORD_QUICK, edits=1, trials=12))
    tasks = [
        *(
            partial(inbetweens.measured_alone, (inbetweener, motion, 10, 1))
            for _, motion in windows[:1]
        ),
        partial(words.edited_by_words, studio),
    ]
    in_turn, at_once = ([*run(call, tasks)] for run in (map, results.on_all_cores))
    for one, other in zip(in_turn, at_once, strict=True):
        found, again = (list(map(str, each.values())) for each in (one, other))
        assert found and "[]" not in found and one.keys() == other.keys()
        assert found == again


def test_windows_of_a_file_are_cut_at_even_distances(folder):
    found = list(recorded(held_out(), FULL))
    assert [name for name, _ in found] == [*["walk0.bvh"] * 3, "walk1.bvh", "walk2.bvh"]
    assert [len(motion) for _, motion in found] == [120, 120, 120, 120, 60]
    starts = [motion.positions[0] for _, motion in found[:3]]
    whole = md.read_motion(folder / "bvh" / "walk0.bvh").positions
    assert all(np.array_equal(one, whole[80 * k]) for k, one in enumerate(starts))


def test_a_trial_counts_once_and_trained_persons_are_left_out(folder):
    for name in ("cmu_05_06_dance", "cmu_max_131_01", "cmu_acrnn_salsa_10"):
        shutil.copy(folder / "bvh" / "walk0.bvh", folder / "bvh" / f"{name}.bvh")
    (folder / "cmu30").mkdir()
    for name in ("cmu_005_06", "cmu_005_07", "acrnn_salsa_01"):
        shutil.copy(folder / "bvh" / "walk0.bvh", folder / "cmu30" / f"{name}.bvh")
    names = {path.stem for path in trials()} - {"walk0", "walk1", "walk2", "broken"}
    assert names == {
        "cmu_05_06_dance", "cmu_max_131_01", "cmu_acrnn_salsa_10", "cmu_005_07", "acrnn_salsa_01",
    }  # fmt: skip
    kept = {path.stem for path in held_out()} & names
    assert kept == {"cmu_05_06_dance", "cmu_max_131_01", "cmu_005_07"}


def test_without_recordings_it_says_what_to_set(monkeypatch, tmp_path):
    monkeypatch.setenv("MOTIONDIFF_REAL_DATA", str(tmp_path))
    with pytest.raises(SystemExit, match="MOTIONDIFF_REAL_DATA must name a folder"):
        list(continuations.windows(FULL, RANGE))


def test_a_variant_is_trained_and_measured(folder, tmp_path, monkeypatch):
    monkeypatch.setattr(inbetweens, "STEPS", 2)
    (folder / "cmu30").mkdir()
    shutil.copy(folder / "bvh" / "walk0.bvh", folder / "cmu30" / "acrnn_x.bvh")
    sizes = replace(INBETWEENER.config, S=20, widths=(16, 24), heads=2)
    budget = replace(
        trainings.QUICK, training=trainings.QUICK.training | {"config": sizes, "batch": 2}
    )
    sweep = trainings.sweep(budget, tmp_path / "runs")
    made = run(sweep, "ours", tmp_path / "rows", "python -m x")
    records = {one["name"]: one for one in made}
    ours = records["inbetween-budget.ours.inbetween_over_interpolation"]
    assert ours["seeds"]["trainings"] == 2 and ours["low"] <= ours["value"] <= ours["high"]
    seeds = [records[f"{ours['name']}.seed{k}"]["value"] for k in (0, 1)]
    assert seeds[0] != seeds[1]


def test_the_dancer_that_is_not_shown_what_is_given_keeps_it(folder, tmp_path):
    one = trainings.trained(trainings.NOT_SHOWN, 0, trainings.QUICK, tmp_path / "runs")
    assert not (tmp_path / "runs").exists(), "nothing is trained"
    (_, motion), *_ = inbetweens.windows_of(QUICK)
    truth, known = motion.positions, keyframes(len(motion), 20)

    def filled(positions):
        draw = torch.Generator().manual_seed(0)
        return one.fill(positions, known, samples=2, steps=3, remainder=1.0, generator=draw)

    made = filled(truth)
    assert np.isfinite(made).all() and not np.allclose(*made)
    np.testing.assert_array_equal(made[:, known], truth[known][None].repeat(2, 0))
    blind = filled(np.where(known[..., None], truth, 9.0))
    np.testing.assert_array_equal(blind, made, "it has seen the truth")


def test_a_row_of_the_budget_is_trained_and_no_other_part(monkeypatch, tmp_path):
    """The names of other parts begin alike."""
    asked = []
    monkeypatch.setattr(trainings, "sweep", lambda budget, runs: (budget, runs))
    monkeypatch.setattr(results, "run", lambda *given: asked.append(given))
    context = results.Context(True, {}, tmp_path, tmp_path / "runs")
    results.records_of("inbetween-budget.ours", context, {}, "python -m x")
    made = trainings.QUICK, tmp_path / "runs" / "inbetween-budget"
    assert asked == [(made, "ours", tmp_path / "inbetween-budget", "python -m x")]


def test_variants_differ_from_the_recipe_in_what_they_say():
    ours = trainings.recipe_of("ours", 1, trainings.FULL)
    assert (ours.seed, ours.steps) == (1, INBETWEENER.steps // 4)
    changed = {
        name: {
            key
            for key, value in vars(trainings.recipe_of(name, 1, trainings.FULL)).items()
            if value != getattr(ours, key)
        }
        for name in trainings.VARIANTS
        if name != trainings.NOT_SHOWN
    }
    assert changed["no-recordings"] == {"name", "recordings"}
    configs = {name: trainings.recipe_of(name, 1, trainings.FULL).config for name in changed}
    assert replace(configs["plain"], activity=True) == configs["ours"] and configs["ours"].activity
    assert changed["plain"] == {"name", "config"}
    assert changed["cosine"] == {"name", "snr"}


def test_whose_a_recording_is():
    whose = person_of
    assert whose("cmu_05_06_dance.bvh") == whose("cmu_005_12.bvh") == "5"
    assert whose("acrnn_salsa_01.bvh") == whose("cmu_acrnn_salsa_10.bvh") == whose("acrnn_x.bvh")
    assert whose("walk0.bvh") != whose("walk1.bvh")


def test_limbs_of_recordings_are_reconstructed_and_compared_with_lines(folder, monkeypatch):
    """The network is replaced by one that is off by a centimetre where the limb is missing."""

    def off(walker, positions, known, *, generator):
        return positions + 0.01 * ~known[..., None] * [0.0, 1.0, 0.0]

    monkeypatch.setattr(reconstructions, "reconstruct", off)
    monkeypatch.setattr(reconstructions, "WALKS", ("walk0",))
    size, pieces = replace(QUICK, files=None), list(reconstructions.pieces(QUICK))
    assert all(len(truth) == 60 for _, truth in pieces)
    known = reconstructions.limb_missing(reconstructions.ARM)
    assert (~known).any(1).nonzero()[0].tolist() == list(range(20, 40)) and (~known).sum() == 80
    made = reconstructions.reconstruction_records(None, "0", size, "python -m x")
    found = {one["name"]: one["value"] for one in made}
    for limb, joints in reconstructions.LIMBS.items():
        lost = reconstructions.limb_missing(joints)
        over = {
            source: 0.01 / unknown_error(linear(x, lost)[None], x[None], lost)[0]
            for source, x in reconstructions.pieces(size)
        }
        walk = over.pop("walk0.bvh")
        assert found[f"real.reconstruction_{limb}_walks_over_lines"] == pytest.approx(
            walk, rel=1e-4
        )
        others = np.median(list(over.values()))
        assert found[f"real.reconstruction_{limb}_others_over_lines"] == pytest.approx(
            others, rel=1e-4
        )
