"""Solutions of exercises, each with one mechanical change: would a check notice?

    python tools/mutants.py             how many mutants each check lets pass, and which
    python tools/mutants.py q_sample    those of one exercise

A mutant changes one thing in the body of a solution: an axis, an index, a sign, an operator, a
comparison, a number, a name, an order; or it leaves something out, or writes into an argument. Some
mutants compute the same as the solution, such as those that exchange what is squared afterwards.
They are told apart by other inputs than those of the check: a mutant that gives the same for all of
them is no wrong answer.
"""

import ast
import contextlib
import copy
import functools
import io
import sys
import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch

sys.path.insert(0, str(Path(__file__).parent))

import notebook_cells  # noqa: E402

from motiondiff_edu.course import checks  # noqa: E402
from motiondiff_edu.course.answers import checks_called  # noqa: E402
from motiondiff_edu.course.checks._compare import other_inputs  # noqa: E402

SWAPPED = {
    ast.Add: (ast.Sub,),
    ast.Sub: (ast.Add,),
    ast.Mult: (ast.Div,),
    ast.Div: (ast.Mult,),
    ast.Lt: (ast.LtE, ast.Gt),
    ast.LtE: (ast.Lt, ast.GtE),
    ast.Gt: (ast.GtE, ast.Lt),
    ast.GtE: (ast.Gt, ast.LtE),
    ast.Eq: (ast.NotEq, ast.GtE),
    ast.NotEq: (ast.Eq,),
    ast.And: (ast.Or,),
    ast.Or: (ast.And,),
}
CALLS = {
    "sum": ("mean", "max"),
    "mean": ("sum", "median"),
    "median": ("mean", "max"),
    "min": ("max",),
    "max": ("min",),
    "argmin": ("argmax",),
    "argmax": ("argmin",),
    "maximum": ("minimum",),
    "softmax": ("log_softmax",),
    "logsumexp": ("sum",),
    "cos": ("sin",),
    "sin": ("cos",),
    "log": ("log2", "exp"),
    "exp": ("log",),
    "abs": ("square",),
    "floor": ("ceil",),
    "flip": ("roll",),
}
DROPPED = {
    *("sqrt", "abs", "exp", "log", "square", "clamp", "clip", "copy", "clone", "flip", "softmax"),
    *("transpose", "permute", "round", "long", "cumsum", "norm", "mean", "sum"),
}


def mutants(source: str) -> Iterator[tuple[str, str]]:
    """(what was changed, source) for each change of the first function in `source`."""
    tree = ast.parse(source)
    nodes = [node for node in ast.walk(_function(tree)) if not isinstance(node, ast.arguments)]
    names = [one.arg for one in _function(tree).args.args]
    for index, node in enumerate(nodes):
        for words, change in (*_changes(node), *_other_names(node, names)):
            copied = copy.deepcopy(tree)
            target = [
                one for one in ast.walk(_function(copied)) if not isinstance(one, ast.arguments)
            ][index]
            new = _Replace(target, change(copy.deepcopy(target))).visit(copied)
            text = ast.unparse(ast.fix_missing_locations(new))
            if text != ast.unparse(tree):
                yield f"{_place(node)}: {words}", text
    yield from _in_place(tree)
    yield from _exchanged_arguments(tree)


def _function(tree: ast.Module) -> ast.FunctionDef:
    return next(node for node in tree.body if isinstance(node, ast.FunctionDef))


def _place(node: ast.AST) -> str:
    return f"line {getattr(node, 'lineno', 0)}, `{ast.unparse(node)[:50]}`"


class _Replace(ast.NodeTransformer):
    """Puts a node in another's place."""

    def __init__(self, target: ast.AST, new: ast.AST):
        self.target, self.new = target, new

    def visit(self, node: ast.AST) -> ast.AST:
        return self.new if node is self.target else super().visit(node)


def _changes(node: ast.AST) -> Iterator[tuple[str, Callable]]:
    """The changes of one node, each as (words, function of a copy)."""
    if isinstance(node, ast.BinOp):
        for other in SWAPPED.get(type(node.op), ()):
            yield f"{other.__name__} instead", lambda n, other=other: _with(n, op=other())
        yield "left side alone", lambda n: n.left
        yield "right side alone", lambda n: n.right
        if isinstance(node.op, ast.Sub | ast.Div | ast.MatMult | ast.Pow):
            yield "sides exchanged", lambda n: _with(n, left=n.right, right=n.left)
    if isinstance(node, ast.UnaryOp):
        yield "left out", lambda n: n.operand
    if isinstance(node, ast.Compare) and len(node.ops) == 1:
        for other in SWAPPED.get(type(node.ops[0]), ()):
            yield f"{other.__name__} instead", lambda n, other=other: _with(n, ops=[other()])
    if isinstance(node, ast.BoolOp):
        for other in SWAPPED[type(node.op)]:
            yield f"{other.__name__} instead", lambda n, other=other: _with(n, op=other())
    if isinstance(node, ast.Constant) and type(node.value) in (int, float):
        yield from _numbers(node)
    if isinstance(node, ast.Constant) and isinstance(node.value, bool):
        yield "the other truth", lambda n: ast.Constant(not n.value)
    if isinstance(node, ast.Call):
        yield from _calls(node)
    if isinstance(node, ast.Slice):
        yield "no start", lambda n: _with(n, lower=None)
        yield "no end", lambda n: _with(n, upper=None)
        for end in ("lower", "upper"):
            if getattr(node, end) is not None:
                for by in (1, -1):
                    yield (
                        f"{end} {by:+d}",
                        lambda n, end=end, by=by: _with(
                            n, **{end: ast.BinOp(getattr(n, end), ast.Add(), ast.Constant(by))}
                        ),
                    )
    if isinstance(node, ast.Return):
        for form in ("-({})", "2 * ({})", "({}) ** 2", "({}) + 0.01", "({})[1:]", "({}) * 0"):
            yield (
                f"returns {form.format('...')}",
                lambda n, form=form: ast.Return(
                    ast.parse(form.format(ast.unparse(n.value)), mode="eval").body
                ),
            )
    if isinstance(node, ast.Attribute) and node.attr == "T":
        yield "not transposed", lambda n: n.value
    if isinstance(node, ast.IfExp):
        yield "never", lambda n: n.orelse
        yield "always", lambda n: n.body
    if isinstance(node, ast.List | ast.Tuple) and isinstance(node.ctx, ast.Load):
        if len(node.elts) > 1:
            yield "turned round", lambda n: _with(n, elts=n.elts[::-1])
            yield "the last left out", lambda n: _with(n, elts=n.elts[:-1])


def _other_names(node: ast.AST, names: list[str]) -> Iterator[tuple[str, Callable]]:
    """Each use of an argument, with another argument there."""
    if isinstance(node, ast.Name) and node.id in names and isinstance(node.ctx, ast.Load):
        for other in names:
            if other != node.id:
                yield f"`{other}` instead", lambda n, other=other: ast.Name(other, ast.Load())


def _with(node: ast.AST, **fields) -> ast.AST:
    for name, value in fields.items():
        setattr(node, name, value)
    return node


def _numbers(node: ast.Constant) -> Iterator[tuple[str, Callable]]:
    value = node.value
    steps = (1, -1) if isinstance(value, int) else (0.01, -0.01)
    for by in steps:
        yield f"{by:+g}", lambda n, by=by: ast.Constant(n.value + by)
    if value:
        yield "negative", lambda n: ast.UnaryOp(ast.USub(), n)
        yield "doubled", lambda n: ast.Constant(2 * n.value)
        yield "0", lambda n: ast.Constant(0)


def _calls(node: ast.Call) -> Iterator[tuple[str, Callable]]:
    name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
    if isinstance(node.func, ast.Attribute):
        for other in CALLS.get(name, ()):
            yield (
                f"{other} instead",
                lambda n, other=other: _with(n, func=_with(n.func, attr=other)),
            )
        module = isinstance(node.func.value, ast.Name) and node.func.value.id in (
            *("np", "torch", "math", "F", "cross", "music", "reconstruction"),
        )
        if name in DROPPED and not module:
            yield f"{name} left out", lambda n: n.func.value
        if name in DROPPED and module and node.args:
            yield f"{name} left out", lambda n: n.args[0]
    if len(node.args) > 1 and not any(isinstance(one, ast.Starred) for one in node.args):
        for i in range(len(node.args) - 1):
            yield (
                f"arguments {i} and {i + 1} exchanged",
                lambda n, i=i: _with(
                    n, args=[*n.args[:i], n.args[i + 1], n.args[i], *n.args[i + 2 :]]
                ),
            )
    for i, keyword in enumerate(node.keywords):
        if keyword.arg in ("axis", "dim", "keepdim"):
            yield (
                f"{keyword.arg} left out",
                lambda n, i=i: _with(n, keywords=[*n.keywords[:i], *n.keywords[i + 1 :]]),
            )


def _in_place(tree: ast.Module) -> Iterator[tuple[str, str]]:
    """The right result, but an argument is overwritten on the way."""
    for argument in _function(tree).args.args:
        copied = copy.deepcopy(tree)
        function = _function(copied)
        name = function.name
        function.name = "_right"
        names = ", ".join(one.arg for one in function.args.args)
        spoilt = ast.parse(
            f"def {name}({names}):\n"
            f"    result = _copy.deepcopy(_right({names}))\n"
            f"    _spoil({argument.arg})\n"
            "    return result"
        ).body
        copied.body[copied.body.index(function) + 1 : copied.body.index(function) + 1] = spoilt
        yield f"`{argument.arg}` is overwritten", ast.unparse(ast.fix_missing_locations(copied))


def _exchanged_arguments(tree: ast.Module) -> Iterator[tuple[str, str]]:
    """Two neighbouring arguments are taken for each other."""
    for i in range(len(_function(tree).args.args) - 1):
        copied = copy.deepcopy(tree)
        arguments = _function(copied).args.args
        first, second = arguments[i].arg, arguments[i + 1].arg
        arguments[i].arg, arguments[i + 1].arg = second, first
        yield f"`{first}` and `{second}` are exchanged", ast.unparse(copied)


def spoil(value) -> None:
    """Overwrite an array, or the first of a list; anything else stays."""
    if isinstance(value, torch.Tensor | np.ndarray) and value.shape:
        inverted = value.dtype in (torch.bool, bool)
        value[...] = ~value if inverted else value * 0 + 7
    elif isinstance(value, list) and value:
        if isinstance(value[0], torch.Tensor | np.ndarray):
            spoil(value[0])
        else:
            value[0] = value[-1] if value[0] != value[-1] else None


class Exercise:
    """A solution cell: the function, the check, and the names that it may rely on."""

    def __init__(self, source: str, namespace: dict):
        tree = ast.parse(source)
        self.function = _function(tree).name
        self.check = next(checks_called(source))
        body = [node for node in tree.body if isinstance(node, ast.FunctionDef)]
        self.source = ast.unparse(ast.Module(body, []))
        self.namespace = namespace

    def answer(self, source: str | None = None) -> Callable:
        """The function that a source defines, or the solution's."""
        namespace = dict(self.namespace) | {"_copy": copy, "_spoil": spoil}
        exec(compile(source or self.source, self.check, "exec"), namespace)
        return namespace[self.function]

    def told(self, answer: Callable) -> str | None:
        """What the check says to an answer; None if it lets it pass."""
        with warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()):
            warnings.simplefilter("ignore")
            try:
                checks.load_all()[self.check](answer)
            except checks.CheckFailed as error:
                return str(error)
        return None

    def calls(self, seeds: Sequence[int]) -> list[tuple]:
        """What the check gives an answer, with each of these seeds."""
        given, solution = [], self.answer()

        @functools.wraps(solution)
        def recording(*args):
            given.append(copy.deepcopy(args))
            return solution(*args)

        for seed in seeds:
            with other_inputs(seed):
                told = self.told(recording)
                assert told is None, f"the solution is refused: {told} (seed {seed})"
        assert given, f"checks.{self.check} never asks for an answer"
        return given

    def judged(self, most: int | None = None, seeds: Sequence[int] = range(1, 13)) -> "Judged":
        """The check on the mutants, or on `most` of them, drawn with a fixed seed."""
        found = list({text: words for words, text in mutants(self.source)}.items())
        chosen = np.random.default_rng(0).permutation(len(found))[:most]
        told = {i: self.told(self.answer(found[i][0])) for i in sorted(chosen)}
        passed = [i for i in told if told[i] is None]
        calls = self.calls(seeds)
        wrong = [i for i in passed if not self.same(self.answer(found[i][0]), calls)]
        return Judged(
            len(told) - len(passed) + len(wrong),
            [(found[i][1], found[i][0]) for i in wrong],
            [found[i][1] for i in passed if i not in wrong],
            {found[i][1]: (found[i][0], message) for i, message in told.items() if message},
        )

    def same(self, answer: Callable, calls: list[tuple]) -> bool:
        """Whether an answer gives what the solution gives, and leaves its input alone."""
        solution = self.answer()
        for given in calls:
            kept, used = copy.deepcopy(given), copy.deepcopy(given)
            try:
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")
                    got = answer(*used)
            except Exception:
                return False
            if not alike(solution(*kept), got) or not alike(given, used):
                return False
        return True


@dataclass(frozen=True)
class Judged:
    """A check on the mutants of its solution.

    wrong    how many of them give other results, or change their input
    passing  (words, source) of those among them that the check lets pass
    equal    the words of those that compute the same
    refused  {words: (source, message)}
    """

    wrong: int
    passing: list[tuple[str, str]]
    equal: list[str]
    refused: dict[str, tuple[str, str]]


def alike(one, other) -> bool:
    """Whether two results, or two lists of arguments, hold the same numbers."""
    if isinstance(one, torch.Tensor | np.ndarray | np.generic | float | int):
        try:
            a, b = (np.asarray(torch.as_tensor(x), dtype=complex) for x in (one, other))
        except (TypeError, ValueError, RuntimeError):
            return False
        return a.shape == b.shape and np.allclose(a, b, 1e-6, 1e-9, equal_nan=True)
    if isinstance(one, list | tuple):
        listed = isinstance(other, list | tuple) and len(other) == len(one)
        return listed and all(map(alike, one, other))
    return not isinstance(one, str) or one == other


def exercises(path: Path) -> list[Exercise]:
    """The exercises of a notebook, after its cells tagged imports, setup and twin."""
    notebook = notebook_cells.read(path)
    with contextlib.redirect_stdout(io.StringIO()):
        namespace = notebook_cells.start(notebook, path.stem)
        namespace = notebook_cells.run(notebook_cells.code(notebook, "twin"), namespace, path.stem)
    return [
        Exercise(cell["source"], namespace) for cell in notebook_cells.code(notebook, "solution")
    ]


def main(names: list[str]) -> None:
    for path in notebook_cells.sources():
        for exercise in exercises(path):
            if names and exercise.check not in names:
                continue
            judged = exercise.judged()
            print(
                f"{path.stem[:2]} {exercise.check}: {judged.wrong} wrong mutants, of which "
                f"{len(judged.passing)} pass; {len(judged.equal)} equal to the solution"
            )
            for words, text in judged.passing:
                print(f"    {words}\n{text}")
            if names:
                for words, (_, message) in judged.refused.items():
                    print(f"    {words}\n        {message}")


if __name__ == "__main__":
    main(sys.argv[1:])
