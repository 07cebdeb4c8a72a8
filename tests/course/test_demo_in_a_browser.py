"""A demo moves before anybody has clicked, in a window without tabs and side bar."""

import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import nbformat
import pytest
from browser import PATIENCE, open_page
from jupyter_page import free_port, wait_until_answering

expect = pytest.importorskip("playwright.sync_api").expect
pytestmark = pytest.mark.browser

CELL = """import numpy as np
from motiondiff_edu.motion.skeleton import OFFSETS
from motiondiff_edu.widgets.player import Player
Player(np.cumsum(OFFSETS, 0)[None] + 0.02 * np.arange(80)[:, None, None], labels="alive")"""
START = """
import sys
from pathlib import Path
from motiondiff_edu import __main__ as command
from motiondiff_edu.course import places
places.PACKAGE = Path(sys.argv.pop(1)) / "motiondiff_edu"
sys.exit(command.main(sys.argv[1:]))
"""


@pytest.fixture
def address(chromium, tmp_path: Path):
    """The address of the demo of a notebook with a figure far below its title."""
    repo = tmp_path / "repo"
    (repo / "notebooks").mkdir(parents=True)
    (repo / "pyproject.toml").touch()
    text = nbformat.v4.new_markdown_cell("# Far below\n\n" + "words\n\n" * 60)
    cells = [text, nbformat.v4.new_code_cell(CELL)]
    nbformat.write(nbformat.v4.new_notebook(cells=cells), repo / "notebooks" / "07_far.ipynb")
    port, log = free_port(), tmp_path / "demo.log"
    options = ["--no-browser", "--expose-app-in-browser", f"--ServerApp.port={port}"]
    options += ["--ServerApp.port_retries=0", "--IdentityProvider.token=test"]
    environment = os.environ | {"MOTIONDIFF_CACHE": str(tmp_path / "cache")}
    with log.open("w") as out:
        server = subprocess.Popen(
            [sys.executable, "-c", START, str(repo), "demo", "07", *options],
            stdout=out, stderr=out, env=environment, start_new_session=True,
        )  # fmt: skip
        try:
            wait_until_answering(f"http://127.0.0.1:{port}/api/status?token=test", server, log)
            yield f"http://127.0.0.1:{port}/doc/tree/notebooks/07_far.ipynb?token=test"
        finally:
            # Asked to end while a kernel starts, Jupyter waits 15 s. Kernels end without it.
            os.killpg(server.pid, signal.SIGKILL)
            server.wait(60)


def test_a_demo_moves_without_a_click(address, browser):
    with open_page(browser, offline=False, viewport={"width": 1280, "height": 720}) as page:
        page.goto(address)
        iframe = page.locator(".jp-OutputArea iframe").first
        player = page.frame_locator(".jp-OutputArea iframe").first.locator(".mde-player")
        expect(player).to_have_attribute("data-frame", re.compile("[1-9]"), timeout=PATIENCE)
        box = iframe.bounding_box()
        assert box["y"] >= 0 and box["y"] + 400 < 720, "the figure is not in sight"
        assert not page.locator(".jp-FileBrowser").is_visible()
