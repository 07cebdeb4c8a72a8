"""A JupyterLab that serves one notebook, and the page that shows it.

Every test of a widget with a kernel uses it. It runs the CELL of the test's module.
"""

import json
import os
import socket
import subprocess
import sys
import time
import urllib.request

import pytest
from browser import PATIENCE

from motiondiff_edu.course.jupyter import end

ASK = """async (code) => {
  const panel = window.jupyterapp.shell.currentWidget, kernel = panel.sessionContext.session.kernel;
  let text = "";
  const future = kernel.requestExecute({ code });
  future.onIOPub = (m) => { if (m.header.msg_type === "stream") text += m.content.text; };
  await future.done;
  return text.trim();
}"""
IDLE = """() => {
  const panel = window.jupyterapp?.shell.currentWidget;
  return panel?.sessionContext?.isReady && panel.sessionContext.session?.kernel?.status === "idle";
}"""


def notebook(path, code: str) -> None:
    cell = {
        "cell_type": "code",
        "id": "player",
        "metadata": {},
        "source": code,
        "outputs": [],
        "execution_count": None,
    }
    spec = {"name": "python3", "display_name": "Python 3", "language": "python"}
    content = {
        "cells": [cell],
        "metadata": {"kernelspec": spec},
        "nbformat": 4,
        "nbformat_minor": 5,
    }
    path.write_text(json.dumps(content), "utf-8")


def free_port() -> int:
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


@pytest.fixture
def lab(chromium, root, tmp_path, request):
    """The address of a JupyterLab that serves one notebook.

    Its cell is the CELL of the test's module.
    """
    pytest.importorskip("jupyterlab")
    notebook(
        tmp_path / "walk.ipynb", request.module.CELL.format(tests=str(root / "tests" / "helpers"))
    )
    port, token = free_port(), "test"
    command = [
        sys.executable,
        "-m",
        "jupyter",
        "lab",
        "--no-browser",
        "--expose-app-in-browser",
        "--allow-root",
    ]
    command += [
        f"--ServerApp.port={port}",
        "--ServerApp.port_retries=0",
        f"--IdentityProvider.token={token}",
    ]
    command += [f"--ServerApp.root_dir={tmp_path}", "--LabApp.news_url=None"]
    command += ["--LabApp.check_for_updates_class=jupyterlab.NeverCheckForUpdate"]
    settings = {
        f"JUPYTERLAB_{name}_DIR": str(tmp_path / name) for name in ("SETTINGS", "WORKSPACES")
    }
    settings["PYTHONPATH"] = os.pathsep.join([str(root), os.environ.get("PYTHONPATH", "")])
    with open(tmp_path / "lab.log", "w") as log:
        server = subprocess.Popen(
            command, stdout=log, stderr=log, env=os.environ | settings, cwd=tmp_path
        )
    try:
        wait_until_answering(
            f"http://127.0.0.1:{port}/api/status?token={token}", server, tmp_path / "lab.log"
        )
        yield f"http://127.0.0.1:{port}/lab/tree/walk.ipynb?token={token}"
    finally:
        end(server)


def wait_until_answering(address: str, server, log) -> None:
    end_of_patience = time.monotonic() + PATIENCE / 1000
    while server.poll() is None and time.monotonic() < end_of_patience:
        try:
            urllib.request.urlopen(address, timeout=2).read()
            return
        except OSError:
            try:
                server.wait(0.25)
            except subprocess.TimeoutExpired:
                continue
    pytest.fail(f"JupyterLab did not start:\n{log.read_text()[-3000:]}")


def run_all(page, address: str, widget: str):
    """Open the notebook, run its cell, and return the widget's canvas once the kernel rests."""
    page.goto(address)
    page.wait_for_function(IDLE)
    page.evaluate("window.jupyterapp.commands.execute('notebook:run-all-cells')")
    canvas = page.locator(f".{widget} canvas").first
    canvas.wait_for()
    page.wait_for_function(IDLE)
    return canvas
