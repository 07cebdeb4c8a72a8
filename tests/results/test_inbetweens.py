"""In-betweens as they are measured.

Errors, rivals, seams and spectra of motions whose measures are known.
"""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import torch
from small_dancers import dancer_of_bands, small_inbetweener

from motiondiff_edu.metrics.bodies import bone_lengths
from motiondiff_edu.metrics.keyframes import npss
from tools.results.inbetweens import departures, inbetween
from tools.results.inbetweens.inbetween import (
    GAPS,
    Filled,
    InbetweenSize,
    inbetween_records,
    measures_of,
    middle,
    trials,
)
from tools.results.sweep import run

GAP = 10


@pytest.fixture(scope="module")
def truth():
    return trials(4)


def off(truth, known, metres):
    """The truth, but for the gap, which is so far to the side."""
    return np.where(known[..., None], truth, truth + [metres, 0.0, 0.0])


def filled(truth, **changed):
    """Two samples 4 cm off to either side, arcs nearer than lines; `changed` replaces some."""
    known = middle(GAP)
    sides = np.stack([off(truth, known, 0.04), off(truth, known, -0.04)])
    ways = {"made": sides, "masked": off(truth, known, 0.5), "free": off(truth, known, 0.9)}
    ways |= {"lines": off(truth, known, 0.2), "arcs": off(truth, known, 0.1)} | changed
    return Filled(
        known, truth, *(ways[name] for name in ("made", "masked", "free", "lines", "arcs"))
    )


def values(one):
    return {measure.name: measure.value for measure in measures_of(one)}


def test_errors_are_those_of_the_mean_of_one_and_of_the_best(truth):
    found = values(filled(truth))
    by_hand = {
        "error_cm": 0,
        "error_one_cm": 4,
        "error_best_cm": 4,
        "error_masked_cm": 50,
        "error_free_cm": 90,
        "error_lines_cm": 20,
        "error_arcs_cm": 10,
        "keyframe_error_cm": 0,
    }
    assert {name: found[name] for name in by_hand} == pytest.approx(by_hand, abs=1e-9)


@pytest.mark.parametrize("nearer", ["lines", "arcs"])
def test_the_rival_is_the_better_interpolation(truth, nearer):
    one = filled(truth, **{nearer: off(truth, middle(GAP), 0.05)})
    found = values(one)
    assert found["error_one_over_interpolation"] == pytest.approx(4 / 5)
    rival = getattr(one, nearer).reshape(4, 100, -1)
    assert found["npss_interpolation"] == pytest.approx(npss(rival, truth.reshape(4, 100, -1)))


def test_seams_are_over_the_datas_own_and_sliding_is_of_the_gap(truth):
    found = values(filled(truth))
    still = values(filled(truth, made=np.stack([truth, truth]), masked=truth))
    assert (
        still["seam_jump_over_data"]
        == pytest.approx(1)
        == pytest.approx(still["seam_jump_masked_over_data"])
    )
    assert (
        found["seam_jump_over_data"] > 1.2
        and found["seam_jump_masked_over_data"] > found["seam_jump_over_data"]
    )
    assert still["skating_mps"] == pytest.approx(still["skating_data_mps"])
    assert (
        found["skating_masked_mps"] > found["skating_mps"] > found["skating_data_mps"]
    )  # the step into the gap


def test_spectra_are_the_means_of_the_samples_and_their_ratio(truth):
    shaken = truth + 0.05 * np.random.default_rng(0).standard_normal(truth.shape)
    one = filled(truth, made=np.stack([shaken, truth]))
    flat = [x.reshape(4, 100, -1) for x in (shaken, truth, one.arcs)]
    found, half = values(one), npss(flat[0], flat[1]) / 2  # of the second sample it is 0
    assert found["npss"] == pytest.approx(half)
    assert found["npss_over_interpolation"] == pytest.approx(half / npss(flat[2], flat[1]))


def test_the_worst_gap_stands_under_the_bar(monkeypatch):
    """Each gap's samples are off by its length in millimetres, but given frames are held."""
    monkeypatch.setattr(
        inbetween, "filled", lambda shown, masked, truth, length, size: shifted(truth, length)
    )

    def shifted(truth, length):
        known = middle(length)
        made = off(truth, known, length / 1000)
        return Filled(
            known, truth, made[None], made, made, off(truth, known, 0.1), off(truth, known, 0.2)
        )

    records = {
        one["name"]: one
        for one in inbetween_records(
            (None, "digest"), (None, "other"), InbetweenSize(motions=2), "a command"
        )
    }
    for length in GAPS:
        assert records[f"inbetween.gap{length}.error_over_interpolation"]["value"] == pytest.approx(
            length / 100
        )
    assert records["inbetween.gap60_error_over_interpolation"]["value"] == pytest.approx(0.6)
    for kind in ("seam_jump_over_data", "npss_over_interpolation"):
        each = [records[f"inbetween.gap{length}.{kind}"]["value"] for length in GAPS]
        assert records[f"inbetween.{kind}"]["value"] == max(each) > min(each)


def test_every_way_is_asked_for_what_it_is_for(monkeypatch, truth):
    """The paper's masking has none of our options; what is free is given nothing.

    Ours is as a user calls it.
    """
    asked = []

    def made(network, positions, known, samples=1, **options):
        asked.append(
            SimpleNamespace(
                network=network,
                known=known,
                holes=np.isnan(positions),
                samples=samples,
                options=options,
            )
        )
        return np.zeros((samples, 100, 21, 3))

    for way in ("inbetween", "inpaint"):
        monkeypatch.setattr(inbetween, way, made)
    found = inbetween.filled("shown", "masked", truth, GAP, InbetweenSize(samples=3, steps=7))
    usual, paper, free = (asked[4 * k : 4 * k + 4] for k in range(3))
    assert found.made.shape[:2] == (3, 4) and len(asked) == 12
    assert all(np.array_equal(one.holes.all(-1), ~middle(GAP)) for one in (*usual, *paper))
    assert all(set(one.options) == {"steps", "generator"} for one in asked)
    assert {one.options["steps"] for one in usual} == {7}
    assert {one.options["steps"] for one in (*paper, *free)} == {25}
    assert all(one.samples == 3 for one in usual)
    assert {one.network for one in usual} == {"shown"}
    assert {one.network for one in (*paper, *free)} == {"masked"}
    assert not any(one.known.any() for one in free)


def test_departures_are_measured_on_the_same_noise_one_left_out_at_a_time(monkeypatch, tmp_path):
    """The networks are replaced by one that stretches the gap, which the clean-up mends, and errs.

    The one that is not shown what is given errs more, and most without guidance.
    """
    asked = []

    def made(network, positions, known, *, samples, steps, generator, steer=None):
        asked.append((network, steer, torch.rand(1, generator=generator).item()))
        whole = np.array(left.pop(0))
        hole = ~known.any(1)
        whole[hole] *= 1.1
        whole[hole] += [0.0, 0.0, 0.011 if network == "inbetweener" else 0.022]
        whole[hole] += [0.0, 0.0, 0.033 if steer is departures.blend else 0.0]
        return np.stack([whole] * samples)

    def clean_samples(made, known):
        cleaned.append(len(made))
        return np.where(known[..., None], made, made / 1.1)

    class Filler(str):
        def fill(self, *args, **how):
            return made(self, *args, **how)

    def ours(network, positions, known, **how):
        return clean_samples(made(network, positions, known, **how), known)

    size = InbetweenSize(motions=2, samples=2)
    truth, cleaned = inbetween.trials(2), []
    left = [one for _ in departures.VARIANTS for one in truth]
    networks = {name: (Filler(name), "digest") for name in ("inbetweener", "unconditional")}
    monkeypatch.setattr(departures, "inpaint", made)
    monkeypatch.setattr(departures, "clean_samples", clean_samples)
    variants = dict(departures.VARIANTS)
    for name, fill in (("ours", ours), ("no-clean-up", made), ("paper", made)):
        network, _ = variants[name].recipe
        variants[name] = replace(variants[name], recipe=(network, fill))
    monkeypatch.setattr(departures, "VARIANTS", variants)
    sweep = departures.sweep(networks, size)
    found = {
        one["name"].removeprefix("inbetween-departures."): one["value"]
        for name in departures.VARIANTS
        for one in run(sweep, name, tmp_path, "a command")
    }
    each = [asked[2 * k : 2 * k + 2] for k in range(len(variants))]
    assert len(asked) == 2 * len(variants)
    for row, (one, other) in zip(variants.values(), each, strict=True):
        assert one[:2] == other[:2] and one[0] == row.recipe[0]
        assert [one[2], other[2]] == [noise for _, _, noise in asked[:2]]
    steers = [one[1] for one, _ in each]
    assert steers[:2] == [None] * 2 and steers[-1] is None
    assert steers[2:5] == [departures.guide_and_blend, departures.blend, departures.guide]
    assert len(cleaned) == 2 * (len(variants) - 2), "all but two rows are cleaned up"
    assert found["ours.error_one_cm"] == pytest.approx(1.0)
    assert found["not-shown.error_one_cm"] == pytest.approx(2.0)
    assert found["not-shown.error_one_minus_base_cm"] == pytest.approx(1.0)
    assert found["no-guidance.error_one_cm"] == pytest.approx(5.0)
    assert found["no-guidance.error_one_minus_base_cm"] == pytest.approx(3.0)
    lengths = 100 * bone_lengths(truth[:, ~middle(departures.GAP).any(1)])
    tenth = 0.1 * np.sqrt((lengths**2).mean())
    assert found["no-clean-up.bone_rmse_cm"] == pytest.approx(tenth, rel=0.01)
    assert found["ours.bone_rmse_cm"] < 0.01 < found["paper.bone_rmse_cm"]


def test_the_rows_of_departures_run_and_differ(truth):
    """On small networks: no two rows fill a gap alike."""
    networks = {"inbetweener": small_inbetweener(activity=True), "unconditional": dancer_of_bands()}
    known = middle(departures.GAP)
    made = []
    for row in departures.VARIANTS.values():
        network, fill = row.recipe
        draw = torch.Generator().manual_seed(0)
        made.append(fill(networks[network], truth[0], known, samples=1, steps=3, generator=draw))
    for k, one in enumerate(made):
        assert np.array_equal(one[0][known], truth[0][known])
        assert not any(np.array_equal(one, other) for other in made[:k])
