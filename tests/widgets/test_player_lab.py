"""The whole path: JupyterLab, a kernel, a browser; the figure has ink, plays with its sound, and
Python hears of it."""

import os

from browser import drawn, ink, open_page
from jupyter_page import ASK, run_all

CELL = """import sys; sys.path.insert(0, {tests!r})
from click_track import RATE, clicks
from synthetic_walk import walk
from motiondiff_edu.widgets.player import Player, Soundtrack
positions, contacts = walk(frames=40)
sound = Soundtrack(clicks([0.5, 1, 1.5], 2), sample_rate=RATE)
player = Player(positions, contacts=contacts, past=10, labels="walker", audio=sound)
player"""
HEARD = "document.querySelector('.mde-player audio').currentTime"
SHOWN = "Number(document.querySelector('.mde-player').dataset.frame)"


def test_figure_plays_in_jupyterlab_and_python_sees_it(browser, lab):
    size = {"width": 1300, "height": 900}
    with open_page(browser, offline=False, viewport=size) as page:
        canvas = run_all(page, lab, "mde-player")
        drawn(canvas)
        first = ink(canvas)
        page.locator(".mde-player").get_by_role("button", name="Play").click()
        page.wait_for_function(f"{SHOWN} > 5 && {HEARD} > 0.25")
        canvas.focus()
        page.keyboard.press(" ")
        page.keyboard.press("End")
        page.keyboard.press("ArrowLeft")
        page.wait_for_function(f"{SHOWN} === 38")
        assert ink(canvas) != first
        assert page.locator(".jp-Cell").count() == 1, "a key reached JupyterLab"
        heard = (page.evaluate(ASK, "print(player.frame, player.playing)") for _ in range(40))
        assert "38 False" in heard, "Python was not told the frame"
        page.evaluate(ASK, "player.frame = 33")
        page.wait_for_function(f"{SHOWN} === 33 && Math.abs({HEARD} - 1.65) < 0.001")
        if folder := os.environ.get("MOTIONDIFF_SCREENSHOTS"):
            page.screenshot(path=os.path.join(folder, "player_lab.png"))
        assert page.problems == []
