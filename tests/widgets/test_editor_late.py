"""The editor where Python answers late, out of order or not at all: presses and drags add up.

The answers are held until a test lets them go, so that no test depends on how fast the machine is.
"""

import numpy as np
import pytest
from browser import SPOKEN, open_page
from editor_page import guess, open_editor, received, settled
from synthetic_walk import walk

from motiondiff_edu.motion.skeleton import joint_index
from motiondiff_edu.viz.body import Camera, project
from motiondiff_edu.widgets.editor import Editor

T, FRAME = 31, 12
HAND = joint_index("LeftHand")
FIGURE = "canvas:not(.mde-lane)"


@pytest.fixture
def editor():
    return Editor(walk(frames=T, turn=0.5)[0], guess)


@pytest.fixture
def page(browser, tmp_path, editor):
    """The editor at a pinned frame with the left hand chosen."""
    editor.pin(FRAME)
    editor.frame = FRAME
    with open_page(browser, viewport={"width": 1100, "height": 800}) as page:
        open_editor(page, tmp_path, editor)
        page.get_by_label("Joint to move").select_option("LeftHand")
        # presses come in quick succession, however slow the machine is
        page.evaluate("() => { performance.now = () => 1000; }")
        page.locator(FIGURE).focus()
        yield page
        assert page.problems == []


def press(page, *keys) -> None:
    for key in keys:
        page.keyboard.press(key)


def said(page) -> str:
    return page.locator(".mde-say").inner_text()


def moved(editor, poses=None) -> float:
    """How far the left hand is from where it was, in cm."""
    poses = editor.positions if poses is None else poses
    return 100 * np.linalg.norm(poses[FRAME, HAND] - editor.edit.motion[FRAME, HAND])


UP = "Shift+ArrowUp"  # 5 cm


@pytest.mark.parametrize("delay", [300, 1000])
def test_four_presses_are_twenty_centimetres_however_late_the_answers(page, editor, delay):
    page.evaluate(f"delay = {delay}")
    press(page, UP, UP, UP, UP)
    page.get_by_text("LeftHand in frame 12 moved by 20 cm.").wait_for()
    press(page, UP, "g")
    page.wait_for_function("model.get('state').made === 3")
    assert moved(editor) == moved(editor, editor.samples[0]) == pytest.approx(25)


def test_what_was_pressed_before_generate_is_in_what_is_made(page, editor):
    page.evaluate("holding = true")
    press(page, UP, UP, UP, UP, "g")
    received(page)
    assert moved(editor, editor.samples[0]) == pytest.approx(20)
    page.evaluate("letGo()")
    settled(page)
    assert moved(editor) == pytest.approx(20) and editor.state["undo"] == 3  # pinned, dragged, made


def test_lost_answers_lose_no_press(page, editor):
    page.evaluate("take = () => {}")
    press(page, UP, UP, UP, UP)
    page.wait_for_function("Math.hypot(...asked.at(-1).by) > 0.199")
    received(page)
    assert moved(editor) == pytest.approx(20)


def test_an_answer_that_was_overtaken_takes_nothing_back(page, editor):
    page.evaluate("holding = true")
    press(page, UP)
    received(page)
    press(page, UP)
    page.wait_for_function("held.length === 2")  # the second goes although no answer came
    page.evaluate("holding = false; held.reverse().forEach(take)")
    assert said(page) == "LeftHand in frame 12 moved by 10 cm."
    page.locator(FIGURE).focus()
    press(page, UP)
    settled(page)
    assert moved(editor) == pytest.approx(15)


def test_an_undo_among_the_presses_takes_back_those_before_it(page, editor):
    page.evaluate("holding = true")
    press(page, UP, UP, UP, "z", UP, UP)
    page.evaluate("letGo()")
    page.wait_for_function("Math.hypot(...asked.at(-1).by || []) > 0.099")
    settled(page)
    assert moved(editor) == pytest.approx(10) and editor.state["undo"] == 2
    press(page, "z")
    settled(page)
    assert moved(editor) == 0


def test_a_reset_among_the_presses_takes_back_all(page, editor):
    page.evaluate("holding = true")
    press(page, UP, UP, UP, "r")
    page.evaluate("letGo()")
    settled(page)
    assert np.array_equal(editor.positions, editor.edit.motion) and not editor.known.any()
    assert page.locator(".mde-editor").get_attribute("data-pins") == ""
    press(page, "z")
    settled(page)
    assert moved(editor) == pytest.approx(15)


def test_going_to_another_frame_and_back_loses_nothing(page, editor):
    page.evaluate("holding = true")
    press(page, UP, UP, ".", ",", UP, UP)
    page.evaluate("letGo()")
    page.wait_for_function("asked.length > 1 && Math.hypot(...asked.at(-1).by) > 0.099")
    settled(page)
    assert moved(editor) == pytest.approx(20)
    others = np.delete(editor.positions - editor.edit.motion, FRAME, 0)
    assert not others.any()


def test_a_press_back_counts_from_where_the_hand_is_and_not_from_out_of_reach(page, editor):
    press(page, *[UP] * 30)  # further than the arm reaches
    settled(page)
    top = editor.positions[FRAME, HAND]
    press(page, "Shift+ArrowDown")
    settled(page)
    assert 100 * np.linalg.norm(editor.positions[FRAME, HAND] - top) == pytest.approx(5, abs=0.1)


def test_a_frame_can_be_pinned_and_edited_before_the_answer_comes(page, editor):
    page.evaluate("holding = true")
    press(page, "Enter", "Enter", UP, UP)  # let go, pinned again
    page.evaluate("letGo()")
    page.wait_for_function("Math.hypot(...asked.at(-1).by || []) > 0.099")
    settled(page)
    assert editor.state["pins"] == [FRAME] and moved(editor) == pytest.approx(10)


def test_a_second_drag_of_the_mouse_adds_to_the_first(page, editor):
    box = page.locator(FIGURE).bounding_box()
    around = editor.positions[FRAME - 10 : FRAME + 11, 0].mean(0)
    camera = Camera(x=around[0], z=around[2], distance=5 / 1.1)

    def on_screen():
        size = (box["width"], box["height"])
        pixel, _ = project(editor.positions[FRAME, HAND][None], camera, size)
        return box["x"] + pixel[0, 0], box["y"] + pixel[0, 1]

    x, y = on_screen()
    page.evaluate("holding = true")
    for _ in range(2):  # the hand is still seen where it was
        page.mouse.move(x, y)
        page.mouse.down()
        page.mouse.move(x + 6, y - 20, steps=3)
        page.mouse.move(x + 11, y - 31, steps=3)
        page.mouse.up()
    page.evaluate("letGo()")
    page.wait_for_function("new Set(asked.map((a) => a.grip)).size === 2")
    settled(page)
    assert editor.state["undo"] == 3
    assert on_screen() == pytest.approx((x + 22, y - 62), abs=1.5)


def test_what_is_chosen_on_the_page_comes_with_the_wish(page, editor):
    editor.pin(0, 30)
    page.evaluate("() => { model.save_changes = () => {}; }")  # what was set comes later
    page.get_by_label("Number of in-betweens").select_option("5")
    page.get_by_label("Resampling").select_option("7")
    page.locator(FIGURE).focus()
    press(page, "g")
    settled(page)
    assert len(editor.samples) == 5 and editor.resample == 7
    press(page, "Home", ".", "]", "]", "Enter")
    settled(page)
    assert np.array_equal(editor.positions[1], editor.samples[2, 1])


# What JupyterLab does once the kernel is gone.
LOST = "() => { model.send = () => { throw new Error('Cannot send'); }; }"


def test_without_its_kernel_the_page_says_what_to_do_and_keeps_what_is_shown(page, editor):
    press(page, UP)
    settled(page)
    page.evaluate(LOST)
    page.get_by_role("button", name="Generate").click()
    assert "kernel is gone. Your changes are still shown here" in said(page)
    assert "Restart the kernel" in said(page)
    assert page.get_by_role("button", name="Generate").get_attribute("aria-disabled") == "false"
    assert page.locator(".mde-editor").get_attribute("data-pins") == str(FRAME)
    page.locator(FIGURE).focus()
    for key in ("Enter", UP, "z", "r"):
        page.evaluate("document.querySelector('.mde-say').textContent = ''")
        press(page, key)
        assert "kernel is gone" in said(page), key


def test_a_kernel_that_dies_while_it_generates_is_missed(browser, tmp_path, editor):
    editor.pin(0, 30)
    with open_page(browser) as page:
        page.clock.install()
        open_editor(page, tmp_path, editor)
        page.evaluate("window.kernel = () => {}")
        page.get_by_role("button", name="Generate").click()
        page.evaluate("take({ busy: true })")
        page.evaluate(SPOKEN)
        page.clock.run_for(60_000)
        assert "Making 3 in-betweens" in said(page), "it may take its time"
        assert 5 <= page.evaluate("spoken.length") <= 7, "told every ten seconds"
        page.evaluate(LOST)
        page.clock.run_for(6_000)
        assert "kernel is gone" in said(page)
        assert page.locator(".mde-main").inner_text() == "Generate" and page.problems == []


def test_undo_waits_while_in_betweens_are_made(browser, tmp_path, editor):
    """Else the finished in-betweens would be undone as soon as they come."""
    editor.pin(0, 30)
    with open_page(browser) as page:
        open_editor(page, tmp_path, editor)
        page.evaluate("window.kernel = () => {}")
        page.get_by_role("button", name="Generate").click()
        page.evaluate("take({ busy: true })")
        undo = page.get_by_role("button", name="Undo")
        assert undo.get_attribute("aria-disabled") == "true"
        page.locator(FIGURE).focus()
        page.keyboard.press("z")
        assert "Undo when it is done" in said(page)
        assert "undo" not in [one["do"] for one in page.evaluate("asked")]
        page.evaluate("take({ busy: false })")
        assert page.problems == []


def test_shift_and_enter_pin_nothing(browser, tmp_path, editor):
    """In a notebook they run the cell."""
    with open_page(browser) as page:
        open_editor(page, tmp_path, editor)
        page.locator(FIGURE).focus()
        page.keyboard.press("Shift+Enter")
        page.keyboard.press("Enter")
        settled(page)
        assert [one["do"] for one in page.evaluate("asked")].count("toggle") == 1
