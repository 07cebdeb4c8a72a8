"""A Chromium for the tests of widgets: started without network services, offline where a test says
so."""

import base64
import hashlib
import json
from contextlib import contextmanager
from pathlib import Path

import pytest

from motiondiff_edu.widgets.player import MODULE

PATIENCE = 600_000  # ms; how long a busy machine may take for anything a test waits for
FLAGS = (
    "--no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking "
    "--disable-component-update --disable-sync"
).split()


@contextmanager
def start_browser(executable: str):
    """A Chromium; close it before other tests run: playwright's event loop would stand in their
    way."""
    sync_api = pytest.importorskip("playwright.sync_api")
    with sync_api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=executable, args=FLAGS, timeout=PATIENCE
        )
        yield browser
        browser.close()


@contextmanager
def open_page(browser, offline: bool = True, **context):
    """A page whose errors are collected in `page.problems`; offline, any request but file: and
    data: is refused."""
    fresh = browser.new_context(**({"viewport": {"width": 1000, "height": 620}} | context))
    fresh.set_default_timeout(PATIENCE)
    page = fresh.new_page()
    page.problems, page.asked = [], []
    page.on("pageerror", lambda error: page.problems.append(str(error)))
    if offline:
        page.route("**/*", lambda route: _only_local(page, route))
    yield page
    fresh.close()


def _only_local(page, route) -> None:
    if route.request.url.startswith(("file:", "data:", "about:")):
        route.continue_()
    else:
        page.asked.append(route.request.url)
        route.abort()


def ink(canvas) -> str:
    """A fingerprint of what the canvas shows."""
    return hashlib.sha256(canvas.evaluate("c => c.toDataURL()").encode()).hexdigest()


def shown(page) -> int:
    """The frame that the player shows."""
    return int(page.locator(".mde-player").get_attribute("data-frame"))


UNTIL = """async (element, [condition, patience]) => {
  const holds = eval(condition), end = Date.now() + patience;
  while (!holds(element)) {
    if (Date.now() > end) throw new Error("it never came to be: " + condition);
    await new Promise((done) => setTimeout(done, 20));
  }
}"""


def until(locator, condition: str, patience: int = PATIENCE) -> None:
    """Wait until a JavaScript function of an element gives true, in whatever frame it is."""
    locator.evaluate(UNTIL, [condition, patience])


ANOTHER_FRAME = """() => new Promise((done) => {
  requestAnimationFrame(() => requestAnimationFrame(done));
})"""
COLOURED = """c => {
  const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
  let blue = 0, orange = 0;
  for (let i = 0; i < d.length; i += 4) {
    const [r, g, b] = [d[i], d[i + 1], d[i + 2]];
    if (b > r + 60 && b > g + 20) blue++;
    if (r > b + 80 && r > g + 50) orange++;
  }
  return { blue, orange };
}"""


def coloured(canvas) -> dict:
    """How many pixels of a canvas are as blue as the left limbs and as orange as the right ones."""
    return canvas.evaluate(COLOURED)


def drawn(canvas) -> None:
    """Wait until a figure is drawn, with over 200 pixels of either colour: the canvas comes
    first."""
    until(canvas, f"(c) => Math.min(...Object.values(({COLOURED})(c))) > 200")


# from now on `spoken` collects the words that a screen reader announces unasked
SPOKEN = """() => {
  const live = (node) => {
    for (let e = node; e; e = e.parentElement) {
      const told = e.getAttribute?.("aria-live");
      if (told) return told !== "off";
      if (e.tagName === "OUTPUT" || ["status", "alert", "log"].includes(e.getAttribute?.("role")))
        return true;
    }
    return false;
  };
  window.spoken = [];
  new MutationObserver((changes) => {
    for (const { target, addedNodes } of changes)
      if (addedNodes.length && live(target)) spoken.push(target.textContent);
  }).observe(document.body, { subtree: true, childList: true });
}"""

FAKE_MODEL = """
const decode = (s) => new DataView(Uint8Array.from(atob(s), (c) => c.charCodeAt(0)).buffer);
const state = RECORD, listeners = {};
for (const name of BINARY) state[name] = decode(state[name]);
window.saved = []; window.leaked = 0; window.lost = false;
document.addEventListener("keydown", () => { window.leaked++; });
const fire = (name) => (listeners["change:" + name] || []).forEach((f) => f());
window.model = {
  get: (name) => state[name],
  set: (name, value) => { if (state[name] !== value) { state[name] = value; fire(name); } },
  save_changes: () => { window.saved.push({ ...state }); },
  send: () => { if (window.lost) throw new Error("Cannot send"); }, // as JupyterLab does
  on: (name, f) => { (listeners[name] ||= []).push(f); },
  off: (name, f) => { listeners[name] = (listeners[name] || []).filter((g) => g !== f); },
};
window.answer = (content) => { (listeners["msg:custom"] || []).forEach((f) => f(content)); };
window.listening = () => Object.values(listeners).flat().length;
window.cleanup = widget.render({ model: window.model, el: document.getElementById("here") });
window.another = () => { // a second view; as in anywidget, it gets a model object of its own
  const el = document.body.appendChild(document.createElement("div"));
  return widget.render({ model: { ...window.model }, el });
};
"""


def bare_page(folder: Path, module: Path | str, record: dict, binary: list[str]) -> str:
    """Write a page that runs an ES module (its file or its text) with a fake model on `record`;
    return its address.

    In the page: model, saved (states sent to Python), leaked (keys that reached the document),
    cleanup.
    """
    text = module if isinstance(module, str) else module.read_text("utf-8")
    source = text.replace("export default", "const widget =", 1)
    script = FAKE_MODEL.replace("RECORD", json.dumps(record)).replace("BINARY", json.dumps(binary))
    page = folder / "page.html"
    body = f'<div id="here"></div><script type="module">\n{source}\n{script}</script>'
    page.write_text(f'<!doctype html><meta charset="utf-8"><body>{body}', "utf-8")
    return page.as_uri()


BINARY = ["joints", "roots", "contacts", "sound", "strips"]


def player_page(folder: Path, player) -> str:
    """A bare page with a player as it runs in JupyterLab; return its address."""
    record = {name: base64.b64encode(getattr(player, name)).decode() for name in BINARY}
    record |= {
        "scene": player.scene,
        "music": player.music,
        "notes": player.notes,
        "frame": player.frame,
        "playing": player.playing,
    }
    return bare_page(folder, MODULE, record, BINARY)
