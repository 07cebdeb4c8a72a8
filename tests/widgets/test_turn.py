"""Two messages of a page, answered by two threads of the kernel: the second waits."""

import threading
import time
import warnings
from dataclasses import replace

import numpy as np
import pytest
import small_movers
from editor_page import guess
from synthetic_walk import walk

from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.performers.mover import Mover
from motiondiff_edu.viz.noise import lines
from motiondiff_edu.widgets.action import Action
from motiondiff_edu.widgets.bench import Bench
from motiondiff_edu.widgets.controls import Controls, steering
from motiondiff_edu.widgets.editor import Editor
from motiondiff_edu.widgets.explore import explore
from motiondiff_edu.widgets.prompt import Prompt

SMALL = replace(small_movers.SMALL, S=4)
AT_LEAST = 0.3  # seconds in which a second thread would have begun, if it did not wait


class Work:
    """What a callback calls: says that it began, and goes on when it is let."""

    def __init__(self, real):
        self.real, self.calls = real, 0
        self.begun, self.again, self.go_on = (threading.Event() for _ in range(3))

    def __call__(self, *given, **named):
        self.calls += 1
        (self.begun if self.calls == 1 else self.again).set()
        assert self.go_on.wait(60)
        return self.real(*given, **named)


def both(work: Work, first, second) -> None:
    """Two callbacks in two threads, the second while the first is at work."""
    threads = [threading.Thread(target=one) for one in (first, second)]
    threads[0].start()
    assert work.begun.wait(60)
    threads[1].start()
    overlapped = work.again.wait(AT_LEAST)
    work.go_on.set()
    for thread in threads:
        thread.join(60)
        assert not thread.is_alive()
    assert not overlapped, "two callbacks of a widget ran at once"


@pytest.fixture
def mover() -> Mover:
    return small_movers.mover_of(SMALL, Scaler.nothing(SMALL.D))


def test_two_sentences_are_acted_one_after_the_other(mover, monkeypatch):
    box = Prompt(mover, "walks", seconds=2.0)
    work = Work(Mover.act)
    monkeypatch.setattr(Mover, "act", lambda *a, **k: work(*a, **k))

    def asks(name, value):
        return lambda: setattr(getattr(box, name), "value", value)

    both(work, asks("seed", 7), asks("text", "marches ahead"))
    assert (box.seed.value, box.text.value) == (7, "marches ahead")
    assert "is read as &#x27;walk&#x27;" in box.message.value and not box.button.disabled
    monkeypatch.undo()
    wanted = mover.act("walks ahead", seconds=2.0, samples=4, seed=7, progress=False)
    np.testing.assert_array_equal(box.motions[3].positions, wanted[3].positions)


def test_what_a_cell_does_with_warnings_hides_no_note(mover, monkeypatch):
    box = Prompt(mover, "walks", seconds=2.0)
    monkeypatch.setattr(warnings, "warn", lambda *a, **k: None)
    box.text.value = "marches ahead"
    assert "is read as" in box.message.value


def test_a_figure_is_drawn_when_the_one_before_is_done():
    work = Work(lambda s, t: lines([0, 1], {"a": [s, t]}, "", ("x", "y")))
    work.go_on.set()
    box = explore(work, s=(1, 9, 5), t=(1, 9, 5))
    work.__init__(work.real)
    s, t, _ = box.children[0].children
    both(work, lambda: setattr(s, "value", 7), lambda: setattr(t, "value", 2))
    assert work.calls == 2


def test_of_sliders_that_are_moved_while_one_is_answered_the_last_values_are_made():
    made = []
    work = Work(lambda speed: made.append(speed))
    controls = Controls(work, {"speed": (0, 9, 4)})
    slider = controls.controls["speed"]
    more = []

    def twice():
        for value in (2, 3):  # both wait
            more.append(threading.Thread(target=setattr, args=(slider, "value", value)))
            more[-1].start()
            while slider.value != value or controls._changes < value:
                time.sleep(0.001)

    both(work, lambda: setattr(slider, "value", 7), twice)
    for thread in more:
        thread.join(60)
    assert made == [7, 3] and slider.value == 3


def test_the_first_call_of_sliders_waits_for_its_turn():
    work = Work(lambda **values: None)
    both(work, lambda: steering(work, a=(0, 9, 4)), lambda: steering(work, a=(0, 9, 5)))
    assert work.calls == 2


def test_two_buttons_act_one_after_the_other():
    work = Work(lambda: "done")
    actions = [Action("Go", work, "going ...") for _ in range(2)]
    both(work, actions[0].button.click, actions[1].button.click)
    assert work.calls == 2 and [one.said.value for one in actions] == ["done", "done"]


def test_a_press_while_the_editor_generates_is_added_to_its_result():
    work = Work(guess)
    editor = Editor(walk(frames=31, turn=0.5)[0], work)
    editor.pin(3)

    def press(number, **content):
        return lambda: editor._receive(editor, {"number": number, **content}, [])

    pinned = threading.Event()

    def second():
        press(2, do="toggle", frame=9)()
        pinned.set()

    first = threading.Thread(target=press(1, do="generate", after=0))
    first.start()
    assert work.begun.wait(60)
    other = threading.Thread(target=second)
    other.start()
    early = pinned.wait(AT_LEAST)
    press(3, do="ping")()  # answered at once: the page only asks whether the kernel is there
    work.go_on.set()
    first.join(60)
    other.join(60)
    assert not early, "the press did not wait"
    assert editor.samples is not None and set(editor.edit.pins) == {3, 9}
    assert editor.state["received"] == 2


def test_the_bench_repairs_once_at_a_time(monkeypatch):
    work = Work(lambda self: None)
    monkeypatch.setattr(Bench, "repair", lambda self: work(self))
    bench = Bench.__new__(Bench)
    both(work, lambda: bench._answer({"new": 1}), lambda: bench._answer({"new": 2}))
    assert work.calls == 2 and bench.answered == 2
