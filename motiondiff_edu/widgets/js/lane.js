// The music lane under the figure: waveform, beats, where the playhead is; attention behind the
// waveform, and how far the figure moved when a hit was silenced, beneath it. Click or drag: go
// there.
import { GREEN, clamp, element, mix, rgba } from "./dom.js";

const PURPLE = [204, 121, 167];
const DEEP = [148, 62, 112];
const PALE = [246, 214, 232];
const MARGIN = 8;
const TICKS = 14;
const WAVE = 56;
const AXIS = 18;
const LABEL = 18;
const CURVE = 36;

function unpackLane(record, view) {
  // bytes: lows and highs of the waveform, then the rows of every level
  const all = new Uint8Array(view.buffer, view.byteOffset, view.byteLength);
  const peaks = new Int8Array(all.buffer, all.byteOffset, 2 * record.peaks);
  let start = 2 * record.peaks;
  const levels = record.levels.map((level) => {
    const columns = record.edges[level.edges].length - 1;
    const first = start;
    start += level.rows * columns;
    return {
      ...level,
      columns,
      edges: record.edges[level.edges],
      weight: (row, k) => (all[first + row * columns + k] / 255) * level.tops[row],
    };
  });
  return { ...record, bins: peaks, levels };
}

function timeStep(length, width) {
  // seconds between labels, so that they do not touch
  return [0.5, 1, 2, 5, 10, 20, 30, 60, 120].find((s) => (s / length) * width > 64) || 300;
}

function fitting(pen, width, ...texts) {
  return texts.find((text) => pen.measureText(text).width <= width) || texts.at(-1);
}

export function musicLane(listen, seek, redraw) {
  const canvas = element("canvas", {
    class: "mde-lane",
    tabindex: "0",
    role: "slider",
    "aria-label": "Music",
    "aria-valuemin": "0",
    title: "Click: go there. Arrows: frames.",
  });
  const levels = element("select", { "aria-label": "Level of the attention" });
  const swatch = element("i", { class: "mde-ramp" });
  const words = element("span");
  const said = element("output", { class: "mde-said", "aria-live": "off" });
  const key = element("label", { class: "mde-key" }, swatch, words, levels);
  const row = element("div", { class: "mde-row" }, key, said);
  const node = element("div", { hidden: true }, canvas, row);
  node.style.cssText = "flex-direction:column;gap:4px";
  let lane = null;
  let waves = {};

  function load(record, view) {
    lane = record ? unpackLane(record, view) : null;
    waves = {};
    node.style.display = lane ? "flex" : "none";
    node.hidden = !lane;
    if (!lane) return;
    const chosen = levels.value;
    levels.replaceChildren(...lane.levels.map((l) => element("option", { value: l.name }, l.name)));
    if (lane.levels.some((l) => l.name === chosen)) levels.value = chosen;
    levels.style.display = lane.levels.length > 1 ? "" : "none";
    key.style.display = lane.levels.length ? "" : "none";
    row.style.display = lane.levels.length || lane.moved ? "" : "none";
    canvas.style.height = `${TICKS + WAVE + AXIS + (lane.moved ? LABEL + CURVE : 0)}px`;
    canvas.setAttribute("aria-label", lane.description);
    canvas.setAttribute("aria-valuemax", lane.seconds.toFixed(2));
  }

  function paintAttention(pen, theme, level, now, across) {
    // columns of colour over the tokens' times, behind the waveform
    const full = level.full ?? level.tops[now];
    for (let k = 0; k < level.columns; k++) {
      const [a, b] = [across(level.edges[k]), across(level.edges[k + 1])];
      // from paper to purple, and on to what stands out most
      const share = Math.min(1, level.weight(now, k) / full);
      pen.fillStyle =
        share < 0.5
          ? rgba(PURPLE, 2 * share)
          : rgba(mix(PURPLE, theme.dark ? PALE : DEEP, 2 * share - 1));
      pen.fillRect(a, TICKS, Math.max(b - a, 0.5), WAVE);
    }
  }

  function waveform(theme, width, ratio, alpha) {
    // a picture of it, drawn once: it does not change while playing
    const picture = element("canvas");
    const middle = WAVE / 2;
    const n = lane.peaks;
    const inner = width - 2 * MARGIN;
    picture.width = Math.round(width * ratio);
    picture.height = Math.round(WAVE * ratio);
    const pen = picture.getContext("2d");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.fillStyle = rgba(theme.fg, alpha);
    for (let i = 0; i < n; i++) {
      const [low, high] = [lane.bins[2 * i], lane.bins[2 * i + 1]].map(
        (v) => (v / 127) * (WAVE / 2 - 2),
      );
      pen.rect(
        MARGIN + (i / n) * inner,
        middle - high - 0.5,
        Math.max(inner / n, 0.6),
        high - low + 1,
      );
    }
    pen.fill();
    return picture;
  }

  function paintWave(pen, theme, width, ratio, x) {
    // what has been heard is darker
    const name = [width, ratio, theme.fg].join();
    if (waves.name !== name)
      waves = {
        name,
        heard: waveform(theme, width, ratio, 0.9),
        ahead: waveform(theme, width, ratio, 0.5),
      };
    for (const [picture, from, to] of [
      [waves.heard, 0, x],
      [waves.ahead, x, width],
    ]) {
      if (to - from > 0.01)
        pen.drawImage(
          picture,
          from * ratio,
          0,
          (to - from) * ratio,
          picture.height,
          from,
          TICKS,
          to - from,
          WAVE,
        );
    }
  }

  function paintBeats(pen, theme, across) {
    // ticks above the waveform, the downbeats' taller
    const crowded = across(lane.seconds) / Math.max(1, lane.beats.length) < 4;
    for (const [times, top, alpha, wide] of [
      [crowded ? [] : lane.beats, 8, 0.75, 1],
      [lane.downbeats, 1, 1, 2],
    ]) {
      for (const t of times) {
        const x = across(t);
        pen.fillStyle = rgba(theme.fg, alpha);
        pen.fillRect(x - wide / 2, top, wide, TICKS - 1 - top);
        pen.fillStyle = rgba(theme.fg, 0.15);
        pen.fillRect(x - 0.5, TICKS, 1, WAVE);
      }
    }
  }

  function paintAxis(pen, theme, width, across) {
    const step = timeStep(lane.seconds, width - 2 * MARGIN);
    const y = TICKS + WAVE;
    pen.fillStyle = rgba(theme.fg);
    pen.font = `${width < 700 ? 12 : 14}px system-ui, sans-serif`;
    pen.textBaseline = "alphabetic";
    for (let t = 0; t <= lane.seconds + 1e-6; t += step) {
      const x = across(t);
      const text = `${t} s`;
      const half = pen.measureText(text).width / 2;
      pen.fillRect(x - 0.5, y, 1, 3);
      pen.textAlign = "left";
      pen.fillText(text, clamp(x - half, 1, width - 2 * half - 1), y + 15);
    }
  }

  function paintMoved(pen, theme, width, across) {
    const top = TICKS + WAVE + AXIS + LABEL;
    const foot = top + CURVE - 1;
    const peak = Math.max(lane.moved.top, 1e-6);
    const curve = lane.moved.values;
    const wide = across(curve.length / lane.fps) - across(0);
    pen.beginPath();
    pen.moveTo(across(0), foot);
    curve.forEach((v, t) =>
      pen.lineTo(across(0) + ((t + 0.5) / curve.length) * wide, foot - (v / peak) * (CURVE - 4)),
    );
    pen.lineTo(across(0) + wide, foot);
    pen.closePath();
    pen.fillStyle = rgba(GREEN, 0.4);
    pen.fill();
    pen.strokeStyle = rgba(GREEN);
    pen.lineWidth = 1.5;
    pen.stroke();
    pen.strokeStyle = pen.fillStyle = rgba(theme.fg);
    pen.lineWidth = 1.5;
    pen.setLineDash([4, 3]);
    for (const hit of lane.moved.hits) {
      pen.beginPath();
      pen.moveTo(across(hit), TICKS);
      pen.lineTo(across(hit), TICKS + WAVE);
      pen.moveTo(across(hit), top);
      pen.lineTo(across(hit), foot);
      pen.stroke();
    }
    pen.setLineDash([]);
    pen.textAlign = "left";
    const far = `moved by up to ${lane.moved.top.toFixed(2)} m`;
    const which = lane.moved.hits.map((t) => t.toFixed(2)).join(", ");
    const told = lane.moved.hits.length
      ? [
          `${far} when the sound at ${which} s (dashed) is silenced`,
          `${far}; dashed: the silenced hit`,
        ]
      : [far];
    pen.fillText(fitting(pen, width - 2 * MARGIN, ...told, far), MARGIN, top - 5);
  }

  function say(frame, level, now) {
    // in words what the colours show in this frame
    const parts = [];
    if (level) {
      let best = 0;
      for (let k = 1; k < level.columns; k++)
        if (level.weight(now, k) > level.weight(now, best)) best = k;
      const middle = (level.edges[best] + level.edges[best + 1]) / 2;
      parts.push(
        `most at ${middle.toFixed(2)} s: ${level.weight(now, best).toFixed(3)} ` +
          `(even: ${(1 / level.columns).toFixed(3)})`,
      );
    }
    if (lane.moved)
      parts.push(
        `moved ${lane.moved.values[Math.min(frame, lane.moved.values.length - 1)].toFixed(2)} m`,
      );
    said.textContent = parts.join(" \u00b7 ");
  }

  function draw(theme, frame) {
    if (!lane) return;
    const ratio = devicePixelRatio || 1;
    const [w, h] = [canvas.clientWidth, canvas.clientHeight];
    if (!w || !h) return;
    if (canvas.width !== Math.round(w * ratio) || canvas.height !== Math.round(h * ratio)) {
      canvas.width = Math.round(w * ratio);
      canvas.height = Math.round(h * ratio);
    }
    const pen = canvas.getContext("2d");
    const across = (t) => MARGIN + clamp(t / lane.seconds, 0, 1) * (w - 2 * MARGIN);
    const seconds = frame / lane.fps;
    const x = across(seconds);
    const level = lane.levels.find((l) => l.name === levels.value);
    const now = level
      ? Math.min(level.rows - 1, Math.floor((frame * level.rows) / lane.frames))
      : 0;
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.fillStyle = rgba(mix(theme.bg, theme.fg, 0.05));
    pen.fillRect(0, 0, w, h);
    if (level) paintAttention(pen, theme, level, now, across);
    paintBeats(pen, theme, across);
    paintWave(pen, theme, w, ratio, x);
    paintAxis(pen, theme, w, across);
    if (lane.moved) paintMoved(pen, theme, w, across);
    for (const [colour, wide] of [
      [theme.bg, 4],
      [theme.fg, 2],
    ]) {
      pen.fillStyle = rgba(colour);
      pen.fillRect(x - wide / 2, 0, wide, TICKS + WAVE);
      if (lane.moved) pen.fillRect(x - wide / 2, h - CURVE, wide, CURVE);
    }
    const shades = [rgba(PURPLE, 0), rgba(PURPLE), rgba(theme.dark ? PALE : DEEP)];
    swatch.style.background = `linear-gradient(90deg, ${shades.join(", ")})`;
    if (level) {
      const full = level.full == null ? "each frame's largest" : level.full.toFixed(2);
      words.textContent = `attention (full colour: ${full})`;
    }
    say(frame, level, now);
    const beat = lane.beats.filter((t) => t <= seconds + 1e-6).length;
    canvas.setAttribute("aria-valuenow", seconds.toFixed(2));
    canvas.setAttribute(
      "aria-valuetext",
      `${seconds.toFixed(2)} of ${lane.seconds.toFixed(2)} seconds` +
        (lane.beats.length ? `, beat ${beat} of ${lane.beats.length}` : ""),
    );
    canvas.dataset.row = String(now);
  }

  let held = false;
  const go = (e) => {
    const box = canvas.getBoundingClientRect();
    seek(clamp((e.clientX - box.left - MARGIN) / (box.width - 2 * MARGIN), 0, 1) * lane.seconds);
  };
  listen(canvas, "pointerdown", (e) => {
    held = true;
    canvas.setPointerCapture(e.pointerId);
    canvas.focus({ preventScroll: true });
    go(e);
  });
  listen(canvas, "pointermove", (e) => {
    if (held) go(e);
  });
  for (const name of ["pointerup", "pointercancel"])
    listen(canvas, name, () => {
      held = false;
    });
  listen(levels, "change", redraw);
  return { node, canvas, load, draw };
}
