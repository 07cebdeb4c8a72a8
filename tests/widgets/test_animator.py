"""What an animator does, in JupyterLab: a real walk, three frames pinned, an arm bent in one,
in-betweens, a file."""

import os

import numpy as np
import pytest
from browser import open_page
from jupyter_page import ASK, run_all

CELL = """import sys; sys.path.insert(0, {tests!r})
from functools import partial
import numpy as np
from motiondiff_edu.editing.inbetween import inbetween
from motiondiff_edu.motion.retarget import load_clip
from motiondiff_edu.motion.skeleton import JOINTS
from motiondiff_edu.pretrained import checkpoints
from motiondiff_edu.widgets.editor import Editor
walk = load_clip("WALK").world()[:57]
editor = Editor(walk, partial(inbetween, checkpoints.load("inbetweener"), steps=10))
editor"""
ROOT = "document.querySelector('.mde-editor').dataset"
CHECK = """
made, hand = editor.samples[editor.chosen], JOINTS.index("RightHand")
raised = made[28, hand, 1] - walk[28, hand, 1]
back = load_clip("in-between.bvh").world()
same = lambda x: x - x[:1, :1] * np.array([1.0, 0.0, 1.0])
print(np.array_equal(made[[0, 56]], walk[[0, 56]]), round(float(raised), 2),
      len(back), bool(np.abs(np.linalg.norm(back[:, 14] - back[:, 13], axis=-1)
                             - np.linalg.norm(made[:, 14] - made[:, 13], axis=-1)).max() < 2e-3),
      bool(np.abs(same(back)[..., 1] - same(made)[..., 1]).max() < 2e-2))
"""


@pytest.fixture
def address(monkeypatch, request, real_data):
    walk = real_data / "bvh" / "cmu_02_01_walk.bvh"
    monkeypatch.setattr(request.module, "CELL", CELL.replace("WALK", str(walk)))
    return request.getfixturevalue("lab")


def test_a_real_walk_is_edited_and_saved(browser, address, lab_folder):
    with open_page(browser, offline=False, viewport={"width": 1300, "height": 1000}) as page:
        canvas = run_all(page, address, "mde-editor")
        canvas.focus()
        for key in ("Home", "Enter", "End", "Enter"):
            page.keyboard.press(key)
        page.evaluate(ASK, "editor.frame = 28")
        page.wait_for_function(f"{ROOT}.frame === '28'")
        canvas.focus()
        page.keyboard.press("Enter")
        page.wait_for_function(f"{ROOT}.pins === '0 28 56'")
        page.get_by_label("Joint to move").select_option("RightHand")
        canvas.focus()
        for _ in range(4):
            # 5 cm each, along the screen, which leans back by 0.2 rad
            page.keyboard.press("Shift+ArrowUp")
        page.keyboard.press("g")
        page.wait_for_function(f"{ROOT}.made === '3'")
        assert "keyframe error 0.0 mm" in page.locator(".mde-measured").inner_text()
        if folder := os.environ.get("MOTIONDIFF_SCREENSHOTS"):
            page.screenshot(path=os.path.join(folder, "animator.png"))
        page.get_by_role("button", name="Save as BVH").click()
        page.wait_for_function("document.querySelector('.mde-say').textContent.startsWith('Saved')")
        kept, raised, frames, bones, heights = page.evaluate(ASK, CHECK).splitlines()[-1].split()
        assert (kept, frames, bones, heights) == ("True", "57", "True", "True")
        assert float(raised) == pytest.approx(0.2 * np.cos(0.2), abs=0.006)
        assert (lab_folder / "in-between.bvh").is_file() and page.problems == []
