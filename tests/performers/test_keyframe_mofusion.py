"""The network that sees what is given: its inputs, its file, and its denoiser in a dancer."""

from dataclasses import replace

import numpy as np
import pytest
import torch
from gaits import rest_pose

from motiondiff_edu.baselines.interpolation import linear
from motiondiff_edu.beyond.around_lines import Shown
from motiondiff_edu.beyond.turning_frame import View
from motiondiff_edu.ddpm import cosine_schedule
from motiondiff_edu.editing.inbetween import PAPER, Departures, inbetween
from motiondiff_edu.editing.masks import keyframes
from motiondiff_edu.motion.dance_frame import Place
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.performers.dancer import Dancer
from motiondiff_edu.performers.keyframe_mofusion import KeyframeConfig, KeyframeMoFusion
from motiondiff_edu.performers.with_bar import with_bar
from motiondiff_edu.prediction import x0_from_eps, x0_from_v
from motiondiff_edu.pretrained import checkpoints

SMALL = KeyframeConfig(S=30, widths=(16, 24), heads=2)
T = 24


def seeded(seed: int = 0) -> torch.Generator:
    return torch.Generator().manual_seed(seed)


@pytest.fixture
def dancer() -> Dancer:
    torch.manual_seed(0)
    model = KeyframeMoFusion(SMALL).eval().requires_grad_(False)
    for weight in model.parameters():
        weight.add_(0.1 * torch.randn(weight.shape))
    scalers = Scaler(torch.zeros(63), torch.full((63,), 0.2)), Scaler.nothing(0)
    return Dancer(model, cosine_schedule(30), *scalers)


def shown_first(x: torch.Tensor) -> Shown:
    known = torch.zeros(x.shape, dtype=torch.bool)
    known[:, 0] = True
    return Shown.of(x, known)


def test_lines_scale_and_mask_are_seen_and_nothing_given_is_the_same_as_none(dancer):
    x, s = torch.randn(2, T, 63, generator=seeded()), torch.tensor([3, 20])
    plain = dancer.model(x, s)
    nothing = Shown.of(x, torch.zeros(x.shape, dtype=torch.bool))
    assert plain.shape == x.shape and torch.equal(plain, dancer.model(x, s, nothing))
    shown = shown_first(x)
    assert not torch.allclose(plain, dancer.model(x, s, shown))
    changed = {"lines": shown.lines + 1, "scale": shown.scale / 2, "known": ~shown.known}
    for field, value in changed.items():
        other = replace(shown, **{field: value})
        assert not torch.allclose(dancer.model(x, s, shown), dancer.model(x, s, other)), field


def test_the_denoiser_is_that_of_the_remainder(dancer):
    x, s = torch.randn(1, T, 63, generator=seeded()), torch.tensor([12])
    shown = shown_first(x)
    eps_hat = dancer.shown_denoiser(shown)(x, s)
    v_hat = dancer.model(x, s, shown)
    torch.testing.assert_close(
        x0_from_eps(x, s, eps_hat, dancer.schedule),
        x0_from_v(x, s, v_hat, dancer.schedule),
        atol=1e-4,
        rtol=1e-4,
    )


def test_music_for_a_network_without_is_refused(dancer):
    truth, known = np.zeros((T, 21, 3)), keyframes(T, 20)
    with pytest.raises(ValueError, match="takes no music: leave `mel` out"):
        inbetween(dancer, truth, known, torch.zeros(20, 80), steps=2)


def test_a_network_that_sees_nothing_is_named():
    dancer = checkpoints.pretrained("unconditional")
    x = torch.zeros(1, T, 63)
    assert not dancer.can_be_shown
    with pytest.raises(ValueError, match="MoFusion is not made to see what is given"):
        dancer.shown_denoiser(shown_first(x))


def test_its_file_brings_it_back(dancer, tmp_path):
    path = checkpoints.save(dancer, tmp_path / "mine.safetensors", bits=32)
    again = checkpoints.load(path)
    assert isinstance(again.model, KeyframeMoFusion) and again.config == SMALL
    x, s = torch.randn(1, T, 63, generator=seeded()), torch.tensor([7])
    assert torch.equal(again.model(x, s, shown_first(x)), dancer.model(x, s, shown_first(x)))


def test_in_betweens_use_it_and_the_papers_masking_does_not(dancer):
    truth = np.random.default_rng(0).normal(size=(T, 21, 3)).cumsum(0) * 0.05
    known = keyframes(T, 8)
    seen = []
    model_forward = dancer.model.forward
    dancer.model.forward = lambda x, s, shown=None: seen.append(shown) or model_forward(x, s, shown)
    inbetween(dancer, truth, known, steps=4)
    assert len(seen) == 4 and all(one is not None for one in seen)
    seen.clear()
    inbetween(dancer, truth, known, steps=4, departures=PAPER)
    assert seen == [None] * 4


def test_a_smaller_remainder_is_nearer_to_straight_lines(dancer):
    truth = np.random.default_rng(0).normal(size=(T, 21, 3)).cumsum(0) * 0.05
    known, bare = keyframes(T, 8), Departures(clean=False)
    whole, half, none = (
        inbetween(
            dancer, truth, known, steps=4, departures=replace(bare, remainder=share),
            generator=seeded(),
        )[0]
        for share in (1.0, 0.5, 0.0)
    )  # fmt: skip
    lines = linear(truth, known)
    np.testing.assert_allclose(none, lines, atol=1e-5)
    np.testing.assert_allclose(half, (whole + lines) / 2, atol=1e-5)
    assert np.abs(whole - lines).max() > 0.1


def test_with_activity_calm_motions_are_moved_less_and_lively_ones_no_more(dancer):
    model = KeyframeMoFusion(replace(SMALL, activity=True))
    lively = replace(dancer, model=model)
    x = torch.randn(1, T, 63, generator=seeded()).expand(1, T, 63)
    known = torch.zeros(x.shape, dtype=torch.bool)
    known[:, ::4] = True
    plain, calm = dancer.model.shown(x, known), lively.shown(x / 100, known)
    assert torch.equal(plain.scale, Shown.of(x, known).scale) and (dancer.config.activity is False)
    assert (calm.scale < 0.2 * plain.scale)[~known].all()
    free, limited = model.shown(x, known), lively.shown(x, known)
    ones = torch.ones_like(x)
    assert torch.equal(limited.scale, free.scale) and (free.scale > plain.scale)[~known].all()
    torch.testing.assert_close(limited.whole(ones), plain.whole(ones))
    assert (free.whole(ones) > plain.whole(ones))[~known].all(), "training has no limit"
    assert torch.equal(
        model(x, torch.tensor([3])), model(x, torch.tensor([3]), Shown.of(x, known & False))
    )


def test_a_turning_network_sees_speeds_and_steps_and_needs_no_view(dancer):
    model = KeyframeMoFusion(replace(SMALL, turning=True)).eval().requires_grad_(False)
    for weight in model.parameters():
        weight.add_(0.1 * torch.randn(weight.shape, generator=seeded()))
    x, s = torch.randn(2, T, 63, generator=seeded()), torch.tensor([3, 20])
    known = torch.zeros(x.shape, dtype=torch.bool)
    known[:, ::6] = True
    shown = model.shown(x, known, View.none(x))
    plain = model(x, s, shown)
    torch.testing.assert_close(plain, model(x, s, model.shown(x, known)))
    moved = torch.zeros(63)
    moved[[0, 2]] = 7.0
    elsewhere = model.shown(x + moved, known, View.none(x))
    torch.testing.assert_close(model(x, s, elsewhere), plain, atol=1e-4, rtol=1e-4)
    steps = replace(shown.view, steps=shown.view.steps + 1)
    assert not torch.allclose(model(x, s, replace(shown, view=steps)), plain)


def test_in_betweens_of_a_figure_that_turns_do_not_shrink(dancer):
    """Lines alone, between a first frame and one that looks back: hips stay as wide."""
    model = KeyframeMoFusion(replace(SMALL, turning=True)).eval().requires_grad_(False)
    turning = replace(dancer, model=model)
    angles = np.linspace(0, 0.95 * np.pi, T)
    truth = np.stack([Place(np.zeros(3), np.array(a)).leave(rest_pose()[None])[0] for a in angles])
    known, bare = keyframes(T, T - 1), Departures(clean=False)
    bare = replace(bare, remainder=0.0)
    made, shrunk = (
        inbetween(one, truth, known, steps=2, departures=bare)[0] for one in (turning, dancer)
    )
    np.testing.assert_allclose(made, truth, atol=1e-5)
    width = np.linalg.norm(shrunk[:, 1] - shrunk[:, 5], axis=-1)
    assert width.min() < 0.1 * width.max()


def test_the_bar_counts_its_evaluations(dancer, monkeypatch):
    steps = []
    monkeypatch.setattr("motiondiff_edu.performers.with_bar.bar", lambda *_: _Counting(steps))
    with with_bar(dancer, 5, "filling in") as one:
        inbetween(one, np.zeros((T, 21, 3)), keyframes(T, 8), steps=5)
    assert len(steps) == 5


class _Counting:
    def __init__(self, steps):
        self.steps = steps

    def __enter__(self):
        return lambda: self.steps.append(1)

    def __exit__(self, *_):
        return None
