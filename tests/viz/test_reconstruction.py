"""Figures of repairs: no mark hides another, and what is to be judged stands free."""

import numpy as np

from data_synth.walking import walk
from motiondiff_edu.motion.skeleton import BONES, J
from motiondiff_edu.viz import repairs as viz
from motiondiff_edu.viz import walks

POSES = walk(np.tile([1.2, 0.0, 0.0], (7, 1)), seed=1).poses


def test_methods_with_the_same_figure_do_not_lie_on_each_other():
    fig = viz.faults_and_methods(
        {"cm": {"leg": dict.fromkeys(("a", "b", "ridge", "walker"), 4.0)}}, "words"
    )
    axis = fig.axes[0]
    fig.canvas.draw()
    heights = np.sort([axis.transData.transform(line.get_xydata()[0])[1] for line in axis.lines])
    mark = axis.lines[0].get_markersize() * fig.dpi / 72
    assert np.diff(heights).min() > mark


def test_a_level_is_named_where_no_point_can_lie():
    fig = viz.by_round(
        {"change": {"arm": [3.0, 0.2, 0.1]}}, "words", marks={"change": ("tolerance", 0.1)}
    )
    axis = fig.axes[0]
    assert [text.get_text() for text in axis.get_legend().texts] == [
        "arm",
        "tolerance",
    ] and not axis.texts


def test_the_repairs_have_a_row_of_their_own():
    known = np.ones((len(POSES), J), bool)
    known[3:] = False
    samples = {"mean": np.stack([POSES, POSES + 0.1])}
    fig = viz.with_ghosts({"truth": POSES, "mean": POSES}, samples, known, "words", frames=(0, 3))
    assert [len(axis.lines) for axis in fig.axes] == [0, 0, 0, 0, 0, 2 * len(BONES)]
    assert [axis.texts[0].get_text() for axis in fig.axes[::2]] == ["truth", "mean", "each of them"]


def test_a_table_has_as_many_digits_as_it_takes_to_tell_two_figures_apart():
    rows = {"a": {"cm": 14.17}, "b": {"cm": 13.79}}
    shown = [
        [text.get_text() for text in walks.score_table(rows, "words", **options).axes[0].texts]
        for options in ({}, {"digits": 3})
    ]
    assert shown == [["14", "14"], ["14.2", "13.8"]]
