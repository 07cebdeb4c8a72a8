// The editor: pin frames, drag joints, keep a part, generate in-betweens, choose one, save it.
// Python keeps the edit and poses the figure; the page draws, and sends what was pressed and how
// far a joint was dragged. `model` needs get, set, save_changes, on, off; without send there is no
// kernel, and a message says what needs one.

import { CSS, clamp, element, listener, parse, readTheme, redrawn, rgba, sighted } from "./dom.js";
import { bytes, ground, unpack } from "./figures.js";
import { smoothRoot } from "./paint.js";
import { silentClock } from "./clock.js";
import { timeline } from "./timeline.js";
import { wire } from "./wire.js";
import { along, dot, dragged, jointAt, paintStage } from "./stage.js";

const HOME = { yaw: 0.6, pitch: 0.2, zoom: 1.1 };
const CENTIMETRE = 0.01;
const NUDGES = 900; // milliseconds
const ASLEEP = "needs a running notebook: run the cell that made this editor.";
const MUTE = "The notebook's kernel does not answer: it is busy with another cell, or not running.";
const GONE =
  "The notebook's kernel is gone. Your changes are still shown here, " +
  "but nothing can be generated or saved. " +
  "Restart the kernel and run the notebook's cells again: the editor then starts again from the" +
  " beginning.";
const MORE_CSS = `
.mde-editor canvas { touch-action: none; } .mde-editor canvas.mde-timeline { cursor: pointer; }
.mde-editor canvas.mde-over { cursor: move; }
.mde-editor .mde-row output { min-width: 0; }
.mde-editor .mde-row output.mde-count { min-width: 10.5em; }
.mde-editor label { display: inline-flex; align-items: center; gap: 6px; }
.mde-editor input[type=text] { font: inherit; color: inherit; background: transparent; border: 1px
  solid var(--line); border-radius: 6px;
  padding: 3px 8px; min-height: 30px; box-sizing: border-box; width: 13em; }
.mde-editor input[type=text]:focus-visible { outline: 3px solid var(--focus); outline-offset: 1px; }
.mde-editor button.mde-main { background: var(--focus); border-color: var(--focus); color:
  var(--bg); font-weight: 600; padding: 3px 16px; }
.mde-editor button[aria-disabled=true] { opacity: 0.5; cursor: default; }
.mde-editor button.mde-pin[aria-pressed=true] { background: var(--fg); color: var(--bg); }
.mde-editor .mde-push { margin-left: auto; }
.mde-told { border-left: 4px solid var(--focus); padding: 2px 0 2px 10px; min-height: 3.9em;
  overflow-wrap: anywhere; }
.mde-told > div { min-height: 1.3em; } .mde-told .mde-held { font-weight: 600; } .mde-told
  .mde-measured { font-variant-numeric: tabular-nums; }`;

export function mount(model, el, { fill = false } = {}) {
  const scene = model.get("scene");
  const live = typeof model.send === "function";
  const last = scene.frames - 1;
  const stop = new AbortController();
  const listen = listener(stop);
  const button = (text, title, extra = {}) =>
    element("button", { type: "button", title, ...extra }, text);
  const choice = (label, options) =>
    element(
      "select",
      { "aria-label": label },
      ...options.map(([value, text]) => element("option", { value: String(value) }, text)),
    );
  const upTo = (n) => Array.from({ length: n }, (_, i) => [i + 1, String(i + 1)]);
  const canvas = element("canvas", {
    tabindex: "0",
    role: "application",
    "aria-roledescription": "motion editor",
    title:
      "Drag a joint of a pinned frame; drag elsewhere: turn. Enter: pin. J: next joint, then " +
      "arrows, Page Up, Page Down move it. Space: play. Comma, full stop: frames. [ ]: " +
      "in-betweens. G: generate. Z: undo. + and -: zoom. F: follow. O: the motion before. R: " +
      "reset.",
  });
  const play = button("\u25b6 Play", "Space", { class: "mde-play", "aria-label": "Play" });
  const pin = button("", "Enter", { class: "mde-pin", "aria-pressed": "false" });
  const shown = element("output", { class: "mde-count", "aria-live": "off" });
  const joints = choice("Joint to move", [
    ["", "no joint chosen"],
    ...scene.names.map((name, j) => [j, name]),
  ]);
  const keep = choice("Part of the body kept throughout", [
    ["", "no part"],
    ...scene.keep.map((name) => [name, `the ${name}`]),
  ]);
  const count = choice("Number of in-betweens", upTo(scene.most));
  const strength = choice("Resampling: how often each step is repeated", upTo(10));
  const generate = button("Generate", "Make in-betweens (G)", { class: "mde-main" });
  const previous = button("\u2039", "The previous in-between ([)", {
    "aria-label": "Previous in-between",
  });
  const next = button("\u203a", "The next in-between (])", { "aria-label": "Next in-between" });
  const which = element("output", { "aria-live": "polite" });
  const before = element("input", {
    type: "checkbox",
    title: "The motion before the edit, as a ghost (O)",
  });
  const undo = button("Undo", "Undo the last change (Z)");
  const reset = button("Reset", "Reset the edit (R); Undo brings it back");
  const file = element("input", {
    type: "text",
    "aria-label": "Name of the file",
    spellcheck: "false",
  });
  const save = button(
    "Save as BVH",
    "Write the in-between that is shown, or before the first one the motion with its pinned " +
      "poses",
  );
  const held = element("div", { class: "mde-held" });
  const said = element("span", { class: "mde-say", role: "status" });
  const going = element("span", { "aria-hidden": "true" }); // a dot for each second
  const measured = element("div", { class: "mde-measured" });
  const dots = { L: element("i"), R: element("i") };
  const key = (side, word) => element("span", { class: "mde-key" }, dots[side], word);
  const rail = timeline(
    listen,
    () => ({
      frames: scene.frames,
      fps: scene.fps,
      frame,
      pins: state.pins,
      moved: state.moved,
      part: state.part,
      made: state.made,
    }),
    (t) => halt(t),
    (t) => toggle(t),
    () => draw(),
  );
  const row = (...nodes) => element("div", { class: "mde-row" }, ...nodes);
  const chooser = element("span", { class: "mde-key" }, "show", previous, which, next);
  const root = element(
    "div",
    {
      class: "mde-player mde-editor" + (fill ? " mde-fill" : ""),
      "data-lm-suppress-shortcuts": "true",
    },
    element("style", {}, CSS + MORE_CSS),
    canvas,
    rail.canvas,
    row(
      play,
      pin,
      shown,
      element("label", {}, "move", joints),
      key("L", "left"),
      key("R", "right"),
    ),
    row(
      element("label", {}, "keep throughout", keep),
      element("label", {}, "in-betweens", count),
      ...(scene.strength
        ? [
            element(
              "label",
              { title: "More resampling fits the pinned frames better, and takes longer" },
              "resampling",
              strength,
            ),
          ]
        : []),
      generate,
      chooser,
      element("label", {}, before, "motion before"),
    ),
    row(undo, reset, element("label", { class: "mde-push" }, "file", file), save),
    element("div", { class: "mde-told" }, held, element("div", {}, said, going), measured),
  );
  el.append(root);

  const view = { ...HOME, follow: true };
  const clock = silentClock(scene.frames / scene.fps, () => visible);
  let state;
  let motion;
  let samples;
  let poses;
  let frame = 0;
  let chosen = 0;
  let playing = false;
  let visible = true;
  let ticking = 0;
  let sent = -1;
  let told = 0;
  let look = null;
  let joint = null;
  let hover = null;
  let target = null;
  let held_spot = null;
  let grip = null;
  let grips = 0;
  let pull = null;
  let pressed = 0;
  let begun = 0; // Generate: the number of its message, and when
  const way = wire(
    model,
    () => state.received,
    () => model.get("busy"),
    (gone) => {
      pressed = 0;
      if (gone) target = null;
      words();
      say(gone ? GONE : MUTE);
      draw();
    },
  );

  // ---- messages from Python
  const read = (where, frames) =>
    unpack({
      get: (name) =>
        ({
          scene: { joints: scene.joints, figures: frames.map((n) => ({ frames: n })) },
          joints: model.get(`${where}joints`),
          roots: model.get(`${where}roots`),
          contacts: new DataView(new ArrayBuffer(0)),
        })[name],
    });
  function load() {
    // false for an answer that was overtaken by a newer one
    if (state && model.get("state").edition < state.edition) return false;
    state = { ...model.get("state") };
    samples = read("made_", Array(state.made).fill(scene.frames));
    const flat = new Float32Array(bytes(model.get("poses")));
    const size = 3 * scene.joints;
    poses = new Map(
      state.pins.map((t, i) => [
        t,
        Array.from({ length: scene.joints }, (_, j) =>
          Array.from(flat.slice(i * size + 3 * j, i * size + 3 * j + 3)),
        ),
      ]),
    );
    chosen = clamp(model.get("chosen"), 0, Math.max(samples.length - 1, 0));
    return true;
  }
  const base = () => samples[chosen] || motion;
  const figure = {
    frames: scene.frames,
    path: null,
    past: null,
    prints: [],
    planted: () => 0,
    pose: (t) => poses.get(clamp(t, 0, last)) || base().pose(t),
    root: (t) => (poses.get(clamp(t, 0, last)) || [base().root(t)])[0],
  };

  // ---- what the page shows
  const age = () => (state.old ? " (from before the last change)" : "");
  function title() {
    const where = `frame ${frame}`;
    if (poses.has(frame)) {
      const edited = (state.moved[state.pins.indexOf(frame)] || []).length;
      return `${where} \u00b7 pinned${edited ? ", edited" : ""}`;
    }
    if (!samples.length) {
      const before = state.part
        ? `the ${state.part} kept, the rest`
        : "the motion before the edit,";
      return `${where} \u00b7 ${before} to be generated`;
    }
    return `${where} \u00b7 in-between ${chosen + 1} of ${samples.length}${age()}`;
  }
  function hint() {
    if (playing) return "";
    if (!poses.has(frame)) return "Enter: pin this frame";
    return joint == null
      ? "drag a joint, or J: choose one"
      : "arrows: 1 cm \u00b7 Page Up, Page Down: depth \u00b7 Esc";
  }
  function draw() {
    const ratio = devicePixelRatio || 1;
    const [w, h] = [canvas.clientWidth, canvas.clientHeight];
    if (!w || !h) return;
    if (canvas.width !== Math.round(w * ratio) || canvas.height !== Math.round(h * ratio)) {
      canvas.width = Math.round(w * ratio);
      canvas.height = Math.round(h * ratio);
    }
    const ctx = canvas.getContext("2d");
    const theme = readTheme(root);
    const focus = parse(getComputedStyle(generate).backgroundColor);
    ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
    for (const side of ["L", "R"]) dots[side].style.background = rgba(theme.body[side]);
    const kept = new Set(state.kept);
    const pinned = poses.has(frame);
    const wash = (part) =>
      pinned || samples.length || part.circles.every(([a, b]) => kept.has(a) && kept.has(b))
        ? 0
        : 0.6;
    const others = pinned
      ? []
      : samples.map((f, k) => ({ name: `in-between ${k + 1}`, pose: f.pose(frame) }));
    const ghosts = others.filter((_, k) => k !== chosen);
    if (before.checked) ghosts.push({ name: "motion before", pose: motion.pose(frame) });
    const spot = held_spot || (view.follow ? smoothRoot(figure, frame, scene.fps) : motion.middle);
    look = paintStage(
      ctx,
      {
        parts: scene.parts,
        figure,
        ghosts,
        frame,
        pinned: pinned && !playing,
        wash,
        spot,
        extent: view.follow ? 0 : motion.extent,
        joint,
        hover,
        target,
        names: scene.names,
        title: title(),
        hint: hint(),
        marks: state.pins.map((t) => poses.get(t)[0]),
        focus,
      },
      view,
      theme,
      w,
      h,
    );
    rail.draw(theme, focus);
    shown.textContent = `frame ${frame} of ${last} \u00b7 ${(frame / scene.fps).toFixed(2)} s`;
    pin.textContent = pinned ? "\u25c6 Unpin" : "\u25c7 Pin";
    pin.setAttribute("aria-label", `${pinned ? "Unpin" : "Pin"} frame ${frame}`);
    pin.setAttribute("aria-pressed", String(pinned));
    Object.assign(root.dataset, {
      frame,
      playing,
      pins: state.pins.join(" "),
      joint: joint ?? "",
      chosen,
      made: samples.length,
    });
  }
  function words() {
    held.textContent = state.held[0].toUpperCase() + state.held.slice(1);
    measured.textContent = samples.length
      ? `In-between ${chosen + 1}${age()}: ${state.measured[chosen]}.`
      : "";
    const number = samples.length ? `${chosen + 1} of ${samples.length}` : "none yet";
    if (which.textContent !== number) which.textContent = number; // it is read out when written
    const busy = generating();
    root.setAttribute("aria-busy", String(busy));
    generate.setAttribute("aria-disabled", String(busy));
    generate.textContent = busy ? "Generating \u2026" : "Generate";
    undo.setAttribute("aria-disabled", String(busy || !state.undo));
    for (const node of [previous, next])
      node.setAttribute("aria-disabled", String(samples.length < 2));
    keep.value = state.part;
    canvas.setAttribute("aria-label", state.description);
    joints.value = joint == null ? "" : String(joint);
  }
  const say = (text) => {
    said.textContent = text;
    going.textContent = "";
  };

  // ---- messages to Python
  const generating = () => !way.gone() && (pressed > 0 || model.get("busy"));
  function ask(content, what) {
    if (live) return way.ask(content);
    say(`${what} ${ASLEEP}`);
    return 0;
  }
  function take(j) {
    // a grip is one change to Undo: a run of key presses, or one drag
    way.handOn();
    const more = target && grip && grip.frame === frame && grip.joint === j; // not answered yet
    grips = Math.max(Date.now(), grips + 1);
    grip = {
      id: grips,
      frame,
      joint: j,
      by: [0, 0, 0],
      from: more ? target : figure.pose(frame)[j],
    };
    return grip;
  }
  function pullBy(by, held, name) {
    // metres in all since the grip began
    if (!live) return say(`${name} ${ASLEEP}`);
    held.by = by;
    target = along(held.from, by, 1);
    draw();
    way.drag({ do: "drag", frame: held.frame, joint: held.joint, by, grip: held.id });
  }
  function toggle(t) {
    if (live) return ask({ do: "toggle", frame: t, chosen }, "");
    const on = !poses.has(t); // with no kernel pins are shown, and nothing follows from them
    if (on) poses.set(t, figure.pose(t));
    else poses.delete(t);
    const moved = new Map(state.pins.map((f, i) => [f, state.moved[i]]));
    state.pins = [...poses.keys()].sort((a, b) => a - b);
    state.moved = state.pins.map((f) => moved.get(f) || []);
    state.held = `${state.pins.length} frames pinned${state.part ? `, ${state.part} kept` : ""}.`;
    words();
    say(`Frame ${t} ${on ? "pinned" : "released"}, on this page only.`);
    draw();
  }
  function make() {
    if (generating()) return;
    if (!live) return say(`Generating ${ASLEEP}`);
    halt(frame);
    begun = performance.now();
    const wanted = { count: Number(count.value), resample: Number(strength.value) };
    pressed = ask({ do: "generate", after: state.received, ...wanted }, "");
    if (pressed) {
      words();
      count_up();
    }
  }
  function count_up() {
    // so that one sees that something goes on, and hears it every ten seconds
    if (!pressed || stop.signal.aborted) return;
    const seconds = Math.floor((performance.now() - begun) / 1000);
    const so_far = seconds < 10 ? "" : `, for ${seconds - (seconds % 10)} s now`;
    const text = `Making ${count.value} in-between${count.value === "1" ? "" : "s"}${so_far} `;
    if (said.textContent !== text) say(text);
    going.textContent = ".".repeat(1 + (seconds % 10));
    setTimeout(count_up, 500);
  }
  function choose(by) {
    if (!samples.length) return say("There are no in-betweens yet: press Generate.");
    chosen = (chosen + by + samples.length) % samples.length;
    model.set("chosen", chosen);
    model.save_changes();
    words();
    draw();
  }
  function keepFile() {
    if (model.get("file") !== file.value) {
      model.set("file", file.value);
      model.save_changes();
    }
  }
  function store() {
    keepFile();
    ask({ do: "save", name: file.value, chosen }, "Saving");
  }
  function select(j) {
    joint = j;
    target = null;
    grip = null;
    if (j != null && !poses.has(frame) && !way.asking())
      say(`${scene.names[j]} can be moved once this frame is pinned (Enter).`);
    words();
    draw();
  }
  function nudge(direction, sign, big) {
    // presses in quick succession are one change; one that leads back is another
    if (!poses.has(frame) && !way.asking())
      return say(`Frame ${frame} is not pinned: press Enter to pin it, then move its joints.`);
    const now = performance.now();
    const step = direction.map((v) => v * sign * CENTIMETRE * (big ? 5 : 1));
    const going = grip && grip.step && now - grip.time < NUDGES && dot(grip.step, step) >= 0;
    const held = going ? grip : take(joint);
    Object.assign(held, { step, time: now });
    pullBy(along(held.by, step, 1), held, "Moving a joint");
  }

  // ---- time
  function tell(force) {
    if (sent === frame || (!force && performance.now() - told < 200)) return;
    told = performance.now();
    sent = frame;
    model.set("frame", frame);
    model.save_changes();
  }
  function show(to, force = true) {
    const t = clamp(Math.round(to), 0, last);
    if (t !== frame) {
      target = hover = grip = held_spot = null;
      if (pull && !pull.turn) pull = null;
    }
    frame = t;
    draw();
    tell(force);
  }
  function halt(to) {
    if (playing) setPlaying(false);
    clock.seek(clamp(to, 0, last) / scene.fps);
    show(to);
  }
  function setPlaying(on) {
    if (on && frame >= last) {
      frame = 0;
      clock.seek(0);
    }
    playing = on;
    if (on) {
      clock.seek(frame / scene.fps);
      clock.start();
    } else clock.stop();
    play.textContent = on ? "\u275a\u275a Pause" : "\u25b6 Play";
    play.setAttribute("aria-label", on ? "Pause" : "Play");
    show(frame);
    if (on && !ticking) ticking = requestAnimationFrame(tick);
  }
  function tick() {
    ticking = 0;
    if (!playing || stop.signal.aborted) return;
    const t = clamp(Math.floor(clock.now() * scene.fps + 1e-3), 0, last);
    if (t !== frame) show(t, false);
    ticking = requestAnimationFrame(tick);
  }
  const step = (by) => halt(frame + by);
  function toPin(by) {
    const there = state.pins.filter((t) => (by > 0 ? t > frame : t < frame));
    const t = by > 0 ? there[0] : there.at(-1);
    if (t == null)
      say(by > 0 ? "No frame after this one is pinned." : "No frame before this one is pinned.");
    else halt(t);
  }
  function takeBack() {
    if (generating()) return say("Generating: Undo when it is done, or it would be lost.");
    grip = null;
    ask({ do: "undo" }, "Undo");
  }
  function home() {
    Object.assign(view, HOME, { follow: true });
    joint = target = null;
    halt(0);
    ask({ do: "reset" }, "Resetting the edit");
  }
  function zoom(by) {
    view.zoom = clamp(view.zoom * by, 0.25, 5);
    draw();
  }

  // ---- keys
  const common = {
    " ": () => setPlaying(!playing),
    Enter: () => toggle(frame),
    "[": () => choose(-1),
    "]": () => choose(1),
    g: make,
    z: takeBack,
    ",": () => step(-1),
    ".": () => step(1),
    Home: () => halt(0),
    End: () => halt(last),
    r: home,
    "+": () => zoom(1.2),
    "=": () => zoom(1.2),
    "-": () => zoom(1 / 1.2),
    f: () => {
      view.follow = !view.follow;
      draw();
    },
    o: () => {
      before.checked = !before.checked;
      draw();
    },
    Escape: () => select(null),
    j: (shift) =>
      select(
        joint == null
          ? shift
            ? scene.joints - 1
            : 0
          : (joint + (shift ? -1 : 1) + scene.joints) % scene.joints,
      ),
  };
  const onRail = {
    ...common,
    ArrowRight: () => step(1),
    ArrowLeft: () => step(-1),
    ArrowUp: () => step(10),
    ArrowDown: () => step(-10),
    PageUp: () => toPin(-1),
    PageDown: () => toPin(1),
  };
  const move = (direction, sign, otherwise) => (shift) =>
    joint == null ? otherwise() : nudge(look[direction], sign, shift);
  const onStage = {
    ...onRail,
    ArrowRight: move("right", 1, onRail.ArrowRight),
    ArrowLeft: move("right", -1, onRail.ArrowLeft),
    ArrowUp: move("up", 1, onRail.ArrowUp),
    ArrowDown: move("up", -1, onRail.ArrowDown),
    PageUp: move("ahead", 1, onRail.PageUp),
    PageDown: move("ahead", -1, onRail.PageDown),
  };
  listen(root, "keydown", (event) => {
    const keys = event.target === canvas ? onStage : event.target === rail.canvas ? onRail : null;
    const name = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    // not with Shift, which means "do again" elsewhere
    const undoes = (event.ctrlKey || event.metaKey) && name === "z" && !event.shiftKey && keys;
    if ((event.ctrlKey || event.metaKey || event.altKey) && !undoes) return;
    if (name === "Enter" && event.shiftKey) return; // it runs a cell, and is no pin
    event.stopPropagation(); // otherwise JupyterLab handles the key
    if (event.target === file && name === "Enter") {
      event.preventDefault();
      store();
    }
    if (keys && keys[name]) {
      event.preventDefault();
      keys[name](event.shiftKey);
    }
  });

  // ---- the pointer on the canvas
  const place = (e) => {
    const box = canvas.getBoundingClientRect();
    return [e.clientX - box.left, e.clientY - box.top];
  };
  const over = (e) =>
    look && poses.has(frame) && !playing
      ? jointAt(look, figure.pose(frame), ...place(e), e.pointerType)
      : null;
  listen(canvas, "pointerdown", (e) => {
    canvas.setPointerCapture(e.pointerId);
    canvas.focus({ preventScroll: true });
    const j = over(e);
    if (j == null) {
      pull = { turn: [e.clientX, e.clientY] };
      return;
    }
    held_spot = view.follow ? smoothRoot(figure, frame, scene.fps) : motion.middle;
    const held = take(j);
    select(j);
    pull = { held, at: place(e), moved: false };
  });
  listen(canvas, "pointermove", (e) => {
    if (!pull) {
      const j = over(e);
      if (j !== hover) {
        hover = j;
        canvas.classList.toggle("mde-over", j != null);
        draw();
      }
      return;
    }
    if (pull.turn) {
      view.yaw += (e.clientX - pull.turn[0]) * 0.008;
      view.pitch = clamp(view.pitch + (e.clientY - pull.turn[1]) * 0.006, 0.02, 1.5);
      pull.turn = [e.clientX, e.clientY];
      draw();
      return;
    }
    const [x, y] = place(e);
    const [dx, dy] = [x - pull.at[0], y - pull.at[1]];
    if (!pull.moved && Math.hypot(dx, dy) < 3) return;
    pull.moved = true;
    pullBy(dragged(look, pull.held.from, dx, dy), pull.held, "Dragging a joint");
  });
  function letGo() {
    if (pull && !pull.turn) {
      held_spot = null;
      if (!way.dragging()) target = null;
    }
    pull = null;
    draw();
  }
  listen(canvas, "pointerup", letGo);
  listen(canvas, "pointercancel", () => {
    // the browser took the pointer away: the joint goes back to where it was gripped
    if (pull && pull.moved) pullBy([0, 0, 0], pull.held, "Dragging a joint");
    letGo();
  });
  listen(canvas, "pointerleave", () => {
    if (hover != null) {
      hover = null;
      draw();
    }
  });
  listen(
    canvas,
    "wheel",
    (e) => {
      // only once the figure was clicked, so that a page can be scrolled past it
      if (document.activeElement !== canvas && !e.ctrlKey) return;
      e.preventDefault();
      e.stopPropagation();
      zoom(Math.exp(-e.deltaY * 0.0015));
    },
    { passive: false },
  );

  // ---- the controls
  const press = (node, act) =>
    listen(node, "click", () => {
      if (node.getAttribute("aria-disabled") !== "true" || node === generate) act();
    });
  press(play, () => setPlaying(!playing));
  press(pin, () => toggle(frame));
  press(generate, make);
  press(previous, () => choose(-1));
  press(next, () => choose(1));
  press(undo, takeBack);
  press(reset, home);
  press(save, store);
  listen(joints, "change", () => select(joints.value === "" ? null : Number(joints.value)));
  listen(keep, "change", () => {
    ask({ do: "keep", part: keep.value }, "Keeping a part");
    if (!live) keep.value = state.part;
  });
  listen(count, "change", () => {
    model.set("count", Number(count.value));
    model.save_changes();
  });
  listen(strength, "change", () => {
    model.set("resample", Number(strength.value));
    model.save_changes();
  });
  listen(before, "change", () => draw());
  listen(file, "change", keepFile);

  // ---- Python's changes
  const onState = () => {
    const last_received = state.received;
    if (!load()) return;
    if (state.received !== last_received || !pressed) say(state.message);
    if (pressed && state.received >= pressed) {
      pressed = 0;
      say(state.message);
    }
    way.answered();
    if (!pull && !way.dragging()) target = null;
    words();
    draw();
  };
  const onChosen = () => {
    chosen = clamp(model.get("chosen"), 0, Math.max(samples.length - 1, 0));
    words();
    draw();
  };
  const onFrame = () => {
    if (model.get("frame") !== sent) {
      sent = model.get("frame");
      clock.seek(sent / scene.fps);
      show(sent);
    }
  };
  const onControls = () => {
    count.value = String(model.get("count"));
    strength.value = String(model.get("resample"));
    file.value = model.get("file");
    words();
  };
  const changes = {
    "change:state": onState,
    "change:chosen": onChosen,
    "change:frame": onFrame,
    "change:busy": words,
    "change:count": onControls,
    "change:resample": onControls,
    "change:file": onControls,
  };
  for (const [name, f] of Object.entries(changes)) model.on(name, f);
  // as much as leaves the controls in sight
  if (!fill) canvas.style.height = "clamp(280px, calc(100vh - 460px), 620px)";
  [motion] = read("", [scene.frames]);
  Object.assign(motion, ground(motion));
  load();
  frame = sent = clamp(model.get("frame"), 0, last);
  clock.seek(frame / scene.fps);
  onControls();
  say(state.message);
  draw();
  redrawn(stop, canvas, draw);
  sighted(stop, canvas, (seen) => {
    visible = seen;
  });
  return () => {
    stop.abort();
    way.close();
    cancelAnimationFrame(ticking);
    for (const [name, f] of Object.entries(changes)) model.off(name, f);
    root.remove();
  };
}

// ---- the same module with no kernel: `record` carries the traits, binary ones in base64
export function staticModel(record) {
  const state = { ...record };
  const decode = (s) => new DataView(Uint8Array.from(atob(s), (c) => c.charCodeAt(0)).buffer);
  for (const name of ["joints", "roots", "poses", "made_joints", "made_roots"])
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
