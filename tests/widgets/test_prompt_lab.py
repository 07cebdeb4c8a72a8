"""The prompt box in JupyterLab, with the mover of the course, used by keyboard and by mouse."""

import os

from browser import drawn, open_page
from jupyter_page import ASK, run_all

CELL = """import sys; sys.path.insert(0, {tests!r})
import motiondiff_edu as md
from motiondiff_edu.metrics.texts import actions
from motiondiff_edu.widgets.prompt import Prompt
box = Prompt(md.load("mover"), "walks forward", seconds=3.0)
box"""
CHECK = """
print([{a.verb for a in actions(one.positions)} >= {"kick"} for one in box.motions].count(True))
"""
SAYS = """(words) =>
  document.querySelector(".widget-html [role=alert]")?.innerText.includes(words)"""
SILLY = {  # what is typed, and what the box says
    "": "the text is empty",
    "does a cartwheel": "does not know 'cartwheel'",
    "läuft vorwärts und winkt": "does not know",
    "走る": "has no English words",
    "<img src=x onerror=alert(1)>": "does not know",
    "walks " * 400: "the network reads 64 at most",
}


def test_a_sentence_is_typed_and_acted_in_jupyterlab(browser, lab):
    with open_page(browser, offline=False, viewport={"width": 1300, "height": 900}) as page:
        canvas = run_all(page, lab, "mde-player")
        drawn(canvas)
        folder = os.environ.get("MOTIONDIFF_SCREENSHOTS")
        page.evaluate(ASK, "first = box.motions")
        sentence = page.get_by_label("sentence")
        for text, words in SILLY.items():
            sentence.fill(text)
            sentence.press("Enter")
            page.wait_for_function(SAYS, arg=words)
            if folder:
                page.screenshot(path=os.path.join(folder, f"prompt_{len(text)}.png"))
            assert page.evaluate(ASK, "print(box.motions is first)") == "True"
        sentence.press("Control+A")
        page.keyboard.type("kicks with the left foot")  # keys, not a value: none may reach Lab
        page.get_by_role("button", name="Act").click()
        page.locator(".widget-html [role=alert]").wait_for(state="detached")
        page.wait_for_function("!document.querySelector('button[disabled]')")
        assert int(page.evaluate(ASK, CHECK)) >= 3
        page.get_by_label("seed").fill("7")
        page.get_by_label("seed").press("Enter")
        sentence.fill("marches ahead")
        sentence.press("Enter")
        page.get_by_text("'marches' is read as 'walk'").wait_for()
        assert page.evaluate(ASK, "print(box.seed.value, box.text.value)") == "7 marches ahead"
        if folder:
            page.screenshot(path=os.path.join(folder, "prompt_lab.png"))
        assert page.locator(".jp-Cell").count() == 1, "a key reached JupyterLab"
        assert page.problems == []
