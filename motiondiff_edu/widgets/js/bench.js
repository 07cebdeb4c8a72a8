// The repair bench: a figure whose joints are removed by a click, a map of frames and joints below
// it, and the kernel's repair: the mean as a body, each repair as thin limbs, the truth as an
// outline. `model` needs get, set, save_changes, on, off.

import {
  CSS,
  GREEN,
  clamp,
  element,
  listener,
  mix,
  readTheme,
  redrawn,
  rgba,
  sighted,
} from "./dom.js";
import { unpack } from "./figures.js";
import { camera, paintBody, paintFloor, paintText, smoothRoot } from "./paint.js";
import {
  GUTTER,
  MAP_HEIGHT,
  PURPLE,
  paintGhost,
  paintMap,
  paintMark,
  paintOutline,
  ready,
  without,
} from "./bench_paint.js";
import { silentClock } from "./clock.js";

const STYLE = `
.mde-bench canvas.mde-figure { cursor: pointer; }
.mde-bench output.mde-said { min-height: 2.7em; flex: 1 1 100%; }
.mde-bench button[aria-disabled=true] { opacity: .5; cursor: default; }`;
const STILL = 5; // pixels within which a press is a click, and no drag
const HOME = { yaw: 0.6, pitch: 0.2, zoom: 1 };
const SILENCE = 5000; // milliseconds
const MUTE = "The notebook's kernel does not answer: it is busy with another cell, or not running.";
const GONE =
  "The notebook's kernel is gone, so nothing can be repaired. Restart it, and run the notebook's " +
  "cells again.";
const NOTHING = new DataView(new ArrayBuffer(0));

export function mount(model, el, { fill = false } = {}) {
  const scene = model.get("scene");
  const { T_h, names, frames, fps } = scene;
  const J = names.length;
  const size = T_h * J;
  const button = (text, extra = {}) => element("button", { type: "button", ...extra }, text);
  const canvas = element("canvas", {
    tabindex: "0",
    class: "mde-figure",
    role: "application",
    "aria-roledescription": "repair bench",
    title:
      "Click a joint: remove it or restore it. Drag: turn. Arrows: frame and joint, Space: " +
      "remove. P: play. T: truth. R: reset.",
  });
  const map = element("canvas", {
    tabindex: "0",
    class: "mde-lane",
    role: "application",
    "aria-roledescription": "map of the frames",
    title: "Click a frame of the window: remove it or restore it. Arrows: frame, Space: remove.",
  });
  const play = button("", { class: "mde-play" });
  const repair = button("Repair", { style: "font-weight:600" });
  const reset = button("Reset");
  const speeds = element(
    "select",
    { "aria-label": "Speed" },
    ...[0.1, 0.25, 0.5, 1].map((v) => element("option", { value: String(v) }, `${v}\u00d7`)),
  );
  const scope = element(
    "select",
    { "aria-label": "A click on a joint changes it" },
    element("option", { value: "all" }, "in the whole window"),
    element("option", { value: "one" }, "in this frame only"),
  );
  const truth = element("input", { type: "checkbox", checked: true });
  const body = element("select", { "aria-label": "Which repair is the body" });
  const from = element("input", {
    type: "range",
    min: "0",
    max: String(scene.last_first),
    step: "1",
    "aria-label": "First frame of the window",
  });
  const note = element("output", { class: "mde-said", "aria-live": "polite" });
  const faults = scene.faults.map(({ name, missing }) => [button(name), missing]);
  const key = (colour, word) =>
    element("span", { class: "mde-key" }, element("i", { style: `background:${colour}` }), word);
  const label = (...inside) => element("label", { class: "mde-key" }, ...inside);
  const row = (...inside) => element("div", { class: "mde-row" }, ...inside);
  const root = element(
    "div",
    {
      class: "mde-player mde-bench" + (fill ? " mde-fill" : ""),
      "data-lm-suppress-shortcuts": "true",
    },
    element("style", {}, CSS + STYLE),
    canvas,
    map,
    row(label("a click on a joint changes it", scope), ...faults.map(([node]) => node)),
    row(repair, play, label("speed", speeds), label("body", body), label(truth, "truth"), reset),
    row(
      label("window starts at", from),
      key("#9AA3AE", "given"),
      key(rgba(PURPLE), "missing"),
      key(rgba(GREEN), "repaired"),
    ),
    row(note),
  );
  el.append(root);
  const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
  const stop = new AbortController();
  const listen = listener(stop);
  const figures = (joints, roots, list) =>
    unpack({
      get: (name) =>
        ({ scene: { joints: J, figures: list }, joints, roots, contacts: NOTHING })[name],
    });
  const walk = figures(model.get("joints"), model.get("roots"), [{ frames }])[0];
  const view = { ...HOME };
  const clock = silentClock(frames / fps, () => visible);
  let first = model.get("first");
  let gone = new Set(model.get("missing"));
  let mended = [];
  let frame = 0;
  let joint = names.indexOf("RightHand");
  let spots = [];
  let playing = false;
  let ticking = 0;
  let visible = true;
  let dropped = 0; // the request that the page no longer waits for
  let heard = true; // Python says at once that it has the request; the repair may take its time
  let silence = 0;

  const within = (t) => t >= first && t < first + T_h;
  const number = (t, j) => (t - first) * J + j;
  const lost = (t, j) => within(t) && gone.has(number(t, j));
  const busy = () => model.get("asked") > Math.max(model.get("answered"), dropped);
  function current() {
    // the repairs, unless a joint was removed or restored or the window moved since
    const told = model.get("repaired");
    const same =
      told.edition &&
      told.first === first &&
      told.missing.length === gone.size &&
      told.missing.every((n) => gone.has(n));
    return same ? mended : [];
  }

  function drawFigure(theme) {
    const [ctx, w, h] = ready(canvas);
    const target = smoothRoot(walk, frame, fps);
    const look = camera(view, [target[0], 0.86, target[1]], 4.2 / view.zoom, w, h);
    ctx.fillStyle = rgba(mix(theme.bg, theme.fg, 0.05));
    ctx.fillRect(0, 0, w, h);
    paintFloor(ctx, look, target, theme, 6);
    const pose = walk.pose(frame);
    const away = names.map((_, j) => lost(frame, j));
    const broken = away.some(Boolean);
    const repairs = broken ? current() : [];
    const chosen = Math.min(Number(body.value), repairs.length - 1);
    const shown = repairs.length ? repairs[chosen].pose(frame - first) : pose;
    const touched = (part) => part.circles.some(([a, b]) => away[a] || away[b]);
    const parts = repairs.length ? scene.parts : without(scene.parts, away);
    if (parts.length)
      paintBody(ctx, look, parts, shown, theme, within(frame) ? 0 : 0.55, target, [0, 0]);
    repairs.forEach((f, k) => {
      if (k > 0 && k !== chosen)
        paintGhost(ctx, look, scene.parents, f.pose(frame - first), away, theme);
    });
    if (truth.checked)
      for (const part of scene.parts)
        if (touched(part)) paintOutline(ctx, look, part, pose, rgba(theme.fg, 0.75));
    spots = pose.map((p, j) => look(away[j] && !repairs.length ? p : shown[j]));
    if (!playing && within(frame))
      spots.forEach((p, j) => paintMark(ctx, theme, p, away[j] && !repairs.length, j === joint));
    const state = !within(frame)
      ? "outside the window, given"
      : !broken
        ? "given"
        : !repairs.length
          ? "joints are missing"
          : chosen
            ? `repair ${chosen} of ${repairs.length - 1}`
            : `mean of ${repairs.length - 1} repairs`;
    paintText(ctx, theme, `frame ${frame} \u00b7 ${state}`, 12, 24, "left", 17);
    if (!playing && within(frame))
      paintText(ctx, theme, names[joint], spots[joint].x + 13, spots[joint].y - 8, "left", 14);
    return state;
  }
  function draw() {
    if (!canvas.clientWidth || !canvas.clientHeight) return;
    const theme = readTheme(root);
    const state = drawFigure(theme);
    paintMap(
      map,
      theme,
      { first, last: first + T_h, frame, frames, J },
      lost,
      current().length > 0 ? GREEN : PURPLE,
    );
    canvas.setAttribute(
      "aria-label",
      `Figure, frame ${frame}: ${state}. ` +
        `${names[joint]} is ${lost(frame, joint) ? "missing" : "given"}.` +
        ` ${gone.size} of ${size} joint positions are missing in the window.`,
    );
    map.setAttribute(
      "aria-label",
      `Frames 0 to ${frames - 1}, the window is ${first} to ${first + T_h - 1}. Frame ${frame} ` +
        `is chosen.`,
    );
    repair.setAttribute("aria-disabled", String(busy())); // `disabled` would drop the focus
    from.value = String(first);
    Object.assign(root.dataset, {
      frame,
      playing,
      missing: gone.size,
      repairs: current().length,
      state,
    });
  }

  function tell(words) {
    // the kernel gets every change; an old repair no longer fits and is not shown
    model.set("first", first);
    model.set(
      "missing",
      [...gone].sort((a, b) => a - b),
    );
    model.save_changes();
    note.textContent = `${words} ${gone.size} of ${size} joint positions are missing.`;
    draw();
  }
  function put(numbers, away) {
    for (const n of numbers)
      if (away) gone.add(n);
      else gone.delete(n);
  }
  const outside = () => {
    const window = `frames ${first} to ${first + T_h - 1}`;
    note.textContent = `Frame ${frame} is outside the window (${window}): choose one inside.`;
  };
  function strikeJoint(j) {
    joint = j;
    if (!within(frame)) {
      draw();
      return outside();
    }
    const all = scope.value === "all";
    const times = all ? Array.from({ length: T_h }, (_, k) => first + k) : [frame];
    const away = !lost(frame, j);
    put(
      times.map((t) => number(t, j)),
      away,
    );
    tell(
      `${names[j]} is ${away ? "missing" : "given"} ` +
        (all ? "in the whole window." : `in frame ${frame}.`),
    );
  }
  function strikeFrame(t) {
    go(t);
    if (!within(t)) return outside();
    const all = names.map((_, j) => number(t, j));
    const away = !all.every((n) => gone.has(n));
    put(all, away);
    tell(`Frame ${t} is ${away ? "missing" : "given"}.`);
  }
  function ask() {
    if (!scene.kernel) {
      note.textContent = "Repairing needs a running kernel: open the notebook in JupyterLab.";
      return;
    }
    if (busy()) return;
    if (!reach()) return giveUp(GONE);
    model.set("asked", model.get("asked") + 1);
    model.save_changes();
    if (busy()) note.textContent = "Repairing: there and back, several times ...";
    draw();
  }

  function reach() {
    // `send` throws once the kernel was shut down or restarted; a trait that is set then is lost
    try {
      model.send({ do: "ping" });
    } catch {
      return false;
    }
    return true;
  }
  function giveUp(words) {
    dropped = model.get("asked");
    note.textContent = words;
    draw();
  }
  function waitOn() {
    clearTimeout(silence);
    silence = setTimeout(() => {
      if (!busy()) return;
      if (!reach()) giveUp(GONE);
      else if (!heard) giveUp(MUTE);
      else waitOn();
    }, SILENCE);
  }

  function go(t) {
    setPlaying(false);
    frame = clamp(t, 0, frames - 1);
    clock.seek(frame / fps);
    draw();
  }
  function setPlaying(on) {
    playing = on;
    play.textContent = on ? "\u275a\u275a Pause" : "\u25b6 Play";
    play.setAttribute("aria-label", on ? "Pause" : "Play");
    if (on) {
      clock.seek(frame / fps);
      clock.start();
      if (!ticking) ticking = requestAnimationFrame(tick);
    } else clock.stop();
    draw();
  }
  function tick() {
    ticking = 0;
    if (!playing || stop.signal.aborted) return;
    const next = clamp(Math.floor(clock.now() * fps + 1e-3), 0, frames - 1);
    if (next !== frame) {
      frame = next;
      draw();
    }
    ticking = requestAnimationFrame(tick);
  }
  function load() {
    // the repairs of the kernel
    const told = model.get("repaired");
    const count = told.figures || 0;
    const kept = body.value;
    mended = count
      ? figures(
          model.get("mended_joints"),
          model.get("mended_roots"),
          Array.from({ length: count }, () => ({ frames: T_h })),
        )
      : [];
    body.replaceChildren(
      ...Array.from({ length: Math.max(count, 1) }, (_, k) =>
        element("option", { value: String(k) }, k ? `repair ${k}` : "mean of repairs"),
      ),
    );
    body.value = Number(kept) < count ? kept || "0" : "0";
    draw();
  }
  function rest() {
    Object.assign(view, HOME);
    speeds.value = "0.5";
    clock.rate(0.5);
    scope.value = "all";
    truth.checked = true;
    body.value = "0";
    joint = names.indexOf("RightHand");
    go(first + Math.floor(T_h / 2));
  }
  function home() {
    const start = { first: 0, missing: [], ...model.get("start") };
    first = start.first;
    gone = new Set(start.missing);
    rest();
  }
  const keys = {
    ArrowLeft: () => go(frame - 1),
    ArrowRight: () => go(frame + 1),
    Home: () => go(first),
    End: () => go(first + T_h - 1),
    p: () => setPlaying(!playing),
    t: () => {
      truth.checked = !truth.checked;
      draw();
    },
    r: () => {
      home();
      tell("Reset.");
    },
    "+": () => {
      view.zoom = clamp(view.zoom * 1.2, 0.4, 4);
      draw();
    },
    "-": () => {
      view.zoom = clamp(view.zoom / 1.2, 0.4, 4);
      draw();
    },
  };
  const onFigure = {
    ArrowUp: () => {
      joint = (joint + J - 1) % J;
      go(frame);
    },
    ArrowDown: () => {
      joint = (joint + 1) % J;
      go(frame);
    },
    " ": () => strikeJoint(joint),
  };
  const onMap = { " ": () => strikeFrame(frame) };
  listen(root, "keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    event.stopPropagation(); // otherwise JupyterLab handles the key
    const own =
      event.target === canvas
        ? { ...keys, ...onFigure }
        : event.target === map
          ? { ...keys, ...onMap }
          : {};
    const act = own[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (act) {
      event.preventDefault();
      act();
    }
  });
  let grip = null;
  let turned = false;
  listen(canvas, "pointerdown", (e) => {
    grip = [e.clientX, e.clientY];
    turned = false;
    canvas.setPointerCapture(e.pointerId);
    canvas.focus({ preventScroll: true });
  });
  listen(canvas, "pointermove", (e) => {
    if (!grip || (!turned && Math.hypot(e.clientX - grip[0], e.clientY - grip[1]) < STILL)) return;
    turned = true;
    view.yaw += (e.clientX - grip[0]) * 0.008;
    view.pitch = clamp(view.pitch + (e.clientY - grip[1]) * 0.006, 0.02, 1.5);
    grip = [e.clientX, e.clientY];
    draw();
  });
  listen(canvas, "pointerup", (e) => {
    const click = grip && !turned;
    const box = canvas.getBoundingClientRect();
    grip = null;
    if (!click) return;
    if (playing) setPlaying(false);
    const far = spots.map((p) =>
      Math.hypot(p.x - (e.clientX - box.left), p.y - (e.clientY - box.top)),
    );
    const nearest = far.indexOf(Math.min(...far));
    if (far[nearest] < 22) strikeJoint(nearest);
  });
  listen(canvas, "pointercancel", () => {
    grip = null;
  });
  let press = null; // on the map, where a finger may also scroll the page
  listen(map, "pointerdown", (e) => {
    press = [e.clientX, e.clientY];
  });
  listen(map, "pointercancel", () => {
    press = null;
  });
  listen(map, "pointerup", (e) => {
    const click = press && Math.hypot(e.clientX - press[0], e.clientY - press[1]) < STILL;
    press = null;
    if (!click) return;
    const box = map.getBoundingClientRect();
    const t = Math.floor((e.clientX - box.left - GUTTER) / ((box.width - GUTTER) / frames));
    if (t >= 0 && t < frames) strikeFrame(t);
  });
  for (const [node, missing] of faults)
    listen(node, "click", () => {
      gone = new Set(missing);
      go(first + Math.floor(T_h / 2));
      tell(`Fault: ${node.textContent}.`);
    });
  listen(repair, "click", ask);
  listen(play, "click", () => setPlaying(!playing));
  listen(reset, "click", keys.r);
  listen(speeds, "change", () => clock.rate(Number(speeds.value)));
  listen(body, "change", draw);
  listen(truth, "change", draw);
  listen(from, "change", () => {
    first = Number(from.value);
    go(first + Math.floor(T_h / 2));
    tell(`The window is frames ${first} to ${first + T_h - 1}.`);
  });
  const changes = {
    "change:repaired": load,
    "change:asked": () => {
      heard = false;
      waitOn();
      draw();
    },
    "change:message": () => {
      heard = true;
      note.textContent = model.get("message");
    },
    "change:first": () => {
      first = model.get("first");
      draw();
    },
    "change:missing": () => {
      gone = new Set(model.get("missing"));
      draw();
    },
    "change:answered": () => {
      draw();
      if (current().length && !busy() && !calm) {
        frame = Math.max(0, first - 5);
        setPlaying(true);
      }
    },
  };
  for (const [name, f] of Object.entries(changes)) model.on(name, f);
  if (!fill) canvas.style.height = `${scene.height}px`;
  map.style.height = `${MAP_HEIGHT}px`;
  redrawn(stop, canvas, draw);
  sighted(stop, canvas, (seen) => {
    visible = seen;
  });
  load();
  rest();
  if (busy()) waitOn();
  note.textContent = current().length
    ? model.get("message")
    : "Click a joint or a frame to remove it, then press Repair.";
  return () => {
    stop.abort();
    clearTimeout(silence);
    cancelAnimationFrame(ticking);
    for (const [name, f] of Object.entries(changes)) model.off(name, f);
    root.remove();
  };
}

// ---- the same module with no kernel: `record` carries the traits, binary ones in base64
export function staticModel(record) {
  const state = { ...record };
  const decode = (s) => new DataView(Uint8Array.from(atob(s), (c) => c.charCodeAt(0)).buffer);
  for (const name of ["joints", "roots", "mended_joints", "mended_roots"])
    state[name] = decode(record[name] || "");
  return {
    get: (name) => state[name],
    set: (name, value) => {
      state[name] = value;
    },
    save_changes() {},
    on() {},
    off() {},
  };
}

export default { render: ({ model, el }) => mount(model, el) };
