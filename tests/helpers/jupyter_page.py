"""A JupyterLab, and a page that shows a notebook of one cell: the CELL of the test's module.

Every test of a widget with a kernel uses it. One server serves all tests of a process, which share
its settings (conftest's `lab_server`); each has a folder, a kernel and a workspace of its own.
"""

import json
import os
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

import pytest
from browser import PATIENCE

from motiondiff_edu.course.jupyter import end

TOKEN = "test"
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


@dataclass(frozen=True)
class Lab:
    """A running JupyterLab, and the folder of its notebooks."""

    url: str
    folder: Path

    def opened(self, notebook: Path) -> str:
        """The address of a notebook, in a workspace of its own: no other notebook is open."""
        path = notebook.relative_to(self.folder).as_posix()
        return f"{self.url}/lab/workspaces/{notebook.parent.name}/tree/{path}?token={TOKEN}"

    def end_kernels(self) -> None:
        """End all kernels, so that those of later tests have the machine."""
        kernels = f"{self.url}/api/kernels"
        with urllib.request.urlopen(f"{kernels}?token={TOKEN}", timeout=60) as answer:
            running = json.load(answer)
        for one in running:
            ended = urllib.request.Request(f"{kernels}/{one['id']}?token={TOKEN}", method="DELETE")
            with suppress(urllib.error.HTTPError):  # it may have ended by itself
                urllib.request.urlopen(ended, timeout=60).close()


@contextmanager
def started_lab(folder: Path, root: Path) -> Iterator[Lab]:
    """A JupyterLab that serves this folder, until the end of the block."""
    port = free_port()
    options = [
        "--no-browser",
        "--expose-app-in-browser",
        "--allow-root",
        f"--ServerApp.port={port}",
        "--ServerApp.port_retries=0",
        f"--IdentityProvider.token={TOKEN}",
        f"--ServerApp.root_dir={folder}",
        "--LabApp.news_url=None",
        "--LabApp.check_for_updates_class=jupyterlab.NeverCheckForUpdate",
    ]
    settings = {f"JUPYTERLAB_{name}_DIR": str(folder / name) for name in ("SETTINGS", "WORKSPACES")}
    settings["PYTHONPATH"] = os.pathsep.join([str(root), os.environ.get("PYTHONPATH", "")])
    log = folder / "lab.log"
    with log.open("w") as out:
        server = subprocess.Popen(
            [sys.executable, "-m", "jupyter", "lab", *options],
            stdout=out, stderr=out, env=os.environ | settings, cwd=folder,
        )  # fmt: skip
        try:
            url = f"http://127.0.0.1:{port}"
            wait_until_answering(f"{url}/api/status?token={TOKEN}", server, log)
            yield Lab(url, folder)
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
