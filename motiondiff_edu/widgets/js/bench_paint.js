// What the repair bench draws besides bodies: outlines, thin limbs, marks of joints, the map of
// frames and joints.
import { clamp, mix, rgba, GREEN } from "./dom.js";
import { RING, hull } from "./paint.js";

export const PURPLE = [204, 121, 167]; // Okabe-Ito
export const GUTTER = 66; // the map's names take so many pixels on its left
const HEAD = 20;
const ROW = 5;
const ROWS = 21;
export const MAP_HEIGHT = HEAD + ROWS * ROW + 4;
const GROUPS = [
  ["left leg", 1],
  ["right leg", 5],
  ["back", 9],
  ["left arm", 13],
  ["right arm", 17],
];

export function ready(canvas) {
  // a canvas as large as it is shown, to be drawn on in the page's pixels
  const ratio = devicePixelRatio || 1;
  const [w, h] = [canvas.clientWidth, canvas.clientHeight];
  const ctx = canvas.getContext("2d");
  if (canvas.width !== Math.round(w * ratio) || canvas.height !== Math.round(h * ratio)) {
    canvas.width = Math.round(w * ratio);
    canvas.height = Math.round(h * ratio);
  }
  ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
  return [ctx, w, h];
}

export function without(parts, away) {
  // the body without its missing joints; a trunk that lost a shoulder stays
  const kept = parts.map((part) => ({
    ...part,
    circles: part.circles.filter(([a, b]) => !away[a] && !away[b]),
  }));
  return kept.filter(
    (part, i) => part.circles.length === parts[i].circles.length || part.circles.length > 2,
  );
}

export function paintOutline(ctx, look, part, pose, colour) {
  // of one part, dashed
  const centre = ([a, b, w]) => [0, 1, 2].map((k) => pose[a][k] + w * (pose[b][k] - pose[a][k]));
  const points = hull(
    part.circles.flatMap((c) => {
      const p = look(centre(c));
      const r = c[3] * p.scale;
      return RING.map(([x, y]) => [p.x + r * x, p.y + r * y]);
    }),
  );
  ctx.beginPath();
  points.forEach(([x, y], i) => (i ? ctx.lineTo(x, y) : ctx.moveTo(x, y)));
  ctx.closePath();
  ctx.setLineDash([4, 4]);
  ctx.lineWidth = 1.4;
  ctx.strokeStyle = colour;
  ctx.stroke();
  ctx.setLineDash([]);
}

export function paintGhost(ctx, look, parents, pose, away, theme) {
  // thin lines for the bones with a missing end
  ctx.lineWidth = 2;
  ctx.strokeStyle = rgba(mix(GREEN, theme.fg, 0.25), 0.55);
  ctx.beginPath();
  parents.forEach((p, j) => {
    if (p < 0 || !(away[p] || away[j])) return;
    const [a, b] = [look(pose[p]), look(pose[j])];
    ctx.moveTo(a.x, a.y);
    ctx.lineTo(b.x, b.y);
  });
  ctx.stroke();
}

export function paintMark(ctx, theme, p, away, chosen) {
  // a dot for a joint; with a cross where it is missing
  ctx.lineWidth = chosen ? 3 : 2;
  ctx.strokeStyle = rgba(theme.fg);
  ctx.fillStyle = rgba(away ? PURPLE : theme.bg, 0.9);
  ctx.beginPath();
  ctx.arc(p.x, p.y, chosen ? 8 : away ? 6 : 4, 0, 7);
  ctx.fill();
  ctx.stroke();
  if (!away) return;
  ctx.beginPath();
  for (const s of [-1, 1]) {
    ctx.moveTo(p.x - 3, p.y - 3 * s);
    ctx.lineTo(p.x + 3, p.y + 3 * s);
  }
  ctx.stroke();
}

export function paintMap(canvas, theme, { first, last, frame, frames, J }, lost, colour) {
  // columns are frames, rows joints
  const [ctx, w, h] = ready(canvas);
  const wide = (w - GUTTER) / frames;
  ctx.fillStyle = rgba(mix(theme.bg, theme.fg, 0.05));
  ctx.fillRect(0, 0, w, h);
  ctx.font = "12px system-ui, sans-serif";
  ctx.textBaseline = "middle";
  ctx.textAlign = "right";
  ctx.fillStyle = rgba(theme.fg);
  for (const [name, j] of GROUPS) ctx.fillText(name, GUTTER - 6, HEAD + (j + 2) * ROW);
  for (let t = 0; t < frames; t++) {
    for (let j = 0; j < J; j++) {
      ctx.fillStyle = lost(t, j)
        ? rgba(colour)
        : rgba(theme.line, t >= first && t < last ? 0.75 : 0.22);
      ctx.fillRect(GUTTER + t * wide + 0.5, HEAD + j * ROW, Math.max(wide - 1, 1), ROW - 1);
    }
  }
  ctx.strokeStyle = ctx.fillStyle = rgba(theme.fg);
  ctx.lineWidth = 2;
  ctx.textAlign = "center";
  ctx.strokeRect(GUTTER + first * wide, HEAD - 2, (last - first) * wide, J * ROW + 3);
  ctx.fillText("the window", clamp(GUTTER + ((first + last) / 2) * wide, GUTTER + 40, w - 40), 9);
  const x = GUTTER + (frame + 0.5) * wide;
  ctx.lineWidth = 3;
  ctx.globalAlpha = 0.5;
  ctx.beginPath();
  ctx.moveTo(x, HEAD - 4);
  ctx.lineTo(x, h);
  ctx.stroke();
  ctx.globalAlpha = 1;
}
