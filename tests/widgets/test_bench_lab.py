"""The repair bench in JupyterLab, with the walker of the course: an arm is knocked out by hand,
mended, and read."""

import os

from browser import drawn, open_page
from jupyter_page import ASK, run_all

CELL = """import sys; sys.path.insert(0, {tests!r})
import numpy as np
from data_synth.walking import walk
from motiondiff_edu.pretrained import checkpoints
from motiondiff_edu.motion.skeleton import JOINTS
from motiondiff_edu.widgets.bench import Bench
clip = walk(np.tile([1.2, 0.0, 0.4], (60, 1)), seed=6)
bench = Bench(checkpoints.load("walker"), clip, samples=3, rounds=2, steps=5)
bench"""
CHECK = """
hand, T_h = JOINTS.index("RightHand"), bench.bench.T_h
truth, mean = clip.world()[bench.first : bench.first + T_h], bench.outcome.motions[0]
off = np.linalg.norm(mean - truth, axis=-1)
lost = [divmod(n, len(JOINTS)) for n in bench.missing]
print(bench.shows_repairs, lost == [(t, hand) for t in range(3)],
      float(np.delete(off.flatten(), bench.missing).max()) < 1e-5,
      0 < float(off.flatten()[bench.missing].mean()) < 0.3)
"""
ROOT = "document.querySelector('.mde-bench').dataset"


def test_a_hand_is_knocked_out_and_mended_in_jupyterlab(browser, lab):
    with open_page(browser, offline=False, viewport={"width": 1300, "height": 1000}) as page:
        canvas = run_all(page, lab, "mde-bench")
        page.get_by_label("A click on a joint changes it").select_option("one")
        canvas.focus()
        page.keyboard.press("Home")
        # the right hand, in the first three frames
        for key in (" ", "ArrowRight", " ", "ArrowRight", " "):
            page.keyboard.press(key)
        page.wait_for_function(f"{ROOT}.missing === '3'")
        page.get_by_role("button", name="Repair").click()
        page.wait_for_function(f"{ROOT}.repairs === '4'")
        # of itself, so that the repair is seen
        page.wait_for_function(f"{ROOT}.playing === 'true'")
        assert "the mean of 3 repairs" in page.locator("output.mde-said").inner_text()
        canvas.focus()
        page.keyboard.press("Home")
        page.wait_for_function(f"{ROOT}.state === 'mean of 3 repairs'")
        drawn(canvas)
        assert page.evaluate(ASK, CHECK).splitlines()[-1] == "True True True True"
        if folder := os.environ.get("MOTIONDIFF_SCREENSHOTS"):
            page.screenshot(path=os.path.join(folder, "bench_lab.png"))
        page.evaluate(ASK, "bench.missing = []")
        page.wait_for_function(f"{ROOT}.missing === '0' && {ROOT}.repairs === '0'")
        assert page.locator(".jp-Cell").count() == 1, "a key reached JupyterLab"
        assert page.problems == []
