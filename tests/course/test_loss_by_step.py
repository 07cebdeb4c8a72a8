"""Losses over diffusion time.

Against the algebra, against autograd by differences, and on answers that are known.
"""

import math
import re

import numpy as np
import pytest
import torch
from synthetic_dance import windows

from motiondiff_edu.course.analyses.loss_by_step import (
    clean_guess,
    losses_over_time,
    noisy_predictor,
    predictor_of,
)
from motiondiff_edu.ddpm import cosine_schedule, q_sample
from motiondiff_edu.exact import dataset_denoiser
from motiondiff_edu.motion.dance_frame import body_of
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.viz import training as viz
from motiondiff_edu.viz.style import caption

SCHEDULE, STEPS = cosine_schedule(50), (1, 17, 30, 44)
WINDOWS = windows(n=24)
BODY = body_of(Scaler(WINDOWS.motion_scaler.mean.double(), WINDOWS.motion_scaler.std.double()))
X0, _, PLANTED = WINDOWS.take(torch.arange(3))
X0 = X0.double()
EPS = torch.randn(X0.shape, generator=torch.Generator().manual_seed(1), dtype=torch.float64)


def measured(predict=None, steps=STEPS, target="eps"):
    predict = predict or noisy_predictor(0.05, seed=2)
    return losses_over_time(predict, X0, EPS, PLANTED, BODY, SCHEDULE, steps, target)


def carried(s):
    """b / a: how much larger an error of eps_hat is in x0_hat."""
    share = float(SCHEDULE.alpha_bar[s])
    return math.sqrt((1 - share) / share)


def test_an_error_of_five_percent_is_one_and_the_same_at_every_step():
    off = noisy_predictor(0.05)(X0, 1, EPS) - EPS
    torch.testing.assert_close(noisy_predictor(0.05)(X0, 30, EPS) - EPS, off)
    assert not torch.equal(noisy_predictor(0.05, seed=1)(X0, 1, EPS) - EPS, off)
    assert off.square().mean().sqrt().item() == pytest.approx(0.05, rel=0.03)
    torch.testing.assert_close(noisy_predictor(0.0)(X0, 1, EPS), EPS)


def test_the_guess_is_off_by_b_over_a():
    for s in STEPS:
        guess = clean_guess(lambda x_s, s, eps: eps + 0.1, X0, EPS, s, SCHEDULE)
        torch.testing.assert_close(X0 - guess, torch.full_like(X0, 0.1 * carried(s)))


def test_who_is_right_pays_nothing():
    loss = measured(noisy_predictor(0.0))
    assert all(
        loss.value[name].max() < 1e-4 for name in ("data", "skeleton", "asymmetry", "motion")
    )


@pytest.mark.parametrize(
    "target, share", [("eps", 1 - SCHEDULE.alpha_bar), ("x0", SCHEDULE.alpha_bar)]
)
def test_the_papers_weight_on_the_motion_is_a_reweighting(target, share):
    loss = measured(target=target)
    weighted = loss.weighted(SCHEDULE, "alpha_bar")
    wanted = share[list(STEPS)]
    torch.testing.assert_close(
        weighted.value["motion"] / loss.value["data"], wanted, rtol=1e-5, atol=0
    )
    torch.testing.assert_close(
        weighted.gradient["motion"] / loss.gradient["data"], wanted, rtol=1e-5, atol=0
    )
    torch.testing.assert_close(weighted.value["data"], loss.value["data"])


def test_pull_of_the_data_term_is_known():
    """The gradient of mean(e^2) over n numbers is 2 e / n."""
    loss = measured(lambda x_s, s, eps: eps + 0.1)
    n = X0[0].numel()
    torch.testing.assert_close(
        loss.gradient["data"], torch.full((len(STEPS),), 2 * 0.1 / math.sqrt(n)).double()
    )


def test_pull_of_a_loss_is_what_small_steps_change():
    """Along random directions of unit length the slopes' mean square is |gradient|^2 / n."""
    draw_from, n = torch.Generator().manual_seed(5), X0[0].numel()
    wrong = EPS[:1] + 0.05 * torch.randn(X0[:1].shape, generator=draw_from, dtype=torch.float64)

    def at(eps_hat):
        return losses_over_time(
            lambda *_: eps_hat, X0[:1], EPS[:1], PLANTED[:1], BODY, SCHEDULE, (30,)
        )

    slopes = []
    for _ in range(60):
        way = torch.randn(wrong.shape, generator=draw_from, dtype=torch.float64)
        way = 1e-5 * way / way.norm()
        slopes.append(
            (at(wrong + way).value["skeleton"] - at(wrong - way).value["skeleton"]) / 2e-5
        )
    wanted = at(wrong).gradient["skeleton"]
    assert (torch.stack(slopes).square().mean() * n).sqrt().item() == pytest.approx(
        wanted.item(), rel=0.3
    )


def test_a_network_that_predicts_x0_feels_the_bones_less_by_a_over_b():
    eps = measured().gradient["skeleton"]
    x0 = measured(target="x0").gradient["skeleton"]
    torch.testing.assert_close(
        eps / x0, torch.tensor([carried(s) for s in STEPS]).double(), rtol=1e-5, atol=0
    )


def test_squared_losses_level_off_under_the_papers_weight_and_the_others_fall():
    """5 % off: unweighted all explode; alpha_bar L_s stays, alpha_bar L_a falls by a / a."""
    late, later = 45, 49
    loss = measured(steps=(late, later))
    weighted = measured(steps=(late, later)).weighted(SCHEDULE, "alpha_bar")
    growth = {
        name: float(loss.value[name][1] / loss.value[name][0]) for name in ("skeleton", "asymmetry")
    }
    ratio = carried(later) / carried(late)
    assert growth["skeleton"] == pytest.approx(ratio**2, rel=0.25) and ratio > 3
    assert growth["asymmetry"] == pytest.approx(ratio, rel=0.25)
    kept = {name: float(weighted.value[name][1] / weighted.value[name][0]) for name in growth}
    assert kept["skeleton"] == pytest.approx(1, abs=0.25) and kept["asymmetry"] < 0.5


def test_the_ideal_guess_at_high_noise_is_a_mean_with_short_bones():
    windows = WINDOWS.take(torch.arange(len(WINDOWS)))[0].double()
    answer = predictor_of(dataset_denoiser(windows, SCHEDULE))
    guess = clean_guess(answer, X0, EPS, 50, SCHEDULE)
    torch.testing.assert_close(guess[0], windows.mean(0), rtol=0, atol=0.1)
    ideal = measured(answer, (49,)).value["skeleton"]
    off = measured(steps=(49,)).value["skeleton"]
    assert ideal < off / 100


def test_the_answer_is_asked_with_the_noised_motion_and_its_step():
    asked = []

    def denoise(x_s, s):
        asked.append((x_s, s))
        return EPS

    clean_guess(predictor_of(denoise), X0, EPS, 17, SCHEDULE)
    torch.testing.assert_close(asked[0][0], q_sample(X0, 17, SCHEDULE, EPS))
    assert asked[0][1].tolist() == [17, 17, 17]


def test_unknown_names_are_refused():
    with pytest.raises(ValueError, match="constant"):
        measured().weighted(SCHEDULE, "linear")
    with pytest.raises(ValueError, match="target"):
        measured(target="noise")
    with pytest.raises(IndexError, match="51"):
        measured(steps=(51,))


def test_stretched_bones_are_coloured_and_a_torn_figure_is_told_its_width():
    poses = BODY.to_positions(X0[:1])[0].numpy()
    figure = viz.pose_rows({"truth": poses, "torn": 10 * poses}, "two rows", n=3)
    assert caption(figure) == "two rows" and len(figure.axes) == 2 * 3 + 1
    colours = [
        {tuple(np.round(line.get_color(), 1)) for line in axis.lines if len(line.get_xdata()) == 2}
        for axis in figure.axes[:6]
    ]
    assert len(colours[0]) == 1 and colours[0] != colours[3]
    named = [text.get_text() for axis in figure.axes for text in axis.texts]
    assert named[0] == "truth" and re.fullmatch(r"torn\n\(shows [\d.]+ m\)", named[1])
    low, high = figure.axes[0].get_xlim()
    assert low > high  # x is the figure's left, and we look at its face


def test_poses_have_their_seconds_and_what_is_too_wide_is_cut():
    poses = np.zeros((41, 21, 3))
    poses[:, 5, 0] = 4.0  # a joint 4 m beside the hips
    figure = viz.pose_rows({"torn": poses}, "words", n=3, fps=20, widest=3)
    assert [axis.get_title() for axis in figure.axes[:3]] == ["0.0 s", "1.0 s", "2.0 s"]
    assert figure.axes[0].get_xlim() == (1.5, -1.5)
    assert [text.get_text() for text in figure.axes[0].texts] == ["torn\n(shows 3.0 m of 8.0 m)"]
    assert [axis.get_title() for axis in viz.pose_rows({"torn": poses}, "words", n=3).axes[:3]] == [
        "",
        "",
        "",
    ]


def test_the_table_shows_what_it_was_given():
    figure = viz.loss_table(
        np.array([[0.0, 2.0], [4.0, 0.5], [1e-9, 0.0]]), ["a", "b", "c"], ["L", "M"], "table"
    )
    assert [text.get_text() for text in figure.axes[0].texts] == ["0", "2", "4", "0.5", "0", "0"]


def test_curves_over_steps_are_what_was_given_and_the_moment_marks_its_step():
    lines = {"one": ((1, 5, 9), np.array([1.0, 0.0, 3.0]))}
    figure = viz.over_steps({"p": lines, "q": lines, "r": lines}, "curves", "loss")
    np.testing.assert_allclose(figure.axes[1].lines[0].get_ydata(), [1.0, np.nan, 3.0])
    assert figure.axes[0].get_yscale() == "log"
    poses = np.random.default_rng(0).normal(size=(6, 21, 3))
    figure = viz.guess_and_losses(poses, {"p": lines, "q": lines}, 9, "now", n=3)
    marked = [line for axis in figure.axes for line in axis.lines if line.get_marker() == "o"]
    assert [float(line.get_xdata()[0]) for line in marked] == [9, 9]
