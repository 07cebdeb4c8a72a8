// The path pad: draw on a floor grid where a figure shall walk. Seen from above: the figure starts
// at the origin, facing up; z is up on the screen and x, the figure's left, is to the left.

import { GREEN, element, listener, redrawn, rgba } from "./dom.js";

const PAD_CSS = `
.mde-pad { --bg: var(--jp-layout-color0, #ffffff); --fg: var(--jp-ui-font-color1, #1f2933);
  --line: var(--jp-border-color2, #c9d1da); --focus: var(--jp-brand-color1, #1976d2);
  display: flex; flex-direction: column; gap: 6px; background: var(--bg);
  color: var(--fg); box-sizing: border-box;
  font: 15px/1.3 var(--jp-ui-font-family, system-ui, sans-serif); padding: 6px;
  width: 100%; max-width: 620px; }
.mde-pad canvas { width: 100%; display: block; border-radius: 8px; cursor: crosshair;
  touch-action: none; outline: none; }
.mde-pad canvas:focus-visible, .mde-pad :is(button, input, select):focus-visible {
  outline: 3px solid var(--focus); outline-offset: 1px; }
.mde-pad-row { display: flex; flex-wrap: wrap; align-items: center; gap: 6px 12px; }
.mde-pad-row label { display: inline-flex; align-items: center; gap: 6px; }
.mde-pad-row input[type=range] { accent-color: var(--focus); width: 140px; }
.mde-pad-row button, .mde-pad-row select { font: inherit; color: inherit; background: transparent;
  border: 1px solid var(--line); border-radius: 6px; padding: 3px 10px; min-height: 30px;
  cursor: pointer; }
.mde-pad-row select option { color: #1f2933; background: #fff; }
.mde-pad-row output { font-variant-numeric: tabular-nums; }`;
const SILENCE = 5000; // milliseconds
const DEAF =
  "The notebook's kernel does not answer: it is busy with another cell, or not running. Until it " +
  "does, nothing walks along what is drawn here, and ready-made paths do not come.";
const STEP = 0.5; // metres

const apart = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]);
const lengthOf = (points) => points.slice(1).reduce((sum, p, i) => sum + apart(p, points[i]), 0);
const rounded = (p) => p.map((v) => Math.round(v * 100) / 100);

export function mount(model, el) {
  const canvas = element("canvas", {
    tabindex: "0",
    role: "application",
    "aria-roledescription": "path pad",
    title:
      "Draw a path. Or use the keyboard: arrows add half a metre, Backspace takes it back, " +
      "C clears, R resets.",
  });
  const presets = element(
    "select",
    { "aria-label": "Ready-made path" },
    element("option", { value: "" }, "drawn by hand"),
    ...model.get("presets").map((name) => element("option", { value: name }, name)),
  );
  const speed = element("input", {
    type: "range",
    min: "0.3",
    max: "3",
    step: "0.1",
    "aria-label": "Speed in metres a second",
  });
  const told = element("output", { "aria-live": "off" });
  const words = element("output", { "aria-live": "polite" });
  const length = element("output", { "aria-live": "off" }); // while one draws
  const clear = element("button", { type: "button" }, "Clear");
  const reset = element("button", { type: "button" }, "Reset");
  const root = element(
    "div",
    { class: "mde-pad", "data-lm-suppress-shortcuts": "true" },
    element("style", {}, PAD_CSS),
    canvas,
    element(
      "div",
      { class: "mde-pad-row" },
      presets,
      element("label", {}, "speed", speed, told),
      clear,
      reset,
    ),
    element("div", { class: "mde-pad-row" }, length, words),
  );
  el.append(root);
  const stop = new AbortController();
  const listen = listener(stop);
  let points = model.get("line");
  let drawing = false;
  let frame = null; // what part of the floor is shown
  let pen = null;
  let deaf = false;
  let silence = 0; // the timer that ends in `deaf`

  function shownFloor() {
    // metres shown: always the start with some room, and the whole path
    const xs = [-3.5, 3.5, ...points.map((p) => p[0])];
    const zs = [-1.5, 6.5, ...points.map((p) => p[1])];
    const [x0, x1] = [Math.min(...xs) - 0.5, Math.max(...xs) + 0.5];
    const [z0, z1] = [Math.min(...zs) - 0.5, Math.max(...zs) + 0.5];
    const [w, h] = [canvas.clientWidth, canvas.clientHeight];
    const scale = Math.min(w / (x1 - x0), h / (z1 - z0));
    return { scale, x: (x0 + x1) / 2, z: (z0 + z1) / 2, w, h };
  }
  const toPixel = ([x, z]) => [
    frame.w / 2 - (x - frame.x) * frame.scale,
    frame.h / 2 - (z - frame.z) * frame.scale,
  ];
  const toMetres = (e) => {
    const box = canvas.getBoundingClientRect();
    return [
      frame.x - (e.clientX - box.left - frame.w / 2) / frame.scale,
      frame.z - (e.clientY - box.top - frame.h / 2) / frame.scale,
    ];
  };

  function paintGrid(fg) {
    pen.font = "13px system-ui, sans-serif";
    pen.fillStyle = fg;
    pen.textBaseline = "middle";
    const [halfW, halfH] = [frame.w / 2 / frame.scale, frame.h / 2 / frame.scale];
    const every = frame.scale < 22 ? 5 : frame.scale < 45 ? 2 : 1;
    const line = (a, b, strong) => {
      pen.globalAlpha = strong ? 0.45 : 0.16;
      pen.lineWidth = strong ? 1.5 : 1;
      pen.strokeStyle = fg;
      pen.beginPath();
      pen.moveTo(...toPixel(a));
      pen.lineTo(...toPixel(b));
      pen.stroke();
      pen.globalAlpha = 1;
    };
    for (let x = Math.ceil(frame.x - halfW); x <= frame.x + halfW; x++)
      line([x, frame.z - halfH], [x, frame.z + halfH], x === 0);
    pen.textAlign = "left";
    for (let z = Math.ceil(frame.z - halfH); z <= frame.z + halfH; z++) {
      line([frame.x - halfW, z], [frame.x + halfW, z], z === 0);
      if (
        z % every === 0 &&
        z !== 0 &&
        toPixel([0, z])[1] < frame.h - 30 &&
        toPixel([0, z])[1] > 20
      )
        pen.fillText(`${z} m`, 6, toPixel([0, z])[1] - 9);
    }
    pen.textAlign = "center";
    for (let x = Math.ceil(frame.x - halfW); x <= frame.x + halfW; x++) {
      const across = toPixel([x, 0])[0];
      const whole = across > 20 && across < frame.w - 20; // a label cut in half misleads
      if (x % every === 0 && x !== 0 && whole)
        pen.fillText(`${Math.abs(x)} m`, across, frame.h - 10);
    }
    const middle = toPixel([0, 0])[0];
    pen.fillText("\u2190 left", middle - 36, frame.h - 28);
    pen.fillText("right \u2192", middle + 36, frame.h - 28);
  }

  function arrow([x, y], angle, size, colour) {
    pen.save();
    pen.translate(x, y);
    pen.rotate(angle);
    pen.fillStyle = colour;
    pen.beginPath();
    pen.moveTo(0, -size);
    pen.lineTo(size * 0.62, size * 0.7);
    pen.lineTo(0, size * 0.35);
    pen.lineTo(-size * 0.62, size * 0.7);
    pen.closePath();
    pen.fill();
    pen.restore();
  }

  function at(metres) {
    // the point that lies so far along the path
    let left = metres;
    for (let i = 1; i < points.length; i++) {
      const part = apart(points[i], points[i - 1]);
      if (left <= part && part > 0)
        return points[i].map((v, k) => points[i - 1][k] + (left / part) * (v - points[i - 1][k]));
      left -= part;
    }
    return points.at(-1);
  }

  function draw() {
    const ratio = devicePixelRatio || 1;
    const [w, h] = [canvas.clientWidth, canvas.clientHeight];
    if (!w || !h) return;
    canvas.width = Math.round(w * ratio);
    canvas.height = Math.round(h * ratio);
    if (!drawing) frame = shownFloor();
    const style = getComputedStyle(root);
    const fg = style.color;
    pen = canvas.getContext("2d");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.fillStyle = style.backgroundColor;
    pen.fillRect(0, 0, w, h);
    pen.globalAlpha = 0.05;
    pen.fillStyle = fg;
    pen.fillRect(0, 0, w, h);
    pen.globalAlpha = 1;
    paintGrid(fg);
    const pixels = points.map(toPixel);
    if (pixels.length > 1) {
      pen.strokeStyle = rgba(GREEN);
      pen.lineWidth = 5;
      pen.lineJoin = pen.lineCap = "round";
      pen.beginPath();
      pixels.forEach((p, i) => (i ? pen.lineTo(...p) : pen.moveTo(...p)));
      pen.stroke();
      const [b, a] = [pixels.at(-1), pixels.at(-Math.min(4, pixels.length))];
      arrow(b, Math.atan2(b[0] - a[0], a[1] - b[1]), 15, rgba(GREEN));
    }
    for (const s of model.get("stops")) {
      const [x, y] = toPixel(at(s));
      pen.fillStyle = "#D55E00";
      pen.fillRect(x - 8, y - 8, 16, 16);
      pen.fillStyle = fg;
      pen.textAlign = "left";
      pen.fillText("stop", x + 14, y);
    }
    arrow(toPixel([0, 0]), 0, 17, fg);
    pen.fillStyle = fg;
    pen.textAlign = "left";
    pen.font = "600 14px system-ui, sans-serif";
    pen.fillText("start, facing up", toPixel([0, 0])[0] + 18, toPixel([0, 0])[1] + 14);
    const metres = lengthOf(points);
    const pace = Number(speed.value);
    told.textContent = `${pace.toFixed(1)} m/s`;
    const text = deaf
      ? DEAF
      : points.length < 2
        ? "No path yet: draw one, or choose one."
        : `${metres.toFixed(1)} m` +
          (model.get("seconds") ? `, ${model.get("seconds").toFixed(1)} s from rest to rest` : "");
    length.textContent = drawing ? `${metres.toFixed(1)} m` : "";
    if (words.textContent !== text || drawing) words.textContent = drawing ? "" : text;
    canvas.setAttribute("aria-label", `Floor seen from above. ${length.textContent || text}`);
    root.dataset.points = String(points.length);
  }

  function send(changes) {
    for (const [name, value] of Object.entries(changes)) model.set(name, value);
    model.save_changes(); // without a word where the kernel was restarted
    clearTimeout(silence);
    silence = setTimeout(() => hear(false), SILENCE);
    try {
      model.send({ do: "ping" });
    } catch {
      hear(false);
    } // it throws then
  }
  function hear(there) {
    clearTimeout(silence);
    deaf = !there;
    draw();
  }
  const onMessage = () => hear(true);
  function drawn() {
    presets.value = "";
    send({ line: points.map(rounded), stops: [], preset: "" });
    draw();
  }
  function restore() {
    const first = { line: [], stops: [], preset: "", speed: 1.2, ...model.get("start") };
    speed.value = String(first.speed);
    presets.value = first.preset;
    points = first.line;
    send(first);
    draw();
  }
  function add(dx, dz) {
    const [x, z] = points.at(-1) || [0, 0];
    points = [...(points.length ? points : [[0, 0]]), [x + dx, z + dz]];
    drawn();
  }
  const keys = {
    ArrowUp: () => add(0, STEP),
    ArrowDown: () => add(0, -STEP),
    ArrowLeft: () => add(STEP, 0),
    ArrowRight: () => add(-STEP, 0),
    Backspace: () => {
      points = points.slice(0, -1);
      drawn();
    },
    c: () => {
      points = [];
      drawn();
    },
    r: restore,
  };
  listen(root, "keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    event.stopPropagation(); // else JupyterLab takes the key for its own
    const act = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (event.target === canvas && act) {
      event.preventDefault();
      act();
    }
  });
  listen(canvas, "pointerdown", (e) => {
    const p = toMetres(e);
    points =
      points.length && apart(p, points.at(-1)) < 14 / frame.scale ? [...points] : [[0, 0], p];
    drawing = true;
    canvas.setPointerCapture(e.pointerId);
    canvas.focus({ preventScroll: true });
    draw();
  });
  listen(canvas, "pointermove", (e) => {
    if (!drawing) return;
    for (const event of e.getCoalescedEvents?.() || [e]) {
      const p = toMetres(event);
      if (apart(p, points.at(-1)) > 0.06) points.push(p);
    }
    draw();
  });
  listen(canvas, "pointerup", (e) => {
    if (drawing) {
      drawing = false;
      drawn();
    }
  });
  listen(canvas, "pointercancel", (e) => {
    if (drawing) {
      drawing = false;
      onLine();
    }
  });
  listen(presets, "change", () => send({ preset: presets.value }));
  listen(speed, "input", draw);
  listen(speed, "change", () => send({ speed: Number(speed.value) }));
  listen(clear, "click", () => {
    points = [];
    drawn();
  });
  listen(reset, "click", restore);
  const onLine = () => {
    if (!drawing) {
      points = model.get("line");
      draw();
    }
  };
  const onPreset = () => {
    presets.value = model.get("preset");
  };
  const onSpeed = () => {
    speed.value = String(model.get("speed"));
    draw();
  };
  const changes = {
    "change:line": onLine,
    "change:stops": onLine,
    "change:preset": onPreset,
    "change:speed": onSpeed,
    "change:seconds": draw,
    "msg:custom": onMessage,
  };
  for (const [name, f] of Object.entries(changes)) model.on(name, f);
  canvas.style.height = `${model.get("height")}px`;
  speed.value = String(model.get("speed"));
  onPreset();
  redrawn(stop, canvas, draw);
  draw();
  return () => {
    stop.abort();
    clearTimeout(silence);
    for (const [name, f] of Object.entries(changes)) model.off(name, f);
    root.remove();
  };
}

export default { render: ({ model, el }) => mount(model, el) };
