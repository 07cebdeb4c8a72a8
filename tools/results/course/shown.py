"""What readers see of the notebooks: their form, their figures in words, the pages, the demos.

Needs `make pages` (for build/executed and build/pages), playwright and Chromium. The time of a demo
depends on the machine: it is that of the page, from its address to the first moving figure, after
one demo has prepared the notebook.
"""

import os
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ... import backed_numbers, check_notebooks, notebook_cells
from ...pages import raw
from ..walks.scores import Measure

EXECUTED, PAGES = Path("build/executed"), Path("build/pages")
DEMOS = ("00", "07", "12", "15")
SCREEN = {"width": 1280, "height": 720}
MOVES = "Number(document.querySelector('.mde-player')?.dataset.frame) > 0"


def form() -> dict[str, float]:
    """The most words of a short path, and the most new ideas, over all notebooks."""
    read = [notebook_cells.read(path) for path in notebook_cells.sources()]
    return {
        "words_max": max(check_notebooks.words_of(one, extra=False) for one in read),
        "ideas_max": max(len(check_notebooks.ideas(one)) for one in read),
    }


def unbacked(executed: Path) -> int:
    """Figures in answers that no cell before them has printed."""
    found = backed_numbers.unbacked_in(executed)
    print("\n".join(found))
    return len(found)


def raw_on_pages(browser, pages: Path) -> dict[str, int]:
    """Formulas as TeX, and widgets as Python's words, that a reader sees on the pages."""
    counts = {"pages_raw_formulas": 0, "pages_raw_widgets": 0}
    for path in sorted([*pages.glob("*.html"), *pages.glob("docs/*.html")]):
        context = browser.new_context(viewport=SCREEN, offline=True)
        page = context.new_page()
        page.goto(path.resolve().as_uri())
        text, told = page.evaluate(raw.VISIBLE)
        counts["pages_raw_formulas"] += len(raw.raw_formulas(text))
        counts["pages_raw_widgets"] += len(raw.raw_widgets(text, told))
        context.close()
    return counts


@contextmanager
def demo(number: str) -> Iterator[str]:
    """The address of a running demo."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    name = next(p.name for p in notebook_cells.sources() if p.name.startswith(number))
    command = [sys.executable, "-m", "motiondiff_edu", "demo", number, "--no-browser"]
    command += ["--expose-app-in-browser", f"--ServerApp.port={port}"]
    command += ["--ServerApp.port_retries=0", "--IdentityProvider.token=demo"]
    quiet = subprocess.DEVNULL
    server = subprocess.Popen(command, stdout=quiet, stderr=quiet)
    host = f"http://127.0.0.1:{port}"
    try:
        while server.poll() is None:
            try:
                urllib.request.urlopen(f"{host}/api/status?token=demo", timeout=5).close()
                break
            except (urllib.error.URLError, OSError):
                time.sleep(0.2)
        if server.poll() is not None:
            sys.exit(
                f"the demo of notebook {number} did not start: try `motiondiff-edu demo {number}`"
            )
        yield f"{host}/doc/tree/notebooks/{name}?token=demo"
    finally:
        server.terminate()
        server.wait(30)


def first_motion(browser, number: str) -> float:
    """Seconds from a demo's address to a figure that moves, without a click."""
    with demo(number) as address:
        page = browser.new_page(viewport=SCREEN)
        began = time.perf_counter()
        page.goto(address)
        frame = page.wait_for_selector(".jp-OutputArea iframe", timeout=120_000).content_frame()
        frame.wait_for_function(MOVES, timeout=120_000)
        seconds = time.perf_counter() - began
        page.close()
    return seconds


def shown_records(command: str) -> list[dict]:
    """The records of the part "course-shown".

    Exits where `make pages` has not been run, or there is no Chromium.
    """
    chromium = next(filter(None, map(shutil.which, ("chromium", "google-chrome"))), None)
    if not (EXECUTED.is_dir() and PAGES.is_dir() and chromium):
        sys.exit("course-shown needs build/executed, build/pages (make pages) and Chromium")
    from playwright.sync_api import sync_playwright  # only where it is needed

    values: dict[str, tuple[float, str]] = {
        name: (value, "count") for name, value in form().items()
    }
    values["prose_numbers_unbacked"] = unbacked(EXECUTED), "count"
    with tempfile.TemporaryDirectory() as cache, sync_playwright() as playwright:
        os.environ["MOTIONDIFF_CACHE"] = cache
        flags = ["--no-sandbox", "--disable-gpu"]
        browser = playwright.chromium.launch(executable_path=chromium, args=flags)
        found = raw_on_pages(browser, PAGES)
        values |= {name: (float(count), "count") for name, count in found.items()}
        times = {}
        for number in DEMOS:
            with demo(number):  # prepares it
                pass
            times[number] = first_motion(browser, number)
            print(f"demo {number}: {times[number]:.1f} s")
        values["demo_first_motion_s"] = max(times.values()), "s"
        browser.close()
    about = {"demos": list(DEMOS), "screen": "1280 x 720"}
    return [
        Measure(name, float(v), float(v), float(v), unit).as_record("course.", about, command)
        for name, (v, unit) in values.items()
    ]
