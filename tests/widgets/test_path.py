"""The path pad: traits in Python, and drawing by mouse and keyboard in a browser."""

import numpy as np
import pytest
import traitlets
from browser import SPOKEN, bare_page, ink, open_page

from motiondiff_edu.conditions.drawn_path import PRESETS, path_to_control, preset
from motiondiff_edu.motion.root_frame import root_path
from motiondiff_edu.widgets.path import MODULE, PathPad


def test_a_new_pad_holds_a_ready_made_path_and_its_control_walks_it():
    pad = PathPad(speed=1)
    assert np.allclose(pad.points, preset("slalom")[0], atol=1e-4)
    walked, _ = root_path(pad.control())
    assert np.linalg.norm(walked[-1] - pad.points[-1]) < 1e-3


def test_presets_bring_their_stops_and_drawing_takes_them_away():
    pad = PathPad(preset="stop and go")
    assert pad.stops == [2.5, 5.0]
    assert np.array_equal(pad.control(), path_to_control(pad.points, 1.2, stops=[2.5, 5.0]))
    pad.points = [[0, 0], [1, 2]]
    assert (pad.stops, pad.preset) == ([], "")
    assert pad.points.shape == (2, 2)


def test_the_pad_says_how_long_the_walk_takes():
    pad = PathPad(preset="stop and go")
    assert pad.seconds == len(pad.control()) / 20 > 7.5 / 1.2 + 3
    pad.speed = 2.4
    assert pad.seconds == len(pad.control()) / 20
    pad.points = np.zeros((0, 2))
    assert pad.seconds == 0


def test_changes_are_told_once_each():
    pad, told = PathPad(), []
    pad.on_change(lambda p: told.append((len(p.line), p.speed)))
    pad.points = np.zeros((3, 2))
    pad.speed = 2.0
    pad.preset = "circle"
    assert told == [(3, 1.2), (3, 2.0), (81, 2.0)]
    pad.preset = "stop and go"  # path and stops change together
    assert len(told) == 4
    pad.stops = [1.0]
    pad.stops = [1.0]
    assert len(told) == 5


def test_what_cannot_be_a_path_is_refused():
    pad = PathPad()
    with pytest.raises(
        ValueError, match=r"\(n, 2\) finite numbers \[x, z\] in metres, not shape \(4, 3\)"
    ):
        pad.points = np.zeros((4, 3))
    with pytest.raises(traitlets.TraitError, match="moonwalk.*figure eight"):
        pad.preset = "moonwalk"
    with pytest.raises(ValueError, match="at least two points"):
        PathPad(points=np.zeros((0, 2))).control()


def test_the_still_picture_has_words():
    bundle, _ = PathPad(preset="circle")._repr_mimebundle_()
    assert 'alt="A path seen from above: 81 points' in bundle["text/html"]
    assert {"image/png", "application/vnd.jupyter.widget-view+json"} <= set(bundle)


@pytest.fixture
def page(browser, tmp_path):
    pad = PathPad(preset="straight")
    record = {
        name: getattr(pad, name)
        for name in ("start", "line", "stops", "speed", "preset", "presets", "height", "seconds")
    }
    with open_page(browser, viewport={"width": 700, "height": 620}) as page:
        page.goto(bare_page(tmp_path, MODULE, record, []))
        yield page
        assert page.problems == []


def test_drawing_with_the_mouse_starts_at_the_origin(page):
    canvas = page.locator("canvas")
    first, box = ink(canvas), canvas.bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.evaluate(SPOKEN)
    page.mouse.down()
    for step in range(1, 9):
        page.mouse.move(x - 10 * step, y - 12 * step)
    page.wait_for_function(
        "document.querySelector('.mde-pad canvas').getAttribute('aria-label').endsWith(' m')"
    )
    assert page.evaluate("spoken") == [], "the length is told at rest"
    assert page.evaluate("saved.length") == 0, "Python is told when the pen is lifted"
    page.mouse.up()
    line = np.array(page.evaluate("saved.at(-1).line"))
    assert page.evaluate("spoken.length") == 1
    assert page.evaluate("saved.at(-1).preset") == "" and len(line) >= 8
    assert np.array_equal(line[0], [0, 0])
    assert (np.diff(line[1:, 0]) > 0).all() and (np.diff(line[1:, 1]) > 0).all(), (
        "left is x, up is z"
    )
    assert ink(canvas) != first


def test_only_the_first_button_and_the_first_finger_draw(page):
    canvas = page.locator("canvas")
    first, box = ink(canvas), canvas.bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    for button in ("right", "middle"):
        page.mouse.move(x, y)
        page.mouse.down(button=button)
        page.mouse.move(x - 60, y - 80, steps=3)
        page.mouse.up(button=button)
    finger = {"isPrimary": False, "clientX": box["x"] + 9, "clientY": box["y"] + 9}
    canvas.dispatch_event("pointerdown", finger)
    assert page.evaluate("saved.length") == 0 and ink(canvas) == first
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x - 20, y - 20)
    canvas.dispatch_event("pointermove", finger)
    canvas.dispatch_event("pointerup", finger)
    assert page.evaluate("saved.length") == 0, "the pen is still down"
    page.mouse.move(x - 40, y - 40)
    page.mouse.up()
    assert len(page.evaluate("saved.at(-1).line")) == 4, "the start, and where the pen was"


def test_a_stroke_that_the_browser_takes_away_leaves_the_path_as_it_was(page):
    canvas = page.locator("canvas")
    first, box = ink(canvas), canvas.bounding_box()
    page.mouse.move(box["x"] + 200, box["y"] + 200)
    page.mouse.down()
    page.mouse.move(box["x"] + 150, box["y"] + 150, steps=3)
    assert ink(canvas) != first
    canvas.dispatch_event("pointercancel", {"isPrimary": True})
    page.mouse.up()
    assert page.evaluate("saved.length") == 0 and ink(canvas) == first


def test_drawing_on_from_the_end_continues_the_path(page):
    canvas = page.locator("canvas")
    canvas.focus()
    for key in ("c", "ArrowUp", "ArrowUp"):
        page.keyboard.press(key)
    box = canvas.bounding_box()
    scale = min(
        box["width"] / 8, box["height"] / 9
    )  # metres shown: 8 across, 9 up, the middle at z = 2.5
    x = box["x"] + box["width"] / 2
    y = box["y"] + box["height"] / 2 + (2.5 - 1.0) * scale
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x - scale, y - scale, steps=4)
    page.mouse.up()
    line = np.array(page.evaluate("saved.at(-1).line"))
    assert np.allclose(line[:3], [[0, 0], [0, 0.5], [0, 1]])
    assert np.allclose(line[-1], [1, 2], atol=0.05)


def test_keyboard_draws_undoes_clears_and_resets_without_leaking(page):
    canvas = page.locator("canvas")
    canvas.focus()
    page.keyboard.press("c")
    assert page.evaluate("saved.at(-1).line") == []
    for key in ("ArrowUp", "ArrowLeft", "ArrowRight", "ArrowDown"):
        page.keyboard.press(key)
    expected = [[0, 0], [0, 0.5], [0.5, 0.5], [0, 0.5], [0, 0]]
    assert page.evaluate("saved.at(-1).line") == expected
    page.keyboard.press("Backspace")
    assert page.evaluate("saved.at(-1).line") == expected[:-1]
    page.keyboard.press("r")
    assert page.evaluate("[saved.at(-1).preset, saved.at(-1).line]") == [
        "straight",
        [[0, 0], [0, 8]],
    ]
    assert page.evaluate("leaked") == 0


def test_reset_goes_back_to_what_python_gave_in_a_view_that_was_made_later_too(page):
    page.locator("canvas").focus()
    for key in ("c", "ArrowUp", "ArrowUp"):
        page.keyboard.press(key)
    page.evaluate("() => { cleanup(); another(); }")
    page.get_by_role("button", name="Reset").click()
    assert page.evaluate("[saved.at(-1).preset, saved.at(-1).line]") == [
        "straight",
        [[0, 0], [0, 8]],
    ]


def test_what_the_page_draws_is_not_where_reset_leads():
    pad = PathPad(preset="straight")
    pad.set_state({"preset": "circle", "speed": 2.0})
    assert len(pad.line) == 81 and len(pad.start["line"]) == 2
    assert pad.start["preset"] == "straight" and pad.start.get("speed", 1.2) == 1.2
    pad.points = [[0, 0], [1, 2]]
    assert (pad.start["preset"], pad.start["line"]) == ("", [[0, 0], [1, 2]])


NOBODY = "kernel does not answer"


def test_a_kernel_that_is_gone_or_silent_is_told_until_it_answers(page):
    words = page.locator(".mde-pad").inner_text
    page.clock.install()
    page.get_by_label("Ready-made path").select_option("circle")
    page.clock.run_for(4_000)
    assert NOBODY not in words(), "it may take its time"
    page.clock.run_for(2_000)
    assert NOBODY in words()
    page.evaluate("answer({ do: 'heard' })")
    assert NOBODY not in words()
    page.get_by_label("Ready-made path").select_option("straight")
    page.evaluate("answer({ do: 'heard' })")
    page.clock.run_for(60_000)
    assert NOBODY not in words()
    page.evaluate("lost = true")
    page.get_by_role("button", name="Clear").click()
    assert NOBODY in words(), "at once: nothing can be sent"


def test_python_answers_the_pads_question_whether_it_is_there(monkeypatch):
    pad, said = PathPad(), []
    monkeypatch.setattr(pad, "send", said.append)
    pad._handle_custom_msg({"do": "ping"}, [])
    assert said == [{"do": "heard"}]


def test_presets_and_speed_are_told_and_python_can_draw(page):
    page.get_by_label("Ready-made path").select_option("circle")
    assert page.evaluate("saved.at(-1).preset") == "circle"
    assert page.get_by_label("Ready-made path").locator("option").count() == len(PRESETS) + 1
    speed = page.get_by_label("Speed in metres a second")
    speed.focus()
    page.keyboard.press("ArrowRight")
    assert (
        page.evaluate("saved.at(-1).speed") == 1.3
        and "1.3 m/s" in page.locator(".mde-pad").inner_text()
    )
    first = ink(page.locator("canvas"))
    page.evaluate("model.set('line', [[0, 0], [2, 2], [2, 4]])")
    assert ink(page.locator("canvas")) != first
    assert page.locator(".mde-pad").get_attribute("data-points") == "3"
