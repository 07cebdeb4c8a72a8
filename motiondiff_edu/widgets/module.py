"""The ES modules of player, editor, bench and path pad.

Each is made from the files in js/, joined into one module that imports nothing. The files import
from each other as usual; joining removes these lines.
"""

import re
from pathlib import Path

FOLDER = Path(__file__).parent / "js"
# each file imports only from those before it
PARTS = ("dom", "figures", "paint", "clock", "lane", "player")
EDITOR = ("dom", "figures", "paint", "clock", "timeline", "stage", "wire", "editor")
BENCH = ("dom", "figures", "paint", "clock", "bench_paint", "bench")
PATH = ("dom", "path")

_IMPORT = re.compile(r'^import \{[^}]*\} from "\./\w+\.js";\n', re.MULTILINE)
_EXPORT = re.compile(r"^export (?=function|const)", re.MULTILINE)


def es_module(parts: tuple[str, ...] = PARTS) -> str:
    """One ES module: the text of the parts without their imports.

    Only the exports of the last part remain.
    """
    *inner, last = (_IMPORT.sub("", (FOLDER / f"{name}.js").read_text("utf-8")) for name in parts)
    return "\n".join([*(_EXPORT.sub("", text) for text in inner), last])
