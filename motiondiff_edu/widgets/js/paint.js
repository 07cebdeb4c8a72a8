// Geometry and painting: one panel of the canvas, with floor, trail, marks and bodies.
import { GREEN, clamp, mix, rgba } from "./dom.js";

export const RING = Array.from({ length: 20 }, (_, i) => [
  Math.cos((i * Math.PI) / 10),
  Math.sin((i * Math.PI) / 10),
]);

// ---- geometry
export function hull(points) {
  // Andrew's monotone chain
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

export function camera(view, target, distance, width, height) {
  const [cy, sy, cp, sp] = [
    Math.cos(view.yaw),
    Math.sin(view.yaw),
    Math.cos(view.pitch),
    Math.sin(view.pitch),
  ];
  const ahead = [cp * cy, -sp, -cp * sy];
  const right = [sy, 0, cy];
  const up = [
    right[1] * ahead[2] - right[2] * ahead[1],
    right[2] * ahead[0] - right[0] * ahead[2],
    right[0] * ahead[1] - right[1] * ahead[0],
  ];
  const eye = target.map((v, k) => v - distance * ahead[k]);
  const focal = Math.min(2.05 * height, 2.9 * width);
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const look = (p) => {
    const away = [p[0] - eye[0], p[1] - eye[1], p[2] - eye[2]];
    const depth = dot(away, ahead);
    const scale = focal / Math.max(depth, 0.1);
    return {
      x: width / 2 + scale * dot(away, right),
      y: height / 2 - scale * dot(away, up),
      scale,
      seen: depth > 0.3,
    };
  };
  return Object.assign(look, { right, up, ahead });
}

export function smoothRoot(figure, t, fps) {
  // the root on the floor, averaged over a second: the camera does not bob (as in poster.py)
  const half = Math.floor(fps / 2);
  const count = 2 * half + 1;
  let x = 0;
  let z = 0;
  for (let i = -half; i <= half; i++) {
    const r = figure.root(t + i);
    x += r[0] / count;
    z += r[2] / count;
  }
  return [x, z];
}

// ---- painting
export function fillPolygon(ctx, points, fill, edge) {
  ctx.beginPath();
  points.forEach(([x, y], i) => (i ? ctx.lineTo(x, y) : ctx.moveTo(x, y)));
  ctx.closePath();
  if (edge) {
    ctx.strokeStyle = edge;
    ctx.lineWidth = 2;
    ctx.lineJoin = "round";
    ctx.stroke();
  }
  ctx.fillStyle = fill;
  ctx.fill();
}

export function paintFloor(ctx, look, target, theme, reach) {
  const [cx, cz] = [Math.round(target[0]), Math.round(target[1])];
  const step = reach > 12 ? 2 : 1;
  const n = Math.ceil(reach / step);
  const paths = new Map(); // of equal strength, so that a few strokes draw some hundred segments
  const segment = (a, b) => {
    const d = Math.hypot((a[0] + b[0]) / 2 - target[0], (a[2] + b[2]) / 2 - target[1]) / reach;
    const alpha = Math.round(25 * (1 - d * d));
    const p = look(a);
    const q = look(b);
    if (alpha <= 0 || !p.seen || !q.seen) return;
    if (!paths.has(alpha)) paths.set(alpha, new Path2D());
    paths.get(alpha).moveTo(p.x, p.y);
    paths.get(alpha).lineTo(q.x, q.y);
  };
  for (let i = -n; i <= n; i++) {
    for (let k = -n; k < n; k++) {
      const [u, v, w] = [i * step, k * step, (k + 1) * step];
      segment([cx + u, 0, cz + v], [cx + u, 0, cz + w]);
      segment([cx + v, 0, cz + u], [cx + w, 0, cz + u]);
    }
  }
  ctx.lineWidth = 1;
  for (const [alpha, path] of paths) {
    ctx.strokeStyle = rgba(theme.line, alpha / 50);
    ctx.stroke(path);
  }
}

export function paintLine(ctx, look, points, colour, width, dash = []) {
  ctx.setLineDash(dash);
  ctx.strokeStyle = colour;
  ctx.lineWidth = width;
  ctx.lineCap = ctx.lineJoin = "round";
  ctx.beginPath();
  let open = false;
  for (const [x, z] of points) {
    const p = look([x, 0.002, z]);
    if (p.seen) {
      if (open) ctx.lineTo(p.x, p.y);
      else ctx.moveTo(p.x, p.y);
    }
    open = p.seen;
  }
  ctx.stroke();
  ctx.setLineDash([]);
}

export function floorDisc(look, x, z, radius) {
  return RING.map(([c, s]) => look([x + radius * c, 0.003, z + radius * s])).map((p) => [p.x, p.y]);
}

export function paintGround(ctx, look, figure, t, theme, off) {
  // path, trail, footprints, contact marks
  const shift = ([x, z]) => [x + off[0], z + off[1]];
  if (figure.path) paintLine(ctx, look, figure.path.map(shift), rgba(GREEN, 0.85), 3, [9, 7]);
  const trail = (from, to) =>
    Array.from({ length: to - from + 1 }, (_, i) => {
      const r = figure.root(from + i);
      return shift([r[0], r[2]]);
    });
  const past = figure.past || 0;
  const now = Math.min(t, figure.frames - 1);
  paintLine(ctx, look, trail(0, Math.min(past, now)), rgba(theme.line, 0.9), 5);
  if (now > past) paintLine(ctx, look, trail(past, now), rgba(theme.fg, 0.45), 2.5);
  for (const print of figure.prints) {
    if (print.begin > t) continue;
    const discs = [
      [print.a, 0.035],
      [print.b, 0.05],
    ].flatMap(([p, r]) => floorDisc(look, p[0] + off[0], p[2] + off[1], r));
    fillPolygon(
      ctx,
      hull(discs),
      rgba(theme.body[print.side], Math.max(0.12, 0.5 - (t - print.begin) * 0.006)),
    );
  }
  const pose = figure.pose(t);
  [
    [1, 3, 4, "L"],
    [2, 7, 8, "R"],
  ].forEach(([bit, ankle, toe, side]) => {
    if (!(figure.planted(t) & bit)) return;
    const ring = floorDisc(
      look,
      (pose[ankle][0] + pose[toe][0]) / 2 + off[0],
      (pose[ankle][2] + pose[toe][2]) / 2 + off[1],
      0.17,
    );
    fillPolygon(ctx, ring, rgba(theme.body[side], 0.22), rgba(theme.body[side], 0.9));
  });
}

// `wash`: how pale, 0 to 1, or a function that says it of each part
export function paintBody(ctx, look, parts, pose, theme, wash, target, off) {
  const moved = pose.map(([x, y, z]) => [x + off[0], y, z + off[1]]);
  const centre = ([a, b, w]) => [0, 1, 2].map((k) => moved[a][k] + w * (moved[b][k] - moved[a][k]));
  ctx.beginPath(); // the shadow: one path, filled once, so that overlaps do not darken
  for (const part of parts) {
    const ring = part.circles.flatMap((c) => {
      const p = centre(c);
      const x = p[0] + 0.25 * p[1];
      const z = p[2] - 0.15 * p[1];
      return floorDisc(look, x, z, 0.9 * c[3]);
    });
    hull(ring).forEach(([x, y], i) => (i ? ctx.lineTo(x, y) : ctx.moveTo(x, y)));
    ctx.closePath();
  }
  ctx.fillStyle = theme.shadow;
  ctx.fill();
  const middle = look([target[0], 0.86, target[1]]).scale;
  const drawn = parts
    .map((part) => {
      const dots = part.circles.map((c) => {
        const p = look(centre(c));
        return [p.x, p.y, c[3] * p.scale, p.scale];
      });
      const scale = dots.reduce((sum, d) => sum + d[3], 0) / dots.length;
      const around = (size, dx, dy) =>
        hull(
          dots.flatMap(([x, y, r]) =>
            RING.map(([c, s]) => [x - dx * r + size * r * c, y - dy * r + size * r * s]),
          ),
        );
      return { part, scale, outline: around(1, 0, 0), shine: around(0.45, 0.15, 0.3) };
    })
    .sort((p, q) => p.scale - q.scale);
  for (const { part, scale, outline, shine } of drawn) {
    const behind = clamp(4 * (1 - scale / middle), 0, 0.45);
    const pale = typeof wash === "function" ? wash(part) : wash;
    const colour = mix(theme.body[part.side], theme.bg, pale + behind * (1 - pale));
    fillPolygon(ctx, outline, rgba(colour), rgba(theme.bg, 0.9));
    fillPolygon(ctx, shine, rgba(mix(colour, [255, 255, 255], theme.dark ? 0.16 : 0.22)));
  }
}

export function paintText(ctx, theme, text, x, y, align, size, weight = 600) {
  ctx.font = `${weight} ${size}px system-ui, sans-serif`;
  ctx.textAlign = align;
  ctx.textBaseline = "alphabetic";
  ctx.lineWidth = 4;
  ctx.lineJoin = "round";
  ctx.strokeStyle = rgba(theme.bg, 0.85);
  ctx.strokeText(text, x, y);
  ctx.fillStyle = rgba(theme.fg);
  ctx.fillText(text, x, y);
}

// The text in lines that fit into `room` pixels; a single long word may stand out.
function wrapped(ctx, text, size, room) {
  ctx.font = `600 ${size}px system-ui, sans-serif`;
  const lines = [];
  for (const word of text.split(" ")) {
    const longer = lines.length ? `${lines.at(-1)} ${word}` : word;
    if (lines.length && ctx.measureText(longer).width <= room) lines[lines.length - 1] = longer;
    else lines.push(word);
  }
  return lines;
}

export const tense = (figure, t) =>
  figure.past == null ? "" : t < figure.past ? "past (given)" : "future (generated)";

export function paintPanel(ctx, scene, figures, frame, view, theme, width, height) {
  const offsets = figures.map((_, i) =>
    [0, 1].map((k) => (i - (figures.length - 1) / 2) * scene.offset[k]),
  );
  const spots = figures.map((f, i) =>
    (view.follow ? smoothRoot(f, frame, scene.fps) : f.middle).map((v, k) => v + offsets[i][k]),
  );
  const target = [0, 1].map((k) => spots.reduce((s, p) => s + p[k], 0) / spots.length);
  const spread = Math.max(
    0,
    ...spots.map((p) => 2 * Math.hypot(p[0] - target[0], p[1] - target[1])),
  );
  const extent = spread + (view.follow ? 0 : Math.max(...figures.map((f) => f.extent)));
  const distance = (5 + 1.15 * extent) / view.zoom;
  const look = camera(view, [target[0], 0.86, target[1]], distance, width, height);
  paintFloor(ctx, look, target, theme, 6 + extent);
  figures.forEach((f, i) => paintGround(ctx, look, f, frame, theme, offsets[i]));
  const order = figures
    .map((_, i) => i)
    .sort(
      (a, b) =>
        look([spots[a][0], 0, spots[a][1]]).scale - look([spots[b][0], 0, spots[b][1]]).scale,
    );
  for (const i of order) {
    const f = figures[i];
    const pose = f.pose(frame);
    const wash = f.past != null && frame < f.past ? 0.55 : 0;
    paintBody(ctx, look, scene.parts, pose, theme, wash, spots[i], offsets[i]);
    if (figures.length > 1 && f.label) {
      const top = Math.max(...pose.map((p) => p[1]));
      const head = look([pose[0][0] + offsets[i][0], top + 0.28, pose[0][2] + offsets[i][1]]);
      paintText(ctx, theme, f.label, head.x, head.y, "center", 15);
    }
  }
  const f = figures[0];
  const small = width < 330;
  const size = small ? 14 : 17;
  const titles = [
    figures.length === 1 ? f.label : "",
    small ? tense(f, frame).split(" ")[0] : tense(f, frame),
  ].filter(Boolean);
  const lines = (small ? titles : [titles.join(" \u00b7 ")]).flatMap((title) =>
    wrapped(ctx, title, size, width - 24),
  );
  lines.forEach((line, i) => paintText(ctx, theme, line, 12, 24 + 19 * i, "left", size));
  if (frame >= f.frames && figures.length === 1)
    paintText(
      ctx,
      theme,
      `ended after ${(f.frames / scene.fps).toFixed(1)} s`,
      12,
      Math.max(64, 26 + 19 * lines.length),
      "left",
      14,
      400,
    );
  paintText(
    ctx,
    theme,
    `floor squares: ${6 + extent > 12 ? 2 : 1} m`,
    width - 10,
    height - 10,
    "right",
    13,
    400,
  );
}
