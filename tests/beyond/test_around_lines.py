"""Around lines: lines and scale by hand and by data, and the exact answer for what remains."""

import numpy as np
import pytest
import torch
from two_numbers import correlated

from data_synth.mixed import motions
from motiondiff_edu.beyond.around_lines import HALF, GivenLines, lines_round
from motiondiff_edu.ddpm import cosine_schedule, final
from motiondiff_edu.exact import conditional, exact_denoiser, mixture
from motiondiff_edu.inbetweening import inpaint_steps
from motiondiff_edu.motion.dance_frame import Place, at_origin, placed_features
from motiondiff_edu.motion.directions import ARMS, UPLEGS
from motiondiff_edu.motion.known import between_known
from motiondiff_edu.motion.scaler import Scaler

SCHEDULE = cosine_schedule(100)


def seeded(seed: int = 0) -> torch.Generator:
    return torch.Generator().manual_seed(seed)


def test_the_scale_is_nothing_where_a_motion_is_given_and_grows_with_the_distance():
    known = torch.zeros(1, 7, 3, dtype=torch.bool)
    known[0, [1, 5], 0], known[0, 6, 1] = True, True
    scale = GivenLines.of(torch.zeros(1, 7, 3), known).scale[0]
    between = [1 / (1 + HALF * (1 / k + 1 / (4 - k))) for k in (1, 2, 3)]
    outside = 1 / (1 + HALF)
    wanted = torch.tensor([outside, 0, *between, 0, outside])
    torch.testing.assert_close(scale[:, 0], wanted)
    assert scale[5, 1] == pytest.approx(outside) and scale[0, 1] == pytest.approx(6 / (6 + HALF))
    assert torch.equal(scale[:, 2], torch.ones(7))


def test_scales_are_those_of_motions():
    """As far as motions are from the lines: within a factor of two, at every distance."""
    motion = torch.from_numpy(
        np.stack([placed_features(positions[:101]) for positions, _ in motions(12, 5, 5.1)])
    ).float()
    x0 = Scaler.fit(motion).transform(motion)
    x0 = x0[..., [column for column in range(63) if column not in (0, 2)]]  # without the path
    for every in (5, 10, 20, 50):
        known = torch.zeros(x0.shape, dtype=torch.bool)
        known[:, ::every] = True
        shown = GivenLines.of(x0, known)
        middle = slice(every // 2, None, every)
        size = float(shown.remainder(x0)[:, middle].square().mean().sqrt())
        assert 0.5 < size < 2, every


def test_lines_and_remainder_are_the_motion():
    x0, known = torch.randn(4, 20, 6, generator=seeded()), torch.rand(4, 20, 6) < 0.3
    shown = GivenLines.of(torch.where(known, x0, torch.nan), known)
    remainder = shown.remainder(x0)
    assert (remainder[known] == 0).all()
    torch.testing.assert_close(shown.whole(remainder), x0)
    nothing = GivenLines.of(x0, torch.zeros_like(known))
    assert torch.equal(nothing.remainder(x0), x0) and torch.equal(nothing.whole(x0), x0)


def test_an_exact_remainder_gives_exact_samples_of_the_rest():
    """Two correlated numbers as two frames, of which the first is given."""
    first, n = 0.8, 4000
    rest = conditional(correlated(), torch.tensor([first, 0.0]), torch.tensor([True, False]))
    mean, variance = float(rest.means[0, 0]), float(rest.variances[0, 0])
    assert (mean, variance) == pytest.approx((-0.2 + 0.9 * 0.5, 1 - 0.9**2))
    known = torch.tensor([True, False]).view(1, 2, 1).expand(n, 2, 1)
    given = torch.tensor([first, 0.0]).view(1, 2, 1).expand(n, 2, 1)
    shown = GivenLines.of(given, known)
    scale = float(shown.scale[0, 1])
    moved = mixture(
        rest.weights, (rest.means - first) / scale, rest.variances[..., None] / scale**2
    )
    exact = exact_denoiser(moved, SCHEDULE)

    def remainder(r_s, s):
        eps_hat = torch.zeros_like(r_s)
        eps_hat[:, 1] = exact(r_s[:, 1].to(moved.means), s).to(r_s)
        alpha_bar = SCHEDULE.alpha_bar[s].view(-1, 1).to(r_s)
        eps_hat[:, 0] = r_s[:, 0] / (1 - alpha_bar).sqrt()  # it is 0 at the given frame
        return eps_hat

    start = torch.randn(n, 2, 1, generator=seeded())
    nothing = torch.zeros(n, 2, 1)
    how = {"steps": 100, "generator": seeded(1)}
    made = shown.whole(final(inpaint_steps(remainder, start, SCHEDULE, nothing, known, **how)).x_s)
    assert torch.equal(made[:, 0], given[:, 0])
    assert float(made[:, 1].mean()) == pytest.approx(mean, abs=0.03)
    assert float(made[:, 1].var()) == pytest.approx(variance, rel=0.1)


def turning(angles: np.ndarray) -> torch.Tensor:
    """The features of a pose that turns on the spot, facing these angles."""
    ((positions, _),) = motions(1, 5, 0.5)
    pose = np.repeat(at_origin(positions)[:1, None], len(angles), 0)
    placed = Place(np.zeros((len(angles), 3)), -np.asarray(angles)).enter(pose)[:, 0]
    return torch.from_numpy(placed_features(placed)).float()


def given(features: torch.Tensor, known: np.ndarray) -> torch.Tensor:
    return features.where(torch.from_numpy(np.repeat(known, 3, 1)), torch.nan)


@pytest.mark.parametrize("pair", [UPLEGS, ARMS])
@pytest.mark.parametrize("turn", [-2.9, 1.0, 2.9])
def test_lines_go_round_with_the_heading_of_hips_or_shoulders(pair, turn):
    """A pose that turns evenly is its own line, though one pair alone says so in between."""
    features = turning(np.linspace(0.5, 0.5 + turn, 11))
    known = np.zeros((11, 21), bool)
    known[[0, 10]] = True
    lines = lines_round(given(features, known), known)
    torch.testing.assert_close(lines, features, atol=1e-5, rtol=0)
    other = UPLEGS if pair is ARMS else ARMS
    known[:, other] = False  # the other pair alone tells the heading
    some = np.repeat(known, 3, 1).any(0)
    lines = lines_round(given(features, known), known)
    torch.testing.assert_close(lines[:, some], features[:, some], atol=1e-5, rtol=0)
    assert (lines[:, ~some] == 0).all()


def test_lines_are_straight_where_nothing_says_which_way_the_figure_faces():
    features, known = turning(np.linspace(0, 2, 11)), np.zeros((11, 21), bool)
    known[[0, 10]] = True
    known[:, [*UPLEGS, *ARMS]] = False
    columns = torch.from_numpy(np.repeat(known, 3, 1))[None]
    assert torch.equal(lines_round(features, known), between_known(features[None], columns)[0])


def test_the_pelvis_goes_straight_and_turns_go_the_short_way():
    angles = np.linspace(3.0, 3.0 + 2 * np.pi - 5.0, 6)  # from 172 to 246 degrees
    features = turning(angles)
    features[:, 0], features[:, 2] = torch.linspace(0, 2, 6), torch.linspace(1, 0, 6)
    known = np.zeros((6, 21), bool)
    known[[0, 5]] = True
    torch.testing.assert_close(lines_round(features, known), features, atol=1e-5, rtol=0)
