// The editor's canvas: the figure, ghosts of the other in-betweens, the joints that can be dragged.
import { clamp, mix, rgba } from "./dom.js";
import { camera, paintBody, paintFloor, paintGround, paintText } from "./paint.js";

const REACH = { mouse: 16, pen: 18, touch: 26 }; // pixels from a joint within which it is meant

export const along = (p, direction, metres) => p.map((v, k) => v + metres * direction[k]);
export const dot = (a, b) => a.reduce((sum, v, k) => sum + v * b[k], 0);

// How far so many pixels move a joint that is at `from`, in the plane that faces the viewer:
// metres.
export function dragged(look, from, dx, dy) {
  const scale = look(from).scale;
  return along(along([0, 0, 0], look.right, dx / scale), look.up, -dy / scale);
}

export function jointAt(look, pose, x, y, kind) {
  // the joint under the pointer, the nearer one of two; null for none
  const near = pose.map((p, j) => {
    const q = look(p);
    return { j, d: Math.hypot(q.x - x, q.y - y) - 1e-3 * q.scale, seen: q.seen };
  });
  const best = near
    .filter((n) => n.seen && n.d < (REACH[kind] || REACH.mouse))
    .sort((a, b) => a.d - b.d)[0];
  return best ? best.j : null;
}

function ghost(ctx, width, height, paint) {
  // a whole figure, then made transparent: its parts do not shine through
  const ratio = ctx.getTransform().a;
  const layer = new OffscreenCanvas(Math.round(width * ratio), Math.round(height * ratio));
  const pen = layer.getContext("2d");
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  paint(pen);
  ctx.save();
  ctx.setTransform(1, 0, 0, 1, 0, 0);
  ctx.globalAlpha = 0.3;
  ctx.drawImage(layer, 0, 0);
  ctx.restore();
}

// The names of the ghosts, in a column beside their heads, each with a line to its own.
function paintNames(ctx, look, ghosts, theme, width, height) {
  const size = 13;
  const step = size + 4;
  const top = (pose) => look(pose.reduce((a, b) => (a[1] > b[1] ? a : b)));
  const heads = ghosts
    .map(({ pose, name }) => ({ name, ...top(pose) }))
    .filter((head) => head.seen);
  if (!heads.length) return;
  heads.sort((a, b) => a.y - b.y);
  ctx.font = `600 ${size}px system-ui, sans-serif`;
  const widest = Math.max(...heads.map(({ name }) => ctx.measureText(name).width));
  const away = 0.45 * heads[0].scale;
  const middle = heads.reduce((sum, { y }) => sum + y / heads.length, 0);
  const right = Math.max(...heads.map(({ x }) => x)) + away;
  const left = Math.min(...heads.map(({ x }) => x)) - away;
  const side = right + widest < width - 4 ? 1 : -1;
  const x = side > 0 ? Math.max(right, 4) : Math.max(left, widest + 4);
  const tall = step * (heads.length - 1);
  const low = height - 30 - tall;
  const first = clamp(middle - tall / 2, 62, Math.max(low, 62)); // below the title
  ctx.strokeStyle = rgba(theme.fg, 0.5);
  ctx.lineWidth = 1;
  heads.forEach((head, i) => {
    ctx.beginPath();
    ctx.moveTo(head.x, head.y);
    ctx.lineTo(x - 4 * side, first + i * step - 4);
    ctx.stroke();
  });
  heads.forEach(({ name }, i) =>
    paintText(ctx, theme, name, x, first + i * step, side > 0 ? "left" : "right", size),
  );
}

function paintHandles(ctx, look, pose, theme, s, width) {
  const order = pose.map((p, j) => [look(p), j]).sort((a, b) => a[0].scale - b[0].scale);
  for (const [q, j] of order) {
    if (!q.seen) continue;
    const on = j === s.joint;
    const near = j === s.hover;
    const size = on ? 8 : near ? 7 : 4.5;
    ctx.beginPath();
    ctx.arc(q.x, q.y, size, 0, 2 * Math.PI);
    ctx.fillStyle = on ? rgba(s.focus) : rgba(theme.bg, 0.92);
    ctx.fill();
    ctx.strokeStyle = on ? rgba(theme.bg) : rgba(theme.fg);
    ctx.lineWidth = on ? 2.5 : 1.5;
    ctx.stroke();
    if (on) {
      ctx.beginPath();
      ctx.arc(q.x, q.y, size + 3, 0, 2 * Math.PI);
      ctx.strokeStyle = rgba(theme.fg);
      ctx.lineWidth = 1.5;
      ctx.stroke();
    }
  }
  const named = s.hover ?? s.joint;
  if (named != null) {
    const q = look(pose[named]);
    const side = q.x > 0.7 * width ? -1 : 1;
    paintText(
      ctx,
      theme,
      s.names[named],
      q.x + 16 * side,
      q.y + 22,
      side < 0 ? "right" : "left",
      14,
    );
  }
  if (s.target && s.joint != null) {
    // where the pointer wants the joint
    const [a, b] = [look(pose[s.joint]), look(s.target)];
    ctx.setLineDash([5, 4]);
    ctx.strokeStyle = rgba(s.focus);
    ctx.lineWidth = 2;
    ctx.beginPath();
    ctx.moveTo(a.x, a.y);
    ctx.lineTo(b.x, b.y);
    ctx.stroke();
    ctx.setLineDash([]);
    ctx.beginPath();
    ctx.moveTo(b.x - 6, b.y);
    ctx.lineTo(b.x + 6, b.y);
    ctx.moveTo(b.x, b.y - 6);
    ctx.lineTo(b.x, b.y + 6);
    ctx.stroke();
  }
}

// `s`: parts, figure (solid), ghosts ({ pose, name }), frame, pinned, wash(part), spot, extent,
// joint, hover, target, names, title, hint, marks (floor points of the pinned frames), focus.
// Returns the camera, for picking and dragging.
export function paintStage(ctx, s, view, theme, width, height) {
  const sky = ctx.createLinearGradient(0, 0, 0, height);
  sky.addColorStop(0, rgba(mix(theme.bg, theme.fg, 0.03)));
  sky.addColorStop(1, rgba(mix(theme.bg, theme.fg, 0.09)));
  ctx.fillStyle = sky;
  ctx.fillRect(0, 0, width, height);
  const look = camera(
    view,
    [s.spot[0], 0.86, s.spot[1]],
    (5 + 1.15 * s.extent) / view.zoom,
    width,
    height,
  );
  paintFloor(ctx, look, s.spot, theme, 6 + s.extent);
  paintGround(ctx, look, s.figure, s.frame, theme, [0, 0]);
  for (const [x, , z] of s.marks) {
    const q = look([x, 0.003, z]);
    if (!q.seen) continue;
    const size = clamp(0.07 * q.scale, 3, 9);
    ctx.beginPath();
    ctx.moveTo(q.x - size, q.y);
    ctx.lineTo(q.x, q.y - size / 2);
    ctx.lineTo(q.x + size, q.y);
    ctx.lineTo(q.x, q.y + size / 2);
    ctx.closePath();
    ctx.fillStyle = rgba(theme.fg, 0.75);
    ctx.fill();
  }
  for (const { pose } of s.ghosts)
    ghost(ctx, width, height, (pen) =>
      paintBody(pen, look, s.parts, pose, theme, 0.15, s.spot, [0, 0]),
    );
  const pose = s.figure.pose(s.frame);
  paintBody(ctx, look, s.parts, pose, theme, s.wash, s.spot, [0, 0]);
  paintNames(ctx, look, s.ghosts, theme, width, height);
  if (s.pinned) paintHandles(ctx, look, pose, theme, s, width);
  const small = width < 520;
  const lines = small ? s.title.split(" \u00b7 ") : [s.title];
  lines.forEach((line, i) => paintText(ctx, theme, line, 12, 24 + 19 * i, "left", small ? 14 : 17));
  paintText(
    ctx,
    theme,
    small ? s.hint.replaceAll("Page Up, Page Down", "PgUp, PgDn") : s.hint,
    12,
    height - 12,
    "left",
    13,
    400,
  );
  return look;
}
