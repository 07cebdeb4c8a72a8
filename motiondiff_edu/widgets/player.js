// The player: one canvas that draws skeletons. No dependencies; runs in JupyterLab (anywidget), in exported
// HTML (an iframe with this same text) and in a bare page. `model` needs get, set, save_changes, on, off.

const CSS = `
.mde-player { --bg: var(--jp-layout-color0, #ffffff); --fg: var(--jp-ui-font-color1, #1f2933);
  --line: var(--jp-border-color2, #c9d1da); --focus: var(--jp-brand-color1, #1976d2);
  display: flex; flex-direction: column; gap: 6px; background: var(--bg); color: var(--fg); box-sizing: border-box;
  font: 15px/1.3 var(--jp-ui-font-family, system-ui, sans-serif); padding: 6px; width: 100%; max-width: 1200px; }
.mde-player.mde-fill { height: 100%; max-width: none; }
.mde-player.mde-fill canvas { flex: 1; min-height: 0; }
.mde-player canvas { width: 100%; display: block; border-radius: 8px; cursor: grab; touch-action: pan-y; outline: none; }
.mde-player canvas:active { cursor: grabbing; }
.mde-player canvas:focus-visible, .mde-player :is(button, input, select):focus-visible {
  outline: 3px solid var(--focus); outline-offset: 1px; }
.mde-row { display: flex; flex-wrap: wrap; align-items: center; gap: 6px 12px; }
.mde-row > input[type=range] { flex: 1 1 140px; min-width: 100px; accent-color: var(--focus); margin: 0; }
.mde-row button, .mde-row select { font: inherit; color: inherit; background: transparent; border: 1px solid var(--line);
  border-radius: 6px; padding: 3px 10px; min-height: 30px; cursor: pointer; }
.mde-row select option { color: #1f2933; background: #fff; }
.mde-row button.mde-play { min-width: 84px; font-weight: 600; }
.mde-row output { font-variant-numeric: tabular-nums; min-width: 7.5em; }
.mde-key { display: inline-flex; align-items: center; gap: 5px; } .mde-key i { width: 14px; height: 14px; border-radius: 7px; }
@media (forced-colors: active) { .mde-key i { forced-color-adjust: none; } }`;
const HOME = { yaw: 0.6, pitch: 0.2, zoom: 1 };
const COLOUR = { L: [0, 114, 178], R: [213, 94, 0], C: [91, 100, 114] }, GREEN = [0, 158, 115];
const LIGHT_ON_DARK = { L: [58, 160, 220], R: [240, 128, 40], C: [168, 178, 192] };
const RING = Array.from({ length: 20 }, (_, i) => [Math.cos(i * Math.PI / 10), Math.sin(i * Math.PI / 10)]);
const clamp = (v, lo, hi) => Math.min(hi, Math.max(lo, v));
const mix = (a, b, w) => a.map((v, i) => v + w * (b[i] - v));
const rgba = (c, alpha = 1) => `rgba(${c.map(Math.round)},${alpha})`;
const parse = (text) => (text.match(/[\d.]+/g) || [255, 255, 255]).slice(0, 3).map(Number);

function element(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name in node && typeof value !== "string") node[name] = value; else node.setAttribute(name, value);
  }
  node.append(...children);
  return node;
}

// ---- data: bytes -> per figure { frames, joint(t, j), ... }
function bytes(view) { return view.buffer.slice(view.byteOffset, view.byteOffset + view.byteLength); }

function unpack(model) {
  const scene = model.get("scene"), J = scene.joints;
  const joints = new Int16Array(bytes(model.get("joints"))), roots = new Float32Array(bytes(model.get("roots")));
  const codes = new Uint8Array(bytes(model.get("contacts")));
  let start = 0;
  return scene.figures.map((info) => {
    const first = start; start += info.frames;
    const at = (t) => first + clamp(t, 0, info.frames - 1);
    const root = (t) => [0, 1, 2].map((k) => roots[3 * at(t) + k]);
    const pose = (t) => {
      const r = root(t), base = 3 * J * at(t);
      return Array.from({ length: J }, (_, j) => [0, 1, 2].map((k) => r[k] + joints[base + 3 * j + k] / 2048));
    };
    const figure = { ...info, root, pose, planted: (t) => (info.contacts ? codes[at(t)] : 0) };
    figure.prints = info.contacts ? footprints(figure) : [];
    return figure;
  });
}

function footprints(figure) { // one print for each run of contact: where ankle and toe are in its middle
  const prints = [];
  [[1, 3, 4, "L"], [2, 7, 8, "R"]].forEach(([bit, ankle, toe, side]) => {
    for (let t = 0; t < figure.frames; t++) {
      if (!(figure.planted(t) & bit)) continue;
      const begin = t;
      while (t + 1 < figure.frames && figure.planted(t + 1) & bit) t++;
      const pose = figure.pose((begin + t) >> 1);
      prints.push({ begin, side, a: pose[ankle], b: pose[toe] });
    }
  });
  return prints;
}

// ---- geometry
function hull(points) { // Andrew's monotone chain
  points.sort((p, q) => p[0] - q[0] || p[1] - q[1]);
  const chain = (list) => {
    const kept = [];
    for (const p of list) {
      while (kept.length > 1) {
        const [a, b] = kept.slice(-2);
        if ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0) break;
        kept.pop();
      }
      kept.push(p);
    }
    kept.pop();
    return kept;
  };
  return [...chain(points), ...chain(points.reverse())];
}

function camera(view, target, distance, width, height) {
  const [cy, sy, cp, sp] = [Math.cos(view.yaw), Math.sin(view.yaw), Math.cos(view.pitch), Math.sin(view.pitch)];
  const ahead = [cp * cy, -sp, -cp * sy], right = [sy, 0, cy];
  const up = [right[1] * ahead[2] - right[2] * ahead[1], right[2] * ahead[0] - right[0] * ahead[2],
    right[0] * ahead[1] - right[1] * ahead[0]];
  const eye = target.map((v, k) => v - distance * ahead[k]);
  const focal = Math.min(2.05 * height, 2.9 * width);
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  return (p) => {
    const away = [p[0] - eye[0], p[1] - eye[1], p[2] - eye[2]], depth = dot(away, ahead);
    const scale = focal / Math.max(depth, 0.1);
    return { x: width / 2 + scale * dot(away, right), y: height / 2 - scale * dot(away, up), scale, seen: depth > 0.3 };
  };
}

function smoothRoot(figure, t) { // the root on the floor, averaged over a second: the camera does not bob
  let x = 0, z = 0;
  for (let i = -10; i <= 10; i++) { const r = figure.root(t + i); x += r[0] / 21; z += r[2] / 21; }
  return [x, z];
}

// ---- painting
function fillPolygon(ctx, points, fill, edge) {
  ctx.beginPath();
  points.forEach(([x, y], i) => (i ? ctx.lineTo(x, y) : ctx.moveTo(x, y)));
  ctx.closePath();
  if (edge) { ctx.strokeStyle = edge; ctx.lineWidth = 2; ctx.lineJoin = "round"; ctx.stroke(); }
  ctx.fillStyle = fill; ctx.fill();
}

function paintFloor(ctx, look, target, theme, reach) {
  const [cx, cz] = [Math.round(target[0]), Math.round(target[1])], step = reach > 12 ? 2 : 1, n = Math.ceil(reach / step);
  const segment = (a, b) => {
    const d = Math.hypot((a[0] + b[0]) / 2 - target[0], (a[2] + b[2]) / 2 - target[1]) / reach;
    const alpha = 0.5 * (1 - d * d), p = look(a), q = look(b);
    if (alpha <= 0.01 || !p.seen || !q.seen) return;
    ctx.strokeStyle = rgba(theme.line, alpha);
    ctx.beginPath(); ctx.moveTo(p.x, p.y); ctx.lineTo(q.x, q.y); ctx.stroke();
  };
  ctx.lineWidth = 1;
  for (let i = -n; i <= n; i++) {
    for (let k = -n; k < n; k++) {
      const [u, v, w] = [i * step, k * step, (k + 1) * step];
      segment([cx + u, 0, cz + v], [cx + u, 0, cz + w]);
      segment([cx + v, 0, cz + u], [cx + w, 0, cz + u]);
    }
  }
}

function paintLine(ctx, look, points, colour, width, dash = []) {
  ctx.setLineDash(dash); ctx.strokeStyle = colour; ctx.lineWidth = width; ctx.lineCap = ctx.lineJoin = "round";
  ctx.beginPath();
  let open = false;
  for (const [x, z] of points) {
    const p = look([x, 0.002, z]);
    if (p.seen) { if (open) ctx.lineTo(p.x, p.y); else ctx.moveTo(p.x, p.y); }
    open = p.seen;
  }
  ctx.stroke(); ctx.setLineDash([]);
}

function floorDisc(look, x, z, radius) {
  return RING.map(([c, s]) => look([x + radius * c, 0.003, z + radius * s])).map((p) => [p.x, p.y]);
}

function paintGround(ctx, look, figure, t, theme, off) { // path, trail, footprints, contact marks
  const shift = ([x, z]) => [x + off[0], z + off[1]];
  if (figure.path) paintLine(ctx, look, figure.path.map(shift), rgba(GREEN, 0.85), 3, [9, 7]);
  const trail = Array.from({ length: figure.frames }, (_, i) => { const r = figure.root(i); return shift([r[0], r[2]]); });
  const past = figure.past || 0, now = Math.min(t, figure.frames - 1);
  paintLine(ctx, look, trail.slice(0, Math.min(past, now) + 1), rgba(theme.line, 0.9), 5);
  if (now > past) paintLine(ctx, look, trail.slice(past, now + 1), rgba(theme.fg, 0.45), 2.5);
  for (const print of figure.prints) {
    if (print.begin > t) continue;
    const discs = [[print.a, 0.035], [print.b, 0.05]].flatMap(([p, r]) => floorDisc(look, p[0] + off[0], p[2] + off[1], r));
    fillPolygon(ctx, hull(discs), rgba(theme.body[print.side], Math.max(0.12, 0.5 - (t - print.begin) * 0.006)));
  }
  const pose = figure.pose(t);
  [[1, 3, 4, "L"], [2, 7, 8, "R"]].forEach(([bit, ankle, toe, side]) => {
    if (!(figure.planted(t) & bit)) return;
    const ring = floorDisc(look, (pose[ankle][0] + pose[toe][0]) / 2 + off[0], (pose[ankle][2] + pose[toe][2]) / 2 + off[1], 0.17);
    fillPolygon(ctx, ring, rgba(theme.body[side], 0.22), rgba(theme.body[side], 0.9));
  });
}

function paintBody(ctx, look, parts, pose, theme, wash, target, off) {
  const moved = pose.map(([x, y, z]) => [x + off[0], y, z + off[1]]);
  const centre = ([a, b, w]) => [0, 1, 2].map((k) => moved[a][k] + w * (moved[b][k] - moved[a][k]));
  ctx.beginPath(); // the shadow: one path, filled once, so that overlaps do not darken
  for (const part of parts) {
    const ring = part.circles.flatMap((c) => {
      const p = centre(c), x = p[0] + 0.25 * p[1], z = p[2] - 0.15 * p[1];
      return floorDisc(look, x, z, 0.9 * c[3]);
    });
    hull(ring).forEach(([x, y], i) => (i ? ctx.lineTo(x, y) : ctx.moveTo(x, y)));
    ctx.closePath();
  }
  ctx.fillStyle = theme.shadow; ctx.fill();
  const middle = look([target[0], 0.86, target[1]]).scale;
  const drawn = parts.map((part) => {
    const dots = part.circles.map((c) => { const p = look(centre(c)); return [p.x, p.y, c[3] * p.scale, p.scale]; });
    const scale = dots.reduce((sum, d) => sum + d[3], 0) / dots.length;
    const around = (size, dx, dy) => hull(dots.flatMap(([x, y, r]) =>
      RING.map(([c, s]) => [x - dx * r + size * r * c, y - dy * r + size * r * s])));
    return { part, scale, outline: around(1, 0, 0), shine: around(0.45, 0.15, 0.3) };
  }).sort((p, q) => p.scale - q.scale);
  for (const { part, scale, outline, shine } of drawn) {
    const behind = clamp(4 * (1 - scale / middle), 0, 0.45);
    const colour = mix(theme.body[part.side], theme.bg, wash + behind * (1 - wash));
    fillPolygon(ctx, outline, rgba(colour), rgba(theme.bg, 0.9));
    fillPolygon(ctx, shine, rgba(mix(colour, [255, 255, 255], theme.dark ? 0.16 : 0.22)));
  }
}

function paintText(ctx, theme, text, x, y, align, size, weight = 600) {
  ctx.font = `${weight} ${size}px system-ui, sans-serif`; ctx.textAlign = align; ctx.textBaseline = "alphabetic";
  ctx.lineWidth = 4; ctx.lineJoin = "round"; ctx.strokeStyle = rgba(theme.bg, 0.85); ctx.strokeText(text, x, y);
  ctx.fillStyle = rgba(theme.fg); ctx.fillText(text, x, y);
}

const tense = (figure, t) => (figure.past == null ? "" : t < figure.past ? "past (given)" : "future (generated)");

function paintPanel(ctx, scene, figures, frame, view, theme, width, height) {
  const offsets = figures.map((_, i) => [0, 1].map((k) => (i - (figures.length - 1) / 2) * scene.offset[k]));
  const spots = figures.map((f, i) => (view.follow ? smoothRoot(f, frame) : f.middle).map((v, k) => v + offsets[i][k]));
  const target = [0, 1].map((k) => spots.reduce((s, p) => s + p[k], 0) / spots.length);
  const spread = Math.max(0, ...spots.map((p) => 2 * Math.hypot(p[0] - target[0], p[1] - target[1])));
  const extent = spread + (view.follow ? 0 : Math.max(...figures.map((f) => f.extent)));
  const distance = (5 + 1.15 * extent) / view.zoom;
  const look = camera(view, [target[0], 0.86, target[1]], distance, width, height);
  paintFloor(ctx, look, target, theme, 6 + extent);
  figures.forEach((f, i) => paintGround(ctx, look, f, frame, theme, offsets[i]));
  const order = figures.map((_, i) => i).sort((a, b) => look([spots[a][0], 0, spots[a][1]]).scale - look([spots[b][0], 0, spots[b][1]]).scale);
  for (const i of order) {
    const f = figures[i], pose = f.pose(frame), wash = f.past != null && frame < f.past ? 0.55 : 0;
    paintBody(ctx, look, scene.parts, pose, theme, wash, spots[i], offsets[i]);
    if (figures.length > 1 && f.label) {
      const top = Math.max(...pose.map((p) => p[1])), head = look([pose[0][0] + offsets[i][0], top + 0.28, pose[0][2] + offsets[i][1]]);
      paintText(ctx, theme, f.label, head.x, head.y, "center", 15);
    }
  }
  const f = figures[0], small = width < 330, size = small ? 14 : 17;
  const titles = [figures.length === 1 ? f.label : "", small ? tense(f, frame).split(" ")[0] : tense(f, frame)].filter(Boolean);
  (small ? titles : [titles.join(" \u00b7 ")]).forEach((line, i) => paintText(ctx, theme, line, 12, 24 + 19 * i, "left", size));
  if (frame >= f.frames && figures.length === 1) paintText(ctx, theme, `ended after ${(f.frames / scene.fps).toFixed(1)} s`, 12, 64, "left", 14, 400);
  paintText(ctx, theme, `floor squares: ${6 + extent > 12 ? 2 : 1} m`, width - 10, height - 10, "right", 13, 400);
}

function readTheme(root) {
  const style = getComputedStyle(root), bg = parse(style.backgroundColor), fg = parse(style.color);
  const dark = bg[0] + bg[1] + bg[2] < 380;
  return { bg, fg, dark, body: dark ? LIGHT_ON_DARK : COLOUR, line: mix(bg, fg, 0.42), shadow: dark ? "rgba(0,0,0,.5)" : "rgba(30,40,55,.17)" };
}

// ---- the widget
export function mount(model, el, { fill = false } = {}) {
  const text = { title: "Drag: turn. Click, then wheel: zoom. Space: play. Arrows: frames. Home, End. + and -: zoom. F: follow. R: reset." };
  const canvas = element("canvas", { tabindex: "0", role: "application", "aria-roledescription": "motion player", ...text });
  const play = element("button", { type: "button", class: "mde-play", "aria-label": "Play" });
  const scrub = element("input", { type: "range", min: "0", step: "1", "aria-label": "Frame" });
  const clock = element("output", {});
  const speeds = element("select", { "aria-label": "Speed" }, ...[0.1, 0.25, 0.5, 1, 2, 4].map((v) => element("option", { value: String(v) }, `${v}\u00d7`)));
  const follow = element("input", { type: "checkbox", checked: true });
  const reset = element("button", { type: "button", title: "First frame, first view, normal speed (R)" }, "Reset");
  const dots = { L: element("i"), R: element("i") };
  const key = (side, word) => element("span", { class: "mde-key" }, dots[side], word);
  const root = element("div", { class: "mde-player" + (fill ? " mde-fill" : ""), "data-lm-suppress-shortcuts": "true" },
    element("style", {}, CSS), canvas, element("div", { class: "mde-row" }, play, scrub, clock),
    element("div", { class: "mde-row" }, key("L", "left"), key("R", "right"), element("label", { class: "mde-key" }, "speed", speeds),
      element("label", { class: "mde-key" }, follow, "follow"), reset));
  el.append(root);
  const view = { ...HOME, follow: true };
  const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
  const stop = new AbortController(), listen = (node, name, f, options = {}) => node.addEventListener(name, f, { signal: stop.signal, ...options });
  let scene, figures, last, frame = 0, playing = false, visible = true, ticking = 0, before = 0, carry = 0, sent = 0, told = 0;

  function load() {
    scene = model.get("scene"); figures = unpack(model);
    last = Math.max(...figures.map((f) => f.frames)) - 1;
    for (const f of figures) {
      const [xs, zs] = [0, 2].map((k) => Array.from({ length: f.frames }, (_, t) => f.root(t)[k]));
      const ends = [xs, zs].map((v) => [Math.min(...v), Math.max(...v)]);
      f.middle = ends.map(([a, b]) => (a + b) / 2); f.extent = Math.hypot(...ends.map(([a, b]) => b - a));
    }
    scrub.max = String(last); canvas.setAttribute("aria-label", scene.description);
    if (!fill) canvas.style.height = `${scene.height}px`;
    view.follow = follow.checked = scene.follow;
  }

  function draw() {
    const ratio = devicePixelRatio || 1, [w, h] = [canvas.clientWidth, canvas.clientHeight];
    if (!w || !h) return;
    if (canvas.width !== Math.round(w * ratio) || canvas.height !== Math.round(h * ratio)) {
      canvas.width = Math.round(w * ratio); canvas.height = Math.round(h * ratio);
    }
    const ctx = canvas.getContext("2d"), theme = readTheme(root);
    ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
    for (const side of ["L", "R"]) dots[side].style.background = rgba(theme.body[side]);
    const sky = ctx.createLinearGradient(0, 0, 0, h);
    sky.addColorStop(0, rgba(mix(theme.bg, theme.fg, 0.03))); sky.addColorStop(1, rgba(mix(theme.bg, theme.fg, 0.09)));
    ctx.fillStyle = sky; ctx.fillRect(0, 0, w, h);
    const panels = scene.layout === "side" ? figures.map((f) => [f]) : [figures];
    const most = clamp(Math.round(Math.sqrt(panels.length * w / h * 1.5)), 1, panels.length);
    const rows = Math.ceil(panels.length / most), columns = Math.ceil(panels.length / rows), pw = w / columns, ph = h / rows;
    panels.forEach((group, i) => {
      ctx.save(); ctx.translate((i % columns) * pw, Math.floor(i / columns) * ph);
      ctx.beginPath(); ctx.rect(0, 0, pw, ph); ctx.clip();
      paintPanel(ctx, scene, group, frame, view, theme, pw, ph);
      if (panels.length > 1) { ctx.strokeStyle = rgba(theme.line, 0.5); ctx.lineWidth = 1; ctx.strokeRect(0, 0, pw, ph); }
      ctx.restore();
    });
    const seconds = (t) => (t / scene.fps).toFixed(2);
    scrub.value = String(frame); clock.textContent = `${seconds(frame)} s \u00b7 ${frame} / ${last}`;
    scrub.setAttribute("aria-valuetext", `${seconds(frame)} of ${seconds(last)} seconds ${tense(figures[0], frame)}`);
    root.dataset.frame = String(frame); root.dataset.playing = String(playing);
  }

  function tell(force) { // the kernel hears at most five times a second, and at once when something is decided
    if (sent === frame && model.get("playing") === playing) return;
    if (!force && performance.now() - told < 200) return;
    told = performance.now(); sent = frame;
    model.set("frame", frame); model.set("playing", playing); model.save_changes();
  }
  function show(to, force = true) { frame = clamp(Math.round(to), 0, last); draw(); tell(force); }
  function setPlaying(on) {
    if (on && !playing && frame >= last) frame = 0;
    playing = on; before = 0; carry = 0;
    play.textContent = on ? "\u275a\u275a Pause" : "\u25b6 Play"; play.setAttribute("aria-label", on ? "Pause" : "Play");
    show(frame);
    if (on && !ticking) ticking = requestAnimationFrame(tick);
  }
  function tick(now) {
    ticking = 0;
    if (!playing || stop.signal.aborted) return;
    if (visible && before) {
      carry += Math.min(0.5, (now - before) / 1000) * scene.fps * Number(speeds.value);
      const whole = Math.floor(carry); carry -= whole;
      if (whole) show((frame + whole) % (last + 1), false);
    }
    before = now; ticking = requestAnimationFrame(tick);
  }
  function home() { Object.assign(view, HOME); view.follow = follow.checked = scene.follow; speeds.value = "1"; setPlaying(false); show(0); }
  function zoom(by) { view.zoom = clamp(view.zoom * by, 0.25, 5); draw(); }
  function step(by) { if (playing) setPlaying(false); show(frame + by); }
  function setFollow(on) { view.follow = follow.checked = on; draw(); }
  const keys = {
    " ": () => setPlaying(!playing), ArrowRight: () => step(1), ArrowLeft: () => step(-1), ArrowUp: () => step(10), ArrowDown: () => step(-10),
    Home: () => show(0), End: () => show(last), "+": () => zoom(1.2), "=": () => zoom(1.2), "-": () => zoom(1 / 1.2),
    r: home, R: home, f: () => setFollow(!view.follow), F: () => setFollow(!view.follow),
  };
  listen(root, "keydown", (event) => {
    const own = event.target === canvas || (event.target === scrub && event.key !== "Tab");
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    event.stopPropagation(); // else JupyterLab takes the key for its own
    if (own && keys[event.key]) { event.preventDefault(); keys[event.key](); }
  });
  listen(play, "click", () => setPlaying(!playing));
  listen(scrub, "input", () => { if (playing) setPlaying(false); show(Number(scrub.value)); });
  listen(reset, "click", home);
  listen(follow, "change", () => setFollow(follow.checked));
  let grip = null;
  listen(canvas, "pointerdown", (e) => { grip = [e.clientX, e.clientY]; canvas.setPointerCapture(e.pointerId); canvas.focus({ preventScroll: true }); });
  listen(canvas, "pointermove", (e) => {
    if (!grip) return;
    view.yaw += (e.clientX - grip[0]) * 0.008; view.pitch = clamp(view.pitch + (e.clientY - grip[1]) * 0.006, 0.02, 1.5);
    grip = [e.clientX, e.clientY]; draw();
  });
  for (const name of ["pointerup", "pointercancel"]) listen(canvas, name, () => { grip = null; });
  listen(canvas, "wheel", (e) => { // only once the figure was clicked, so that a page can be scrolled past it
    if (document.activeElement !== canvas && !e.ctrlKey) return;
    e.preventDefault(); e.stopPropagation(); zoom(Math.exp(-e.deltaY * 0.0015));
  }, { passive: false });
  const onFrame = () => { if (model.get("frame") !== sent) { sent = model.get("frame"); frame = clamp(sent, 0, last); draw(); } };
  const onPlaying = () => { if (model.get("playing") !== playing) setPlaying(model.get("playing")); };
  const onScene = () => { load(); show(Math.min(frame, last)); };
  model.on("change:frame", onFrame); model.on("change:playing", onPlaying); model.on("change:scene", onScene);
  const sizes = new ResizeObserver(draw), sights = new IntersectionObserver(([seen]) => { visible = seen.isIntersecting; before = 0; });
  const themes = new MutationObserver(draw);
  sizes.observe(canvas); sights.observe(canvas); themes.observe(document.body, { attributes: true });

  load(); speeds.value = "1"; frame = sent = clamp(model.get("frame"), 0, last);
  setPlaying(model.get("playing") || (scene.autoplay && !calm));
  return () => {
    stop.abort(); cancelAnimationFrame(ticking); [sizes, sights, themes].forEach((o) => o.disconnect());
    model.off("change:frame", onFrame); model.off("change:playing", onPlaying); model.off("change:scene", onScene); root.remove();
  };
}

// ---- the same module with no kernel: `record` carries the traits, binary ones in base64
export function staticModel(record) {
  const state = { ...record }, decode = (s) => new DataView(Uint8Array.from(atob(s), (c) => c.charCodeAt(0)).buffer);
  for (const name of ["joints", "roots", "contacts"]) state[name] = decode(record[name]);
  return { get: (name) => state[name], set: (name, value) => { state[name] = value; }, save_changes() {}, on() {}, off() {} };
}

export default { render: ({ model, el }) => mount(model, el) };
