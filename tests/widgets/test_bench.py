"""The repair bench: its logic and traits in Python, and knocking out, repairing and resetting in a
browser.

The walker of these tests goes on as the last pose was, but for noise: what it mends is known.
"""

import base64
import io
import threading
import time

import numpy as np
import pytest
import torch
import traitlets
from browser import bare_page, coloured, drawn, ink, open_page
from PIL import Image

from data_synth.walking import walk
from motiondiff_edu.editing.repair_bench import RepairBench
from motiondiff_edu.editing.repairs import sample_reconstructions
from motiondiff_edu.motion.root_frame import root_path, to_world
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.motion.skeleton import JOINTS, J
from motiondiff_edu.viz import body
from motiondiff_edu.widgets import packing, poster
from motiondiff_edu.widgets.bench import _BYTES, GHOST, HEARD, MODULE, Bench
from motiondiff_edu.widgets.live import TURN

T_H = 8
CLIP = walk(np.tile([1.2, 0.0, 0.6], (31, 1)), seed=6)
HAND = [t * J + JOINTS.index("RightHand") for t in range(T_H)]
ARM = np.ones((T_H, J), bool)
ARM[:, -4:] = False


class Standing:
    """Stays in its last pose, with noise of 5 mm drawn for each row of the batch."""

    class config:
        T_h = T_H
        T_p = T_H
        D = 63
        C = 3

    pose_scaler = Scaler(torch.from_numpy(CLIP.poses.mean(0)).float().flatten(), torch.ones(63))
    control_scaler = Scaler.nothing(3)

    def window_sampler(self, steps=None):
        def sample(past, control, generator):
            return past[:, -1:] + 0.005 * torch.randn(len(past), T_H, 63, generator=generator)

        return sample


def bench(**options) -> Bench:
    return Bench(
        Standing(),
        CLIP,
        **{"first": 9, "samples": 3, "rounds": 2, "faults": {"right arm": ARM}} | options,
    )


def by_the_library(first: int, missing: list[int]) -> np.ndarray:
    """The mean of the repairs, placed in the world, without the bench."""
    known = np.ones(T_H * J, bool)
    known[missing] = False
    known = known.reshape(T_H, J)
    past = CLIP.poses[first : first + T_H]
    control = CLIP.control[first : first + 2 * T_H]
    options = {"n": 3, "rounds": 2, "generator": torch.Generator().manual_seed(0)}
    *_, last = sample_reconstructions(
        Standing(), np.where(known[..., None], past, np.nan), known, control, **options
    )
    path, heading = root_path(CLIP.control)
    return to_world(last.mean, control[:T_H], (*path[first], heading[first]))


def shown(widget: Bench) -> list[np.ndarray]:
    """The repairs as the browser gets them."""
    told = packing.Packed(
        widget.mended_joints, widget.mended_roots, (T_H,) * widget.repaired["figures"], J
    )
    return packing.unpack(told)


def test_what_is_shown_is_what_the_library_mends_where_the_walk_is():
    widget = bench()
    widget.missing = HAND
    widget.repair()
    mean, *samples = shown(widget)
    assert len(samples) == 3
    np.testing.assert_allclose(mean, by_the_library(9, HAND), atol=6e-4)
    known = np.ones((T_H, J), bool)
    known.flat[HAND] = False
    truth = CLIP.world()[9 : 9 + T_H]
    for poses in (mean, *samples):
        np.testing.assert_allclose(poses[known], truth[known], atol=6e-4)
    assert widget.shows_repairs and widget.repaired["missing"] == HAND


def test_the_words_are_the_librarys_figures():
    outcomes = list(RepairBench(Standing(), CLIP, samples=3, rounds=2).mend(9, HAND))
    errors = outcomes[-1].mended.errors(CLIP.poses[9 : 9 + T_H])
    assert [o.words[:12] for o in outcomes] == ["Round 1 of 2", "Round 2 of 2"]
    assert f"{errors['their mean']:.1f} cm for the mean of 3 repairs" in outcomes[-1].words
    assert f"{errors['one repair']:.1f} cm for one repair" in outcomes[-1].words
    assert f"{T_H} of {T_H * J} joint positions were missing" in outcomes[-1].words


def test_asking_answers_and_says_what_cannot_be_done():
    widget = bench()
    widget.asked = 1  # nothing is knocked out
    assert widget.message == "Not repaired: nothing is missing, so there is nothing to repair."
    assert widget.answered == 1 and widget.repaired == {}
    widget.missing = list(range(T_H * J))
    widget.asked = 2
    assert "nothing is known, so the repair has no information" in widget.message
    assert widget.answered == 2
    widget.missing = HAND
    widget.asked = 3
    assert (
        widget.message.startswith("Round 2 of 2")
        and widget.repaired["edition"] == 1
        and widget.answered == 3
    )


def test_it_says_that_it_heard_and_repairs_what_is_missing_when_its_turn_has_come():
    widget = bench()
    with TURN:
        thread = threading.Thread(target=setattr, args=(widget, "asked", 1))
        thread.start()
        while not widget.message:
            time.sleep(0.001)
        assert widget.message == HEARD and widget.answered == 0
        widget.first = 3
        widget.missing = HAND
    thread.join(60)
    assert widget.repaired["first"] == 3 and widget.repaired["missing"] == HAND


def test_an_interrupted_repair_says_so(monkeypatch):
    def stop(*_):
        raise KeyboardInterrupt

    widget = bench()
    monkeypatch.setattr(Bench, "repair", stop)
    widget.asked = 1
    assert widget.message == "Not repaired: stopped." and widget.answered == 1


def test_a_walkers_failure_is_told_too(monkeypatch):
    widget = bench()
    widget.missing = HAND
    monkeypatch.setattr(Standing, "window_sampler", lambda self, steps: 1 / 0)
    widget.asked = 1
    assert "ZeroDivisionError" in widget.message and widget.answered == 1


def test_an_old_repair_no_longer_counts():
    widget = bench()
    widget.missing = HAND
    widget.repair()
    widget.missing = HAND[1:]
    assert (
        not widget.shows_repairs and "7 of 168 places of joints are missing." in widget.description
    )
    widget.missing = HAND
    assert widget.shows_repairs and "cm for one repair" in widget.description
    widget.first = 3
    assert not widget.shows_repairs


def test_wrong_inputs():
    with pytest.raises(ValueError, match="15 frames; the bench needs 16"):
        Bench(Standing(), CLIP.cut(0, 15))
    with pytest.raises(ValueError, match=r"the fault 'arm' is \(7, 21\)"):
        bench(faults={"arm": ARM[:7]})
    widget = bench()
    with pytest.raises(traitlets.TraitError, match="frame 0 to 15, not 16"):
        widget.first = 16
    with pytest.raises(traitlets.TraitError, match="entry 168 is outside the window's 168"):
        widget.missing = [168]
    with pytest.raises(ValueError, match="can begin at 0 to 15"):
        next(widget.bench.mend(16, HAND))


def test_the_still_picture_has_words_and_a_second_row_once_mended():
    widget = bench()
    height = widget.poster().height
    widget.missing = HAND
    widget.repair()
    assert widget.poster().height > 1.3 * height
    bundle, _ = widget._repr_mimebundle_()
    assert 'alt="A walk of 1.6 s. In the window, frames 9 to 16, 8 of 168' in bundle["text/html"]
    assert {"image/png", "application/vnd.jupyter.widget-view+json"} <= set(bundle)


def test_the_still_picture_shows_the_window_its_holes_and_the_repairs_against_the_truth(
    monkeypatch,
):
    strips = []
    drawn = poster.filmstrip
    monkeypatch.setattr(
        poster,
        "filmstrip",
        lambda *args, **options: strips.append(options) or drawn(*args, **options),
    )

    def near(picture, colour: str) -> int:
        wanted = np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)])
        # as it is shown, in few colours
        picture = Image.open(io.BytesIO(poster.as_png(picture))).convert("RGB")
        return int((np.abs(np.asarray(picture).astype(int) - wanted).sum(-1) < 60).sum())

    widget = bench()
    whole = widget.poster()
    assert strips[-1]["between"] == (9, 9 + T_H - 1)
    widget.missing = np.flatnonzero(~ARM).tolist()
    holes = widget.poster()
    # without words
    upper = [
        picture.crop((0, 30, picture.width, picture.height - 60)) for picture in (whole, holes)
    ]
    assert near(upper[1], body.INK) > near(upper[0], body.INK) + 100
    widget.repair()
    mended = widget.poster()
    # without the words below
    lower = mended.crop((0, mended.height // 2, mended.width, mended.height - 30))
    assert near(lower, GHOST) > 100 and near(lower, body.INK) > 100
    widget.first = 3  # moved: the repairs are old, and the strip shows the new window
    assert widget.poster().height < mended.height and strips[-1]["between"] == (3, 3 + T_H - 1)


def test_thin_limbs_are_those_with_a_missing_end():
    away = np.zeros((len(CLIP), J), bool)
    away[5, JOINTS.index("RightHand")] = True
    thin = poster.Thin(CLIP.world()[None], away, GHOST)
    plain, marked = (poster.Figure(CLIP.world(), thin=limbs) for limbs in ((), (thin,)))
    for t, differs in ((4, False), (5, True)):
        pictures = [np.asarray(poster.render(figure, t, (120, 200))) for figure in (plain, marked)]
        assert (pictures[0] != pictures[1]).any() == differs


STATE = ("scene", "start", "first", "missing", "repaired", "message", "asked", "answered")
SEND = """([state, binary]) => {
  const data = (s) => new DataView(Uint8Array.from(atob(s), (c) => c.charCodeAt(0)).buffer);
  for (const [name, value] of Object.entries(binary)) model.set(name, data(value));
  for (const [name, value] of Object.entries(state)) model.set(name, value);
}"""


class Table:
    """A page with a bench, and the widget behind it: `answer` does what the kernel does with what
    the page saved."""

    def __init__(self, page, widget):
        self.page, self.widget = page, widget
        self.figure = page.locator("canvas.mde-figure")
        self.map = page.locator("canvas.mde-lane")

    def saved(self, name: str):
        return self.page.evaluate(f"saved.at(-1).{name}")

    def data(self, name: str) -> str:
        return self.page.locator(".mde-bench").get_attribute(f"data-{name}")

    def note(self) -> str:
        return self.page.locator("output.mde-said").inner_text()

    def answer(self) -> None:
        for name in ("first", "missing", "asked"):
            setattr(self.widget, name, self.saved(name))
        binary = {
            name: base64.b64encode(getattr(self.widget, name)).decode()
            for name in ("mended_joints", "mended_roots")
        }
        state = {name: getattr(self.widget, name) for name in ("message", "repaired", "answered")}
        self.page.evaluate(SEND, [state, binary])

    def click_joint(self, name: str, button: str = "left") -> None:
        """Where the camera of the still pictures sees the joint, from as far away as the
        bench's."""
        box, frame = self.figure.bounding_box(), int(self.data("frame"))
        walked = CLIP.world()
        camera = poster.camera_at(walked, frame, body.Camera(distance=4.2))
        spots, _ = body.project(walked[frame], camera, (box["width"], box["height"]))
        x, y = spots[JOINTS.index(name)]
        self.page.mouse.click(box["x"] + x, box["y"] + y, button=button)

    def place_of(self, frame: int) -> tuple[float, float]:
        box, gutter = self.map.bounding_box(), 66
        x = box["x"] + gutter + (frame + 0.5) * (box["width"] - gutter) / len(CLIP)
        return x, box["y"] + 60

    def click_frame(self, frame: int, button: str = "left") -> None:
        self.page.mouse.click(*self.place_of(frame), button=button)


@pytest.fixture
def table(browser, tmp_path):
    widget = bench()
    record = {name: base64.b64encode(getattr(widget, name)).decode() for name in _BYTES}
    record |= {name: getattr(widget, name) for name in STATE}
    with open_page(browser, viewport={"width": 1000, "height": 760}) as page:
        page.goto(bare_page(tmp_path, MODULE, record, list(_BYTES)))
        yield Table(page, widget)
        assert page.problems == []


def test_a_clicked_hand_is_mended_as_the_library_mends_it(table):
    whole, drawn = ink(table.figure), coloured(table.figure)
    assert min(drawn.values()) > 200
    table.click_joint("RightHand")
    assert table.saved("missing") == HAND and table.data("missing") == str(T_H)
    assert (
        "RightHand is missing in the whole window. 8 of 168 joint positions are missing."
        in table.note()
    )
    broken = ink(table.figure)
    # the forearm has gone
    assert broken != whole and coloured(table.figure)["orange"] < drawn["orange"]
    before = table.widget.mended_joints
    table.page.get_by_role("button", name="Repair").click()
    assert (
        table.saved("asked") == 1 and table.page.get_by_role("button", name="Repair").is_disabled()
    )
    table.page.keyboard.press("Enter")  # the focus stays; pressed again, it does nothing
    assert table.saved("asked") == 1
    assert table.page.evaluate("document.activeElement.textContent") == "Repair"
    table.answer()
    assert table.widget.mended_joints != before
    np.testing.assert_allclose(
        shown(table.widget)[0], by_the_library(9, table.saved("missing")), atol=6e-4
    )
    assert table.data("repairs") == "4" and "the mean of 3 repairs" in table.note()
    # it plays of itself
    table.page.wait_for_function("document.querySelector('.mde-bench').dataset.frame > 5")
    assert (
        table.data("playing") == "true"
        and table.page.get_by_role("button", name="Repair").is_enabled()
    )
    table.figure.focus()
    table.page.keyboard.press("End")
    assert table.data("state") == "mean of 3 repairs" and ink(table.figure) not in (whole, broken)
    as_mean = ink(table.figure)
    table.page.get_by_label("Which repair is the body").select_option("2")
    assert table.data("state") == "repair 2 of 3" and ink(table.figure) != as_mean


def test_reset_goes_back_to_what_python_gave_in_a_view_that_was_made_later_too(table):
    table.click_joint("RightHand")
    table.page.evaluate("() => { cleanup(); another(); }")
    assert table.data("missing") == str(T_H)
    table.page.get_by_role("button", name="Reset").click()
    assert table.saved("first") == 9 and table.saved("missing") == []


def test_what_the_page_removes_is_not_where_reset_leads():
    widget = bench()
    widget.set_state({"first": 3, "missing": HAND})
    assert widget.missing == HAND and widget.start == {"first": 9}
    widget.missing = HAND[1:]
    assert widget.start == {"first": 9, "missing": HAND[1:]}


def ask(table) -> None:
    table.click_joint("RightHand")
    table.page.get_by_role("button", name="Repair").click()


def free(table) -> bool:
    return table.page.get_by_role("button", name="Repair").is_enabled()


def test_a_kernel_that_never_hears_of_a_repair_is_told(table):
    table.page.clock.install()
    ask(table)
    table.page.clock.run_for(4_000)
    assert not free(table)
    table.page.clock.run_for(2_000)
    assert "kernel does not answer" in table.note() and free(table)
    table.answer()  # it was busy
    assert "the mean of 3 repairs" in table.note() and free(table)


def test_a_kernel_that_goes_during_a_repair_or_before_it_is_told(table):
    table.page.clock.install()
    ask(table)
    table.page.evaluate("model.set('message', 'Round 1 of 2')")
    table.page.clock.run_for(60_000)
    assert not free(table) and table.note() == "Round 1 of 2", "a repair may take its time"
    table.page.evaluate("lost = true")
    table.page.clock.run_for(6_000)
    assert "kernel is gone" in table.note() and free(table)
    table.page.evaluate("document.querySelector('output.mde-said').textContent = ''")
    table.page.get_by_role("button", name="Repair").click()
    assert "kernel is gone" in table.note() and free(table)


def test_a_right_click_a_drag_and_a_scrolling_finger_remove_nothing(table):
    page = table.page
    for button in ("right", "middle"):
        table.click_joint("RightHand", button)
        table.click_frame(11, button)
    x, y = table.place_of(11)
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x, y + 30, steps=3)
    page.mouse.up()
    page.mouse.move(x, y)
    page.mouse.down()
    table.map.dispatch_event("pointercancel", {"isPrimary": True})  # the finger scrolls the page
    page.mouse.up()
    assert page.evaluate("saved.length") == 0 and table.data("missing") == "0"
    table.click_frame(11)
    assert len(table.saved("missing")) == J


def test_a_change_after_the_repair_shows_the_holes_again(table):
    table.click_joint("RightHand")
    table.page.get_by_role("button", name="Repair").click()
    table.answer()
    table.figure.focus()
    table.page.keyboard.press("Home")
    assert table.data("state") == "mean of 3 repairs"
    table.click_frame(11)
    assert table.data("state") == "joints are missing" and table.data("repairs") == "0"
    assert len(table.saved("missing")) == T_H + J - 1


def test_keyboard_alone_knocks_out_restores_and_does_not_leak(table):
    page = table.page
    table.figure.focus()
    for key in ("ArrowUp", "ArrowRight", " "):  # the joint before the hand, the next frame
        page.keyboard.press(key)
    forearm = JOINTS.index("RightForeArm")
    assert (
        table.saved("missing") == [t * J + forearm for t in range(T_H)]
        and table.data("frame") == "14"
    )
    page.get_by_label("A click on a joint changes it").select_option("one")
    table.figure.focus()
    page.keyboard.press(" ")
    assert len(table.saved("missing")) == T_H - 1 and 5 * J + forearm not in table.saved("missing")
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.className") == "mde-lane"
    page.keyboard.press("ArrowLeft")
    page.keyboard.press(" ")
    assert {4 * J + j for j in range(J)} <= set(table.saved("missing"))
    page.keyboard.press(" ")
    assert not {4 * J + j for j in range(J)} & set(table.saved("missing"))
    first = ink(table.figure)
    page.keyboard.press("t")
    assert not page.get_by_label("truth").is_checked()
    page.keyboard.press("r")
    assert (
        table.saved("missing") == [] and table.data("frame") == "13" and ink(table.figure) != first
    )
    assert page.evaluate("leaked") == 0


def test_buttons_the_window_and_the_truth(table):
    page = table.page
    page.get_by_role("button", name="right arm").click()
    assert table.saved("missing") == np.flatnonzero(~ARM).tolist()
    with_truth = ink(table.figure)
    page.get_by_label("truth").uncheck()
    assert ink(table.figure) != with_truth
    table.click_frame(2)
    assert "outside the window (frames 9 to 16)" in table.note() and table.data("frame") == "2"
    slider = page.get_by_label("First frame of the window")
    slider.focus()
    page.keyboard.press("ArrowRight")
    assert table.saved("first") == 10 and "frames 10 to 17" in table.note()
    assert len(table.saved("missing")) == 4 * T_H  # the holes move along
    page.get_by_role("button", name="Reset").click()
    assert table.saved("first") == 9 and table.saved("missing") == []


def test_all_knocked_out_is_said_in_words(table):
    for frame in range(9, 17):
        table.click_frame(frame)
    assert table.data("missing") == str(T_H * J)
    table.page.get_by_role("button", name="Repair").click()
    table.answer()
    assert "Not repaired: nothing is known" in table.note()
    assert (
        table.page.get_by_role("button", name="Repair").is_enabled()
        and table.data("playing") == "false"
    )


def test_dragging_turns_the_view_and_knocks_nothing_out(table):
    first, box = ink(table.figure), table.figure.bounding_box()
    table.page.mouse.move(box["x"] + 500, box["y"] + 200)
    table.page.mouse.down()
    table.page.mouse.move(box["x"] + 620, box["y"] + 240, steps=4)
    table.page.mouse.up()
    assert ink(table.figure) != first and table.data("missing") == "0"
    table.page.evaluate("cleanup()")
    assert table.page.evaluate("[document.querySelectorAll('canvas').length, listening()]") == [
        0,
        0,
    ]


def test_exported_html_plays_offline_and_says_that_repairing_needs_a_kernel(browser, tmp_path):
    widget = bench()
    widget.missing = HAND
    widget.repair()
    export = tmp_path / "export.html"
    export.write_text(f"<!doctype html><body>{widget._repr_mimebundle_()[0]['text/html']}", "utf-8")
    with open_page(browser) as page:
        page.goto(export.as_uri())
        inside = page.frame_locator("iframe")
        inside.locator(".mde-bench[data-state='mean of 3 repairs']").wait_for()
        drawn(inside.locator("canvas.mde-figure"))
        inside.get_by_role("button", name="Repair").click()
        inside.get_by_text("needs a running kernel").wait_for()
        inside.get_by_role("button", name="Play").click()
        inside.locator(".mde-bench:not([data-frame='13'])").wait_for()
        assert page.problems == [] and page.asked == []


LATE_SIGHTS = """
window.IntersectionObserver = class {
  constructor(tell) { this.tell = tell; }
  observe() { this.tell([{ isIntersecting: false }, { isIntersecting: true }]); }
  disconnect() {}
};"""


def test_the_last_of_several_readings_says_whether_the_figure_is_in_sight(browser, tmp_path):
    # a busy page tells at once that the canvas was out of sight and that it no longer is
    export = tmp_path / "export.html"
    export.write_text(
        f"<!doctype html><body>{bench()._repr_mimebundle_()[0]['text/html']}", "utf-8"
    )
    with open_page(browser) as page:
        page.add_init_script(LATE_SIGHTS)
        page.goto(export.as_uri())
        inside = page.frame_locator("iframe")
        inside.get_by_role("button", name="Play").click()
        inside.locator(".mde-bench:not([data-frame='13'])").wait_for()
