"""Figures of measured dances show the numbers they are given."""

import numpy as np
from moves import stopping_at, sway

from motiondiff_edu.motion.resample import DANCE_FPS
from motiondiff_edu.viz import dances as viz
from motiondiff_edu.viz.style import caption


def test_dots_stand_where_the_dance_slows_down_and_lines_at_the_beats():
    stops = np.array([0.6, 1.2, 1.9])
    music = np.array([-0.5, 0.5, 1.5, 9.0])
    fig = viz.stops_and_beats(
        {"stops": stopping_at(stops, 2.5, 20), "sways": sway(2.5, 20)}, music, "words"
    )
    speed, dots = fig.axes[0].lines
    # a speed lies in the middle between two frames
    np.testing.assert_allclose(speed.get_xdata()[:2], [0.5 / DANCE_FPS, 1.5 / DANCE_FPS])
    np.testing.assert_allclose(dots.get_xdata(), stops, atol=0.04)
    assert (
        dots.get_ydata().max() < 0.5 * speed.get_ydata().max()
        and len(fig.axes[1].lines[1].get_xdata()) == 0
    )
    drawn = [segment[0, 0] for segment in fig.axes[0].collections[0].get_segments()]
    assert drawn == [0.5, 1.5] and caption(fig) == "words"


def bars(axis):
    return [bar.get_width() for bar in axis.patches], [line.get_xdata()[0] for line in axis.lines]


def test_bars_end_at_the_score_and_lines_stand_at_chance():
    panels = {
        "first": {"a": (0.4, 0.2), "b": (0.25, 0.3)},
        "second": {"a": (0.9, 0.5), "b": (0.1, 0.5)},
    }
    fig = viz.beside_chance(panels, "w")
    assert bars(fig.axes[0]) == ([0.4, 0.25], [0.2, 0.3]) and bars(fig.axes[1]) == (
        [0.9, 0.1],
        [0.5, 0.5],
    )
    assert [text.get_text() for text in fig.axes[0].texts] == ["0.40", "0.25"]
    assert [label.get_text() for label in fig.axes[0].get_yticklabels()] == ["a", "b"]
    assert [fig.axes[k].get_title() for k in (0, 1)] == ["first", "second"]


def test_distances_and_their_floor_fit_on_one_axis_from_nought_to_thousands():
    fig = viz.beside_floor({"p": {"a": (4321.0, 12.0), "b": (0.0, 12.0)}}, "w")
    (axis,) = fig.axes
    assert bars(axis) == ([4321.0, 0.0], [12.0, 12.0])
    assert [text.get_text() for text in axis.texts] == ["4321", "0"]
    assert axis.get_xscale() == "symlog" and axis.get_xlim()[1] > 4321
    assert [label.get_text() for label in axis.get_xticklabels()] == ["0", "1", "10", "100", "1000"]


def test_published_scores_are_level_lines_over_the_chance_curve():
    fig = viz.chance_over_tempo(
        np.array([80.0, 100, 140]), np.array([0.17, 0.21, 0.29]), {"theirs": 0.25}, "w"
    )
    curve, line = fig.axes[0].lines
    assert curve.get_ydata().tolist() == [0.17, 0.21, 0.29] and set(line.get_ydata()) == {0.25}
    assert [text.get_text() for text in fig.axes[0].get_legend().texts] == [
        "stops at random times",
        "theirs: 0.25",
    ]


def test_distances_over_clips_are_logarithmic_and_named():
    sizes = np.array([10.0, 20, 80])
    fig = viz.over_clips(sizes, {"a": (sizes, sizes / 5), "b": (2 * sizes, sizes)}, "w")
    assert fig.axes[0].get_xscale() == fig.axes[0].get_yscale() == "log"
    assert [line.get_ydata().tolist() for line in fig.axes[0].lines] == [
        [10, 20, 80],
        [20, 40, 160],
    ]
    assert [label.get_text() for label in fig.axes[0].get_xticklabels()] == ["10", "20", "80"]


def test_matrices_are_drawn_in_seconds_from_minus_one_to_one():
    matrix = np.eye(40)
    fig = viz.similarity_matrices({"a": matrix, "b": -np.eye(60)}, "w", fps=20)
    images = [axis.images[0] for axis in fig.axes[:2]]
    assert images[0].get_extent() == [0, 2, 2, 0] and images[1].get_extent() == [0, 3, 3, 0]
    assert np.array_equal(images[0].get_array(), matrix) and images[0].get_clim() == (-1, 1)
