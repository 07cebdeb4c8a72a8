"""Figures of dropout show the numbers they are given."""

import numpy as np
import pytest

from motiondiff_edu.viz import walks as viz
from motiondiff_edu.viz.style import caption


def test_panels_share_colours_by_name_and_have_their_own_scales():
    panels = {
        "small": {"a": ([1, 2, 3], [4.0, 5, 6])},
        "large": {"b": ([1, 2], [10.0, 1e6]), "a": ([1, 2], [1.0, 2])},
    }
    fig = viz.beside(panels, "words", "rate", log=["large"])
    left, right = fig.axes
    assert left.get_title() == "small" and left.get_ylim()[0] == 0 and right.get_yscale() == "log"
    b, a = right.lines
    assert a.get_color() == left.lines[0].get_color() != b.get_color()
    assert left.lines[0].get_xydata().tolist() == [[1, 4], [2, 5], [3, 6]]
    assert [text.get_text() for text in fig.legends[0].texts] == ["a", "b"] and caption(
        fig
    ) == "words"


def test_bars_are_the_roots_of_summed_squares_frame_by_frame():
    weight = np.zeros((2 * 3 + 2 + 1, 3))  # two past frames, two numbers of control, the constant
    weight[0, 0], weight[2, 1] = 3, 4  # the older frame: 5
    weight[4] = 2  # the last one: sqrt(12)
    weight[6, 2], weight[7, 0] = 5, 12  # control: 13
    weight[8] = 99  # the constant is not shown
    fig = viz.weights_by_input({"x": weight, "y": 2 * weight}, 2, "words")
    heights = [bar.get_height() for bar in fig.axes[0].patches]
    assert heights == pytest.approx([5, 12**0.5, 13, 10, 2 * 12**0.5, 26])
    assert [tick.get_text() for tick in fig.axes[0].get_xticklabels()] == ["-1", "last", "control"]


def test_each_target_stands_above_its_past():
    fig = viz.noise_pairs(
        {"x": (np.array([0.1, 0.9]), np.array([0.0, 0.5])), "y": (np.zeros(3), np.ones(3))}, "words"
    )
    dots = [axis.lines[1].get_xydata().tolist() for axis in fig.axes]
    assert dots == [[[0.1, 0.0], [0.9, 0.5]], [[0.0, 1.0]] * 3]
    assert [axis.get_title() for axis in fig.axes] == ["x", "y"]
