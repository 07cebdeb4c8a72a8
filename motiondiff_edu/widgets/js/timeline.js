// The editor's timeline: a ruler to go along, and below it a tick for every frame, where frames are
// pinned.
import { GREEN, clamp, element, mix, rgba } from "./dom.js";

const RULER = 24;
const TRACK = 30;
const BAND = 8;
const EDGE = 14;
const DIAMOND = 8;

function labelStep(length, width) {
  // seconds between labels, so that they do not touch
  return [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 60].find((s) => (s / length) * width > 58) || 300;
}

// `go(frame)` shows it; `press(frame)` pins or releases it. `facts()`: { frames, fps, frame, pins,
// moved, part, made }
export function timeline(listen, facts, go, press, redraw) {
  const canvas = element("canvas", {
    class: "mde-lane mde-timeline",
    tabindex: "0",
    role: "slider",
    "aria-label": "Timeline",
    "aria-valuemin": "0",
    title:
      "Click or drag: go there. Double click or Enter: pin or release the frame. Arrows: frames.",
  });
  canvas.style.height = `${RULER + TRACK + BAND + 4}px`;
  let held = false;
  let hover = null;
  const across = (t, width) => EDGE + (t / Math.max(facts().frames - 1, 1)) * (width - 2 * EDGE);
  function under(event) {
    // the frame under the pointer; a pin close by is meant
    const box = canvas.getBoundingClientRect();
    const x = event.clientX - box.left;
    const { frames, pins } = facts();
    const near = pins
      .map((t) => [Math.abs(across(t, box.width) - x), t])
      .sort((a, b) => a[0] - b[0])[0];
    if (near && near[0] < 6) return near[1];
    return clamp(Math.round(((x - EDGE) / (box.width - 2 * EDGE)) * (frames - 1)), 0, frames - 1);
  }

  function diamond(pen, x, y, size, fill, edge) {
    pen.beginPath();
    pen.moveTo(x, y - size);
    pen.lineTo(x + size, y);
    pen.lineTo(x, y + size);
    pen.lineTo(x - size, y);
    pen.closePath();
    pen.fillStyle = fill;
    pen.fill();
    pen.strokeStyle = edge;
    pen.lineWidth = 1.5;
    pen.stroke();
  }

  function draw(theme, focus) {
    const ratio = devicePixelRatio || 1;
    const [w, h] = [canvas.clientWidth, canvas.clientHeight];
    if (!w || !h) return;
    canvas.width = Math.round(w * ratio);
    canvas.height = Math.round(h * ratio);
    const pen = canvas.getContext("2d");
    const { frames, fps, frame, pins, moved, part, made } = facts();
    const x = (t) => across(t, w);
    const middle = RULER + TRACK / 2;
    const gap = (w - 2 * EDGE) / Math.max(frames - 1, 1);
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.fillStyle = rgba(mix(theme.bg, theme.fg, 0.05));
    pen.fillRect(0, 0, w, RULER);
    pen.fillStyle = rgba(mix(theme.bg, theme.fg, 0.09));
    pen.fillRect(0, RULER, w, h - RULER);
    if (made) {
      // in-betweens lie between what is pinned
      pen.fillStyle = rgba(focus, 0.16);
      pen.fillRect(x(0), RULER + 5, x(frames - 1) - x(0), TRACK - 10);
    }
    const every = [1, 2, 5, 10, 20, 50].find((n) => n * gap >= 3) || 100;
    for (let t = 0; t < frames; t += every) {
      const tall = t % (fps / 2) === 0 ? 11 : 6;
      pen.fillStyle = rgba(theme.fg, t % (fps / 2) === 0 ? 0.5 : 0.32);
      pen.fillRect(x(t) - 0.5, middle - tall / 2, 1, tall);
    }
    pen.font = "12px system-ui, sans-serif";
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    pen.fillStyle = rgba(theme.fg, 0.8);
    const length = frames / fps;
    const step = labelStep(length, w);
    for (let s = 0; s * fps <= frames - 1; s += step) {
      const at = clamp(x(s * fps), 16, w - 16);
      pen.fillText(`${+s.toFixed(1)} s`, at, RULER / 2);
      pen.fillRect(x(s * fps) - 0.5, RULER - 4, 1, 4);
    }
    if (part) {
      pen.fillStyle = rgba(GREEN, 0.85);
      pen.fillRect(x(0), RULER + TRACK, x(frames - 1) - x(0), BAND - 2);
    }
    pen.fillStyle = rgba(focus);
    pen.fillRect(x(frame) - 1, 0, 2, h); // the playhead
    pen.beginPath();
    pen.moveTo(x(frame) - 7, 0);
    pen.lineTo(x(frame) + 7, 0);
    pen.lineTo(x(frame), 9);
    pen.fill();
    pins.forEach((t, i) => {
      diamond(pen, x(t), middle, DIAMOND, rgba(theme.fg), rgba(theme.bg));
      // joints were dragged there
      if (moved[i].length) diamond(pen, x(t), middle, 3.5, rgba(theme.bg), rgba(theme.bg));
    });
    if (hover != null) {
      pen.font = "600 12px system-ui, sans-serif";
      pen.textAlign = "center";
      pen.fillStyle = rgba(theme.fg);
      const words = `frame ${hover}`;
      const wide = pen.measureText(words).width / 2 + 5;
      const at = clamp(x(hover), wide, w - wide);
      pen.fillStyle = rgba(theme.fg);
      pen.fillRect(at - wide, 3, 2 * wide, RULER - 7);
      pen.fillStyle = rgba(theme.bg);
      pen.fillText(words, at, RULER / 2);
      pen.strokeStyle = rgba(theme.fg, 0.6);
      pen.lineWidth = 1;
      pen.strokeRect(x(hover) - 0.5, RULER, 1, TRACK);
    }
    canvas.setAttribute("aria-valuemax", String(frames - 1));
    canvas.setAttribute("aria-valuenow", String(frame));
    canvas.setAttribute(
      "aria-valuetext",
      `frame ${frame} of ${frames - 1}, ${(frame / fps).toFixed(2)} ` +
        `seconds${pins.includes(frame) ? ", pinned" : ""}`,
    );
  }

  listen(canvas, "pointerdown", (e) => {
    canvas.setPointerCapture(e.pointerId);
    canvas.focus({ preventScroll: true });
    held = true;
    go(under(e));
  });
  listen(canvas, "pointermove", (e) => {
    hover = under(e);
    if (held) go(hover);
    else redraw();
  });
  for (const name of ["pointerup", "pointercancel"])
    listen(canvas, name, () => {
      held = false;
    });
  listen(canvas, "dblclick", (e) => press(under(e)));
  listen(canvas, "pointerleave", () => {
    hover = null;
    redraw();
  });
  return { canvas, draw };
}
