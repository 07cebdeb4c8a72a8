"""Figures of measures show the numbers they are given."""

import numpy as np

from motiondiff_edu.viz import walks as viz
from motiondiff_edu.viz.body import LEFT_COLOUR
from motiondiff_edu.viz.style import caption


def texts(axis):
    return [text.get_text() for text in axis.texts]


def test_the_dot_stands_where_95_percent_are_reached():
    fig = viz.footstep_curves(
        {"a": np.array([0.0, 50, 96, 100, 90]), "b": np.array([7.0, 7, 7, 7, 7])}, "words"
    )
    lines = fig.axes[0].lines
    np.testing.assert_allclose(lines[0].get_xydata()[:, 1], [0, 50, 96, 100, 90])
    assert lines[1].get_xydata().tolist() == [[3, 96]] and lines[3].get_xydata().tolist() == [
        [1, 7]
    ]
    assert caption(fig) == "words" and [t.get_text() for t in fig.axes[0].get_legend().texts] == [
        "a",
        "b",
    ]


def test_seconds_are_drawn_at_their_middle_in_each_panel():
    fig = viz.measures_over_time(
        {"bones": {"x": np.array([1.0, 2, 4])}, "off": {"x": np.array([3.0, 1])}},
        "words",
        shade_to=1,
    )
    assert fig.axes[0].lines[0].get_xydata().tolist() == [[0.5, 1], [1.5, 2], [2.5, 4]]
    assert fig.axes[1].get_title() == "off" and len(fig.axes[1].patches) == 1


def test_six_lines_have_six_patterns():
    """The fifth pattern and those after it are dash lengths, not names."""
    curves = {str(k): np.arange(1.0, 6.0) for k in range(6)}
    fig = viz.footstep_curves(curves, "words")
    drawn = [str(line._unscaled_dash_pattern) for line in fig.axes[0].lines[::2]]
    assert len(set(drawn)) == 6
    over = viz.measures_over_time({"bones": curves}, "words")
    assert len(over.axes[0].lines) == 6


def test_planted_steps_are_grey_for_as_long_as_they_last():
    height = np.linspace(0, 0.1, 12).reshape(6, 2)
    fig = viz.toe_heights(height, np.array([True, True, False, False, True]), "words", fps=10)
    spans = [
        patch.get_extents().transformed(fig.axes[0].transData.inverted())
        for patch in fig.axes[0].patches
    ]
    np.testing.assert_allclose([[s.x0, s.x1] for s in spans], [[0, 0.2], [0.4, 0.5]], atol=1e-9)
    np.testing.assert_allclose(fig.axes[0].lines[1].get_ydata(), 100 * height[:, 1])


def test_treads_are_of_both_toes_a_panel_for_each_walk():
    toes = np.arange(12.0).reshape(6, 2)
    fig = viz.treads({"one": toes, "other": 2 * toes[:4]}, "words", fps=10)
    one, other = fig.axes
    assert (one.get_title(), other.get_title()) == ("one", "other")
    for side in (0, 1):
        np.testing.assert_allclose(one.lines[side].get_xdata(), [0, 0.1, 0.2, 0.3, 0.4, 0.5])
        np.testing.assert_allclose(other.lines[side].get_ydata(), 2 * toes[:4, side])
    assert one.get_ylim() == other.get_ylim() and one.lines[0].get_color() == LEFT_COLOUR


def test_a_table_says_none_where_there_is_no_figure_and_nought_for_rounding():
    fig = viz.score_table({"a": {"m": 1.234, "n": np.nan}, "b": {"m": 1e-12, "n": 0.5}}, "words")
    assert texts(fig.axes[0]) == ["1.2", "none", "0", "0.5"]


def test_shades_go_with_the_value_or_with_its_logarithm():
    scores = {
        "a": {"m": 1.0, "n": 1.0},
        "b": {"m": 10.0, "n": 10.0},
        "c": {"m": 100.0, "n": np.nan},
    }
    shades = viz.score_table(scores, "words", log=["m"]).axes[0].images[0].get_array()
    np.testing.assert_allclose(shades, [[0, 0.1], [0.5, 1], [1, 0]])
    nothing = (
        viz.score_table({"a": {"m": -1.0}, "b": {"m": 0.0}}, "words", log=["m"])
        .axes[0]
        .images[0]
        .get_array()
    )
    np.testing.assert_allclose(nothing, 0)
