"""A button that says what it does, and widgets side by side."""

import ipywidgets
import pytest
from synthetic_walk import walk

from motiondiff_edu.widgets import action as action_module
from motiondiff_edu.widgets.action import UNSEEN, Action
from motiondiff_edu.widgets.controls import Controls, steering
from motiondiff_edu.widgets.path import PathPad
from motiondiff_edu.widgets.player import Player
from motiondiff_edu.widgets.still import Beside


def test_while_it_acts_it_says_so_and_cannot_be_pressed():
    seen = []

    def act():
        seen.append((action.button.disabled, action.said.value))
        return "done"

    action = Action("Go", act, "going ...")
    action.button.click()
    assert seen == [(True, "going ...")]
    assert not action.button.disabled and action.said.value == "done"


def test_an_error_is_said_and_raised_and_the_button_is_free_again():
    action = Action("Go", lambda: 1 / 0, "going ...")
    with pytest.raises(ZeroDivisionError):
        action.press()
    assert action.said.value == "ZeroDivisionError: division by zero"
    assert not action.button.disabled


def test_an_interrupt_is_said_too():
    def act():
        raise KeyboardInterrupt

    action = Action("Go", act, "going ...")
    with pytest.raises(KeyboardInterrupt):
        action.button.click()
    assert action.said.value == "stopped" and not action.button.disabled


def test_clicks_that_waited_for_the_answer_are_not_acted_on(monkeypatch):
    now, calls = [100.0], []
    monkeypatch.setattr(action_module.time, "monotonic", lambda: now[0])

    def act():
        calls.append(now[0])
        now[0] += 5.0
        return "done"

    action = Action("Go", act, "going ...")
    for _ in range(5):  # the kernel was busy: they come at once, one after the other
        action.button.click()
    assert calls == [100.0]
    now[0] += UNSEEN
    action.button.click()
    assert len(calls) == 2
    action.press()  # in a cell: it is meant each time
    assert len(calls) == 3


def test_what_is_beside_stands_between_the_button_and_the_words():
    dice = ipywidgets.IntText(3)
    action = Action("Go", str, "going ...", beside=(dice,))
    assert action.children == (action.button, dice, action.said)


def test_a_reset_calls_once_for_all_controls():
    seen = []
    controls = steering(lambda **values: seen.append(values), a=(0, 9, 4), b=[1, 2], c=True)
    for name, value in {"a": 7, "b": 2, "c": False}.items():
        controls.controls[name].value = value
    assert seen[0] == {"a": 4, "b": 1, "c": True} and len(seen) == 4
    controls.children[-1].click()
    assert seen[4:] == [seen[0]]


def test_after_an_error_a_reset_still_works():
    def act(a):
        if a == 9:
            raise RuntimeError("too large")

    controls = Controls(act, {"a": (0, 9, 4)})
    with pytest.raises(RuntimeError):
        controls.controls["a"].value = 9
    controls.children[-1].click()
    assert controls.values() == {"a": 4}


def test_sliders_are_wide_enough_to_be_set():
    controls = Controls(print, {"a": (0, 9, 4), "b": (0.0, 1.0, 0.5)})
    assert all(c.layout.min_width == "290px" for c in controls.controls.values())


def test_a_slider_has_whole_numbers_where_all_three_are_whole():
    controls = Controls(print, {"speed": (-0.5, 3.0, 1), "count": (0, 9, 4)}).controls
    assert (controls["speed"].min, controls["speed"].max) == (-0.5, 3.0)
    assert controls["speed"].step == pytest.approx(0.07) and controls["count"].step == 1


@pytest.mark.parametrize("start", [(0.0, 1.0, 5.0), (0, 9, -1), (9, 0, 4)])
def test_a_slider_that_cannot_start_there_is_refused(start):
    with pytest.raises(ValueError, match="speed cannot start at"):
        Controls(print, {"speed": start})


def test_side_by_side_shows_what_needs_no_kernel():
    player = Player(walk(frames=5)[0])
    box = Beside(ipywidgets.VBox([PathPad(height=300), ipywidgets.Button()]), player)
    shown = box._repr_mimebundle_()
    bundle = shown[0] if isinstance(shown, tuple) else shown
    assert bundle["text/html"].count('title="motion player"') == 1
    assert bundle["text/html"].count("<img alt=") == 2  # the pad's, and the player's poster


def test_side_by_side_of_controls_alone_has_no_still_picture():
    shown = Beside(ipywidgets.Button())._repr_mimebundle_()
    bundle = shown[0] if isinstance(shown, tuple) else shown
    assert "text/html" not in bundle
