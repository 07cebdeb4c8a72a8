"""The editor in JupyterLab, with a kernel: a frame is pinned, in-betweens are made, Python and the
page agree."""

import os

from browser import drawn, open_page
from jupyter_page import ASK, run_all

CELL = """import sys; sys.path.insert(0, {tests!r})
import torch
from synthetic_walk import walk
from motiondiff_edu.baselines.interpolation import spherical
from motiondiff_edu.widgets.editor import Editor
def make(positions, known, generator, samples=1, resample=1):
    shake = 0.02 * torch.randn(samples, 40, 21, 3, generator=generator).double().numpy()
    return spherical(positions, known) + shake * ~known[..., None]
editor = Editor(walk(frames=40)[0], make)
editor"""
ROOT = "document.querySelector('.mde-editor').dataset"


def test_pins_drags_and_in_betweens_in_jupyterlab(browser, lab):
    with open_page(browser, offline=False, viewport={"width": 1300, "height": 1000}) as page:
        canvas = run_all(page, lab, "mde-editor")
        canvas.focus()
        for key in ("Enter", "End", "Enter"):
            page.keyboard.press(key)
        page.wait_for_function(f"{ROOT}.pins === '0 39'")
        for key in ("j", "j", "Escape"):
            page.keyboard.press(key)
        page.get_by_label("Joint to move").select_option("RightHand")
        canvas.focus()
        page.keyboard.press("Shift+ArrowUp")
        page.get_by_text("RightHand in frame 39 moved by 5 cm").wait_for()
        page.keyboard.press("g")
        page.wait_for_function(f"{ROOT}.made === '3'")
        page.keyboard.press("]")
        page.wait_for_function(f"{ROOT}.chosen === '1'")
        assert "keyframe error 0.0 mm" in page.locator(".mde-measured").inner_text()
        drawn(canvas)
        asked = (
            "print(editor.chosen, editor.edit, "
            "bool((editor.samples[:, [0, 39]] == editor.positions[[0, 39]]).all()))"
        )
        heard = (page.evaluate(ASK, asked) for _ in range(40))
        assert "1 2 frames pinned (1 edited) True" in heard
        assert page.locator(".jp-Cell").count() == 1, "a key reached JupyterLab"
        page.evaluate(ASK, "editor.keep('trajectory'); editor.frame = 20")
        page.wait_for_function(f"{ROOT}.frame === '20'")
        assert "trajectory kept" in page.locator(".mde-held").inner_text()
        if folder := os.environ.get("MOTIONDIFF_SCREENSHOTS"):
            page.screenshot(path=os.path.join(folder, "editor_lab.png"))
        page.evaluate("() => window.jupyterapp.shell.currentWidget.sessionContext.shutdown()")
        page.get_by_role("button", name="Generate").click()
        page.get_by_text("kernel is gone. Your changes are still shown here").wait_for()
        assert page.locator(".mde-editor").get_attribute("data-made") == "3"
        assert page.problems == []
