// What every part needs: style sheet, colours, elements.

export const CSS = `
.mde-player { --bg: var(--jp-layout-color0, #ffffff); --fg: var(--jp-ui-font-color1, #1f2933);
  --line: var(--jp-border-color2, #c9d1da); --focus: var(--jp-brand-color1, #1976d2);
  display: flex; flex-direction: column; gap: 6px; background: var(--bg); color: var(--fg);
    box-sizing: border-box;
  font: 15px/1.3 var(--jp-ui-font-family, system-ui, sans-serif); padding: 6px; width: 100%;
    max-width: 1200px; }
.mde-player.mde-fill { height: 100%; max-width: none; }
.mde-player.mde-fill canvas:not(.mde-lane) { flex: 1; min-height: 40vh; }
.mde-player canvas { width: 100%; display: block; border-radius: 8px; cursor: grab; touch-action:
  pan-y; outline: none; }
.mde-player canvas:active { cursor: grabbing; }
.mde-player canvas:focus-visible, .mde-player :is(button, input, select, summary):focus-visible {
  outline: 3px solid var(--focus); outline-offset: 1px; }
.mde-row { display: flex; flex-wrap: wrap; align-items: center; gap: 6px 12px; }
.mde-row > input[type=range] { flex: 1 1 140px; min-width: 100px; accent-color: var(--focus);
  margin: 0; }
.mde-row button, .mde-row select { font: inherit; color: inherit; background: transparent; border:
  1px solid var(--line);
  border-radius: 6px; padding: 3px 10px; min-height: 30px; cursor: pointer; }
.mde-row select option { color: #1f2933; background: #fff; }
.mde-row button.mde-play { min-width: 84px; font-weight: 600; }
.mde-row output { font-variant-numeric: tabular-nums; min-width: 7.5em; }
.mde-key { display: inline-flex; align-items: center; gap: 5px; } .mde-key i { width: 14px;
  height: 14px; border-radius: 7px; }
@media (forced-colors: active) { .mde-key i { forced-color-adjust: none; } }
.mde-player canvas.mde-lane { border-radius: 6px; cursor: pointer; touch-action: pan-y; }
.mde-key i.mde-ramp { width: 36px; border: 1px solid var(--line); }
.mde-row output.mde-said { min-width: 0; }
.mde-notes { font-size: 13px; border-left: 3px solid var(--line); padding-left: 9px;
  overflow-wrap: anywhere; }
.mde-notes p { margin: 0 0 3px; }
.mde-notes summary { cursor: pointer; width: fit-content; padding: 4px 4px 4px 0; }`;

export const COLOUR = { L: [0, 114, 178], R: [213, 94, 0], C: [91, 100, 114] };
export const GREEN = [0, 158, 115];
export const LIGHT_ON_DARK = { L: [58, 160, 220], R: [240, 128, 40], C: [168, 178, 192] };
export const clamp = (v, lo, hi) => Math.min(hi, Math.max(lo, v));
export const mix = (a, b, w) => a.map((v, i) => v + w * (b[i] - v));
export const rgba = (c, alpha = 1) => `rgba(${c.map(Math.round)},${alpha})`;
export const parse = (text) => (text.match(/[\d.]+/g) || [255, 255, 255]).slice(0, 3).map(Number);

export function element(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name in node && typeof value !== "string") node[name] = value;
    else node.setAttribute(name, value);
  }
  node.append(...children);
  return node;
}

// Adds listeners until `stop` aborts. Of pointers it hears the mouse, the pen or the first finger,
// and of presses those of the first button: a right click belongs to the browser's menu.
export function listener(stop) {
  const meant = (e) =>
    !e.type.startsWith("pointer") || (e.isPrimary && !(e.type === "pointerdown" && e.button));
  return (node, name, f, options = {}) =>
    node.addEventListener(name, (e) => meant(e) && f(e), { signal: stop.signal, ...options });
}

// Draws again when the canvas gets another size, JupyterLab another theme, or the window another
// screen (its pixels may be finer).
export function redrawn(stop, canvas, draw) {
  const sizes = new ResizeObserver(draw);
  const themes = new MutationObserver(draw);
  sizes.observe(canvas);
  themes.observe(document.body, { attributes: true });
  const until = { once: true, signal: stop.signal };
  const watch = () =>
    matchMedia(`(resolution: ${devicePixelRatio}dppx)`).addEventListener("change", finer, until);
  const finer = () => {
    draw();
    watch();
  };
  watch();
  stop.signal.addEventListener("abort", () => [sizes, themes].forEach((o) => o.disconnect()));
}

// Tells whether the canvas is in sight. A busy page gathers several readings before it tells them:
// the last one holds.
export function sighted(stop, canvas, tell) {
  const sights = new IntersectionObserver((readings) => tell(readings.at(-1).isIntersecting));
  sights.observe(canvas);
  stop.signal.addEventListener("abort", () => sights.disconnect());
}

export function readTheme(root) {
  const style = getComputedStyle(root);
  const bg = parse(style.backgroundColor);
  const fg = parse(style.color);
  const dark = bg[0] + bg[1] + bg[2] < 380;
  return {
    bg,
    fg,
    dark,
    body: dark ? LIGHT_ON_DARK : COLOUR,
    line: mix(bg, fg, 0.42),
    shadow: dark ? "rgba(0,0,0,.5)" : "rgba(30,40,55,.17)",
  };
}
