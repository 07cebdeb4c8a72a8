"""Figures from plain arrays.

They hold what was given, carry a caption, and refuse what does not fit.
"""

import io

import numpy as np
import pytest
from matplotlib.colors import to_hex
from PIL import Image
from synthetic_walk import walk

from motiondiff_edu.viz import attention, body, curves, skeleton
from motiondiff_edu.viz.style import add_caption, caption


@pytest.fixture(scope="module")
def motion():
    return walk(frames=31, turn=0.4)


@pytest.fixture(scope="module")
def weights():
    scores = np.random.default_rng(3).random((2, 5, 11))
    return scores / scores.sum(-1, keepdims=True)


def polygons(axis) -> list[str]:
    return [to_hex(patch.get_facecolor()).upper() for patch in axis.patches]


def test_camera_sees_the_target_in_the_middle_up_is_up_and_ahead_is_to_the_right():
    camera = body.Camera(x=1.0, z=-2.0)
    points = np.array([[1.0, 0.86, -2.0], [1.0, 1.86, -2.0], [1.0, 0.86, -1.0], [0.0, 0.86, -2.0]])
    (middle, above, ahead, nearer), scale = body.project(points, camera, (300, 200))
    assert np.allclose(middle, [150, 100])
    assert above[1] < 100 and abs(above[0] - 150) < 1 and ahead[0] > 150
    assert scale[3] > scale[0], "the figure's right side faces the camera"
    assert np.isclose(scale[0], camera.focal * 200 / camera.distance)


def test_hull_is_convex_and_holds_every_point():
    points = np.random.default_rng(0).normal(size=(57, 2))
    polygon = body.hull(points)
    edges = np.roll(polygon, -1, 0) - polygon
    away = points[:, None] - polygon
    assert (edges[:, 0] * away[..., 1] - edges[:, 1] * away[..., 0] > -1e-9).all()


def test_nearer_limbs_are_painted_later(motion):
    drawn = body.body_polygons(motion[0][4], body.Camera().at(*motion[0][4, 0, [0, 2]]), (300, 400))
    outlines = [colour for _, colour, is_outline in drawn if is_outline]
    assert len(outlines) == len(body.BODY) and len(drawn) == 2 * len(outlines)
    assert outlines.index(body.RIGHT_COLOUR) > 5, (
        "the right side, nearest to the camera, comes late"
    )


def test_mixing_colours_ends_at_its_ends():
    assert body.mix("#0072B2", "#FFFFFF", 0.0) == "#0072B2"
    assert body.mix("#0072B2", "#FFFFFF", 1.0) == "#FFFFFF"


def test_pose_strip_has_n_poses_and_pales_the_past(motion):
    fig = skeleton.pose_strip(motion[0], n=5, past=16)
    assert len(fig.axes) == 5
    assert body.RIGHT_COLOUR not in polygons(fig.axes[0]) and body.RIGHT_COLOUR in polygons(
        fig.axes[4]
    )
    assert [axis.get_title() for axis in fig.axes] == ["0.0 s", "0.4 s", "0.8 s", "1.1 s", "1.5 s"]
    assert "up to 0.8 s, were given" in caption(fig)


def test_side_by_side_leaves_an_ended_motion_empty(motion):
    fig = skeleton.side_by_side([motion[0], motion[0][:14]], ["data", "walker"], n=3)
    assert [bool(axis.patches) for axis in fig.axes] == [True, True, True, True, False, False]
    assert "data, walker" in caption(fig)


def test_noise_to_motion_has_a_row_for_each_step_as_given(motion):
    poses = motion[0][:10]
    fig = skeleton.noise_to_motion({100: poses + 0.3, 7: poses, 0: poses}, "words", n=3)
    assert len(fig.axes) == 9
    assert [axis.get_title() for axis in fig.axes[:3]] == ["pose 1", "pose 5", "pose 10"]
    assert [fig.axes[3 * row].texts[0].get_text() for row in range(3)] == [
        "s = 100",
        "s = 7",
        "s = 0",
    ]
    first, last = (fig.axes[k].patches[-1].get_xy() for k in (3, 5))
    assert not np.allclose(first, last)  # other poses of the window


def test_top_view_puts_left_on_the_left():
    path = np.array([[0.0, 0.0], [1.0, 3.0]])
    (axis,) = skeleton.top_view(path).axes
    assert axis.get_xlim()[0] > axis.get_xlim()[1]
    assert np.array_equal(np.transpose(axis.lines[0].get_data()), path)


def test_attention_map_shows_the_weights_and_parts_the_groups(weights):
    fig = attention.attention_map(weights[0], [("past poses", 4), ("control", 7)], title="layer 2")
    assert np.array_equal(fig.axes[0].images[0].get_array(), weights[0])
    assert [line.get_xdata()[0] for line in fig.axes[0].lines] == [3.5]
    assert "5 queries over 11 keys" in caption(fig)


def test_labels_and_groups_that_do_not_fit_are_refused(weights):
    with pytest.raises(ValueError, match="groups have 10 keys, but the map has 11"):
        attention.attention_map(weights[0], [("past", 4), ("control", 6)])
    with pytest.raises(ValueError, match="3 query labels for 5 query positions"):
        attention.attention_map(weights[0], query_labels=["a", "b", "c"])
    assert sum(count for _, count in attention.modiff_groups(7, 3)) == 17


def test_running_mean_of_the_last_values():
    assert np.allclose(curves.running_mean(np.array([1.0, 3.0, 5.0, 9.0]), 2), [1, 2, 4, 7])


def test_curves_draw_what_was_given_in_different_dashes():
    x = np.arange(6.0)
    (axis,) = curves.loss_curves({"eps": (x, x + 1), "x0": (x, 2 * x + 1)}).axes
    assert np.array_equal(axis.lines[1].get_ydata(), 2 * x + 1)
    assert (
        len({line.get_linestyle() for line in axis.lines})
        == len({line.get_color() for line in axis.lines})
        == 2
    )
    assert axis.get_yscale() == "log"
    with pytest.raises(ValueError, match=r"curve 'v': x has shape \(6,\), y has \(5,\)"):
        curves.loss_curves({"v": (x, x[1:])})


def test_each_plot_of_a_control_has_its_numbers():
    control = np.random.default_rng(1).normal(size=(8, 3))
    axes = curves.control_curves({"held": control}, past=3).axes
    assert [
        np.array_equal(axis.lines[0].get_ydata(), control[:, k]) for k, axis in enumerate(axes)
    ] == [True] * 3


def test_a_figure_says_what_is_written_in_it():
    fig = curves.loss_curves({"walker": (np.arange(1.0, 6.0), np.arange(1.0, 6.0))})
    assert "walker" in fig._repr_mimebundle_()[1]["texts"]


def test_a_figure_shows_itself_with_its_caption_as_alternative_text():
    fig = add_caption(skeleton.top_view(np.array([[0.0, 0.0], [0.5, 2.0]])), 'a < b & "c"')
    bundle, more = fig._repr_mimebundle_()
    assert "texts" in more
    assert (
        'alt="a &lt; b &amp; &quot;c&quot;"' in bundle["text/html"]
        and "<figcaption" in bundle["text/html"]
    )
    assert Image.open(io.BytesIO(fig.as_png())).size == (620, 620)
