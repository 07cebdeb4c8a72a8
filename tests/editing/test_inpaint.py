"""Masked sampling in metres: given entries come back bit by bit, wherever the motion stands."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
import torch
from seeds import seeded
from small_dancers import dancer_of_bands as dancer
from walked_clips import clip

from data_synth.walking import walk
from motiondiff_edu.ddpm import ddim_steps, final, timesteps
from motiondiff_edu.editing import inpaint as module
from motiondiff_edu.editing.inpaint import blend, fade_lengths, guide_and_blend, inpaint
from motiondiff_edu.editing.masks import PARTS, body_part, gap, keyframes, seed
from motiondiff_edu.inbetweening import resampling_steps
from motiondiff_edu.metrics.keyframes import seam_jump
from motiondiff_edu.mofusion import MoFusion
from motiondiff_edu.motion.dance_frame import Place, to_features, to_positions
from motiondiff_edu.performers.dancer import FARTHEST
from motiondiff_edu.prediction import x0_from_eps
from motiondiff_edu.pretrained import checkpoints


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
@pytest.mark.parametrize("steer", [None, blend, guide_and_blend])
def test_known_entries_come_back_bit_by_bit_and_the_rest_is_made(known, C, steer):
    truth = clip()
    mel = torch.randn(64, 5, generator=seeded(9)) if C else None
    holes = np.where(known[..., None], truth, np.nan)
    make = partial(inpaint, dancer(C), holes, known, mel, samples=3, steps=[30, 20, 30, 10])
    made = make(steer=steer, generator=seeded(1))
    assert made.shape == (3, 40, 21, 3) and np.isfinite(made).all()
    assert all(np.array_equal(one[known], truth[known]) for one in made)
    assert not np.allclose(made[0][~known], made[1][~known])
    assert np.array_equal(made, make(steer=steer, generator=seeded(1)))


@pytest.mark.parametrize("steer", [None, guide_and_blend])
def test_all_known_is_the_input_and_nothing_known_is_a_plain_sample(steer):
    truth, one = clip(), dancer()
    everything = np.ones((40, 21), bool)
    same = inpaint(one, truth, everything, steps=5, steer=steer, generator=seeded())
    assert np.array_equal(same[0], truth)
    holes, draw = np.full_like(truth, np.nan), seeded(2)
    made = inpaint(one, holes, ~everything, samples=2, steps=5, steer=steer, generator=seeded(2))
    start = torch.randn(2, 40, 63, generator=draw)
    plain = ddim_steps(one.denoiser(None, 40), start, one.schedule, 5, 1.0, generator=draw)
    wanted = to_positions(one.motion_scaler.inverse(final(plain).x_s))
    np.testing.assert_allclose(made, wanted, atol=1e-5)


@pytest.mark.parametrize("known", [seed(40, 10), *(body_part(40, part) for part in PARTS)])
def test_where_the_motion_stands_and_faces_does_not_matter(known):
    """The same motion elsewhere: what is made is the same, elsewhere."""
    truth = walk(np.tile([1.2, 0.1, 0.3], (40, 1)), 0).world()
    place, one = Place(np.array([1.0, 0.0, -5.0]), np.array(2.1)), dancer()
    here, there = (
        inpaint(one, x, known, steps=5, steer=guide_and_blend, generator=seeded(3))
        for x in (truth, place.leave(truth))
    )
    np.testing.assert_allclose(place.enter(there), here, atol=1e-4)


def test_blending_and_guidance_close_the_seam(monkeypatch):
    truth, known = clip(), gap(40, 12, 14)
    one = checkpoints.load("unconditional")

    def made(steer, mask=known, **how):
        how = {"samples": 2, "steps": 5, "generator": seeded(4)} | how
        return inpaint(one, truth, mask, steer=steer, **how)

    printed, blended, both = (made(steer) for steer in (None, blend, guide_and_blend))
    jumps = [seam_jump(x, known).mean() for x in (printed, blended, both)]
    assert max(jumps[1:]) < 0.5 * jumps[0]
    assert np.abs(both - blended).max() > 1e-3
    again = resampling_steps(timesteps(one.schedule.S, 5), 2)
    assert np.abs(made(blend, steps=again) - blended).max() > 1e-3
    ends = []
    for frames in (2, 10):
        monkeypatch.setattr(module, "FADE", frames)
        ends.append(made(blend, seed(40, 10)))
    assert np.abs(ends[0] - ends[1])[:, 10:20].max() > 1e-3
    fade = fade_lengths(10).reshape(21, 3)
    assert fade[0].tolist() == [np.inf, 10, np.inf] and bool((fade[1:] == 10).all())


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
    made = inpaint(wild, clip(), seed(40, 10), steps=5)
    features = wild.motion_scaler.transform(torch.from_numpy(to_features(made)).float())
    assert features[..., 3:].abs().max() < 1.01 * FARTHEST


def test_other_music_gets_another_dance():
    songs = (torch.randn(64, 5, generator=seeded(k)) for k in (9, 10))
    one, other = (
        inpaint(dancer(5), clip(), seed(40, 10), mel, steps=3, generator=seeded()) for mel in songs
    )
    assert np.abs(one - other).max() > 1e-4


def test_a_dancer_of_another_kind_is_refused():
    with pytest.raises(ValueError, match="dances to music"):
        inpaint(dancer(5), clip(), seed(40, 10))
    with pytest.raises(ValueError, match="takes no music"):
        inpaint(dancer(), clip(), seed(40, 10), torch.zeros(64, 5))
