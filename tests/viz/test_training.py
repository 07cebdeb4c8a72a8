"""Figures of training draw the numbers that they are given, and say what lies outside."""

import numpy as np

from motiondiff_edu.viz import training as viz
from motiondiff_edu.viz.style import caption
from motiondiff_edu.viz.training import loss_table


def test_a_bar_is_the_floor_and_what_lies_above_it():
    fig = viz.loss_above_floor({"a": 0.5, "b": 0.2}, {"a": 0.3, "b": 0.25}, "w")
    (axis,) = fig.axes
    bars = [(bar.get_x(), bar.get_width()) for bar in axis.patches]
    np.testing.assert_allclose(bars, [(0, 0.3), (0.3, 0.2), (0, 0.25), (0.25, 0)])
    assert [text.get_text() for text in axis.texts] == ["0.500", "0.200"]


def test_points_outside_are_counted_in_the_caption():
    inside = np.zeros((5, 2))
    some = np.array([[0.0, 3.0], [-3.0, 0.0], [9.0, 9.0], [1.0, -1.0]])
    assert caption(viz.clouds({"a": inside, "b": some}, "w")) == "w Outside of the frame: 3."
    assert caption(viz.clouds({"a": inside}, "w")) == "w"


def test_guesses_lead_from_the_noised_points_beside_the_exact_ones():
    x_s, right = np.array([[1.0, 0], [0, 1]]), np.array([[0.5, 0], [0, 0]])
    fig = viz.guesses(np.zeros((4, 2)), x_s, right, {"eps": x_s / 4}, "w")
    lines = fig.axes[0].lines
    np.testing.assert_array_equal([line.get_xydata() for line in lines[1:3]], [
        [[1, 0], [0.25, 0]], [[0, 1], [0, 0.25]]
    ])  # fmt: skip
    np.testing.assert_array_equal(lines[-1].get_xydata(), right)


def test_curves_over_s_and_the_marked_levels():
    fig = viz.over_s({"a": ([1, 2, 3], [0.1, 1, 10])}, "w", "loss", marks={"best": 0.5})
    curve, mark = fig.axes[0].lines
    assert curve.get_ydata().tolist() == [0.1, 1, 10] and set(mark.get_ydata()) == {0.5}
    assert fig.axes[0].get_yscale() == "log" and fig.axes[0].texts[0].get_text() == "best"
    assert viz.over_s({"a": ([1], [1])}, "w", "", log=False).axes[0].get_yscale() == "linear"


def test_a_loss_is_shaded_by_its_share_of_the_largest_in_its_column():
    values = np.array([[4.0, 1.0], [1.0, 0.0]])
    (axis,) = loss_table(values, ["a", "b"], ["x", "y"], "w").axes
    np.testing.assert_allclose(axis.images[0].get_array(), [[1.0, 1.0], [0.5, 0.0]])
    assert [text.get_text() for text in axis.texts] == ["4", "1", "1", "0"]
