"""The editor: in Python, and in a browser whose messages reach the Python object."""

import re
import time

import numpy as np
import pytest
import traitlets
from browser import coloured, drawn, ink, open_page
from editor_page import guess, open_editor, settled
from synthetic_walk import walk

from motiondiff_edu.motion.formats.bvh import read_bvh
from motiondiff_edu.motion.formats.bvh.write import write_bvh
from motiondiff_edu.motion.formats.files import read_motion
from motiondiff_edu.motion.motion import MotionError
from motiondiff_edu.motion.skeleton import BONES, JOINTS, joint_index
from motiondiff_edu.viz.body import Camera, project
from motiondiff_edu.widgets import packing
from motiondiff_edu.widgets.editor import Editor

T, HAND = 31, joint_index("LeftHand")
FIGURE, RAIL = "canvas:not(.mde-lane)", "canvas.mde-timeline"


@pytest.fixture(scope="module")
def motion() -> np.ndarray:
    return walk(frames=T, turn=0.5)[0]


def words(page) -> str:
    return page.locator(".mde-told").inner_text()


# ---- in Python
def test_the_page_is_told_what_is_held(motion):
    editor = Editor(motion, guess)
    editor.pin(20, 4)
    editor.keep("upper body")
    target = motion[4, HAND] + [0, 0.2, 0.05]
    editor.drag(4, "LeftHand", target)
    state = editor.state
    assert (state["pins"], state["moved"], state["part"]) == ([4, 20], [[HAND], []], "upper body")
    assert state["held"].startswith(
        "2 frames pinned (1 edited), upper body kept. In frame 4 the pinned pose moves the part"
    )
    assert state["message"] == "LeftHand in frame 4 moved by 21 cm."
    np.testing.assert_allclose(
        np.frombuffer(editor.poses, "<f4").reshape(2, 21, 3)[0], editor.positions[4], atol=1e-6
    )
    np.testing.assert_allclose(editor.positions[4, HAND], target, atol=1e-9)
    assert editor.known[:, HAND].all() and editor.known.any(1).all() and editor.samples is None


def test_the_last_frame_by_its_number_from_the_end_is_the_same_frame(motion):
    editor = Editor(motion, guess)
    target = motion[-1, HAND] + [0, 0.2, 0.05]
    assert editor.pin(-1) == f"Pinned frame {T - 1}."
    assert editor.drag(-1, "LeftHand", target) == f"LeftHand in frame {T - 1} moved by 21 cm."
    editor.pin(-1)  # pinned already: what was dragged there stays
    np.testing.assert_allclose(editor.positions[-1, HAND], target, atol=1e-9)
    assert editor.unpin(-1) == f"Released frame {T - 1}." and not editor.known.any()
    with pytest.raises(IndexError, match=f"frame {T} is not within"):
        editor.pin(T)


def test_generating_tells_what_was_measured_and_the_same_seed_makes_the_same(motion):
    editors = [Editor(motion, guess, seed=s) for s in (5, 5, 6)]
    for editor in editors:
        editor.pin(0, 15, 30)
        editor.count, editor.resample = 2, 4
        editor.generate()
    one, same, other = (editor.samples for editor in editors)
    assert (
        one.shape == (2, T, 21, 3) and np.array_equal(one, same) and not np.array_equal(one, other)
    )
    assert np.array_equal(one[:, [0, 15, 30]], np.stack([motion[[0, 15, 30]]] * 2))
    assert re.fullmatch(
        r"In-betweens generated: 2, in \d+\.\d s \(seed 5\)\.", editors[0].state["message"]
    )
    assert re.fullmatch(r"keyframe error 0\.0 mm, seam jump \d.*", editors[0].state["measured"][1])
    unpacked = packing.unpack(
        packing.Packed(editors[0].made_joints, editors[0].made_roots, (T, T), 21)
    )
    assert max(np.abs(a - b).max() for a, b in zip(unpacked, one, strict=True)) < 0.001
    editors[0].generate()
    assert not np.array_equal(editors[0].samples, one) and "(seed 6)" in editors[0].state["message"]


def test_a_frame_is_pinned_as_it_is_seen(motion):
    editor = Editor(motion, guess)
    editor.pin(0, 30)
    editor.generate()
    editor.chosen = 2
    editor.pin(11)
    assert np.array_equal(editor.positions[11], editor.samples[2, 11]) and editor.state["old"]
    editor.generate()
    assert np.array_equal(editor.samples[0, 11], editor.positions[11]) and not editor.state["old"]
    assert editor.chosen == 0


def test_undo_goes_back_step_by_step_and_reset_can_be_undone(motion):
    editor = Editor(motion, guess)
    editor.pin(3)
    editor.generate()
    editor.chosen, made = 1, editor.samples
    editor.unpin(3)
    editor.reset()
    assert (
        editor.samples is None
        and editor.made_joints == b""
        and editor.state["held"] == "nothing is pinned or kept."
    )
    editor.undo()
    assert editor.state["pins"] == [] and editor.samples is made and editor.chosen == 1
    editor.undo()
    assert editor.state["pins"] == [3] and not editor.state["old"] and editor.state["undo"] == 2
    editor.undo()
    editor.undo()
    assert editor.samples is None
    with pytest.raises(IndexError, match="nothing to undo"):
        editor.undo()


def test_a_saved_file_reads_back_as_the_chosen_in_between(motion, tmp_path, capsys):
    editor = Editor(motion, guess, fps=25)
    editor.pin(0, 12, 30)
    editor.generate()
    editor.chosen = 1
    report = editor.save(tmp_path / "made.bvh")
    bvh = read_bvh(tmp_path / "made.bvh")
    back = bvh.world_positions()[:, [bvh.names.index(name) for name in JOINTS]] / 100
    assert bvh.fps == 25 and np.abs(back - report.positions).max() < 1e-3
    off = np.linalg.norm(back - editor.samples[1], axis=-1)
    np.testing.assert_allclose(off, report.shift_mm / 1000, atol=1e-4)
    assert [path.name for path in tmp_path.iterdir()] == [
        "made.bvh"
    ] and "made.bvh" in capsys.readouterr().out


def receive(editor, **content) -> str:
    editor._receive(editor, {"number": editor.state["received"] + 1, **content}, [])
    return editor.state["message"]


def test_a_retouched_pose_is_saved_before_anything_is_generated(motion, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    editor = Editor(motion, guess)
    editor.pin(4)
    editor.drag(4, "LeftHand", motion[4, HAND] + [0, 0.2, 0.05])
    said = receive(editor, do="save", name=" retouched ", chosen=0)
    assert said.startswith(f"Saved {tmp_path / 'retouched.bvh'} (the motion with its pinned poses;")
    back = read_bvh(tmp_path / "retouched.bvh")
    hand = back.world_positions()[:, back.names.index("LeftHand")] / 100
    np.testing.assert_allclose(hand, editor.positions[:, HAND], atol=0.02)  # bones are evened out
    assert hand[4, 1] > motion[4, HAND, 1] + 0.17
    again = receive(editor, do="save", name="retouched.bvh")
    assert ", which replaced the file saved before: " in again


def test_a_file_of_yesterday_is_not_replaced(motion, tmp_path, monkeypatch):
    """Nor one that somebody else changed since it was saved."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "walk.bvh").write_text("of yesterday")
    editor = Editor(motion, guess)
    said = receive(editor, do="save", name="walk")
    assert said.startswith("Not saved: walk.bvh is from before this kernel, and it would be lost.")
    assert said.endswith("for instance walk-2.bvh.")
    assert (tmp_path / "walk.bvh").read_text() == "of yesterday"
    assert receive(editor, do="save", name="walk-2").startswith("Saved")
    (tmp_path / "walk-2.bvh").write_text("changed by hand")
    assert receive(editor, do="save", name="walk-2").startswith("Not saved")
    assert (tmp_path / "walk-2.bvh").read_text() == "changed by hand"


def test_a_recording_that_was_read_is_not_replaced(motion, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_bvh("my walk.bvh", motion)
    before = (tmp_path / "my walk.bvh").read_bytes()
    editor = Editor(read_motion("my walk.bvh").positions, guess)
    said = receive(editor, do="save", name="my walk", chosen=0)
    assert said == (
        "Not saved: my walk.bvh was read, and it would be lost. Type another name, for instance "
        "my walk-2.bvh."
    )
    with pytest.raises(MotionError, match="my walk.bvh was read"):
        editor.save("my walk.bvh")
    assert (tmp_path / "my walk.bvh").read_bytes() == before
    assert receive(editor, do="save", name="my walk-2").startswith("Saved")
    read_motion("my walk-2.bvh")  # what the editor wrote, it may write again
    assert receive(editor, do="save", name="my walk-2").startswith("Saved")
    assert "for instance my walk-3.bvh." in receive(editor, do="save", name="my walk")
    editor.save("my walk.bvh", overwrite=True)
    editor.save("my walk.bvh")  # now it is our own


@pytest.mark.parametrize(
    "name, message",
    [
        (
            "/elsewhere/walk.bvh",
            "'/elsewhere/walk.bvh' contains a folder. Type only a name: the file goes to",
        ),
        ("../walk.bvh", "contains a folder"),
        ("~/walk", "contains a folder"),
        (r"C:\walk.bvh", "contains a folder"),
        ("my walk.txt", "Not saved: only .bvh can be written, not .txt. Type my walk.bvh."),
        (" ", "Give the file a name."),
        (".bvh", "Give the file a name."),
        ("..", "Give the file a name."),
    ],
)
def test_what_is_no_name_for_a_file_is_refused_and_nothing_written(
    motion, tmp_path, monkeypatch, name, message
):
    inside = tmp_path / "inside"
    inside.mkdir()
    monkeypatch.chdir(inside)
    assert message in receive(Editor(motion, guess), do="save", name=name)
    assert list(tmp_path.rglob("*")) == [inside]


def test_errors_are_told_in_the_page_and_leave_it_at_rest(motion, tmp_path):
    def broken(positions, known, generator, samples=1, resample=1):
        raise RuntimeError("out of memory")

    editor = Editor(motion, broken)
    assert receive(editor, do="generate", after=0) == "RuntimeError: out of memory."
    assert not editor.busy and editor.samples is None and isinstance(editor.error, RuntimeError)
    assert receive(editor, do="undo") == "There is nothing to undo."
    assert receive(editor, do="drag", frame=3, joint=5, by=[0, 0, 0], grip=1).startswith(
        "Frame 3 is not pinned"
    )
    assert receive(editor, do="save", name=str(tmp_path / "x")).endswith("in a cell.")
    assert receive(editor, do="save", name=" ") == "Give the file a name."
    editor.pin(*range(T))
    assert receive(editor, do="generate", after=5).startswith(
        "Every frame is pinned, so there is nothing to generate. Release some."
    )
    assert editor.state["received"] == 6


def test_a_press_while_another_is_answered_is_ignored(motion):
    calls = []

    def make(positions, known, generator, **_):
        calls.append(len(calls))
        assert editor.busy
        receive(editor, do="generate", after=0)  # a message that comes in between
        return guess(positions, known, generator, samples=3)

    editor = Editor(motion, make)
    editor.pin(0, 30)
    assert receive(editor, do="generate", after=0).startswith("In-betweens generated: 3")
    receive(editor, do="generate", after=0)  # pressed before the answer had come
    assert calls == [0]
    receive(editor, do="generate", after=1)
    assert calls == [0, 1]


def test_drags_of_one_grip_start_from_the_same_pose_and_are_undone_together(motion):
    editor = Editor(motion, guess)
    editor.pin(8)
    for by in ([5.0, 5.0, 5.0], [-3.0, 0.5, 0.2], [0.1, 0.3, 0.0]):
        receive(editor, do="drag", frame=8, joint=HAND, by=by, grip=1)
    alone = Editor(motion, guess)
    alone.pin(8)
    alone.drag(8, "LeftHand", motion[8, HAND] + [0.1, 0.3, 0.0])
    assert np.array_equal(editor.positions, alone.positions)
    receive(editor, do="drag", frame=8, joint=12, by=[0.05, 0, 0], grip=2)
    assert editor.edit.moved == {8: ("LeftHand", "Head")} and editor.state["undo"] == 3
    receive(editor, do="undo")
    assert np.array_equal(editor.positions, alone.positions)
    receive(editor, do="undo")
    assert np.array_equal(editor.positions, motion)


def height(editor, frame: int = 8) -> float:
    """How far the left hand of a frame was raised, in cm."""
    return 100 * (editor.positions - editor.edit.motion)[frame, HAND, 1]


def test_a_grip_goes_on_after_an_undo_with_what_it_was_moved_since(motion):
    editor = Editor(motion, guess)
    editor.pin(8)
    for cm in (5, 12):
        receive(editor, do="drag", frame=8, joint=HAND, by=[0, cm / 100, 0], grip=1)
    receive(editor, do="undo")
    assert height(editor) == 0
    for cm in (15, 19):  # 3 and 7 more than before the undo
        receive(editor, do="drag", frame=8, joint=HAND, by=[0, cm / 100, 0], grip=1)
    assert height(editor) == pytest.approx(7) and editor.state["undo"] == 2
    receive(editor, do="drag", frame=8, joint=HAND, by=[0, 0.01, 0], grip=2)
    assert height(editor) == pytest.approx(8)
    receive(editor, do="undo")
    assert height(editor) == pytest.approx(7)
    assert "not [0.0, nan, 0.0]" in receive(
        editor, do="drag", frame=8, joint=HAND, by=[0, None, 0], grip=3
    )
    receive(editor, do="drag", frame=8, joint=HAND, by=[0, 0.02, 0], grip=3)
    assert height(editor) == pytest.approx(9)


def test_a_press_after_an_undo_is_no_old_one(motion):
    editor = Editor(motion, guess)
    editor.pin(0, 30)
    receive(editor, do="generate", after=0, count=2, resample=4)
    assert (len(editor.samples), editor.count, editor.resample) == (2, 2, 4)
    receive(editor, do="undo")
    assert editor.samples is None
    receive(editor, do="generate", after=1)  # the page has not heard of the undo yet
    assert len(editor.samples) == 2


def test_a_frame_is_turned_over_as_it_is_here_and_pinned_as_it_is_shown_there(motion):
    editor = Editor(motion, guess)
    editor.pin(0, 30)
    editor.generate()
    receive(editor, do="toggle", frame=11, chosen=2)
    assert np.array_equal(editor.positions[11], editor.samples[2, 11]) and editor.chosen == 2
    assert receive(editor, do="toggle", frame=11, chosen=2) == "Released frame 11."
    receive(editor, do="ping")
    assert editor.state["message"] == "Released frame 11."


def test_what_is_no_motion_is_refused(motion):
    with pytest.raises(
        ValueError, match=r"\(frames, 21, 3\), world positions in metres, not \(31, 63\)"
    ):
        Editor(motion.reshape(T, 63), guess)
    with pytest.raises(ValueError, match="frame 2, joint 5"):
        Editor(np.where(np.arange(T * 21).reshape(T, 21, 1) == 2 * 21 + 5, np.nan, motion), guess)
    with pytest.raises(ValueError, match="3 names for the 21 joints"):
        Editor(motion, guess, names=["a", "b", "c"])
    with pytest.raises(traitlets.TraitError, match="frame must be from 0 to 30, not 31"):
        Editor(motion, guess).frame = T
    with pytest.raises(traitlets.TraitError, match="chosen must be from 0 to 0, not 1"):
        Editor(motion, guess).chosen = 1


# ---- in a browser
@pytest.fixture
def editor(motion):
    return Editor(motion, guess)


@pytest.fixture
def page(browser, tmp_path, editor):
    with open_page(browser, viewport={"width": 1100, "height": 800}) as page:
        open_editor(page, tmp_path, editor)
        yield page
        assert page.problems == []


def press(page, *keys) -> None:
    for key in keys:
        page.keyboard.press(key)
    settled(page)


def test_the_whole_way_by_keyboard(page, editor, motion, tmp_path, monkeypatch):
    page.locator(FIGURE).focus()
    press(page, "Enter", *["."] * 12, "Enter", "End", "Enter")
    press(page, "PageUp")
    assert page.locator(".mde-editor").get_attribute("data-pins") == "0 12 30"
    assert page.locator(".mde-editor").get_attribute(
        "data-frame"
    ) == "12" and "3 frames pinned." in words(page)
    page.get_by_label("Joint to move").select_option("LeftHand")
    page.locator(FIGURE).focus()
    press(page, *["Shift+ArrowUp"] * 6, "ArrowUp", "PageUp")
    moved = editor.positions[12] - motion[12]
    assert moved[HAND, 1] == pytest.approx(0.31, abs=0.02) and np.array_equal(
        np.delete(moved, range(13, 17), 0), np.zeros((17, 3))
    )
    assert (page.evaluate("leaked"), editor.edit.moved) == (0, {12: ("LeftHand",)})
    press(page, "g")
    page.wait_for_function("model.get('state').made === 3")
    pinned = [0, 12, 30]
    assert all(np.array_equal(one[pinned], editor.positions[pinned]) for one in editor.samples)
    assert "keyframe error 0.0 mm" in words(page) and "(seed 0)" in words(page)
    press(page, "]", "]")
    assert editor.chosen == 2 and "In-between 3:" in words(page)
    press(page, "]")
    assert editor.chosen == 0
    monkeypatch.chdir(tmp_path)
    page.get_by_label("Name of the file").fill("edited 1.5")
    press(page, "Enter")
    page.wait_for_function("document.querySelector('.mde-say').textContent.startsWith('Saved')")
    bvh = read_bvh(tmp_path / "edited 1.5.bvh")
    back = bvh.world_positions()[:, [bvh.names.index(name) for name in JOINTS]] / 100
    told = float(re.search(r"([\d.]+) mm at most", words(page))[1]) / 1000
    assert np.linalg.norm(back - editor.samples[0], axis=-1).max() == pytest.approx(told, abs=1e-4)


def handle(page, editor, frame: int, joint: int) -> tuple[float, float]:
    """Where a joint of a frame is on the screen, by the camera of the still pictures."""
    box = page.locator(FIGURE).bounding_box()
    around = editor.positions[np.clip(np.arange(frame - 10, frame + 11), 0, T - 1), 0].mean(0)
    camera = Camera(x=around[0], z=around[2], distance=5 / 1.1)
    pixel, _ = project(editor.positions[frame, joint][None], camera, (box["width"], box["height"]))
    return box["x"] + pixel[0, 0], box["y"] + pixel[0, 1]


def test_a_hand_is_dragged_with_the_mouse_and_the_bones_keep_their_lengths(page, editor, motion):
    page.locator(FIGURE).focus()
    press(page, ".", ".", "Enter")
    x, y = handle(page, editor, 2, HAND)
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 10, y - 40, steps=5)
    page.mouse.move(x + 20, y - 70, steps=5)
    page.mouse.up()
    settled(page)
    page.wait_for_function("model.get('state').moved[0].length === 1")
    after = handle(page, editor, 2, HAND)
    assert after == pytest.approx((x + 20, y - 70), abs=1.5), (
        "the hand is under the pointer, in the plane of the view"
    )
    for parent, child in BONES:
        lengths = [np.linalg.norm(p[2, child] - p[2, parent]) for p in (motion, editor.positions)]
        assert lengths[1] == pytest.approx(lengths[0])
    assert "LeftHand in frame 2 moved by" in words(page) and editor.state["undo"] == 2
    press(page, "Control+Shift+Z")  # elsewhere it does again what was undone
    assert editor.state["undo"] == 2
    press(page, "Control+z")
    assert np.array_equal(editor.positions, motion) and editor.state["pins"] == [2]


def test_a_drag_with_another_button_or_one_that_is_taken_away_moves_no_joint(page, editor, motion):
    page.locator(FIGURE).focus()
    press(page, ".", ".", "Enter")
    x, y = handle(page, editor, 2, HAND)
    for button in ("right", "left"):
        page.mouse.move(x, y)
        page.mouse.down(button=button)
        page.mouse.move(x + 10, y - 40, steps=5)
        if button == "left":
            page.wait_for_function("asked.length > 1")
            page.locator(FIGURE).dispatch_event("pointercancel", {"isPrimary": True})
        page.mouse.up(button=button)
        settled(page)
        assert page.evaluate("asked.length === 1") == (button == "right")
    page.wait_for_function("asked.at(-1).by?.every((v) => v === 0)")
    settled(page)
    np.testing.assert_allclose(editor.positions, motion, atol=1e-9)


def test_dragging_elsewhere_turns_the_view_and_moves_nothing(page, editor, motion):
    page.locator(FIGURE).focus()
    press(page, "Enter")
    first = ink(page.locator(FIGURE))
    box = page.locator(FIGURE).bounding_box()
    page.mouse.move(box["x"] + 60, box["y"] + 200)
    page.mouse.down()
    page.mouse.move(box["x"] + 160, box["y"] + 230, steps=3)
    page.mouse.up()
    assert ink(page.locator(FIGURE)) != first and np.array_equal(editor.positions, motion)
    assert page.evaluate("asked.length") == 1


def test_a_click_on_the_timeline_goes_there_and_a_double_click_pins(page, editor):
    box = page.locator(RAIL).bounding_box()
    at = lambda t: 14 + t / (T - 1) * (box["width"] - 28)  # noqa: E731
    track, ruler = box["y"] + 38, box["y"] + 10
    for row, frame in ((track, 10), (ruler, 20), (track, 5)):
        page.mouse.click(box["x"] + at(frame), row)
        settled(page)
        assert editor.frame == frame and page.evaluate("asked.length") == 0
    for row, frame, pins in ((track, 10, [10]), (ruler, 20, [10, 20]), (track, 10, [20])):
        page.mouse.dblclick(box["x"] + at(frame), row)
        settled(page)
        assert editor.frame == frame and editor.state["pins"] == pins
    page.mouse.click(box["x"] + at(20), track)  # a click lets nothing go
    settled(page)
    assert editor.frame == 20 and editor.state["pins"] == [20]
    page.mouse.move(box["x"] + at(3), ruler)
    page.mouse.down()
    page.mouse.move(box["x"] + at(27), ruler, steps=4)
    page.mouse.up()
    page.wait_for_function("document.querySelector('.mde-editor').dataset.frame === '27'")
    assert editor.state["pins"] == [20]
    page.locator(RAIL).focus()
    press(page, "PageUp")
    assert (
        page.locator(RAIL).get_attribute("aria-valuetext") == "frame 20 of 30, 1.00 seconds, pinned"
    )
    press(page, "Enter")
    assert editor.state["pins"] == [] and "Nothing is pinned or kept" in words(page)


LABELS = """() => {  // boxes of the labels written on the stage
  const boxes = [], write = CanvasRenderingContext2D.prototype.fillText;
  CanvasRenderingContext2D.prototype.fillText = function (text, x, y) {
    const wide = this.measureText(text).width, left = this.textAlign === "right" ? x - wide : x;
    if (text.match(/^in-b|^motion/)) boxes.push([text, left, y - 11, left + wide, y + 2]);
    return write.call(this, text, x, y);
  };
  document.querySelector(".mde-editor input[type=checkbox]").click();
  CanvasRenderingContext2D.prototype.fillText = write;
  return boxes;
}"""


@pytest.mark.parametrize("frame", [1, 15])  # in one place, and apart
def test_every_ghost_has_its_name_and_no_name_covers_another(page, editor, frame):
    editor.pin(0, 30)
    page.get_by_role("button", name="Generate").click()
    page.wait_for_function("model.get('state').made === 3")
    page.locator(FIGURE).focus()
    press(page, "Home", *["."] * frame, "]")
    boxes, width = page.evaluate(LABELS), page.locator(FIGURE).bounding_box()["width"]
    assert sorted(box[0] for box in boxes) == ["in-between 1", "in-between 3", "motion before"]
    for i, (_, left, top, right, foot) in enumerate(boxes):
        assert 0 <= left and right <= width and top > 0
        for _, left2, top2, right2, foot2 in boxes[:i]:
            assert right <= left2 or right2 <= left or foot <= top2 or foot2 <= top


def test_controls_are_told_and_ghosts_are_drawn(page, editor):
    page.get_by_label("Number of in-betweens").select_option("5")
    page.get_by_label("Resampling").select_option("7")
    page.get_by_label("Part of the body").select_option("the lower body")
    settled(page)
    assert (editor.count, editor.resample, editor.edit.part) == (5, 7, "lower body")
    page.locator(FIGURE).focus()
    press(page, "Enter", ".", ".", ".")
    pale = coloured(page.locator(FIGURE))
    page.get_by_role("button", name="Generate").click()
    page.wait_for_function("model.get('state').made === 5")
    assert editor.samples.shape == (5, T, 21, 3)
    assert coloured(page.locator(FIGURE))["orange"] > 1.2 * pale["orange"], (
        "what is to be made is pale before"
    )
    seen = ink(page.locator(FIGURE))
    page.get_by_label("Next in-between").click()
    settled(page)
    assert editor.chosen == 1 and ink(page.locator(FIGURE)) != seen
    page.get_by_role("button", name="Undo").click()
    settled(page)
    assert editor.samples is None and "1 frame pinned, lower body kept" in words(page)
    page.get_by_role("button", name="Reset").click()
    settled(page)
    assert editor.edit.part is None and page.get_by_label("Part of the body").input_value() == ""


def test_a_busy_editor_says_so_and_ignores_a_second_press(browser, tmp_path, motion):
    calls = []

    def slow(positions, known, generator, samples, resample):
        calls.append(samples)
        time.sleep(0.3)
        return guess(positions, known, generator, samples)

    editor = Editor(motion, slow)
    editor.pin(0, 30)
    with open_page(browser) as page:
        open_editor(page, tmp_path, editor)
        page.evaluate("""() => {
            const b = document.querySelector(".mde-main");
            const root = document.querySelector(".mde-editor");
            b.click(); b.click();
            const off = b.getAttribute("aria-disabled"), busy = root.getAttribute("aria-busy");
            window.seen = [b.textContent, off, busy];
        }""")
        assert page.evaluate("seen") == ["Generating …", "true", "true"]
        page.wait_for_function("model.get('state').made === 3")
        page.wait_for_function("document.querySelector('.mde-main').textContent === 'Generate'")
        assert calls == [3] and page.evaluate("asked.length") == 1
        assert page.problems == []


def test_errors_appear_in_the_message_line(page, editor):
    page.locator(FIGURE).focus()
    press(page, "j", "ArrowUp")
    assert (
        "Frame 0 is not pinned: press Enter" in words(page) and page.evaluate("asked.length") == 0
    )
    press(page, "]")
    assert "There are no in-betweens yet" in words(page)
    press(page, "z")
    assert "There is nothing to undo." in words(page)
    editor._make = lambda p, k, **_: p
    press(page, "g")
    page.wait_for_function("document.querySelector('.mde-say').textContent.includes('is needed')")
    assert "(31, 21, 3); (3, 31, 21, 3) is needed." in words(page)
    page.wait_for_function("document.querySelector('.mde-main').textContent === 'Generate'")


def test_playing_runs_through_the_frames_and_python_hears_where_it_stopped(page, editor):
    page.get_by_role("button", name="Play").click()
    page.wait_for_function("Number(document.querySelector('.mde-editor').dataset.frame) > 4")
    page.locator(FIGURE).focus()
    press(page, " ")
    assert page.locator(".mde-editor").get_attribute("data-playing") == "false"
    frame = int(page.locator(".mde-editor").get_attribute("data-frame"))
    page.wait_for_function(f"model.get('frame') === {frame}")
    assert editor.frame == frame
    page.evaluate("cleanup()")
    assert page.evaluate("[document.querySelectorAll('canvas').length, listening()]") == [0, 0]


def test_without_a_kernel_it_plays_and_pins_and_says_what_it_needs(browser, motion, tmp_path):
    editor = Editor(motion, guess)
    editor.pin(0, 30)
    editor.generate()
    bundle, _ = editor._repr_mimebundle_()
    assert (
        'alt="Motion editor: a skeleton moves for 1.6 s, 31 frames; 2 frames pinned. 3 in-betweens '
        'generated."' in bundle["text/html"]
    )
    assert {"image/png", "application/vnd.jupyter.widget-view+json"} <= set(bundle)
    export = tmp_path / "export.html"
    export.write_text(f"<!doctype html><body>{bundle['text/html']}", "utf-8")
    with open_page(browser, viewport={"width": 1100, "height": 850}) as page:
        page.goto(export.as_uri())
        inside = page.frame_locator("iframe")
        canvas, said = inside.locator(FIGURE), inside.locator(".mde-say")
        drawn(canvas)
        inside.get_by_role("button", name="Play").click()
        inside.locator(".mde-editor:not([data-frame='0'])").wait_for()
        canvas.focus()
        for key in (" ", "Home", ".", ".", "Enter"):
            page.keyboard.press(key)
        inside.locator(".mde-editor[data-pins='0 2 30']").wait_for()
        assert "Frame 2 pinned, on this page only." in said.inner_text()
        page.keyboard.press("g")
        inside.get_by_text(
            "Generating needs a running notebook: run the cell that made this editor."
        ).wait_for()
        page.keyboard.press("]")
        inside.get_by_text("In-between 2:").wait_for()
        assert page.problems == [] and page.asked == []


def test_a_kernel_that_does_not_answer_is_told(browser, tmp_path, motion):
    with open_page(browser) as page:
        page.clock.install()
        open_editor(page, tmp_path, Editor(motion, guess))
        page.evaluate("window.kernel = () => {}")
        page.get_by_role("button", name="Generate").click()
        page.clock.run_for(6000)
        assert "kernel does not answer" in words(page)
        assert page.locator(".mde-main").inner_text() == "Generate"
