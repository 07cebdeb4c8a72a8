// The player: one canvas that draws skeletons, and a music lane where there is sound. No
// dependencies; runs in JupyterLab (anywidget), in exported HTML (an iframe with this same text)
// and in a bare page. `model` needs get, set, save_changes, on, off.

import { CSS, clamp, element, listener, mix, readTheme, redrawn, rgba, sighted } from "./dom.js";
import { ground, unpack } from "./figures.js";
import { paintPanel, tense } from "./paint.js";
import { feed, silentClock, soundClock } from "./clock.js";
import { musicLane } from "./lane.js";

const HOME = { yaw: 0.6, pitch: 0.2, zoom: 1 };
const LONG = 200; // characters of notes that are in sight before they are unfolded

// ---- the widget
export function mount(model, el, { fill = false } = {}) {
  const text = {
    title:
      "Drag: turn. Click, then wheel: zoom. Space: play. Arrows: frames. Home, End. + and -: " +
      "zoom. F: follow. R: reset.",
  };
  const canvas = element("canvas", {
    tabindex: "0",
    role: "application",
    "aria-roledescription": "motion player",
    ...text,
  });
  const play = element("button", { type: "button", class: "mde-play", "aria-label": "Play" });
  const scrub = element("input", { type: "range", min: "0", step: "1", "aria-label": "Frame" });
  const shown = element("output", { "aria-live": "off" }); // it changes with every frame
  const speeds = element(
    "select",
    { "aria-label": "Speed" },
    ...[0.1, 0.25, 0.5, 1, 2, 4].map((v) => element("option", { value: String(v) }, `${v}\u00d7`)),
  );
  const follow = element("input", { type: "checkbox", checked: true });
  const reset = element(
    "button",
    { type: "button", title: "First frame, first view, normal speed (R)" },
    "Reset",
  );
  const mute = element(
    "button",
    { type: "button", "aria-label": "Mute", "aria-pressed": "false", title: "No sound (M)" },
    "Mute",
  );
  const note = element("output", { class: "mde-said", "aria-live": "polite" });
  const notes = element("div", { class: "mde-notes", role: "note", "aria-label": "Notes" });
  const sound = element("audio", { preload: "auto" });
  const dots = { L: element("i"), R: element("i") };
  const key = (side, word) => element("span", { class: "mde-key" }, dots[side], word);
  const options = element(
    "div",
    { class: "mde-row" },
    key("L", "left"),
    key("R", "right"),
    element("label", { class: "mde-key" }, "speed", speeds),
    element("label", { class: "mde-key" }, follow, "follow"),
    reset,
  );
  const root = element(
    "div",
    { class: "mde-player" + (fill ? " mde-fill" : ""), "data-lm-suppress-shortcuts": "true" },
    element("style", {}, CSS),
    canvas,
    element("div", { class: "mde-row" }, play, scrub, shown),
    options,
    notes,
  );
  el.append(root);
  const view = { ...HOME, follow: true };
  const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
  const stop = new AbortController();
  const listen = listener(stop);
  const lane = musicLane(
    listen,
    (seconds) => go(seconds * scene.fps),
    () => draw(),
  );
  let scene;
  let figures;
  let last;
  let clock;
  let frame = 0;
  let playing = false;
  let visible = true;
  let ticking = 0;
  let before = 0;
  let at = 0;
  let pace = 16;
  let sent = 0;
  let told = 0;
  let loaded = null;
  let sounding = false;
  let led = false; // silent: another view of this player sounds, or none does before a click
  let unload = () => {};

  function load() {
    scene = model.get("scene");
    figures = unpack(model);
    last = Math.max(...figures.map((f) => f.frames)) - 1;
    for (const f of figures) Object.assign(f, ground(f));
    scrub.max = String(last);
    canvas.setAttribute("aria-label", scene.description);
    if (!fill) canvas.style.height = `${scene.height}px`;
    view.follow = follow.checked = scene.follow;
    loadSound(model.get("music"), model.get("sound"));
  }

  function loadSound(music, bytes) {
    const present = Boolean(music && music.mime);
    lane.load(present ? music : null, model.get("strips"));
    if (present) {
      canvas.after(lane.node);
      options.append(mute, note);
      root.append(sound);
    } else for (const node of [lane.node, mute, note, sound]) node.remove();
    if (present && bytes === loaded && clock) return;
    unload();
    unload = () => {};
    loaded = present ? bytes : null;
    note.textContent = "";
    if (present) {
      clock = led ? silence() : soundClock(sound);
      sounding = true;
      unload = feed(sound, bytes, music.mime, () => {
        useSilentClock();
        mute.remove();
        note.textContent = `No sound: this browser cannot play ${music.mime}.`;
      });
    } else useSilentClock();
    clock.rate(Number(speeds.value));
  }
  const silence = () => silentClock((last + 1) / scene.fps, () => visible);
  const heard = () => sounding && !led;
  function setLed(on) {
    if (!sounding || on === led) return;
    clock.stop();
    led = on;
    clock = led ? silence() : soundClock(sound);
    clock.seek(frame / scene.fps);
    clock.rate(Number(speeds.value));
    if (playing) run();
  }
  function useSilentClock() {
    sounding = false;
    clock = silence();
    clock.seek(frame / scene.fps);
    clock.rate(Number(speeds.value));
    if (playing) clock.start();
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
    ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
    for (const side of ["L", "R"]) dots[side].style.background = rgba(theme.body[side]);
    const sky = ctx.createLinearGradient(0, 0, 0, h);
    sky.addColorStop(0, rgba(mix(theme.bg, theme.fg, 0.03)));
    sky.addColorStop(1, rgba(mix(theme.bg, theme.fg, 0.09)));
    ctx.fillStyle = sky;
    ctx.fillRect(0, 0, w, h);
    const panels = scene.layout === "side" ? figures.map((f) => [f]) : [figures];
    const most = clamp(Math.round(Math.sqrt(((panels.length * w) / h) * 1.5)), 1, panels.length);
    const rows = Math.ceil(panels.length / most);
    const columns = Math.ceil(panels.length / rows);
    const pw = w / columns;
    const ph = h / rows;
    panels.forEach((group, i) => {
      ctx.save();
      ctx.translate((i % columns) * pw, Math.floor(i / columns) * ph);
      ctx.beginPath();
      ctx.rect(0, 0, pw, ph);
      ctx.clip();
      paintPanel(ctx, scene, group, frame, view, theme, pw, ph);
      if (panels.length > 1) {
        ctx.strokeStyle = rgba(theme.line, 0.5);
        ctx.lineWidth = 1;
        ctx.strokeRect(0, 0, pw, ph);
      }
      ctx.restore();
    });
    const seconds = (t) => (t / scene.fps).toFixed(2);
    lane.draw(theme, frame);
    scrub.value = String(frame);
    shown.textContent = `${seconds(frame)} s \u00b7 ${frame} / ${last}`;
    scrub.setAttribute(
      "aria-valuetext",
      `${seconds(frame)} of ${seconds(last)} seconds ${tense(figures[0], frame)}`,
    );
    root.dataset.frame = String(frame);
    root.dataset.playing = String(playing);
  }

  function tell(force) {
    // messages to the kernel: at most five a second, and at once for a final value
    if (sent === frame && model.get("playing") === playing) return;
    if (!force && (led || performance.now() - told < 200)) return;
    told = performance.now();
    sent = frame;
    model.set("frame", frame);
    model.set("playing", playing);
    model.save_changes();
  }
  function show(to, force = true) {
    frame = clamp(Math.round(to), 0, last);
    draw();
    tell(force);
  }
  function go(to) {
    const target = clamp(Math.floor(to + 1e-3), 0, last);
    clock.seek(target / scene.fps);
    show(target);
  }
  function setPlaying(on) {
    if (on && !playing && frame >= last) {
      frame = 0;
      clock.seek(0);
    }
    playing = on;
    if (on) {
      before = 0;
      run();
    } else if (clock) {
      clock.stop();
      settle();
      setLed(false);
    }
    play.textContent = on ? "\u275a\u275a Pause" : "\u25b6 Play";
    play.setAttribute("aria-label", on ? "Pause" : "Play");
    show(frame);
    if (on && !ticking) ticking = requestAnimationFrame(tick);
  }
  function settle() {
    // at rest sound and picture agree: the sound goes to the frame that is seen
    const away = clock.now() * scene.fps - frame;
    if (away < 0 || away >= 1) clock.seek(frame / scene.fps);
  }
  function run() {
    if (heard()) {
      // another player stops; another view of this one follows: its model is an object of its own,
      // but the scene in it is the same
      const detail = { root, scene: model.get("scene") };
      note.textContent = "";
      document.dispatchEvent(new CustomEvent("mde-sound", { detail }));
    }
    Promise.resolve(clock.start()).catch((error) => {
      // a refusal; an interruption and a bad file are told elsewhere
      if (error.name !== "NotAllowedError" || !playing) return;
      setPlaying(false);
      note.textContent = "Press Play: browsers start sound only after a click.";
    });
  }
  // A picture painted now stays until the next chance to paint, a moment the page learns from the
  // last ones: it is painted for the middle of that time, at most half a frame ahead.
  function tick(time) {
    ticking = 0;
    if (!playing || stop.signal.aborted) return;
    if (before) pace += 0.1 * (Math.min(time - before, 100) - pace);
    before = time;
    const ahead = Math.min((pace / 2000) * Number(speeds.value), 0.5 / scene.fps);
    const was = at;
    at = clock.now();
    const next = clamp(Math.floor((at + (heard() ? ahead : 0)) * scene.fps + 1e-3), 0, last);
    // a smaller `ahead` alone takes nothing back
    if (at < was ? next !== frame : next > frame) show(next, false);
    ticking = requestAnimationFrame(tick);
  }
  function setMuted(on) {
    sound.muted = on;
    mute.textContent = on ? "Muted" : "Mute";
    mute.setAttribute("aria-pressed", String(on));
    if (!on && scene.muted) setLed(false);
  }
  function setSpeed(value) {
    speeds.value = value;
    clock.rate(Number(value));
  }
  function home() {
    Object.assign(view, HOME);
    view.follow = follow.checked = scene.follow;
    setSpeed("1");
    setPlaying(false);
    go(0);
  }
  function zoom(by) {
    view.zoom = clamp(view.zoom * by, 0.25, 5);
    draw();
  }
  function step(by) {
    if (playing) setPlaying(false);
    go(frame + by);
  }
  function setFollow(on) {
    view.follow = follow.checked = on;
    draw();
  }
  const keys = {
    " ": () => setPlaying(!playing),
    ArrowRight: () => step(1),
    ArrowLeft: () => step(-1),
    ArrowUp: () => step(10),
    ArrowDown: () => step(-10),
    Home: () => go(0),
    End: () => go(last),
    "+": () => zoom(1.2),
    "=": () => zoom(1.2),
    "-": () => zoom(1 / 1.2),
    r: home,
    R: home,
    f: () => setFollow(!view.follow),
    F: () => setFollow(!view.follow),
    m: () => setMuted(!sound.muted),
    M: () => setMuted(!sound.muted),
  };
  listen(root, "keydown", (event) => {
    const own =
      event.target === canvas ||
      event.target === lane.canvas ||
      (event.target === scrub && event.key !== "Tab");
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    event.stopPropagation(); // otherwise JupyterLab handles the key
    if (own && keys[event.key]) {
      event.preventDefault();
      keys[event.key]();
    }
  });
  listen(play, "click", () => setPlaying(!playing));
  listen(scrub, "input", () => {
    if (playing) setPlaying(false);
    go(Number(scrub.value));
  });
  listen(speeds, "change", () => setSpeed(speeds.value));
  listen(mute, "click", () => setMuted(!sound.muted));
  listen(sound, "pause", () => {
    if (heard() && playing && sound.paused && !sound.error) setPlaying(false);
  }); // by a media key
  listen(sound, "play", () => {
    // it is told late: by then the sound may have been stopped again
    if (!playing && !sound.paused) setPlaying(true);
  });
  listen(sound, "canplay", () => {
    if (heard() && playing && sound.paused) run();
  });
  listen(document, "mde-sound", ({ detail }) => {
    if (detail.root === root) return;
    if (detail.scene === model.get("scene")) setLed(true);
    else if (heard() && playing) setPlaying(false);
  });
  listen(document, "mde-silence", ({ detail }) => {
    if (detail.scene === model.get("scene")) setLed(false); // the view that sounded was closed
  });
  listen(reset, "click", home);
  listen(follow, "change", () => setFollow(follow.checked));
  let grip = null;
  listen(canvas, "pointerdown", (e) => {
    grip = [e.clientX, e.clientY];
    canvas.setPointerCapture(e.pointerId);
    canvas.focus({ preventScroll: true });
  });
  listen(canvas, "pointermove", (e) => {
    if (!grip) return;
    view.yaw += (e.clientX - grip[0]) * 0.008;
    view.pitch = clamp(view.pitch + (e.clientY - grip[1]) * 0.006, 0.02, 1.5);
    grip = [e.clientX, e.clientY];
    draw();
  });
  for (const name of ["pointerup", "pointercancel"])
    listen(canvas, name, () => {
      grip = null;
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
  const onFrame = () => {
    if (model.get("frame") !== sent) {
      sent = model.get("frame");
      frame = clamp(sent, 0, last);
      clock.seek(frame / scene.fps);
      draw();
    }
  };
  const onPlaying = () => {
    if (model.get("playing") !== playing) setPlaying(model.get("playing"));
  };
  const onNotes = () => {
    const found = model.get("notes") || [];
    notes.hidden = !found.length;
    notes.replaceChildren(...(found.length ? noted(found) : []));
  };
  const onScene = () => {
    load();
    frame = Math.min(frame, last);
    clock.seek(frame / scene.fps);
    if (playing) run();
    show(frame);
  };
  model.on("change:frame", onFrame);
  model.on("change:playing", onPlaying);
  model.on("change:scene", onScene);
  model.on("change:notes", onNotes);
  redrawn(stop, canvas, draw);
  sighted(stop, canvas, (seen) => {
    visible = seen;
  });

  speeds.value = "1";
  load();
  onNotes();
  frame = sent = clamp(model.get("frame"), 0, last);
  clock.seek(frame / scene.fps);
  if (scene.muted) {
    // before a click browsers play no sound, not even a muted one: the page's clock leads
    setMuted(true);
    setLed(true);
  }
  setPlaying(model.get("playing") || (scene.autoplay && !calm));
  return () => {
    stop.abort();
    if (heard() && playing)
      document.dispatchEvent(
        new CustomEvent("mde-silence", { detail: { scene: model.get("scene") } }),
      );
    unload();
    cancelAnimationFrame(ticking);
    model.off("change:frame", onFrame);
    model.off("change:playing", onPlaying);
    model.off("change:scene", onScene);
    model.off("change:notes", onNotes);
    root.remove();
  };
}

// The notes as lines of plain text: the first, and the second if both are short; the rest unfolds.
function noted([first, ...rest]) {
  const line = (words) => element("p", {}, words);
  const cut = first.length > LONG ? first.lastIndexOf(" ", LONG) : 0;
  const seen = [cut > 0 ? `${first.slice(0, cut)} \u2026` : first];
  if (rest.length && (first + rest[0]).length <= LONG) seen.push(rest.shift());
  const more = rest.length ? `and ${rest.length} more` : "more";
  if (cut > 0) rest.unshift(`\u2026${first.slice(cut)}`);
  const folded = element("details", {}, element("summary", {}, more), ...rest.map(line));
  return [...seen.map(line), ...(rest.length ? [folded] : [])];
}

// ---- the same module with no kernel: `record` carries the traits, binary ones in base64
export function staticModel(record) {
  const state = { ...record };
  const decode = (s) => new DataView(Uint8Array.from(atob(s), (c) => c.charCodeAt(0)).buffer);
  for (const name of ["joints", "roots", "contacts", "sound", "strips"])
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
