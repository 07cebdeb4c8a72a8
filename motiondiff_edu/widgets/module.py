"""The ES modules of player, editor, bench.

Parts in js/, one after the other, are one module that imports nothing.

The parts name what they take from each other as any ES modules do; joined, these lines have done
their duty.
"""

import re
from pathlib import Path

FOLDER = Path(__file__).parent / "js"
# each takes from those before it only
PARTS = ("dom", "figures", "paint", "clock", "lane", "player")
EDITOR = ("dom", "figures", "paint", "clock", "timeline", "stage", "wire", "editor")
BENCH = ("dom", "figures", "paint", "clock", "bench_paint", "bench")

_IMPORT = re.compile(r'^import \{.*\} from "\./\w+\.js";\n', re.MULTILINE)
_EXPORT = re.compile(r"^export (?=function|const)", re.MULTILINE)


def joined(parts: tuple[str, ...] = PARTS) -> str:
    """One ES module: the text of the parts without their imports.

    Only what the last one exports is exported.
    """
    *inner, last = (_IMPORT.sub("", (FOLDER / f"{name}.js").read_text("utf-8")) for name in parts)
    return "\n".join([*(_EXPORT.sub("", text) for text in inner), last])
