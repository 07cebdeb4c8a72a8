"""Formulas of markdown as MathML, which browsers show without a script or a font from elsewhere."""

import re
from collections.abc import Callable

from latex2mathml.converter import convert

CODE = re.compile(r"(```.*?```|``[^\n]+?``|`[^`\n]+?`)", re.DOTALL)
FORMULA = re.compile(r"\$\$(.+?)\$\$|(?<![\\$])\$([^$\n]+?)\$", re.DOTALL)


class FormulaError(ValueError):
    """A formula that cannot be converted; the message has it."""


def mathml(latex: str, display: str) -> str:
    """One formula, "inline" or "block". Raises FormulaError."""
    try:
        return convert(latex.strip(), display=display)
    except Exception as error:
        raise FormulaError(f"this formula cannot be converted to MathML: {latex}") from error


def with_formulas(markdown: str, render: Callable[[str], str]) -> str:
    """The HTML of markdown with formulas.

    `render` makes HTML of markdown; formulas are kept away from it, since it would take their
    underscores and stars for its own.
    """
    formulas: list[str] = []

    def aside(match: re.Match) -> str:
        block, inline = match.groups()
        formulas.append(mathml(block or inline, "block" if block else "inline"))
        return f"@formula{len(formulas) - 1}@"

    parts = CODE.split(markdown)
    text = "".join(part if i % 2 else FORMULA.sub(aside, part) for i, part in enumerate(parts))
    return re.sub(r"@formula(\d+)@", lambda found: formulas[int(found[1])], render(text))
