"""A few states of a figure for pages: how many, which, and only when pages are made."""

import pytest

from motiondiff_edu.viz.noise import lines
from motiondiff_edu.widgets import states
from motiondiff_edu.widgets.explore import explore


def bundle(box) -> dict:
    live = box._repr_mimebundle_()
    return live[0] if isinstance(live, tuple) else live


def figure(s, name="a"):
    return lines([0, 1], {"a": [s, s]}, f"{name} at <{s}>", ("x", "y"))


def test_without_pages_nothing_is_drawn_twice(monkeypatch):
    monkeypatch.delenv("MOTIONDIFF_PAGES", raising=False)
    drawn = []
    box = explore(lambda s: drawn.append(s) or figure(s), s=(1, 9, 5))
    assert drawn == [5] and "text/html" not in bundle(box)


def test_with_pages_each_state_is_drawn_and_the_start_is_shown(monkeypatch):
    monkeypatch.setenv("MOTIONDIFF_PAGES", "1")
    still = bundle(explore(figure, s=(1, 9, 5), name=["a", "b"]))["text/html"]
    assert still.count("data-state=") <= states.MOST and still.count("<select>") == 2
    assert still.count(" hidden>") == still.count("data-state=") - 1
    assert "b at &lt;9&gt;" in still and "<script>" in still


LATE = {"s": 2.0, "on": True, "k": "h"}


@pytest.mark.parametrize(
    "choices, start",
    [
        ({"s": list(range(1, 10)), "name": ["a", "b", "c"]}, {"s": 4, "name": "c"}),
        ({"s": list(range(100))}, {"s": 41}),
        (
            {"s": [1.0, 2.0], "on": [False, True], "k": list("abcdefgh")},
            {"s": 2.0, "on": True, "k": "h"},
        ),
    ],
)
def test_few_states_keep_the_start_and_both_ends(choices, start):
    kept = states.few(choices, start)
    count = 1
    for name, values in kept.items():
        count *= len(values)
        assert start[name] in values and values == [v for v in choices[name] if v in values]
    assert states.MOST / 3 < count <= states.MOST
