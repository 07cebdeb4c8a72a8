"""Figures in "What happened" cells that no cell before them has printed.

    python tools/backed_numbers.py build/executed

An answer may name decimals, and numbers with a unit, only if the cells before it print them: in
their output, in a caption, in a figure's texts, or in the code as a setting. It does not know which
printed number is meant, so it finds a number that nothing printed, not every wrong one. What
follows from such numbers, or is the value of a record of the results, says so in a comment that is
not shown:

    <!-- 15 % = 100 * (1 - 0.85) -->      <!-- records: dancer.repeat dancer.repeat_data -->

Lists those that are not, and exits with 1 if there are
any. It needs outputs: `make notebooks` leaves executed copies in build/executed.
"""

import argparse
import ast
import html
import json
import re
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from motiondiff_edu.course.answers import plain

UNITS = r"%|cm|mm|km|m/s|m|ms|s|nats?|Hz|kHz|BPM|°|degrees?|seconds?|minutes?|times|million|GB|MB"
NUMBER = r"(?<![\w.$^_{\\/])[-−]?(?:\d{1,3}(?:,\d{3})+|\d*\.?\d+)"
CLAIM = re.compile(rf"({NUMBER})(?:[ -]?({UNITS})(?![\w/]))?")
ABOUT = re.compile(
    r"(?:about|almost|nearly|around|some|roughly|over|under|more than|less than)\s+$"
)
ANSWER = re.compile(r"<summary>What happened</summary>(.*?)</details>", re.DOTALL)
ASIDE = re.compile(
    r"`[^`]*`|\$\$.*?\$\$|\$[^$]*\$|\]\([^)]*\)|<!--.*?-->|\b[Nn]otebooks? \d\d", re.DOTALL
)
DERIVED = re.compile(rf"<!-- ({NUMBER})(?: ?(?:{UNITS}))? = ([^>]+?) -->")
LISTED = re.compile(r"<!-- records: ([\w. -]+?) -->")
TRIVIAL = {1.0, 2.0, 10.0, 100.0, 360.0, 1000.0}  # need no backing in a formula
RESULTS = Path(__file__).parent.parent / "docs" / "results"
# What a number with this unit may have been printed as, times: a share, metres, seconds.
SCALES = {
    "%": (1.0, 100.0),
    "cm": (1.0, 100.0, 0.1),
    "mm": (1.0, 1000.0, 10.0),
    "ms": (1.0, 1000.0),
}


@dataclass(frozen=True)
class Claim:
    """A number as the text writes it."""

    text: str
    unit: str
    about: bool

    @property
    def value(self) -> float:
        return float(self.text.replace(",", "").replace("−", "-"))

    @property
    def step(self) -> float:
        """One in its last digit."""
        digits = self.text.partition(".")[2]
        return 10.0 ** -len(digits)

    def backed(self, printed: set[float], settings: set[float]) -> bool:
        """Whether a printed number rounds to it, as it is or by `SCALES`; or a setting is it."""
        room = max(0.5001 * self.step, 0.2 * abs(self.value) if self.about else 0.0)
        scaled = {scale * one for one in printed for scale in SCALES.get(self.unit, (1.0,))}
        return abs(self.value) in {abs(one) for one in settings} or any(
            abs(abs(one) - abs(self.value)) <= room for one in scaled
        )


def derived(answer: str, there: set[float]) -> set[float]:
    """The numbers that comments of an answer compute from numbers that are there."""
    found = set()
    for text, formula in DERIVED.findall(answer):
        tree = ast.parse(formula.strip(), mode="eval")
        parts = [node for node in ast.walk(tree) if isinstance(node, ast.Constant)]
        allowed = (ast.Expression, ast.BinOp, ast.UnaryOp, ast.operator, ast.unaryop, ast.Constant)
        if not all(isinstance(node, allowed) for node in ast.walk(tree)):
            raise ValueError(f"only numbers and + - * / ** can be in a comment: {formula}")
        used = {float(node.value) for node in parts}
        claim = Claim(text, "", False)
        value = float(eval(compile(tree, "comment", "eval")))
        if used <= there | TRIVIAL and claim.backed({value}, set()):
            found.add(claim.value)
    return found


def of_records(answer: str, records: Mapping[str, float]) -> set[float]:
    """The values of the records that comments of an answer name.

    Raises ValueError for a record that does not exist.
    """
    named = [name for names in LISTED.findall(answer) for name in names.split()]
    missing = [name for name in named if name not in records]
    if missing:
        raise ValueError(f"no record is called {', '.join(missing)}: see docs/RESULTS_ALL.md")
    return {records[name] for name in named}


def claims(answer: str) -> list[Claim]:
    """The decimals, and the numbers with a unit, of an answer; not those in code or formulas."""
    text = ASIDE.sub(" ", answer)
    found = []
    for match in CLAIM.finditer(text):
        number, unit = match[1], match[2] or ""
        if "." in number or unit:
            found.append(Claim(number, unit, bool(ABOUT.search(text[: match.start()]))))
    return found


def numbers(text: str) -> set[float]:
    """All numbers of a printed text."""
    form = r"[-−]?(?:\d{1,3}(?:,\d{3})+(?:\.\d+)?|\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?"
    found = re.findall(form, text)
    return {float(one.replace(",", "").replace("−", "-")) for one in found}


def settings(code: str) -> set[float]:
    """The numbers that code is written with."""
    return {
        float(node.value)
        for node in ast.walk(ast.parse(plain(code)))
        if isinstance(node, ast.Constant) and type(node.value) in (int, float)
    }


def printed(output: dict) -> str:
    """What an output says: printed text, captions, alternative texts, a figure's own texts."""
    if output["output_type"] == "stream":
        return "".join(output["text"])
    data = {
        mime: "".join(text) for mime, text in output.get("data", {}).items() if "json" not in mime
    }
    page = data.get("text/html", "")
    told = re.findall(r"<figcaption[^>]*>(.*?)</figcaption>", page, re.DOTALL)
    told += re.findall(r'<img alt="([^"]*)"', page)
    drawn = output.get("metadata", {}).get("texts", "")
    return html.unescape(" ".join([data.get("text/plain", ""), *told, drawn]))


def unbacked(notebook: dict, records: Mapping[str, float] | None = None) -> list[str]:
    """The claims of a notebook that nothing before them backs, each with the place.

    `records`: the values of the results, by name.
    """
    seen: set[float] = set()
    written: set[float] = set()
    typed: set[float] = set()  # all numbers in code, also within strings
    found = []
    for index, cell in enumerate(notebook["cells"]):
        source = "".join(cell["source"])
        if cell["cell_type"] == "code":
            written |= settings(source)
            typed |= numbers(source)
            for output in cell.get("outputs", []):
                seen |= numbers(printed(output))
        for answer in ANSWER.findall(source) if cell["cell_type"] == "markdown" else ():
            more = derived(answer, seen | written | typed)
            known = seen | of_records(answer, records or {})
            found += [
                f"cell {index}: {claim.text} {claim.unit}".rstrip()
                for claim in claims(answer)
                if not claim.backed(known, written | more)
            ]
    return found


def unbacked_in(executed: Path) -> list[str]:
    """The figures that are not backed in all executed notebooks of a folder, each with its file."""
    records = {
        one["name"]: one["value"]
        for path in RESULTS.glob("*.json")
        for one in json.loads(path.read_text("utf-8"))
        if one["value"] is not None
    }
    found = []
    for path in sorted(executed.glob("*.ipynb")):
        notebook = json.loads(path.read_text("utf-8"))
        found += [f"{path.name}, {one}" for one in unbacked(notebook, records)]
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("executed", type=Path)
    found = unbacked_in(parser.parse_args().executed)
    print("\n".join(found) or "every figure in the answers was printed before it")
    sys.exit(bool(found))


if __name__ == "__main__":
    main()
