"""Figures of notebooks 01 and 06.

Drawn from arrays, with a caption, and true to what they are given.
"""

import numpy as np
import pytest

from motiondiff_edu.motion.skeleton import JOINTS, OFFSETS, PARENTS, J
from motiondiff_edu.viz import attention, motion
from motiondiff_edu.viz.style import caption


def texts(figure):
    return [text.get_text() for axes in figure.axes for text in axes.texts]


def test_joint_map_numbers_and_names_every_joint():
    rest = np.zeros((J, 3))
    for j in range(J):
        rest[j] = OFFSETS[j] + (rest[PARENTS[j]] if j else 0)
    figure = motion.joint_map(rest, "the joints")
    assert caption(figure) == "the joints"
    assert {str(j) for j in range(J)} <= set(texts(figure))
    assert all(any(name in text for text in texts(figure)) for name in JOINTS)


def test_limb_steps_draws_each_way_with_its_length():
    ways = {"a": np.random.default_rng(0).normal(size=(5, 3, 2)), "b": np.ones((5, 3, 2))}
    curves = {"a": np.linspace(0.1, 0.3, 9), "b": np.full(9, 0.28)}
    figure = motion.limb_steps(ways, curves, 0.28, "in between")
    assert [axes.get_title() for axes in figure.axes[:2]] == ["a", "b"]
    np.testing.assert_allclose(figure.axes[2].lines[0].get_ydata(), curves["a"])


def test_paths_show_left_on_the_left():
    path = np.array([[0.0, 0.0], [1.0, 1.0], [3.0, 2.0]])
    figure = motion.paths_from_above(
        {"walk": (path, np.zeros(3)), "other": (-path, np.zeros(3))}, "paths", every=1
    )
    axes = figure.axes[0]
    low, high = axes.get_xlim()
    assert low > high  # x points to the figure's left
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["walk", "other"]


def test_windows_are_as_long_as_they_say():
    figure = motion.windows_in_time(
        [[0, 40], [0, 40, 80]], 80, [["train", "test"], ["train"] * 3], "windows"
    )
    bars = [bar for bar in figure.axes[0].patches if bar.get_width() > 0]
    assert [bar.get_width() for bar in bars] == [4.0] * 5
    assert [bar.get_x() for bar in bars] == [0, 2, 0, 2, 4]
    with pytest.raises(ValueError):
        motion.windows_in_time([[0, 40]], 80, [["train"]], "one group is missing")


def test_buckets_and_sharpness_are_what_was_given():
    distance = np.arange(-4, 5)
    figure = attention.bucket_map(distance, np.abs(distance), 2, "buckets")
    past, future = figure.axes[0].lines
    assert list(past.get_xdata()) == [-4, -3, -2, -1, 0] and list(future.get_ydata()) == [
        1,
        2,
        3,
        4,
    ]
    figure = attention.sharpness(
        np.array([4, 8, 16]), {"a": np.array([0.1, 0.2, 0.3])}, 0.05, "sharp"
    )
    np.testing.assert_allclose(figure.axes[0].lines[0].get_ydata(), [0.1, 0.2, 0.3])


def test_weight_against_effect_has_a_panel_for_each_group():
    rng = np.random.default_rng(1)
    weight, effect = rng.random((4, 7)), rng.random((4, 7))
    figure = attention.weight_against_effect(
        weight, effect, [("past", 2), ("control", 5)], "against"
    )
    assert [axes.get_title() for axes in figure.axes] == ["past", "control"]
    dots = [axes.lines[1].get_xydata() for axes in figure.axes]
    assert [len(d) for d in dots] == [8, 20]
    np.testing.assert_allclose(dots[1][:5, 0], weight[0, 2:] / weight[0, 2:].mean())
    np.testing.assert_allclose(dots[0][:2, 1], effect[0, :2] / effect[0, :2].mean())
