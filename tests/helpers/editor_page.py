"""A page with an editor whose messages reach the Python object, as in JupyterLab: both ends of the
wire, no server."""

import base64
import json
from pathlib import Path

import numpy as np
import torch

from motiondiff_edu.baselines.interpolation import spherical
from motiondiff_edu.widgets.editor import Editor
from motiondiff_edu.widgets.editor_page import BINARY, MODULE, PLAIN

MODEL = """
const decode = (s) => new DataView(Uint8Array.from(atob(s), (c) => c.charCodeAt(0)).buffer);
const state = {}, listeners = {}, dirty = new Set();
window.asked = []; window.leaked = 0;
document.addEventListener("keydown", () => { window.leaked++; });
const fire = (name) => (listeners["change:" + name] || []).forEach((f) => f());
window.take = (record) => {
  for (const [name, value] of Object.entries(record)) {
    state[name] = BINARY.includes(name) ? decode(value) : value;
  }
  for (const name of Object.keys(record)) fire(name);
};
window.model = {
  get: (name) => state[name],
  set: (name, value) => {
    if (state[name] !== value) { state[name] = value; dirty.add(name); fire(name); }
  },
  save_changes: () => {
    const record = Object.fromEntries([...dirty].map((name) => [name, state[name]]));
    dirty.clear();
    window.kernel({ traits: record });
  },
  send: (content) => { window.asked.push(content); window.kernel({ message: content }); },
  on: (name, f) => { (listeners[name] ||= []).push(f); },
  off: (name, f) => { listeners[name] = (listeners[name] || []).filter((g) => g !== f); },
};
window.listening = () => Object.values(listeners).flat().length;
window.take(RECORD);
window.cleanup = widget.render({ model: window.model, el: document.getElementById("here") });
"""

# What Python answers comes at once; after `delay` milliseconds; or where `holding`, by `letGo`.
WIRE = """
window.delay = 0; window.holding = false; window.held = []; window.sent = window.received = 0;
window.kernel = async (what) => {
  window.sent++;
  const changed = await window.kernelled(what);
  window.received++;
  if (window.holding) { window.held.push(changed); return; }
  if (window.delay) await new Promise((done) => setTimeout(done, window.delay));
  window.take(changed);
};
window.letGo = () => {
  window.holding = false;
  while (window.held.length) window.take(window.held.shift());
};
"""


def record(editor: Editor, names=BINARY + PLAIN) -> dict:
    """What the page has of an editor, as JSON takes it."""
    values = {name: getattr(editor, name) for name in names}
    return {
        name: base64.b64encode(v).decode() if isinstance(v, bytes) else v
        for name, v in values.items()
    }


def open_editor(page, folder: Path, editor: Editor, background: str = "#fff") -> None:
    """Show an editor; what the page sends is received by the object, and what changes there is told
    to the page."""
    told = record(editor)

    def kernel(what: dict) -> dict:
        for name, value in what.get("traits", {}).items():
            setattr(editor, name, value)
            told[name] = value
        if "message" in what:
            editor._receive(editor, what["message"], [])
        now = record(editor)
        changed = {name: value for name, value in now.items() if value != told[name]}
        told.update(changed)
        return changed

    page.expose_function("kernelled", kernel)
    source = MODULE.replace("export default", "const widget =", 1).replace(
        "export function", "function"
    )
    script = MODEL.replace("RECORD", json.dumps(told).replace("<", "\\u003c")).replace(
        "BINARY", json.dumps(BINARY)
    )
    path = folder / "page.html"
    style = f"body {{ background: {background}; margin: 8px; }}"
    body = f'<div id="here"></div><script type="module">\n{source}\n{WIRE}\n{script}</script>'
    path.write_text(
        f'<!doctype html><meta charset="utf-8"><style>{style}</style><body>{body}', "utf-8"
    )
    page.goto(path.as_uri())
    page.locator(".mde-editor").wait_for()


def settled(page) -> None:
    """Wait until Python has got all that was sent, and the page has got the answers."""
    answered = "!asked.length || model.get('state').received >= asked.at(-1).number"
    page.wait_for_function(f"sent === received && ({answered})")


def received(page) -> None:
    """Wait until Python has got all that was sent, whether the page has the answers or not."""
    page.wait_for_function("sent === received")


def guess(positions, known, generator, samples=1, resample=1):
    """Bones turned evenly between what is held, shaken; the more it is resampled, the less."""
    base = spherical(positions, known)
    shape = (samples, *base.shape[:2], 3)
    noise = 0.1 / resample * torch.randn(shape, generator=generator, dtype=torch.float64).numpy()
    return np.where(known[..., None], base, base + noise)
