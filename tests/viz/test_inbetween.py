"""Figures of in-betweens show the numbers they are given."""

import numpy as np

from motiondiff_edu.viz import repairs as viz
from motiondiff_edu.viz.repairs import by_fault, over_gaps
from motiondiff_edu.viz.style import caption

RNG = np.random.default_rng(0)


def test_a_slice_has_its_line_its_samples_and_the_density_beside_each_way():
    data, grid = RNG.normal(size=(50, 2)), np.linspace(-3, 3, 31)
    density = np.exp(-(grid**2) / 2) / np.sqrt(2 * np.pi)
    made = {"one": np.array([0.5, 0.5, -1.0]), "other": np.array([2.0])}
    fig = viz.slice_of_plane(data, 0.25, made, grid, density, "words")
    plane, first, second = fig.axes
    points, line, on_line = plane.lines
    assert points.get_xydata().tolist() == data.tolist() and set(line.get_xdata()) == {0.25}
    assert on_line.get_xydata().tolist() == [[0.25, 0.5], [0.25, 0.5], [0.25, -1.0]]
    assert [axis.get_title() for axis in fig.axes] == ["the data", "one", "other"] and caption(
        fig
    ) == "words"
    width = 6 / 60
    for axis, values in ((first, made["one"]), (second, made["other"])):
        np.testing.assert_allclose(axis.lines[0].get_xdata(), density)
        bars = {
            round(bar.get_y() + width / 2, 2): bar.get_width()
            for bar in axis.patches
            if bar.get_width()
        }
        assert abs(sum(bars.values()) * width - 1) < 1e-9
        assert all(min(abs(y - v) for v in values) <= width for y in bars)


def test_ways_are_rows_with_a_dot_for_each_seed_and_a_line_at_the_right_answer():
    found = {
        "a": {"mean": [0.3, 0.4], "spread": [1.1, 0.9]},
        "b": {"mean": [0.0, 0.1], "spread": [0.5, 0.7]},
    }
    fig = viz.ways(found, {"mean": 0.0, "spread": 1.0}, {"mean": "M", "spread": "S"}, "w")
    for axis, name, value in zip(fig.axes, ("mean", "spread"), (0.0, 1.0), strict=True):
        right, *rows = axis.lines
        assert set(right.get_xdata()) == {value} and axis.get_title() == name[0].upper()
        assert [row.get_xdata().tolist() for row in rows] == [
            found[way][name] for way in ("a", "b")
        ]
        assert [set(row.get_ydata()) for row in rows] == [{0}, {1}]
        low, high = axis.get_xlim()
        assert low <= value <= high and all(
            low <= x <= high for row in found.values() for x in row[name]
        )
    assert [label.get_text() for label in fig.axes[0].get_yticklabels()] == ["a", "b"]


def test_masks_have_joints_downwards_and_seconds_to_the_right():
    first, second = np.zeros((40, 21), bool), np.ones((40, 21), bool)
    first[:10, 3] = True
    fig = viz.masks({"a": first, "b": second}, "w", fps=20)
    for axis, mask in zip(fig.axes, (first, second), strict=True):
        (image,) = axis.images
        assert np.array_equal(np.asarray(image.get_array()), mask.T) and image.get_extent()[:2] == [
            0,
            2.0,
        ]
    low, high = fig.axes[0].get_ylim()
    assert low > high  # joint 0 on top


def test_given_frames_are_shaded_from_half_a_frame_before_to_half_a_frame_after():
    samples, line = RNG.normal(size=(3, 8)), np.arange(8.0)
    given = np.array([1, 1, 0, 0, 0, 1, 0, 1], bool)
    fig = viz.value_over_time(samples, {"the data": line}, given, "w", "height (m)", fps=10)
    (axis,) = fig.axes
    spans = [(patch.get_x(), patch.get_x() + patch.get_width()) for patch in axis.patches]
    np.testing.assert_allclose(spans, [(-0.05, 0.15), (0.45, 0.55), (0.65, 0.75)])
    *thin, named = axis.lines
    assert [row.get_ydata().tolist() for row in thin] == samples.tolist()
    assert named.get_ydata().tolist() == line.tolist() and named.get_label() == "the data"
    np.testing.assert_allclose(named.get_xdata(), np.arange(8) / 10)


def test_every_measure_over_gaps_names_its_own_lines():
    line = ((5, 60), (1.0, 300.0), (0.5, 200.0), (2.0, 400.0))
    fig = over_gaps(
        {"error": {"mean": line, "lines": line}, "sliding": {"the data": line}},
        "words",
        log=["error"],
    )
    error, sliding = fig.axes
    assert (error.get_yscale(), sliding.get_yscale()) == ("log", "linear") and sliding.get_ylim()[
        0
    ] == 0
    assert [[text.get_text() for text in axis.get_legend().get_texts()] for axis in fig.axes] == [
        ["mean", "lines"],
        ["the data"],
    ]
    assert error.get_xticks().tolist() == [5, 60]


def test_repairs_stand_in_the_row_of_their_way_with_their_interval():
    fig = by_fault(
        {
            "arm": {"ours": (2.0, 1.0, 4.0), "mean": (9.0, 8.0, 10.0)},
            "leg": {"mean": (5.0, 4.0, 6.0)},
        },
        "",
        "cm",
    )
    arm, leg = fig.axes
    assert [label.get_text() for label in arm.get_yticklabels()] == [
        "ours",
        "mean",
    ] and not leg.get_yticklabels()[0].get_text()
    where = [
        [(float(one[0].get_xdata()[0]), int(one[0].get_ydata()[0])) for one in axis.containers]
        for axis in fig.axes
    ]
    assert where == [[(2.0, 0), (9.0, 1)], [(5.0, 1)]]
    segments = [one[2][0].get_segments()[0][:, 0].tolist() for one in arm.containers]
    assert segments == [[1.0, 4.0], [8.0, 10.0]]
