"""Editing by words: what stays, what changes, where it stands, and what is refused."""

import inspect

import numpy as np
import pytest
import torch
from seeds import seeded
from small_movers import PLANNED, SMALL, mover_of, scaler_of

from data_synth.actions import Act, Phrase, act_out, clips
from motiondiff_edu.beyond import timeline
from motiondiff_edu.conditions.text import TextError
from motiondiff_edu.ddpm import at
from motiondiff_edu.editing import by_words
from motiondiff_edu.editing.by_words import (
    _plan,
    at_the_start_of,
    columns,
    edit_by_words,
    kept_columns,
    recognised_timeline,
)
from motiondiff_edu.editing.masks import UPPER, body_part
from motiondiff_edu.motion.moving_frame import to_features, to_positions
from motiondiff_edu.motion.skeleton import HIPS, joint_index
from motiondiff_edu.performers.mover import Mover


@pytest.fixture(autouse=True)
def few_steps(monkeypatch):
    monkeypatch.setattr(by_words, "STEPS", 30)


@pytest.fixture(scope="module")
def positions() -> np.ndarray:
    return next(iter(clips(1, 8))).acted.positions[:64]


@pytest.fixture(scope="module", params=[SMALL, PLANNED], ids=["alone", "planned"])
def mover(positions, request) -> Mover:
    return mover_of(request.param, scaler_of(to_features(positions)))


def apart(a: np.ndarray, b: np.ndarray) -> float:
    return float(np.abs(a - b).max())


class Exact(Mover):
    """A mover whose motions are standard normal, whatever the text; its denoiser is exact."""

    def denoiser(self, ids, frames, guidance=1.0, plan=None):
        return lambda x_s, s: x_s * (1 - at(self.schedule.alpha_bar, s, x_s)).sqrt()


def test_the_less_noise_the_more_of_the_motion_stays(mover, positions):
    exact = Exact(mover.model, mover.schedule, mover.motion_scaler)
    errors = [
        np.abs(edit_by_words(exact, positions, "walks", strength=s)[0] - positions).mean()
        for s in (0.04, 0.4, 1.0)
    ]
    assert errors[0] < 0.5 * errors[1] < errors[1] < errors[2]


def test_without_any_of_the_motion_it_is_a_sample_of_the_text(mover, positions):
    """With all noise, the motion counts by x_S = sqrt(alpha_bar_S) x0 + ... alone."""
    made = edit_by_words(mover, positions, "walks", strength=1.0)
    other = edit_by_words(mover, positions[::-1].copy(), "walks", strength=1.0)
    again = edit_by_words(mover, positions, "kicks", strength=1.0)
    assert made.shape == (1, 64, 21, 3)
    assert apart(*(to_start(one[0]) for one in (made, other))) < 0.05
    assert apart(made, again) > 1e-4


def to_start(positions: np.ndarray) -> np.ndarray:
    return to_positions(torch.from_numpy(to_features(positions))).numpy()


def test_the_edit_begins_where_the_motion_began(mover, positions):
    turned = positions @ np.array([[0.0, 0, 1], [0, 1, 0], [-1, 0, 0]]).T + [5.0, 0.0, 2.0]
    assert apart(at_the_start_of(turned, to_start(turned)), turned) < 1e-9
    made = edit_by_words(mover, turned, "walks", strength=0.04)[0]
    assert np.linalg.norm(made[0, HIPS] - turned[0, HIPS]) < 0.3


def test_a_child_does_at_its_size_what_an_adult_does(mover, positions):
    adult, child = (
        edit_by_words(mover, size * positions, "waves", strength=0.3)[0] for size in (1.0, 0.7)
    )
    np.testing.assert_allclose(child, 0.7 * adult, atol=1e-4)


def test_a_kept_part_of_the_body_stays_about_the_root_and_the_rest_changes(mover, positions):
    known = np.zeros((64, 21), bool)
    upper = [joint_index(name) for name in UPPER]
    known[:, upper] = True
    made = edit_by_words(mover, positions, "kicks", known, strength=1.0)[0]
    # the root takes another path: all kept joints of a frame turn and move over the floor as one
    kept, wanted = (over_the_floor(x[:, upper]) for x in (made, positions))
    turn = (kept * wanted.conj()).sum(1, keepdims=True)
    np.testing.assert_allclose(kept, turn / np.abs(turn) * wanted, atol=1e-4)
    np.testing.assert_allclose(made[:, upper, 1], positions[:, upper, 1], atol=1e-4)
    legs = [k for k in range(21) if k not in upper]
    assert np.abs(made[:, legs] - positions[:, legs]).mean() > 0.02


def over_the_floor(positions: np.ndarray) -> np.ndarray:
    """Places seen from above, as complex numbers about their mean in each frame."""
    places = positions[..., 0] + 1j * positions[..., 2]
    return places - places.mean(1, keepdims=True)


def test_with_the_pelvis_the_path_stays_and_a_kept_span_is_the_motion_itself(mover, positions):
    known = np.zeros((64, 21), bool)
    known[:40] = True
    made = edit_by_words(mover, positions, "kicks", known, generator=[seeded(0), seeded(1)])
    assert np.array_equal(made[:, :40], np.stack([positions[:40]] * 2))
    assert np.abs(made[0, 50:] - made[1, 50:]).max() > 0.01
    held = columns(torch.from_numpy(known))
    assert held[:39].all() and not held[40:].any()
    assert held[39, : 3 * 21].all(), "the pose of the last frame that stays"
    assert not held[39, 3 * 21 :].any(), "what leads to the first frame that changes"
    known[:] = True
    assert columns(torch.from_numpy(known)).all()


def test_the_timeline_goes_with_what_is_kept(positions):
    """Legs that walk are kept: the plan walks where they do, whatever the text says of the legs."""
    walk = act_out((Phrase(Act("walk"), Act("wave", "left")),), 4.0, 3).positions[:80]
    seen = recognised_timeline(walk)
    assert seen[:, timeline.VERBS.index("walk")].mean() > 0.8
    assert seen[:, timeline.VERBS.index("wave")].any()
    mover = mover_of(PLANNED, scaler_of(to_features(walk)))
    texts = mover.reader.encoded([("squat",)])
    legs = timeline.of_the_legs()
    known = body_part(80, "lower body")
    assert kept_columns(known)[:, legs].all() and not kept_columns(known)[:, ~legs].any()
    assert kept_columns(~known)[:, ~legs].all() and not kept_columns(~known)[:, legs].any()
    draws = [torch.Generator().manual_seed(k) for k in (0, 0)]
    seen = torch.from_numpy(seen).float()
    kept = _plan(mover, seen, kept_columns(known), texts, draws[0])
    assert kept[0, :, timeline.VERBS.index("walk")].mean() > 0.8
    assert not kept[0, :, timeline.VERBS.index("squat")].any()
    free = _plan(mover, seen, kept_columns(np.zeros_like(known)), texts, draws[1])
    assert not torch.equal(kept, free)


def test_a_given_timeline_holds_where_nothing_is_kept(positions, monkeypatch):
    walk = act_out((Phrase(Act("walk"), Act("wave", "left")),), 4.0, 3).positions[:80]
    mover = mover_of(PLANNED, scaler_of(to_features(walk)))
    taken = []
    before = type(mover).denoiser

    def denoiser(self, *rest, plan):
        taken.append(plan)
        return before(self, *rest, plan=plan)

    monkeypatch.setattr(type(mover), "denoiser", denoiser)
    acts = [timeline.Timed("squat", "", 1, 0.5, 2.0), timeline.Timed("clap", "", 3, 0.7, 2.7)]
    plan = torch.from_numpy(timeline.timeline(acts, 80)).float()[None]
    for known in (np.zeros((80, 21), bool), body_part(80, "lower body")):
        edit_by_words(mover, walk, "walks", known, plan=plan, generator=[seeded()])
    legs = timeline.of_the_legs()
    seen = torch.from_numpy(recognised_timeline(walk)).float()
    assert torch.equal(taken[0], plan)
    assert torch.equal(taken[1][0, :, legs], seen[:, legs])
    assert torch.equal(taken[1][0, :, ~legs], plan[0, :, ~legs])


def test_what_cannot_be_edited_is_refused(mover, positions):
    for strength in (0.0, 1.5, float("nan")):
        with pytest.raises(ValueError, match="strength must be a number above 0 and at most 1"):
            edit_by_words(mover, positions, "walks", strength=strength)
    with pytest.raises(TextError, match="does not know 'cartwheel'"):
        edit_by_words(mover, positions, "does a cartwheel")


def test_a_motion_with_holes_and_a_mask_that_does_not_fit_are_refused(mover, positions):
    unchecked = inspect.unwrap(edit_by_words)  # as in a notebook
    holes = positions.copy()
    holes[3, 2, 1] = np.nan
    with pytest.raises(ValueError, match="NaN or infinity"):
        unchecked(mover, holes, "walks")
    known = np.ones(positions.shape[:2])
    for wrong in (known.astype(int), known[1:] > 0):
        with pytest.raises(ValueError, match="of True and False"):
            unchecked(mover, positions, "walks", wrong)
