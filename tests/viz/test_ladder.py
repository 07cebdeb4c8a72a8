"""The picture of the ladder: a row per recipe, a dot per training, one scale for each measure."""

from motiondiff_edu.viz.walks import Rung, ladder

NAN = float("nan")
RUNGS = [
    Rung("ours", "our recipe", {"bones, cm": (0.4, 0.5, 0.9), "ratio": (1.1, 1.0, 1.2)}),
    Rung("no gates", "our recipe", {"bones, cm": (0.8, NAN, 0.7), "ratio": (1.0,)}),
    Rung("printed", "the printed recipe", {"bones, cm": (90.0, 110.0, None)}),
]


def test_every_seed_is_a_dot_and_the_first_row_of_a_group_a_line():
    fig = ladder(RUNGS, ["bones, cm", "ratio"], "words")
    bones, ratio = fig.axes
    dots = [line for line in bones.lines if line.get_linestyle() == "None"]
    assert [list(line.get_xdata()) for line in dots] == [[0.4, 0.5, 0.9], [0.8, 0.7], [90.0, 110.0]]
    assert [set(line.get_ydata()) for line in dots] == [{0}, {1}, {2}]
    lines = [line for line in bones.lines if line.get_linestyle() == "--"]
    assert [line.get_xdata()[0] for line in lines] == [0.6, 100.0]
    assert [label.get_text() for label in bones.get_yticklabels()] == [
        "ours",
        "no gates",
        "printed",
    ]
    assert (bones.get_xscale(), ratio.get_xscale()) == ("log", "linear")


def test_its_ticks_are_plain_numbers():
    fig = ladder(RUNGS, ["bones, cm"], "words")
    fig.draw_without_rendering()
    ticks = [label.get_text() for label in fig.axes[0].get_xticklabels()]
    assert "10" in ticks and not any("$" in tick or "times" in tick for tick in ticks)
