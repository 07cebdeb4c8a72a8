"""BVH files for the tests: a small one to vary, and random skeletons written out."""

import numpy as np

SMALL = """HIERARCHY
ROOT Hips
{
  OFFSET 1 90 2
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Left Leg
  {
    OFFSET 3 -40 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 -45 5
    }
  }
  JOINT Chest
  {
    OFFSET 0 30 -1
    CHANNELS 2 Yrotation Xrotation
  }
}
MOTION
Frames: 3
Frame Time: 0.04
1 90 2 0 0 0 0 0 0 0 0
2 91 3 10 20 30 -5 15 1e1 7 -8
3 92 4 90 0 0 0 45 0 0 0.5
"""


def random_bvh(rng: np.random.Generator, frames: int = 4) -> str:
    """A skeleton of random shape, channel orders, positions anywhere, end sites here and there."""
    parents = [-1] + [int(rng.integers(0, n)) for n in range(1, int(rng.integers(2, 12)))]
    columns, lines = [0], ["HIERARCHY"]

    def write(node: int, depth: int) -> None:
        pad = "\t" * depth
        names = list(rng.permutation([a + "rotation" for a in "XYZ"])[: rng.integers(0, 4)])
        if node == 0 or rng.random() < 0.3:
            positions = [a + "position" for a in "XYZ"]
            names = positions + names if rng.random() < 0.5 else names + positions
        columns[0] += len(names)
        lines.extend([f"{pad}{'JOINT' if depth else 'ROOT'} joint{node}", f"{pad}{{"])
        lines.append(f"{pad}\tOFFSET " + " ".join(repr(float(v)) for v in rng.normal(size=3)))
        lines.append(f"{pad}\tCHANNELS {len(names)} " + " ".join(names))
        children = [n for n, parent in enumerate(parents) if parent == node]
        for child in children:
            write(child, depth + 1)
        if not children and rng.random() < 0.7:
            lines.extend(
                [f"{pad}\tEnd Site", f"{pad}\t{{", f"{pad}\t\tOFFSET 0.5 1 2", f"{pad}\t}}"]
            )
        lines.append(f"{pad}}}")

    write(0, 0)
    rows = rng.normal(scale=60, size=(frames, columns[0]))
    body = [" ".join(repr(float(v)) for v in row) for row in rows]
    return "\n".join(lines + ["MOTION", f"Frames: {frames}", "Frame Time: 0.0083333", *body]) + "\n"


def dump(names, parents, offsets, channels, rows, frame_time: float, is_end) -> str:
    """Any hierarchy as BVH text; the columns of `rows` are the nodes' channels in order."""
    lines = ["HIERARCHY"]

    def write(node: int) -> None:
        lines.extend(
            ["End Site" if is_end[node] else f"{'JOINT' if node else 'ROOT'} {names[node]}", "{"]
        )
        lines.append("OFFSET " + " ".join(f"{v:.9f}" for v in offsets[node]))
        if not is_end[node]:
            lines.append(" ".join([f"CHANNELS {len(channels[node])}", *channels[node]]))
        for child in (n for n, parent in enumerate(parents) if parent == node):
            write(child)
        lines.append("}")

    write(0)
    body = [" ".join(f"{v:.9f}" for v in row) for row in rows]
    return (
        "\n".join(lines + ["MOTION", f"Frames: {len(rows)}", f"Frame Time: {frame_time}", *body])
        + "\n"
    )
