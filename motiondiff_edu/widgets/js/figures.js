// The motion as the page holds it: bytes -> per figure { frames, root(t), pose(t), planted(t),
// prints }.
import { clamp } from "./dom.js";

export function bytes(view) {
  return view.buffer.slice(view.byteOffset, view.byteOffset + view.byteLength);
}

export function unpack(model) {
  const scene = model.get("scene");
  const J = scene.joints;
  const joints = new Int16Array(bytes(model.get("joints")));
  const roots = new Float32Array(bytes(model.get("roots")));
  const codes = new Uint8Array(bytes(model.get("contacts")));
  let start = 0;
  return scene.figures.map((info) => {
    const first = start;
    start += info.frames;
    const at = (t) => first + clamp(t, 0, info.frames - 1);
    const root = (t) => [0, 1, 2].map((k) => roots[3 * at(t) + k]);
    const pose = (t) => {
      const r = root(t);
      const base = 3 * J * at(t);
      return Array.from({ length: J }, (_, j) =>
        [0, 1, 2].map((k) => r[k] + joints[base + 3 * j + k] / 2048),
      );
    };
    const figure = { ...info, root, pose, planted: (t) => (info.contacts ? codes[at(t)] : 0) };
    figure.prints = info.contacts ? footprints(figure) : [];
    return figure;
  });
}

// The middle of a figure's path on the floor, and its extent in metres. A loop: a call takes no
// more than some 100,000 arguments, and a recording of 20 minutes has more frames.
export function ground({ root, frames }) {
  const least = [Infinity, Infinity];
  const most = [-Infinity, -Infinity];
  for (let t = 0; t < frames; t++) {
    const [x, , z] = root(t);
    [x, z].forEach((at, k) => {
      least[k] = Math.min(least[k], at);
      most[k] = Math.max(most[k], at);
    });
  }
  return {
    middle: [0, 1].map((k) => (least[k] + most[k]) / 2),
    extent: Math.hypot(...[0, 1].map((k) => most[k] - least[k])),
  };
}

export function footprints(figure) {
  // one print for each run of contact: where ankle and toe are in its middle
  const prints = [];
  [
    [1, 3, 4, "L"],
    [2, 7, 8, "R"],
  ].forEach(([bit, ankle, toe, side]) => {
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
