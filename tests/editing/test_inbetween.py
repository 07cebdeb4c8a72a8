"""In-betweens in metres: given entries come back bit by bit, wherever the motion stands."""

from dataclasses import replace
from types import SimpleNamespace

import jaxtyping
import numpy as np
import pytest
import torch
from small_dancers import dancer_of_bands as dancer

from data_synth.walking import random_control, walk
from motiondiff_edu.ddpm import ddim_steps
from motiondiff_edu.editing.inbetween import OURS, PAPER, Departures, fading, inbetween, seen_from
from motiondiff_edu.editing.masks import (
    PARTS,
    body_part,
    gap,
    keyframes,
    seed,
)
from motiondiff_edu.metrics.bone_lengths import bone_lengths
from motiondiff_edu.metrics.keyframes import seam_jump
from motiondiff_edu.mofusion import MoFusion
from motiondiff_edu.motion.dance_frame import (
    Place,
    facing,
    placed_features,
    to_features,
    to_positions,
)
from motiondiff_edu.motion.root_frame import to_world
from motiondiff_edu.motion.skeleton import HEELS, TOES
from motiondiff_edu.performers.dancer import FARTHEST, Dancer
from motiondiff_edu.prediction import eps_from_x0, x0_from_eps
from motiondiff_edu.pretrained import checkpoints


def seeded(seed: int = 0) -> torch.Generator:
    return torch.Generator().manual_seed(seed)


def last(loop):
    *_, end = loop
    return end.x_s


def clip(T: int = 40) -> np.ndarray:
    """A real enough motion that starts somewhere, facing somewhere."""
    walked = walk(random_control(T / 20 + 1, np.random.default_rng(0), "turn"), 0)
    return to_world(walked.poses, walked.control, (3.0, -2.0, 0.7))[:T]


@pytest.mark.parametrize(
    "known",
    [
        seed(40, 10),
        keyframes(40, 12),
        gap(40, 5, 20),
        body_part(40, "lower body"),
        body_part(40, "upper body"),
        body_part(40, "trajectory"),
    ],
)
@pytest.mark.parametrize("C", [0, 5])
def test_known_entries_come_back_bit_by_bit_and_the_rest_is_made(known, C):
    truth = clip()
    mel = torch.randn(64, 5, generator=seeded(9)) if C else None
    holes = np.where(known[..., None], truth, np.nan)
    options = {"samples": 3, "steps": 5, "departures": Departures(resample=2)}
    made = inbetween(dancer(C), holes, known, mel, generator=seeded(1), **options)
    assert made.shape == (3, 40, 21, 3) and np.isfinite(made).all()
    assert all(np.array_equal(one[known], truth[known]) for one in made)
    assert not np.allclose(made[0][~known], made[1][~known])
    again = inbetween(dancer(C), holes, known, mel, generator=seeded(1), **options)
    assert np.array_equal(made, again)


def sinking(one: Dancer, truth: np.ndarray, metres: float) -> SimpleNamespace:
    """A dancer that always generates the truth, so much lower."""
    at_home = seen_from(truth, keyframes(len(truth), 13)).enter(truth) - [0.0, metres, 0.0]
    lower = one.motion_scaler.transform(torch.from_numpy(placed_features(at_home)).float())
    denoise = lambda x_s, s: eps_from_x0(x_s, s, lower.expand_as(x_s), one.schedule)  # noqa: E731
    return SimpleNamespace(
        schedule=one.schedule,
        motion_scaler=one.motion_scaler,
        denoiser=lambda mel, frames, fast=True: denoise,
    )


@pytest.mark.parametrize("lowest", [0.0, -0.03])
def test_feet_stay_above_the_floor_or_the_lowest_given_joint(lowest):
    truth = clip()
    truth[..., 1] += lowest - truth[..., 1].min()
    known = keyframes(40, 13)
    at = truth[known][:, 1].min()
    how = replace(OURS, guidance=0.0, blend=None)
    args = {"steps": 5, "generator": seeded()}
    made = inbetween(sinking(dancer(), truth, 0.1), truth, known, departures=how, **args)[0]
    feet = made[:, [*HEELS, *TOES], 1][~known.all(-1)]
    assert feet.min() == pytest.approx(min(0.0, at), abs=1e-6)
    plain = replace(how, clean=False)
    sunk = inbetween(sinking(dancer(), truth, 0.1), truth, known, departures=plain, **args)[0]
    assert sunk[..., 1].min() < -0.05


def test_one_given_joint_under_the_floor_does_not_lower_the_steps():
    truth = walk(random_control(3.0, np.random.default_rng(0), "turn"), 0).world()[:40]
    known = keyframes(40, 13)
    how = replace(OURS, guidance=0.0, blend=None)
    lower = np.array(truth)
    lower[13, TOES[0], 1] = -0.05
    args = {"steps": 5, "departures": how}
    feet = [
        inbetween(sinking(dancer(), one, 0.0), one, known, generator=seeded(), **args)[0][
            :, list(TOES), 1
        ]
        for one in (truth, lower)
    ]
    away = np.arange(40) > 20
    assert np.median(np.abs(feet[1] - feet[0])[away]) < 0.005


def test_all_known_is_the_input_and_nothing_known_is_a_plain_sample():
    truth, one = clip(), dancer()
    everything = np.ones((40, 21), bool)
    assert np.array_equal(inbetween(one, truth, everything, steps=5, generator=seeded())[0], truth)
    made = inbetween(
        one, np.full_like(truth, np.nan), ~everything, samples=2, steps=5, generator=seeded(2)
    )
    draw = seeded(2)
    plain = last(
        ddim_steps(
            one.denoiser(None, 40),
            torch.randn(2, 40, 63, generator=draw),
            one.schedule,
            5,
            1.0,
            generator=draw,
        )
    )
    np.testing.assert_allclose(made, to_positions(one.motion_scaler.inverse(plain)), atol=1e-5)


@pytest.mark.parametrize("known", [seed(40, 10), *(body_part(40, part) for part in PARTS)])
def test_where_the_motion_stands_and_faces_does_not_matter(known):
    """The same motion elsewhere: what is made is the same, elsewhere.

    Whatever part of the body is given.
    """
    truth = walk(np.tile([1.2, 0.1, 0.3], (40, 1)), 0).world()
    one = dancer()
    place = Place(np.array([1.0, 0.0, -5.0]), np.array(2.1))
    here, there = (
        inbetween(one, x, known, steps=5, generator=seeded(3)) for x in (truth, place.leave(truth))
    )
    np.testing.assert_allclose(place.enter(there), here, atol=1e-4)


def test_a_trajectory_is_walked_forward():
    """Nothing tells where the figure faces but its path.

    It is seen from where it begins, along the path.
    """
    path = np.full((40, 21, 3), np.nan)
    path[:, 0] = np.array([7.0, 0.9, 1.0]) + np.linspace(0, 3, 40)[:, None] * [1.0, 0.0, 0.0]
    place = seen_from(path, body_part(40, "trajectory"))
    assert place.ground.tolist() == [7.0, 0.0, 1.0] and place.heading == pytest.approx(np.pi / 2)
    shoulders = seen_from(clip() + [3.0, 0.0, 0.0], body_part(40, "upper body"))
    assert shoulders.heading == pytest.approx(facing(clip())[0], abs=0.3)


def test_what_sets_it_apart_from_the_papers_masking():
    """Each departure does what it is for; each is on by default but for resampling."""
    truth = clip()
    known = gap(40, 12, 14)
    one = checkpoints.pretrained("unconditional")

    def made(departures=OURS, seed=4):
        options = {"departures": departures, "generator": seeded(seed)}
        return inbetween(one, truth, known, samples=2, steps=5, **options)

    usual = made()
    plain = made(PAPER)
    torn = made(Departures(clean=False))
    assert seam_jump(usual, known).mean() < 0.5 * seam_jump(plain, known).mean()
    lengths = bone_lengths(truth)[0]
    assert (
        np.abs(bone_lengths(usual) - lengths).max()
        < 2e-3
        < 5e-3
        < np.abs(bone_lengths(torn) - lengths).max()
    )
    changed = [
        made(replace(OURS, **{name: value}))
        for name, value in (("guidance", 0.0), ("clean", False), ("resample", 2), ("blend", None))
    ]
    assert all(np.abs(x - usual).max() > 1e-3 for x in changed)
    ends = [
        inbetween(one, truth, seed(40, 10), steps=5, departures=Departures(blend=frames))
        for frames in (2, 10)
    ]
    assert np.abs(ends[0] - ends[1])[:, 10:20].max() > 1e-3
    other = made(seed=5)
    assert np.array_equal(usual, made()) and not np.array_equal(usual, other)
    fade = fading(10).reshape(21, 3)
    assert fade[0].tolist() == [np.inf, 10, np.inf] and bool((fade[1:] == 10).all())


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
def test_what_cannot_be_given_is_said(spoil, message, monkeypatch):
    monkeypatch.setattr(
        jaxtyping.config, "jaxtyping_disable", True
    )  # as in a notebook, where no shape is checked
    with pytest.raises(ValueError, match=message):
        inbetween(dancer(), *spoil(clip(), seed(40, 10)), steps=5)


def test_the_guesses_of_a_dancer_that_predicts_noise_are_held_within_what_dances_are():
    one = dancer(0)
    config = replace(one.config, target="eps")
    wild = replace(one, model=MoFusion(config).requires_grad_(False))
    x_S, s = torch.randn(2, 20, 63, generator=seeded(5)), torch.full((2,), 30)
    guesses = {
        who: x0_from_eps(x_S, s, who.denoiser(None, 20)(x_S, s), one.schedule)
        for who in (one, wild)
    }
    assert guesses[wild].abs().max() == pytest.approx(FARTHEST, rel=1e-2)
    raw = Departures(clean=False, blend=None)
    made = inbetween(wild, clip(), seed(40, 10), steps=5, departures=raw)
    features = wild.motion_scaler.transform(torch.from_numpy(to_features(made)).float())
    assert features[..., 3:].abs().max() < 1.01 * FARTHEST


def test_a_dancer_of_another_kind_is_refused():
    with pytest.raises(ValueError, match="dances to music"):
        inbetween(dancer(5), clip(), seed(40, 10))
    with pytest.raises(ValueError, match="takes no music"):
        inbetween(dancer(), clip(), seed(40, 10), torch.zeros(64, 5))
