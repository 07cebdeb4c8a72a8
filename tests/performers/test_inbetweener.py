"""The in-betweener: what its network sees, its denoiser, its file, and what it fills in."""

from dataclasses import replace

import numpy as np
import pytest
import torch
from seeds import seeded
from small_dancers import small_inbetweener

from data_synth.walking import walk
from motiondiff_edu.baselines.interpolation import linear
from motiondiff_edu.beyond.around_lines import GivenLines
from motiondiff_edu.ddpm import ddim_steps, final
from motiondiff_edu.editing.masks import PARTS, body_part, gap, keyframes, seed
from motiondiff_edu.motion.dance_frame import Place, at_origin, to_positions
from motiondiff_edu.motion.directions import UPLEGS
from motiondiff_edu.motion.skeleton import HIPS
from motiondiff_edu.performers import inbetweener as module
from motiondiff_edu.performers.inbetweener import Inbetweener, KeyframeMoFusion
from motiondiff_edu.prediction import x0_from_eps, x0_from_v
from motiondiff_edu.pretrained import checkpoints

T = 24
WALKED = walk(np.tile([1.2, 0.1, 0.3], (T, 1)), 0).world()


def given_first(x: torch.Tensor) -> GivenLines:
    known = torch.zeros(x.shape, dtype=torch.bool)
    known[:, 0] = True
    return GivenLines.of(x, known)


def test_lines_scale_and_mask_are_seen():
    model, x = small_inbetweener().model, torch.randn(2, T, 63, generator=seeded())
    s, lines = torch.tensor([3, 20]), given_first(x)
    changed = {"lines": lines.lines + 1, "scale": lines.scale / 2, "known": ~lines.known}
    for field, value in changed.items():
        other = replace(lines, **{field: value})
        assert not torch.allclose(model(x, s, lines), model(x, s, other)), field


def test_the_denoiser_is_that_of_the_remainder():
    filler, x = small_inbetweener(), torch.randn(1, T, 63, generator=seeded())
    s, lines = torch.tensor([12]), given_first(x)
    eps_hat, v_hat = filler.denoiser(lines)(x, s), filler.model(x, s, lines)
    torch.testing.assert_close(
        x0_from_eps(x, s, eps_hat, filler.schedule),
        x0_from_v(x, s, v_hat, filler.schedule),
        atol=1e-4,
        rtol=1e-4,
    )


def test_its_file_brings_it_back(tmp_path):
    filler, x = small_inbetweener(), torch.randn(1, T, 63, generator=seeded())
    path = checkpoints.save(filler, tmp_path / "mine.safetensors", bits=32)
    again, s = checkpoints.load(path), torch.tensor([7])
    assert isinstance(again, Inbetweener) and again.config == filler.config
    assert torch.equal(again.model(x, s, given_first(x)), filler.model(x, s, given_first(x)))


@pytest.mark.parametrize(
    "known", [seed(T, 10), keyframes(T, 7), gap(T, 5, 9), *(body_part(T, part) for part in PARTS)]
)
def test_known_entries_come_back_bit_by_bit_and_the_rest_is_made(known):
    filler, holes = small_inbetweener(), np.where(known[..., None], WALKED, np.nan)
    how = {"samples": 3, "steps": [30, 20, 30, 10]}  # back and forth
    made = filler.fill(holes, known, **how, generator=seeded(1))
    assert made.shape == (3, T, 21, 3) and np.isfinite(made).all()
    assert all(np.array_equal(one[known], WALKED[known]) for one in made)
    if not known.all():
        assert not np.allclose(made[0][~known], made[1][~known])
    assert np.array_equal(made, filler.fill(holes, known, **how, generator=seeded(1)))
    assert np.array_equal(
        filler.fill(holes, known, steps=3), filler.fill(holes, known, steps=3, generator=seeded())
    ), "without a generator the seed is 0"


def test_the_remainder_is_held_at_nothing_where_a_motion_is_known(monkeypatch):
    """The network sees noise alone there: noised snapshots of a remainder of 0."""
    known, seen = keyframes(T, 7), []
    inpaint = module.inpaint_steps

    def watched(denoise, r_S, schedule, given, columns, **how):
        seen.append((given, columns))
        return inpaint(denoise, r_S, schedule, given, columns, **how)

    monkeypatch.setattr(module, "inpaint_steps", watched)
    small_inbetweener().fill(WALKED, known, samples=2, steps=2)
    ((given, columns),) = seen
    assert given.shape == (2, T, 63) and not given.any()
    wanted = torch.from_numpy(known).repeat_interleave(3, -1).expand(2, T, 63)
    assert torch.equal(columns, wanted)


def test_if_nothing_is_known_it_is_a_plain_sample():
    filler, nothing = small_inbetweener(), np.zeros((T, 21), bool)
    made = filler.fill(
        np.full_like(WALKED, np.nan), nothing, samples=2, steps=5, generator=seeded(2)
    )
    zeros, draw = torch.zeros(2, T, 63), seeded(2)
    lines = GivenLines(zeros, torch.ones_like(zeros), zeros.bool())
    start = torch.randn(2, T, 63, generator=draw)
    plain = ddim_steps(filler.denoiser(lines), start, filler.schedule, 5, 1.0, generator=draw)
    wanted = to_positions(filler.motion_scaler.inverse(final(plain).x_s))
    np.testing.assert_allclose(made, wanted, atol=1e-5)


@pytest.mark.parametrize("known", [seed(T, 10), *(body_part(T, part) for part in PARTS)])
def test_where_the_motion_stands_and_faces_does_not_matter(known):
    """The same motion elsewhere: what is made is the same, elsewhere."""
    filler, place = small_inbetweener(), Place(np.array([1.0, 0, -5]), np.array(2.1))
    here, there = (
        filler.fill(x, known, steps=5, generator=seeded(3)) for x in (WALKED, place.leave(WALKED))
    )
    np.testing.assert_allclose(place.enter(there), here, atol=1e-4)


def test_a_smaller_remainder_is_nearer_to_lines_which_are_straight_where_nobody_turns():
    truth = np.random.default_rng(0).normal(size=(T, 21, 3)).cumsum(0) * 0.05
    truth[:, UPLEGS] = truth[:, [HIPS]] + [[0.1, 0, 0], [-0.1, 0, 0]]
    filler, known = small_inbetweener(), keyframes(T, 8)
    whole, half, none = (
        filler.fill(truth, known, steps=4, remainder=share, generator=seeded())[0]
        for share in (1.0, 0.5, 0.0)
    )
    lines = linear(truth, known)
    np.testing.assert_allclose(none, lines, atol=1e-5)
    np.testing.assert_allclose(half, (whole + lines) / 2, atol=1e-5)
    assert np.abs(whole - lines).max() > 0.1


def test_a_figure_that_turns_round_does_not_fold():
    """Half a turn of a pose between two frames: without a remainder, the pose goes round."""
    known = keyframes(9, 8)
    place = Place(np.zeros((9, 3)), np.linspace(0, 3.0, 9))
    truth = place.enter(np.repeat(at_origin(WALKED)[:1, None], 9, 0))[:, 0]
    made = small_inbetweener().fill(truth, known, steps=2, remainder=0.0)[0]
    np.testing.assert_allclose(made, truth, atol=1e-4)
    hips = np.linalg.norm(np.diff(linear(truth, known)[4, UPLEGS], axis=0))
    assert hips < 0.1 * np.linalg.norm(np.diff(truth[4, UPLEGS], axis=0)), "straight lines fold it"


def test_with_activity_calm_motions_are_moved_less_and_lively_ones_no_more():
    plain, lively = (small_inbetweener(activity=active).model for active in (False, True))
    x = torch.randn(1, T, 63, generator=seeded()).expand(1, T, 63)
    known = torch.zeros(x.shape, dtype=torch.bool)
    known[:, ::4] = True
    usual, calm = plain.lines(x, known), lively.lines(x / 100, known)
    assert torch.equal(usual.scale, GivenLines.of(x, known).scale)
    assert (calm.scale < 0.2 * usual.scale)[~known].all()
    free, limited = lively.lines(x, known), lively.lines(x, known, 1.0)
    ones = torch.ones_like(x)
    assert torch.equal(limited.scale, free.scale) and (free.scale > usual.scale)[~known].all()
    torch.testing.assert_close(limited.whole(ones), usual.whole(ones))
    assert (free.whole(ones) > usual.whole(ones))[~known].all(), "training has no limit"


def test_in_use_the_activity_is_limited(monkeypatch):
    """Lively keyframes: what is added to the lines is no larger than without activity."""
    truth = np.random.default_rng(0).normal(size=(T, 21, 3)).cumsum(0) * 0.5
    known, one = keyframes(T, 8), small_inbetweener(activity=True)
    limits = []
    lines = KeyframeMoFusion.lines

    def watched(self, given, known, activity_at_most=np.inf):
        limits.append(activity_at_most)
        return lines(self, given, known, activity_at_most)

    monkeypatch.setattr(KeyframeMoFusion, "lines", watched)
    one.fill(truth, known, steps=2)
    assert limits == [1.0]


def test_a_loop_that_is_watched_gives_each_step():
    seen = []

    def watch(loop):
        return (seen.append(step.s) or step for step in loop)

    small_inbetweener().fill(WALKED, keyframes(T, 8), steps=5, watch=watch)
    assert len(seen) == 5 + 1 and seen[-1] == 0
