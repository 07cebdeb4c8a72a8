"""Masked sampling.

What is given comes back, what is not follows the true conditional once it is resampled.
"""

from dataclasses import replace

import jaxtyping
import numpy as np
import pytest
import torch
from small_dancers import dancer_of_bands as dancer

from data_synth.mixtures import crossed_bars
from data_synth.walking import random_control, walk
from motiondiff_edu.beyond.guidance import blended, blended_guess, guided, guided_guess, with_guess
from motiondiff_edu.ddpm import cosine_schedule, ddim_steps, timesteps
from motiondiff_edu.editing.inbetween import OURS, PAPER, Departures, fading, inbetween, seen_from
from motiondiff_edu.editing.masks import (
    PARTS,
    body_part,
    gap,
    keyframes,
    known_columns,
    known_frames,
    seed,
)
from motiondiff_edu.exact import conditional, exact_denoiser, log_density, mixture, sample_mixture
from motiondiff_edu.inbetweening import inpaint_steps, resampled
from motiondiff_edu.metrics.bone_lengths import bone_lengths
from motiondiff_edu.metrics.keyframes import seam_jump
from motiondiff_edu.mofusion import MoFusion
from motiondiff_edu.motion.dance_frame import Place, facing, to_features, to_positions
from motiondiff_edu.motion.root_frame import to_world
from motiondiff_edu.performers.dancer import FARTHEST
from motiondiff_edu.prediction import x0_from_eps
from motiondiff_edu.pretrained import checkpoints

SCHEDULE = cosine_schedule(100)


def seeded(seed: int = 0) -> torch.Generator:
    return torch.Generator().manual_seed(seed)


def last(loop):
    *_, end = loop
    return end.x_s


def correlated(rho: float = 0.9):
    """One Gaussian in the plane whose coordinates agree.

    The second is rho times the first, and some noise.
    """
    covariance = torch.tensor([[[1.0, rho], [rho, 1.0]]], dtype=torch.float64)
    return mixture(torch.ones(1), torch.tensor([[0.3, -0.2]]), covariance)


def test_the_conditional_is_the_joint_density_over_the_marginal_one():
    truth = crossed_bars()
    value = torch.tensor([-0.9, 9.0])
    known = torch.tensor([True, False])
    grid = torch.linspace(-4, 4, 8001, dtype=torch.float64)[:, None]
    joint = log_density(truth, torch.cat([torch.full_like(grid, -0.9), grid], 1)).exp()
    wanted = joint / (joint.sum() * (grid[1] - grid[0]))
    ours = log_density(conditional(truth, value, known), grid).exp()
    torch.testing.assert_close(ours, wanted, atol=1e-6, rtol=1e-5)


def test_the_conditional_of_one_gaussian_is_the_textbook_s():
    found = conditional(correlated(0.9), torch.tensor([1.3, 0.0]), torch.tensor([True, False]))
    assert found.mean().item() == pytest.approx(-0.2 + 0.9 * (1.3 - 0.3))
    assert found.covariance().item() == pytest.approx(1 - 0.9**2)
    for known in (torch.tensor([True, True]), torch.tensor([False, False])):
        with pytest.raises(ValueError, match="one entry must be known"):
            conditional(correlated(), torch.zeros(2), known)


def given_first(value: float, n: int):
    known = torch.tensor([True, False]).expand(n, 2)
    return torch.tensor([value, float("nan")]).expand(n, 2), known


def test_masking_with_the_exact_denoiser_misses_the_conditional_until_it_resamples():
    truth, n = correlated(0.9), 4000
    given, known = given_first(1.8, n)
    wanted = conditional(truth, given[0].nan_to_num(), known[0])
    off = {}
    for resample in (1, 10):
        start = torch.randn(n, 2, generator=seeded(1))
        loop = inpaint_steps(
            exact_denoiser(truth, SCHEDULE),
            start,
            SCHEDULE,
            given,
            known,
            steps=resampled(timesteps(100, 50), resample),
            generator=seeded(2),
        )
        x = last(loop)
        assert torch.equal(x[:, 0], given[:, 0])
        off[resample] = abs(x[:, 1].mean().item() - wanted.mean().item())
        if resample == 10:
            assert x[:, 1].var().item() == pytest.approx(wanted.covariance().item(), rel=0.25)
    assert off[1] > 0.1 and off[10] < 0.4 * off[1], off


def test_nothing_known_is_plain_sampling_and_all_known_is_the_input():
    truth = crossed_bars()
    start = torch.randn(50, 2, generator=seeded(3))
    denoise = exact_denoiser(truth, SCHEDULE)
    nothing = torch.zeros(50, 2, dtype=torch.bool)
    for eta in (0.0, 1.0):
        thrice = {"steps": resampled(timesteps(100, 50), 3), "eta": eta, "generator": seeded(4)}
        ours = last(inpaint_steps(denoise, start, SCHEDULE, start, nothing, **thrice))
        plain = last(ddim_steps(denoise, start, SCHEDULE, 50, eta, generator=seeded(4)))
        torch.testing.assert_close(ours, plain, atol=1e-5, rtol=1e-5)
    given = sample_mixture(truth, 50, seeded(5)).float()
    assert torch.equal(
        last(inpaint_steps(denoise, start, SCHEDULE, given, ~nothing, generator=seeded(6))), given
    )


def test_the_known_part_is_a_snapshot_noised_for_the_step():
    given, known = given_first(2.0, 3000)
    denoise = exact_denoiser(correlated(), SCHEDULE)
    start = torch.randn(3000, 2, generator=seeded(7))
    for step in inpaint_steps(
        denoise, start, SCHEDULE, given, known, steps=10, generator=seeded(8)
    ):
        alpha_bar = SCHEDULE.alpha_bar[step.s].item()
        assert step.x_s[:, 0].mean().item() == pytest.approx(2 * alpha_bar**0.5, abs=0.08)
        assert step.x_s[:, 0].std().item() == pytest.approx((1 - alpha_bar) ** 0.5, abs=0.05)


def test_resampling_goes_there_back_and_there():
    assert resampled([30, 20, 10], 2) == [30, 20, 30, 20, 10, 20, 10]
    assert resampled([9, 4], 3) == [9, 4, 9, 4, 9, 4] and resampled([9, 4], 1) == [9, 4]
    with pytest.raises(ValueError, match="R must be at least 1"):
        resampled([9, 4], 0)


def test_a_way_back_adds_the_noise_of_the_forward_process():
    """Whose guess is always 3: at step 60, after a way back, x_s has the mean and spread of 60."""
    n, nothing = 6000, torch.zeros(6000, 2)
    known = torch.tensor([True, False]).expand(n, 2)
    denoise = with_guess(lambda x, s: x, SCHEDULE, lambda x0: torch.full_like(x0, 3.0))
    visited = resampled([60, 10], 2)
    loop = inpaint_steps(
        denoise, nothing, SCHEDULE, nothing, known, steps=visited, generator=seeded(8)
    )
    steps = list(loop)
    assert [step.s for step in steps] == [60, 60, 10, 0]
    free, alpha_bar = steps[1].x_s[:, 1], SCHEDULE.alpha_bar[60].item()
    assert free.mean().item() == pytest.approx(3 * alpha_bar**0.5, abs=0.05)
    assert free.std().item() == pytest.approx((1 - alpha_bar) ** 0.5, abs=0.03)


@pytest.mark.parametrize("steps", [[], [101], [20, 0], 0, 101])
def test_steps_that_are_not_there(steps):
    start = torch.zeros(1, 2)
    with pytest.raises(ValueError, match="between 1 and 100"):
        next(inpaint_steps(lambda x, s: x, start, SCHEDULE, start, start > 0, steps=steps))


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
    torn = made(Departures(bones=False, feet=False))
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
        for name, value in (("guidance", 0.0), ("feet", False), ("resample", 2), ("blend", None))
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


def test_blending_carries_the_correction_and_fades():
    made, given = torch.zeros(1, 9, 2), torch.full((1, 9, 2), float("nan"))
    given[0, 4, 0] = 1.0
    given[0, 2, 1], given[0, 6, 1] = 1.0, 3.0
    out = blended_guess(made, given, ~given.isnan(), 3)[0]
    torch.testing.assert_close(out[:, 0], torch.tensor([0, 0.25, 0.5, 0.75, 1, 0.75, 0.5, 0.25, 0]))
    torch.testing.assert_close(out[:, 1], torch.tensor([0.5, 0.75, 1, 1.5, 2, 2.5, 3, 2.25, 1.5]))
    assert torch.equal(blended_guess(made, given, torch.zeros(1, 9, 2, dtype=torch.bool), 3), made)
    stays = blended_guess(made, given, ~given.isnan(), torch.tensor([torch.inf, 0.0]))[0]
    torch.testing.assert_close(stays[:, 0], torch.ones(9))
    torch.testing.assert_close(stays[:, 1], torch.tensor([0, 0, 1, 1.5, 2, 2.5, 3, 0, 0]))
    right = torch.randn(1, 9, 2)
    assert torch.equal(blended_guess(right, right, ~given.isnan(), 3), right)
    with torch.device("meta"):  # another default device: what is made must go by the inputs
        assert torch.equal(blended_guess(made, given, ~given.isnan(), 3)[0], out)


def test_blending_at_every_step_leaves_no_jump_where_masking_does():
    """A denoiser that knows nothing of the given (its guess is 1 everywhere).

    Masking pops, blending does not.
    """
    given = torch.linspace(3, 5, 30).view(1, 30, 1)
    known = torch.ones(1, 30, 1, dtype=torch.bool)
    known[:, 10:20] = False

    def denoise(x, s):
        alpha_bar = SCHEDULE.alpha_bar[s].view(-1, 1, 1).float()
        return (x - alpha_bar.sqrt()) / (1 - alpha_bar).sqrt()

    options = {"steps": 10, "generator": seeded()}
    drawn = blended(denoise, SCHEDULE, given, known, fade=3)
    plain, blent = (
        last(inpaint_steps(who, torch.randn(1, 30, 1), SCHEDULE, given, known, **options))
        for who in (denoise, drawn)
    )
    assert plain.diff(dim=1).abs().max() > 2 and blent.diff(dim=1).abs().max() < 0.2


@pytest.mark.parametrize("eta, wild, tame", [(0.0, 4.0, 1.1), (0.5, 2.0, 1.1)])
def test_a_bounded_guess_does_not_blow_up_an_error_of_one_percent(eta, wild, tame):
    """At s = S an error of eps counts b / a times: the made entries are five times too wide."""
    schedule, n = cosine_schedule(1000), 2000
    exact = exact_denoiser(correlated(0.3), schedule)
    known, given = torch.tensor([True, False]).expand(n, 2), torch.randn(n, 2, generator=seeded(1))

    def off(x, s):
        return 1.01 * exact(x, s)

    held = with_guess(off, schedule, lambda x0: x0.clamp(-5, 5))
    free, bounded = (
        last(inpaint_steps(who, start, schedule, given, known, eta=eta, generator=seeded(3)))
        for who, start in ((who, torch.randn(n, 2, generator=seeded(2))) for who in (off, held))
    )
    assert free[:, 1].std() > wild and 0.7 < bounded[:, 1].std() < tame


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
    raw = Departures(bones=False, feet=False, blend=None)
    made = inbetween(wild, clip(), seed(40, 10), steps=5, departures=raw)
    features = wild.motion_scaler.transform(torch.from_numpy(to_features(made)).float())
    assert features[..., 3:].abs().max() < 1.01 * FARTHEST


def test_guidance_moves_what_goes_with_the_given():
    """With the exact denoiser of two numbers that agree, the given one moves the other.

    The unknown one comes nearer to where the known one says.
    """
    truth, n = correlated(0.9), 2000
    given, known = given_first(1.8, n)
    wanted = conditional(truth, given[0].nan_to_num(), known[0]).mean().item()
    start = torch.randn(n, 2, generator=seeded(1))
    denoise = exact_denoiser(truth, SCHEDULE)
    off = {}
    for guidance in (0.0, 1.0):
        who = guided(denoise, SCHEDULE, given, known, guidance) if guidance else denoise
        loop = inpaint_steps(who, start, SCHEDULE, given, known, generator=seeded(2))
        off[guidance] = abs(last(loop)[:, 1].mean().item() - wanted)
    assert off[1.0] < 0.5 * off[0.0], off


def test_one_guided_guess_by_hand():
    """J is known for a linear denoiser.

    x0_hat = M x, so the pull is M^T r, as long as leaves least wrong.
    """
    M = torch.tensor([[0.5, 0.3], [0.3, 0.5]])
    x = torch.tensor([[1.0, 2.0]])
    known = torch.tensor([[True, False]])
    alpha_bar = SCHEDULE.alpha_bar[40].item()

    def denoise(x, s):
        return (x - alpha_bar**0.5 * x @ M.T) / (1 - alpha_bar) ** 0.5

    given, s = torch.tensor([[3.0, 0.0]]), torch.tensor([40])
    out = guided_guess(denoise, x, s, SCHEDULE, given, known, 1.0)
    x0_hat = torch.tensor([1.1, 1.3])
    pull = M.T @ torch.tensor([3.0 - 1.1, 0.0])
    torch.testing.assert_close(out[0], x0_hat + pull * (3.0 - 1.1) / pull[0])
    assert out[0, 0] == pytest.approx(3.0)  # one given entry is met at once
    eps_hat = guided(denoise, SCHEDULE, given, known)(x, s)
    torch.testing.assert_close(alpha_bar**0.5 * out + (1 - alpha_bar) ** 0.5 * eps_hat, x)


def test_many_moves_of_guidance_solve_for_all_given_entries():
    """For a Gaussian J is a covariance C, so the end is x0_hat + C_uk C_kk^-1 error."""
    root = torch.randn(6, 6, generator=seeded(3), dtype=torch.float64)
    covariance = root @ root.T / 6 + 0.3 * torch.eye(6)
    truth = mixture(torch.ones(1), torch.randn(1, 6, generator=seeded(4)), covariance[None])
    denoise, s = exact_denoiser(truth, SCHEDULE), torch.full((7,), 40)
    x, given = (torch.randn(7, 6, generator=seeded(k), dtype=torch.float64) for k in (5, 6))
    known = torch.tensor([True, False, True, False, False, True]).expand(7, 6)

    def guess(moves: int, weight: float = 1.0):
        return guided_guess(denoise, x, s, SCHEDULE, given, known, weight, moves)

    a = SCHEDULE.alpha_bar[40].item()
    plain = x0_from_eps(x, s, denoise(x, s), SCHEDULE)
    J = a**0.5 * covariance @ torch.linalg.inv(a * covariance + (1 - a) * torch.eye(6))
    here = known[0]
    pull = J[:, here] @ torch.linalg.solve(J[here][:, here], (given - plain)[:, here].T)
    torch.testing.assert_close(guess(300), plain + pull.T, atol=1e-3, rtol=1e-3)
    torch.testing.assert_close(guess(300, 0.5), plain + 0.5 * pull.T, atol=1e-3, rtol=1e-3)
    missed = [(guess(moves) - given)[known].norm() for moves in (1, 2, 4, 8)]
    assert all(later < 0.9 * sooner for sooner, later in zip(missed, missed[1:], strict=False))


def test_guidance_through_a_fast_twin_is_refused():
    who, mel = dancer(5), torch.randn(1, 64, 5, generator=seeded(9))
    start = torch.zeros(1, 40, 63)
    steered = guided(who.denoiser(mel, 40), who.schedule, start, start == 0)
    loop = inpaint_steps(steered, start, who.schedule, start, start == 0, steps=2)
    with pytest.raises(ValueError, match="fast twin"):
        next(loop)


def test_masks():
    assert seed(200).sum() == 40 * 21 and keyframes(100, 30).any(-1).nonzero()[0].tolist() == [
        0,
        30,
        60,
        90,
        99,
    ]
    assert (~gap(100, 20, 15).any(-1)).nonzero()[0].tolist() == list(range(20, 35))
    both = body_part(5, "upper body").sum() + body_part(5, "lower body").sum()
    assert both == 5 * (21 + 1) and body_part(5, "trajectory").sum() == 5  # the pelvis is in each
    assert known_columns(body_part(5, "trajectory")).sum() == 15


def test_masks_refuse_what_is_not_there():
    with pytest.raises(IndexError, match="frame 40"):
        known_frames(40, [40])
    with pytest.raises(ValueError, match="gap of 30"):
        gap(40, 20, 30)
    with pytest.raises(KeyError, match="lower body"):
        body_part(40, "tail")
    alone = np.zeros((40, 21), bool)
    alone[7, 15] = True
    with pytest.raises(ValueError, match="frame 7 gives LeftHand without the pelvis"):
        inbetween(dancer(), clip(), alone)
    with pytest.raises(ValueError, match="dances to music"):
        inbetween(dancer(5), clip(), seed(40, 10))
    with pytest.raises(ValueError, match="takes no music"):
        inbetween(dancer(), clip(), seed(40, 10), torch.zeros(64, 5))
