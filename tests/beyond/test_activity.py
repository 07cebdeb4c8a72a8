"""Activity: by hand, of still and lively figures, where little is given, and its limit in use."""

import math

import pytest
import torch

from data_synth.mixed import motions, sentences
from motiondiff_edu.beyond.activity import (
    SPAN,
    USED_AT_MOST,
    USUAL,
    activity,
    activity_of,
    with_activity,
)
from motiondiff_edu.beyond.around_lines import GivenLines
from motiondiff_edu.motion.dance_frame import placed_features
from motiondiff_edu.motion.known import between_known
from motiondiff_edu.motion.scaler import Scaler

T = 101


def seeded(seed: int = 0) -> torch.Generator:
    return torch.Generator().manual_seed(seed)


def given_at(frames, T: int = T, D: int = 4, n: int = 1) -> torch.Tensor:
    known = torch.zeros(n, T, D, dtype=torch.bool)
    known[:, frames] = True
    return known


def of(x: torch.Tensor, known: torch.Tensor) -> torch.Tensor:
    return activity_of(between_known(x, known), known)


def steady(speed: float) -> torch.Tensor:
    """All four columns go ahead, at a speed in standard deviations a second."""
    return (torch.arange(T) / SPAN * speed).view(1, T, 1).expand(1, T, 4)


@pytest.mark.parametrize("speed", [0.1, 1.0, 3.0])
def test_in_the_middle_it_is_the_way_in_a_second(speed):
    lively = of(steady(speed), given_at(slice(None, None, SPAN)))
    assert lively.shape == (1, T, 1)
    wanted = math.sqrt((speed**2 + USUAL) / (1 + USUAL))
    assert lively[0, T // 2, 0] == pytest.approx(wanted, rel=2e-3)
    closer = of(steady(speed), given_at(slice(None, None, 5)))
    torch.testing.assert_close(closer[0, T // 2], lively[0, T // 2], rtol=2e-3, atol=0)


def test_to_and_fro_is_a_way_too_and_so_is_a_long_gap():
    x = torch.zeros(1, T, 4)
    x[:, SPAN // 2 :: SPAN] = 1.0
    lively = of(x, given_at(slice(None, None, SPAN // 2)))
    assert float(lively[0, T // 2, 0]) == pytest.approx(math.sqrt(2), rel=0.02)
    far = of(steady(1.0), given_at([0, T - 1]))[0, T // 2, 0]
    assert float(far) == pytest.approx(math.sqrt((T - 1) / SPAN), rel=0.02), "root of the time"


def test_a_still_figure_has_little_and_nothing_given_is_1():
    x = torch.randn(1, 1, 4, generator=seeded()).expand(1, T, 4)
    still = of(x, given_at(slice(None, None, SPAN)))
    assert (still < 0.05).all() and (still > 0).all()
    for none in (given_at([]), given_at([30])):
        assert torch.equal(of(x, none), torch.ones(1, T, 1)), "one frame says nothing about it"
    far = of(x, given_at([0, 10], T=T))
    assert far[0, 5] < 0.1 and far[0, -1] == 1, "far from all that is given it is as usual"


def test_only_what_is_given_counts_and_motions_of_a_batch_are_on_their_own():
    x, known = torch.randn(3, T, 4, generator=seeded()), given_at([0, 20, 40, 100], n=3)
    known[1, :, 2:] = False
    known[2] = False
    lively = of(torch.where(known, x, torch.nan), known)
    assert torch.isfinite(lively).all()
    for k in range(3):
        torch.testing.assert_close(of(x[k : k + 1], known[k : k + 1])[0], lively[k])
    torch.testing.assert_close(
        of(x[1:2, :, :2], known[1:2, :, :2])[0], lively[1], atol=0, rtol=0.05
    )
    assert torch.equal(lively[2], torch.ones(T, 1))
    torch.testing.assert_close(of(x + 7.0, known), lively, atol=1e-3, rtol=1e-3)


def test_the_path_has_an_activity_of_its_own():
    """Who waves on the spot is not expected to sway, nor who slides along to wave."""
    x, known = torch.zeros(1, T, 63), given_at(slice(None, None, SPAN), D=63)
    x[..., 3:] = steady(2.0)[..., :1]
    waving = activity(between_known(x, known), known)[0, T // 2]
    assert (waving[[0, 2]] < 0.1).all() and (waving[3:] > 1).all() and waving[1] == waving[3]
    x = torch.zeros(1, T, 63)
    x[..., 0] = steady(2.0)[..., 0]
    sliding = activity(between_known(x, known), known)[0, T // 2]
    assert (sliding[[0, 2]] > 1).all()
    torch.testing.assert_close(sliding[3:], of(x, known)[0, T // 2].expand(60))


def test_it_has_no_jumps():
    x, known = torch.randn(1, T, 4, generator=seeded()), given_at(slice(None, None, SPAN))
    lively = of(x, known).log()[0, :, 0]
    assert lively.diff().abs().max() < 0.1 and lively.max() - lively.min() > 0.1


def test_what_is_given_comes_back_and_the_limit_is_kept():
    x, known = 3 * torch.randn(2, T, 4, generator=seeded()), given_at(slice(None, None, 10), n=2)
    shown = GivenLines.of(x, known)
    lively, limited = with_activity(shown), with_activity(shown, USED_AT_MOST)
    for one in (lively, limited):
        assert torch.equal(one.whole(torch.ones_like(x))[known], shown.lines[known])
        torch.testing.assert_close(one.whole(one.remainder(x)), x)
    assert (lively.scale > shown.scale)[~known].all()
    assert torch.equal(limited.scale, lively.scale), "the network sees no limit"
    one = torch.ones_like(x)
    torch.testing.assert_close(limited.whole(one), shown.whole(one))  # USED_AT_MOST is 1
    slow = GivenLines.of(x / 100, known)
    torch.testing.assert_close(with_activity(slow).scale, with_activity(slow, USED_AT_MOST).scale)


def test_sizes_of_remainders_differ_less_with_it():
    """Over walks, dances and acts: the spread of their logarithms, with a keyframe a second."""
    made = [*motions(8, 5, 5.1), *sentences(16, 5)]
    features = [
        placed_features(one[k : k + T]) for one, _ in made for k in range(0, len(one) - T, T)
    ]
    motion = torch.stack([torch.from_numpy(one).float() for one in features])
    scaler = Scaler.fit(motion)
    std = scaler.std.clone()
    std[[0, 2]] = 0.3
    x0 = Scaler(scaler.mean, std).transform(motion)
    known = given_at(slice(None, None, SPAN), D=63, n=len(x0))
    plain = GivenLines.of(x0, known)
    spreads = [
        float(one.remainder(x0).square().mean((1, 2)).sqrt().log().std())
        for one in (plain, with_activity(plain))
    ]
    assert spreads[1] < 0.9 * spreads[0]
