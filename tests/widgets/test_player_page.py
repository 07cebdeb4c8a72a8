"""The player's ES module in a browser: with a fake model in a bare page, and exported, offline,
without a kernel."""

import re

import numpy as np
import pytest
from browser import ANOTHER_FRAME, coloured, drawn, ink, open_page, player_page, shown
from synthetic_walk import walk

from motiondiff_edu import __main__ as command
from motiondiff_edu.viz.body import Camera
from motiondiff_edu.widgets import module, poster
from motiondiff_edu.widgets.player import Look, Player

STILL = Look(autoplay=False)

WHEELS = (
    "() => { window.wheels = 0; document.addEventListener('wheel', () => { window.wheels++; }); }"
)
ORANGE_HALVES = """() => {
  const c = document.querySelector("canvas"), w = c.width >> 1;
  return [0, w].map((x) => {
    const d = c.getContext("2d").getImageData(x, 0, w, c.height).data;
    let n = 0;
    for (let i = 0; i < d.length; i += 4) if (d[i] > d[i + 2] + 80 && d[i] > d[i + 1] + 50) n++;
    return n;
  });
}"""


@pytest.fixture(scope="module")
def player():
    positions, contacts = walk(frames=53, turn=0.3)
    return Player(positions, contacts=contacts, past=20, labels="walker", look=STILL)


def test_twenty_minutes_at_120_frames_a_second_are_drawn(browser, tmp_path):
    """More frames than a call takes arguments."""
    positions, _ = walk(frames=100)
    long = Player(np.tile(positions, (1400, 1, 1)), look=STILL)
    with open_page(browser) as page:
        page.goto(player_page(tmp_path, long))
        page.locator("canvas").focus()
        page.keyboard.press("End")
        assert min(coloured(page.locator("canvas")).values()) > 200
        assert page.problems == []


def test_keys_move_the_figure_and_do_not_leak(browser, player, tmp_path):
    with open_page(browser) as page:
        page.goto(player_page(tmp_path, player))
        canvas = page.locator("canvas")
        assert min(coloured(canvas).values()) > 200
        canvas.focus()
        presses = {
            "ArrowRight": 1,
            "ArrowUp": 11,
            "ArrowLeft": 10,
            "ArrowDown": 0,
            "End": 52,
            "Home": 0,
        }
        for key, frame in presses.items():
            before = ink(canvas)
            page.keyboard.press(key)
            assert shown(page) == frame == page.evaluate("saved.at(-1).frame"), key
            assert ink(canvas) != before, key
        assert page.evaluate("leaked") == 0
        assert page.problems == []


def test_zoom_orbit_follow_and_reset_change_the_view_and_reset_brings_it_back(
    browser, player, tmp_path
):
    with open_page(browser) as page:
        page.goto(player_page(tmp_path, player))
        canvas = page.locator("canvas")
        canvas.focus()
        page.wait_for_function("document.activeElement.tagName === 'CANVAS'")
        first = ink(canvas)
        seen = [first]
        for act in ["+", "-", "f"]:
            page.keyboard.press(act)
            seen.append(ink(canvas))
        assert seen[1] != first and seen[2] == first and seen[3] != first
        box = canvas.bounding_box()
        page.mouse.move(box["x"] + 200, box["y"] + 200)
        page.mouse.down()
        page.mouse.move(box["x"] + 320, box["y"] + 250)
        page.mouse.up()
        turned = canvas.evaluate("c => c.toDataURL()")
        page.mouse.wheel(0, -300)
        page.wait_for_function(
            "(was) => document.querySelector('canvas').toDataURL() !== was", arg=turned
        )
        page.keyboard.press("ArrowRight")
        assert ink(canvas) not in seen
        page.get_by_role("button", name="Reset").click()
        assert ink(canvas) == first and shown(page) == 0


SMOOTH = """([roots, t, fps]) =>
  smoothRoot({ root: (i) => roots[Math.min(Math.max(i, 0), roots.length - 1)] }, t, fps)"""


@pytest.mark.parametrize("fps", [10, 20, 25, 60])
def test_page_and_film_follow_the_figure_with_the_same_calm(browser, fps):
    roots = np.random.default_rng(0).normal(size=(90, 1, 3))
    source = re.sub("^export ", "", module.es_module(("dom", "figures", "paint")), flags=re.M)
    with open_page(browser) as page:
        page.add_script_tag(content=source)
        for t in (3, 40, 88):
            seen = page.evaluate(SMOOTH, [roots[:, 0].tolist(), t, fps])
            camera = poster.camera_at(roots, t, Camera(), fps)
            assert seen == pytest.approx([camera.x, camera.z])


def test_wheel_scrolls_the_page_until_the_figure_was_clicked(browser, player, tmp_path):
    with open_page(browser) as page:
        page.goto(player_page(tmp_path, player))
        canvas = page.locator("canvas")
        first, box = ink(canvas), canvas.bounding_box()
        page.evaluate(WHEELS)
        page.mouse.move(box["x"] + 200, box["y"] + 200)
        page.mouse.wheel(0, -300)
        page.wait_for_function("wheels > 0")
        page.evaluate(ANOTHER_FRAME)
        assert ink(canvas) == first
        page.mouse.click(box["x"] + 200, box["y"] + 200)
        clicked = canvas.evaluate("c => c.toDataURL()")
        page.mouse.wheel(0, -300)
        page.wait_for_function(
            "(was) => document.querySelector('canvas').toDataURL() !== was", arg=clicked
        )


def test_play_advances_pauses_and_tells_python(browser, player, tmp_path):
    with open_page(browser) as page:
        page.goto(player_page(tmp_path, player))
        canvas = page.locator("canvas")
        first = canvas.evaluate("c => c.toDataURL()")
        page.get_by_role("button", name="Play").click()
        page.wait_for_function(
            "(was) => document.querySelector('.mde-player').dataset.frame > 3"
            " && document.querySelector('canvas').toDataURL() !== was",
            arg=first,
        )
        page.wait_for_function("saved.some((s) => s.playing && s.frame > 0)")
        canvas.focus()
        page.keyboard.press(" ")
        frame = shown(page)
        assert page.evaluate("[saved.at(-1).frame, saved.at(-1).playing]") == [frame, False]
        assert page.get_by_role("button", name="Play").count() == 1


def test_python_sets_the_frame_and_another_motion(browser, player, tmp_path):
    with open_page(browser) as page:
        page.goto(player_page(tmp_path, player))
        canvas, first = page.locator("canvas"), ink(page.locator("canvas"))
        page.evaluate("model.set('frame', 31)")
        assert shown(page) == 31 and ink(canvas) != first
        assert page.locator("input[type=range]").input_value() == "31"
        page.evaluate("""() => { const s = structuredClone(model.get('scene'));
            s.figures[0].frames = 7; model.set('scene', s); }""")
        assert shown(page) == 6 and page.locator("input[type=range]").get_attribute("max") == "6"
        page.evaluate("cleanup()")
        assert page.evaluate("[document.querySelectorAll('canvas').length, listening()]") == [0, 0]


def test_past_is_paler_and_contacts_leave_marks(browser, tmp_path):
    positions, contacts = walk(frames=53, turn=0.3)

    def at(frame, **options):
        with open_page(browser) as page:
            page.goto(player_page(tmp_path, Player(positions, look=STILL, **options)))
            page.evaluate(f"model.set('frame', {frame})")
            return coloured(page.locator("canvas")), ink(page.locator("canvas"))

    assert at(15, past=20)[0]["blue"] < 0.7 * at(15)[0]["blue"]
    assert at(30, past=20)[0]["blue"] > 0.9 * at(30)[0]["blue"]
    assert at(30, contacts=contacts)[1] != at(30)[1]


@pytest.mark.parametrize("layout", ["side", "together"])
def test_several_figures_are_all_drawn(browser, tmp_path, layout):
    positions, _ = walk(frames=53, turn=0.3)
    several = Player(
        [positions, positions[:20]],
        labels=["long", "short"],
        look=Look(layout=layout, autoplay=False),
    )
    with open_page(browser) as page:
        page.goto(player_page(tmp_path, several))
        page.evaluate("model.set('frame', 40)")
        assert min(page.evaluate(ORANGE_HALVES)) > 100
        assert page.problems == []


def test_notes_are_plain_text_and_the_rest_unfolds_by_key(browser, tmp_path):
    told = Player(walk(frames=30)[0], look=STILL)
    told.notes = ["<b>bold</b> & <img src=x>", "two", "three " + 60 * "wide", "four"]
    with open_page(browser, viewport={"width": 390, "height": 700}) as page:
        page.goto(told.save_html(tmp_path / "told.html").as_uri())
        notes = page.get_by_role("note", name="Notes")
        assert re.findall(".+", notes.inner_text()) == [*told.notes[:2], "and 2 more"]
        page.locator("canvas").focus()
        while page.evaluate("document.activeElement.tagName") != "SUMMARY":
            page.keyboard.press("Tab")
        page.keyboard.press("Enter")
        opened = [*told.notes[:2], "and 2 more", *told.notes[2:]]
        assert re.findall(".+", notes.inner_text()) == opened
        assert page.evaluate("document.documentElement.scrollWidth") <= 390
        assert page.problems == [] and page.asked == []


def test_a_long_note_begins_in_sight_and_no_note_takes_no_room(browser, player, tmp_path):
    with open_page(browser) as page:
        page.goto(player_page(tmp_path, player))
        notes = page.locator(".mde-notes")
        assert notes.get_attribute("hidden") is not None
        page.evaluate("model.set('notes', ['one word '.repeat(40) + 'end'])")
        begins, more, rest = notes.locator("p, summary").all()
        assert begins.inner_text().endswith("one word \u2026") and more.inner_text() == "more"
        assert rest.is_hidden() and 150 < len(begins.inner_text()) <= 202
        more.click()
        whole = (begins.inner_text() + rest.inner_text()).replace(" \u2026\u2026", "")
        assert whole == "one word " * 40 + "end"
        page.evaluate("model.set('notes', [])")
        assert notes.get_attribute("hidden") is not None and notes.inner_html() == ""


@pytest.mark.parametrize("motion, playing", [("reduce", False), ("no-preference", True)])
def test_autoplay_unless_motion_is_unwanted(browser, tmp_path, motion, playing):
    with open_page(browser, reduced_motion=motion) as page:
        page.goto(player_page(tmp_path, Player(walk(frames=30)[0])))
        assert page.locator(".mde-player").get_attribute("data-playing") == str(playing).lower()
        if playing:
            page.wait_for_function("document.querySelector('.mde-player').dataset.frame > 2")


def test_exported_html_is_alive_offline(browser, player, tmp_path):
    page_path = tmp_path / "export.html"
    bundle, _ = player._repr_mimebundle_()
    page_path.write_text(f"<!doctype html><body>{bundle['text/html']}", "utf-8")
    with open_page(browser) as page:
        page.goto(page_path.as_uri())
        inside = page.frame_locator("iframe")
        canvas = inside.locator("canvas")
        drawn(canvas)
        first = ink(canvas)
        inside.get_by_role("button", name="Play").click()
        inside.locator(".mde-player:not([data-frame='0'])").wait_for()
        canvas.focus()
        page.keyboard.press(" ")
        page.keyboard.press("End")
        inside.locator(".mde-player[data-frame='52']").wait_for()
        assert ink(canvas) != first
        assert page.problems == [] and page.asked == []


def test_a_notebook_that_was_run_is_exported_alive_and_offline(browser, player, tmp_path):
    nbformat = pytest.importorskip("nbformat")
    data, metadata = player._repr_mimebundle_()
    output = nbformat.v4.new_output("execute_result", data, metadata=metadata, execution_count=1)
    notebook = nbformat.v4.new_notebook(
        cells=[nbformat.v4.new_code_cell("player", outputs=[output])]
    )
    # as `nbconvert --execute` keeps it, for a page that asks the network
    state = {"state": {}, "version_major": 2, "version_minor": 0}
    notebook.metadata["widgets"] = {"application/vnd.jupyter.widget-state+json": state}
    nbformat.write(notebook, tmp_path / "notebook.ipynb")
    assert command.main(["export", str(tmp_path / "notebook.ipynb")]) == 0
    page_path = tmp_path / "notebook.html"
    with open_page(browser) as page:
        page.goto(page_path.as_uri())
        inside = page.frame_locator("iframe")
        inside.get_by_role("button", name="Play").click()
        inside.locator(".mde-player:not([data-frame='0'])").wait_for()
        drawn(inside.locator("canvas"))


def test_where_no_script_runs_the_poster_is_seen(browser, player, tmp_path):
    page_path = tmp_path / "export.html"
    # a policy holds for the frame within too; a browser told to run no scripts may be told so too
    # late for that frame
    forbid = """<meta http-equiv="Content-Security-Policy" content="script-src 'none'">"""
    html = player._repr_mimebundle_()[0]["text/html"]
    page_path.write_text(f"<!doctype html><head>{forbid}</head><body>{html}", "utf-8")
    with open_page(browser) as page:
        page.goto(page_path.as_uri())
        inside = page.frame_locator("iframe")
        inside.locator("script").first.wait_for(state="attached")
        page.locator("img").evaluate("img => img.decode()")
        page.evaluate(ANOTHER_FRAME)
        assert inside.locator(".mde-player").count() == 0, "a script ran"
        shot = tmp_path / "shot.png"
        page.screenshot(path=shot)
    from PIL import Image

    pixels = list(Image.open(shot).convert("RGB").get_flattened_data())
    assert sum(b > r + 60 and b > g + 20 for r, g, b in pixels) > 500


def test_saved_page_plays_by_itself(browser, tmp_path):
    saved = Player(walk(frames=30)[0], labels="</script><b>").save_html(tmp_path / "walk.html")
    with open_page(browser, reduced_motion="no-preference") as page:
        page.goto(saved.as_uri())
        page.wait_for_function("document.querySelector('.mde-player').dataset.frame > 3")
        assert page.problems == [] and page.asked == []
