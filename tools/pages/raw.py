"""What a page should not show: formulas and widgets as their source text."""

import re

# of the visible text outside of code
FORMULA = re.compile(
    r"\$[^$\n]{1,200}\$|\\(?:frac|sqrt|bar|hat|alpha|mathbb|mathcal|text|sum)(?![a-z])"
)
WIDGET = re.compile(r"\b[A-Z]\w+\((?:children|value|description)=|<motiondiff_edu[.\w]* object")
# the text that a reader sees, with folded answers open and without code
VISIBLE = """() => {
  for (const one of document.querySelectorAll("details")) one.open = true;
  const hidden = "pre, code, script, style";
  const kept = [];
  for (const one of document.querySelectorAll(hidden)) kept.push([one, one.style.display]);
  const told = [...document.querySelectorAll("pre.told")].map((one) => one.innerText).join("\\n");
  for (const [one] of kept) one.style.display = "none";
  const text = document.body.innerText;
  for (const [one, display] of kept) one.style.display = display;
  return [text, told];
}"""


def raw_formulas(text: str) -> list[str]:
    """Formulas that are seen as TeX."""
    return FORMULA.findall(text)


def raw_widgets(text: str, told: str) -> list[str]:
    """Widgets that are seen as Python's words for them, in the text or in printed outputs."""
    return WIDGET.findall(text) + WIDGET.findall(told)
