"""Reading BVH motion capture: `read_bvh(path)` returns every frame of the file, as written.

Rules for cases that the format leaves open (each has its test):
    Position channels replace a joint's OFFSET, before or after the rotations; but where those of a
    joint below the root are 0 in every frame and its OFFSET is not, the OFFSET stays.
    The rotation order is the order of the channels: Zrotation Xrotation Yrotation is Rz Rx Ry.
    End sites can be missing.
    A joint with CHANNELS 0 keeps its offset.
    Two figures in one file raise an error.
    The file states no unit and no upward axis; they stay unknown here (`retarget` finds them).
"""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float, Int

from ...kinematics import euler_to_matrix, forward_kinematics
from .frames import frame_rows, frame_time, header, rate
from .hierarchy import read_nodes
from .tokens import read_lines, statements


@dataclass(frozen=True)
class Bvh:
    """A BVH file: nodes are its joints and end sites (called `<joint>_End`) in file order.

    Lengths are in the file's own units, rotation channels in degrees, `frame_time` in seconds.
    `channels[n]` names the columns of node n; the columns of `frames` are those of all nodes in
    turn.
    """

    names: tuple[str, ...]
    parents: Int[np.ndarray, " N"]
    offsets: Float[np.ndarray, "N 3"]
    channels: tuple[tuple[str, ...], ...]
    frames: Float[np.ndarray, "T K"]
    frame_time: float
    is_end: Bool[np.ndarray, " N"]
    source: str = ""

    @property
    def fps(self) -> float:
        """Frames per second, with the rounding of the frame time undone (.03333 is 30)."""
        return rate(self.frame_time)

    @property
    def joints(self) -> tuple[str, ...]:
        """The names of the joints, without end sites."""
        return tuple(name for name, end in zip(self.names, self.is_end, strict=True) if not end)

    @cached_property
    def orders(self) -> tuple[str, ...]:
        """The rotation order of each node, such as "ZXY"; empty for a node without rotations."""
        return tuple(
            "".join(name[0] for name in names if name.endswith("rotation"))
            for names in self.channels
        )

    @cached_property
    def first_column(self) -> Int[np.ndarray, " N"]:
        """The column of `frames` where each node's channels begin."""
        return np.cumsum([0] + [len(names) for names in self.channels[:-1]])

    def columns(self, node: int, kind: str) -> list[tuple[str, int]]:
        """(axis, column) of a node's "position" or "rotation" channels, in file order."""
        start = int(self.first_column[node])
        return [
            (name[0], start + i)
            for i, name in enumerate(self.channels[node])
            if name.endswith(kind)
        ]

    def local_rotations(self) -> Float[np.ndarray, "T N 3 3"]:
        """The rotation of each node relative to its parent, R = R_first R_second R_third."""
        turns = np.broadcast_to(np.eye(3), (len(self.frames), len(self.names), 3, 3)).copy()
        for order in set(self.orders) - {""}:
            nodes = [n for n, own in enumerate(self.orders) if own == order]
            columns = np.array(
                [[column for _, column in self.columns(n, "rotation")] for n in nodes]
            )
            turns[:, nodes] = euler_to_matrix(np.radians(self.frames[:, columns]), order)
        return turns

    def local_positions(self) -> Float[np.ndarray, "T N 3"]:
        """The position of each node in its parent's frame: its position channels, or its offset."""
        places = np.broadcast_to(self.offsets, (len(self.frames), *self.offsets.shape)).copy()
        for node, parent in enumerate(self.parents):
            columns = self.columns(node, "position")
            moved = self.frames[:, [column for _, column in columns]]
            if parent >= 0 and not moved.any():
                continue  # an exporter's placeholder: the joint would lie on its parent
            for axis, column in columns:
                places[:, node, "XYZ".index(axis)] = self.frames[:, column]
        return places

    def world_positions(self) -> Float[np.ndarray, "T N 3"]:
        """World positions of the nodes in every frame, in the file's units."""
        places = self.local_positions()
        positions, turns = forward_kinematics(
            self.local_rotations(), places[:, 0], self.offsets, self.parents
        )
        if (places[:, 1:] != self.offsets[1:]).any():
            # joints that also move in their parent's frame
            for node, parent in list(enumerate(self.parents))[1:]:
                positions[:, node] = positions[:, parent] + np.einsum(
                    "tij,tj->ti", turns[:, parent], places[:, node]
                )
        return positions

    def rest_positions(self) -> Float[np.ndarray, "N 3"]:
        """Positions with all angles zero: the pose that the offsets draw."""
        still = np.broadcast_to(np.eye(3), (1, len(self.names), 3, 3)).copy()
        return forward_kinematics(still, self.offsets[:1], self.offsets, self.parents)[0][0]


def read_bvh(path: str | Path, file_fps: float | int | None = None) -> Bvh:
    """Read a BVH file; `file_fps` replaces its frame time, for files that state a wrong one.

    Raises BvhError (a ValueError) for anything but a complete, unambiguous BVH file; the message
    has the file, the line, the joint and what to do. Raises FileNotFoundError for a missing file.
    """
    lines = read_lines(path)
    found, motion = statements(lines, path)
    nodes = read_nodes(found, path)
    declared, declared_line, time, time_line, first = header(lines, motion, path)
    seconds = frame_time(time, time_line, path, None if file_fps is None else float(file_fps))
    columns = [(node.name, channel) for node in nodes for channel in node.channels or ()]
    frames = frame_rows(lines, first, declared, columns, path, declared_line)
    return Bvh(
        names=tuple(node.name for node in nodes),
        parents=np.array([node.parent for node in nodes]),
        offsets=np.array([node.offset for node in nodes]),
        channels=tuple(node.channels or () for node in nodes),
        frames=frames,
        frame_time=seconds,
        is_end=np.array([node.end for node in nodes]),
        source=Path(path).stem or Path(path).name,
    )
