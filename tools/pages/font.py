"""The font of the formulas, cut down to the signs that the pages use.

A browser sets MathML well only with a font that has mathematical measures, and few systems have
one. STIX Two Math (SIL Open Font License) comes with the package ziamath.
"""

import base64
import importlib.util
import io
import re
from pathlib import Path

from fontTools import subset
from fontTools.ttLib import TTFont

ALWAYS = "√()[]{}|‖∥&<>=+-−·×,.…/ ¯ˉˆ˜^~⏟⏞∑∫∏"  # some are set without being written, as a root is
STYLE = (
    '@font-face {{ font-family: "formulas"; src: url("data:font/woff;base64,{font}"); }}\n'
    'math {{ font-family: "formulas", math; font-size: 1.12em; }}\n'
)


def signs(pages: str) -> set[int]:
    """The code points within the formulas of some HTML; italic letters as browsers set them."""
    inside = "".join(re.findall(r"<math.*?</math>", pages, re.DOTALL))
    text = re.sub(r"<[^>]+>", "", inside)
    points = {int(code, 16) for code in re.findall(r"&#x([0-9A-Fa-f]+);", text)}
    points |= set(map(ord, re.sub(r"&\w+;|&#x\w+;", "", text)))
    return points | set(map(ord, ALWAYS)) | set(map(_italic, list(points)))


def _italic(point: int) -> int:
    """The italic mathematical letter in whose place a single letter of a formula is set."""
    for first, last, start in (
        (0x41, 0x5A, 0x1D434),
        (0x61, 0x7A, 0x1D44E),
        (0x3B1, 0x3C9, 0x1D6FC),
    ):
        if first <= point <= last:
            return 0x210E if point == 0x68 else start + point - first
    return {0x3F5: 0x1D716, 0x3D5: 0x1D719, 0x3D1: 0x1D717, 0x2202: 0x1D715}.get(point, point)


def file() -> Path:
    """The font's file, without running the package around it."""
    package = importlib.util.find_spec("ziamath").origin
    return Path(package).parent / "fonts" / "STIXTwoMath-Regular.ttf"


def style(pages: str) -> str:
    """CSS with the part of the font that these pages need; empty if they have no formula."""
    if "<math" not in pages:
        return ""
    options = subset.Options()
    options.flavor = "woff"
    options.layout_features = ["ssty", "math"]
    options.name_IDs = [0, 1, 2, 13, 14]  # the licence stays in
    font = TTFont(file())
    cut = subset.Subsetter(options)
    cut.populate(unicodes=signs(pages))
    cut.subset(font)
    font.flavor = "woff"
    buffer = io.BytesIO()
    font.save(buffer)
    return STYLE.format(font=base64.b64encode(buffer.getvalue()).decode())
