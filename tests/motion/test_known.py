"""What is known of a motion: the mask over features, the place of the first known pose."""

import jaxtyping
import numpy as np
import pytest
import torch

from data_synth.walking import random_control, walk
from motiondiff_edu.editing.masks import PARTS, body_part, keyframes, seed
from motiondiff_edu.motion.dance_frame import Place, facing
from motiondiff_edu.motion.known import (
    between_known,
    checked_given,
    first_place,
    given_features,
    known_columns,
    with_given,
)


def clip(T: int = 40) -> np.ndarray:
    """A walk that starts somewhere, facing somewhere."""
    walked = walk(random_control(T / 20 + 1, np.random.default_rng(0), "turn"), 0).world()[:T]
    return Place(np.array([3.0, 0.0, -2.0]), np.array(0.7)).leave(walked)


def test_the_mask_over_features_needs_the_pelvis():
    assert known_columns(body_part(5, "trajectory")).sum() == 15
    hand_and_pelvis = np.zeros((4, 21), bool)
    hand_and_pelvis[2, [0, 15]] = True
    assert np.flatnonzero(known_columns(hand_and_pelvis)[2]).tolist() == [0, 1, 2, 45, 46, 47]
    alone = np.zeros((40, 21), bool)
    alone[7, 15] = True
    with pytest.raises(ValueError, match="frame 7 gives LeftHand without the pelvis"):
        known_columns(alone)


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (lambda x, k: (x, k[:-1]), r"\(40, 21, 3\) and \(39, 21\) of bool"),
        (lambda x, k: (x.reshape(40, 63), k), r"positions \(T, 21, 3\)"),
        (lambda x, k: (x, k.astype(int)), "of int64"),
        (
            lambda x, k: (np.where(np.arange(21)[:, None] == 4, np.nan, x), k),
            "LeftToeBase in frame 0 is given",
        ),
    ],
)
def test_what_cannot_be_given_is_named(spoil, message, monkeypatch):
    # as in a notebook, where no shape is checked
    monkeypatch.setattr(jaxtyping.config, "jaxtyping_disable", True)
    with pytest.raises(ValueError, match=message):
        checked_given(*spoil(clip(), seed(40, 10)))


def test_without_hips_and_shoulders_a_figure_faces_along_its_path():
    path = np.full((40, 21, 3), np.nan)
    path[:, 0] = np.array([7.0, 0.9, 1.0]) + np.linspace(0, 3, 40)[:, None] * [1.0, 0.0, 0.0]
    place = first_place(path, body_part(40, "trajectory"))
    assert place.ground.tolist() == [7.0, 0.0, 1.0] and place.heading == pytest.approx(np.pi / 2)
    shoulders = first_place(clip() + [3.0, 0.0, 0.0], body_part(40, "upper body"))
    assert shoulders.heading == pytest.approx(facing(clip())[0], abs=0.3)
    nothing = first_place(path, np.zeros((40, 21), bool))
    assert nothing.ground.tolist() == [0, 0, 0] and nothing.heading == 0


@pytest.mark.parametrize("known", [keyframes(40, 13), *(body_part(40, part) for part in PARTS)])
def test_features_are_the_same_wherever_the_motion_stands_and_they_lead_back(known):
    here = walk(np.tile([1.2, 0.1, 0.3], (40, 1)), 0).world()
    elsewhere = Place(np.array([1.0, 0.0, -5.0]), np.array(2.1))
    there = elsewhere.leave(here)
    holes = np.where(known[..., None], here, np.nan)
    place, features, columns = given_features(holes, known)
    assert features.isfinite().all(), "no NaN of an unknown joint comes through"
    assert torch.equal(columns, torch.from_numpy(known).repeat_interleave(3, -1))
    other = given_features(np.where(known[..., None], there, np.nan), known)[1]
    torch.testing.assert_close(features[columns], other[columns], atol=1e-5, rtol=0)
    back = with_given(place, features[None], holes, known)
    assert np.array_equal(back[0][known], here[known]), "bit by bit"
    moved = with_given(place, features[None] + 1.0, holes, known)
    assert np.array_equal(moved[0][known], here[known])
    freely = with_given(place, features[None], holes, known & False)
    np.testing.assert_allclose(freely[0][known], here[known], atol=1e-5)


def test_lines_go_from_each_known_entry_to_the_next_and_stay_or_fade_outside():
    given = torch.full((1, 7, 3), float("nan"))
    given[0, 1, 0], given[0, 5, 0] = 2.0, 4.0
    given[0, 3, 1] = -1.0
    lines = between_known(given, ~given.isnan())[0]
    torch.testing.assert_close(lines[:, 0], torch.tensor([2, 2, 2.5, 3, 3.5, 4, 4]))
    torch.testing.assert_close(lines[:, 1], torch.full((7,), -1.0))
    assert torch.equal(lines[:, 2], torch.zeros(7))
    fade = torch.tensor([1.0, 2.0, 3.0])
    faded = between_known(given, ~given.isnan(), fade)[0]
    torch.testing.assert_close(faded[:, 0], torch.tensor([1, 2, 2.5, 3, 3.5, 4, 2]))
    thirds = torch.tensor([0, 1 / 3, 2 / 3, 1, 2 / 3, 1 / 3, 0])
    torch.testing.assert_close(faded[:, 1], -thirds)
