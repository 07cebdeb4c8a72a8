"""The HIERARCHY section of a BVH file as a list of nodes."""

from dataclasses import dataclass, field
from pathlib import Path

from .tokens import LONGEST_NAME, BvhError, Statement, to_count, to_number

CHANNELS = tuple(axis + kind for kind in ("position", "rotation") for axis in "XYZ")
SPELLED = {channel.lower(): channel for channel in CHANNELS}


@dataclass
class Node:
    """A joint or an end site while the file is read."""

    name: str
    parent: int
    line: int
    end: bool = False
    offset: tuple[float, ...] | None = None
    channels: tuple[str, ...] | None = None


@dataclass
class Reader:
    """The state of the reader: all nodes so far, and the open ones, outermost first."""

    path: str | Path
    nodes: list[Node] = field(default_factory=list)
    lines: dict[str, int] = field(default_factory=dict)  # joint name -> line
    open: list[int] = field(default_factory=list)
    waiting: int | None = None  # a node whose brace has not come yet

    def error(self, problem: str, line: int, node: Node | None = None) -> BvhError:
        return BvhError(problem, self.path, line, node.name if node else None)


def read_nodes(statements: list[Statement], path: str | Path) -> list[Node]:
    """The nodes in file order; parents come before their children. Raises BvhError."""
    reader = Reader(path)
    actions = {"{": open_node, "}": close_node, "offset": offset, "channels": channels}
    actions |= {"root": joint, "joint": joint, "end": end_site, "endsite": end_site}
    for statement in statements:
        if statement.word == "hierarchy" and not statement.rest and not reader.nodes:
            continue
        if statement.word not in actions:
            raise reader.error(
                f"'{statement.text[:40]}' is not understood here.", statement.line, current(reader)
            )
        actions[statement.word](reader, statement)
    return complete_nodes(reader, statements[-1].line)


def current(reader: Reader) -> Node | None:
    """The innermost open node."""
    return reader.nodes[reader.open[-1]] if reader.open else None


def joint(reader: Reader, statement: Statement) -> None:
    """Read ROOT or JOINT; blanks inside the name are kept, so 'Right Up Leg' is one joint."""
    name = " ".join(statement.rest.split())
    if not name:
        raise reader.error(
            f"{statement.word.upper()} without a name.", statement.line, current(reader)
        )
    if len(name) > LONGEST_NAME:
        raise reader.error(f"a name of {len(name):,} letters; shorten it.", statement.line)
    if statement.word == "root" and reader.nodes:
        first = reader.nodes[0]
        problem = (
            f"a second ROOT (the first, {first.name}, is on line {first.line}): "
            "the file contains two figures."
        )
        raise BvhError(
            problem + " Export each figure to its own file.", reader.path, statement.line, name
        )
    if name in reader.lines:
        problem = (
            f"line {reader.lines[name]} has a joint of this name already; "
            "give every joint its own name."
        )
        raise BvhError(problem, reader.path, statement.line, name)
    if statement.word == "joint" and not reader.open:
        raise BvhError(
            "a JOINT outside ROOT; a brace is closed too early.", reader.path, statement.line, name
        )
    reader.lines[name] = statement.line
    add(reader, Node(name, reader.open[-1] if reader.open else -1, statement.line))


def end_site(reader: Reader, statement: Statement) -> None:
    """Read an End Site: a point without channels, named after its joint."""
    parent = current(reader)
    if parent is None:
        raise reader.error("an End Site outside a joint.", statement.line)
    add(reader, Node(parent.name + "_End", reader.open[-1], statement.line, end=True, channels=()))


def add(reader: Reader, node: Node) -> None:
    """Add a node; its '{' must follow."""
    if reader.waiting is not None:
        raise reader.error("'{' is missing after it.", node.line, reader.nodes[reader.waiting])
    reader.waiting = len(reader.nodes)
    reader.nodes.append(node)


def open_node(reader: Reader, statement: Statement) -> None:
    """Read '{': the next statements belong to the node that was just named."""
    if reader.waiting is None:
        raise reader.error(
            "'{' without ROOT, JOINT or End Site before it.", statement.line, current(reader)
        )
    reader.open.append(reader.waiting)
    reader.waiting = None


def close_node(reader: Reader, statement: Statement) -> None:
    """Read '}': the innermost node ends, and must be complete."""
    node = current(reader)
    if node is None:
        raise reader.error("this '}' has no matching '{'; remove it.", statement.line)
    if reader.waiting is not None:
        name = reader.nodes[reader.waiting]
        raise reader.error("'{' is missing after it.", statement.line, name)
    if node.offset is None:
        raise reader.error(
            "it has no OFFSET line; add one (0 0 0 when it sits on its parent).", node.line, node
        )
    if node.channels is None:
        raise reader.error(
            "it has no CHANNELS line; write CHANNELS 0 for a joint that never turns.",
            node.line,
            node,
        )
    reader.open.pop()


def inside(reader: Reader, statement: Statement) -> Node:
    """The node to which a property belongs."""
    node = current(reader)
    if node is None or reader.waiting is not None:
        raise reader.error(
            f"{statement.word.upper()} outside the braces of a joint.", statement.line, node
        )
    return node


def offset(reader: Reader, statement: Statement) -> None:
    """Read OFFSET x y z: the position of the node relative to its parent."""
    node = inside(reader, statement)
    words = statement.rest.split()
    if len(words) != 3:
        raise reader.error(f"OFFSET takes 3 numbers, not {len(words)}.", statement.line, node)
    node.offset = tuple(to_number(word, reader.path, statement.line, node.name) for word in words)


def channels(reader: Reader, statement: Statement) -> None:
    """Read CHANNELS n and n names: any subset of the six, in any order, each at most once."""
    node = inside(reader, statement)
    count, *names = statement.rest.split() or [""]
    unknown = [name for name in names if name.lower() not in SPELLED]
    if unknown:
        raise reader.error(
            f"unknown channel '{unknown[0]}'; known: {', '.join(CHANNELS)}.", statement.line, node
        )
    if to_count(count) != len(names):
        problem = (
            f"CHANNELS says '{count[:40]}' but {len(names)} names follow; make the number fit."
        )
        raise reader.error(problem, statement.line, node)
    if len(set(map(str.lower, names))) < len(names):
        raise reader.error("a channel is listed twice.", statement.line, node)
    node.channels = tuple(SPELLED[name.lower()] for name in names)


def complete_nodes(reader: Reader, line: int) -> list[Node]:
    """The nodes after every brace is closed; end sites get names that no joint has."""
    if reader.open or reader.waiting is not None:
        node = reader.nodes[reader.waiting if reader.waiting is not None else reader.open[-1]]
        count = len(reader.open) + (reader.waiting is not None)
        problem = (
            f"its braces are never closed ({count} open where MOTION begins); "
            f"add {count} '}}' before MOTION."
        )
        raise reader.error(problem, line, node)
    if not reader.nodes:
        raise reader.error("the HIERARCHY has no ROOT.", line)
    taken = set(reader.lines)
    for node in (node for node in reader.nodes if node.end):
        while node.name in taken:
            node.name += "_End"
        taken.add(node.name)
    return reader.nodes
