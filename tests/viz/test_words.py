"""Plots of words: what is drawn where."""

import numpy as np

from motiondiff_edu.beyond.timeline import TO_COME, Timed, timeline
from motiondiff_edu.viz import words as viz
from motiondiff_edu.viz.style import caption


def test_attention_over_words_has_a_column_for_each_word_and_time_runs_down():
    maps = {"left": np.eye(3)[[0, 0, 1, 2]], "right": np.full((4, 2), 0.5)}
    fig = viz.words_over_time(maps, [("kick", "left", "foot"), ("bow", "low")], 2.0, "Two maps.")
    first, second, *_ = fig.axes
    assert [text.get_text() for text in first.get_xticklabels()] == ["kick", "left", "foot"]
    assert [text.get_text() for text in second.get_xticklabels()] == ["bow", "low"]
    assert first.get_ylim() == (2.0, 0.0) and caption(fig) == "Two maps."
    drawn = first.images[0]
    np.testing.assert_array_equal(drawn.get_array(), maps["left"])
    assert drawn.get_clim() == second.images[0].get_clim() == (0, 1)


def test_what_was_asked_stands_in_rows_with_its_numbers():
    table = np.array([[9, 1, 0], [2, 2, 4]])
    fig = viz.asked_and_shown(table, ("one", "two"), ("0", "1", "2"), "A table.")
    (axis,) = fig.axes
    written = {text.get_position(): text.get_text() for text in axis.texts}
    assert written[0, 0] == "9" and written[2, 1] == "4" and len(written) == 6
    np.testing.assert_allclose(axis.images[0].get_array()[1], [0.25, 0.25, 0.5])
    assert [text.get_text() for text in axis.get_yticklabels()] == ["one", "two"]


def test_a_timeline_shows_its_verbs_what_is_to_come_and_each_time():
    plan = timeline([Timed("kick", "left", 2, 1.0, 3.0), Timed("clap", "", 3, 0.5, 2.0)], 80)
    fig = viz.timelines({"both at once": plan, "again": plan}, "Two timelines.")
    first, second = fig.axes
    assert [text.get_text() for text in first.texts] == ["kick", "clap"]
    kick, clap = (text.get_position() for text in first.texts)
    assert kick[0] == 2.0 and clap[0] == 1.25 and clap[1] < kick[1]
    legs, arms = first.lines
    np.testing.assert_array_equal(legs.get_ydata(), plan[:, TO_COME])
    np.testing.assert_array_equal(arms.get_ydata(), plan[:, TO_COME + 1])
    assert legs.get_xdata()[-1] == 79 / 20 and len(first.collections) == 2
    assert first.get_title("left") == "both at once" and not second.get_legend()
