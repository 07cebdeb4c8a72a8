"""Runs lines as a reader types them: in a fresh process, without the tests' check of shapes.

    python tests/helpers/as_typed.py < lines.json      # {"name": "code", ...}
Prints {"name": what it raised, or the repr of its last line}.
"""

import ast
import json
import subprocess
import sys
import traceback

START = "import numpy as np, torch; import motiondiff_edu as md"


def outcomes(lines: dict[str, str], folder, setup: str = "") -> dict[str, str]:
    """What each piece of code gives or raises, run one after the other in `folder`."""
    done = subprocess.run(
        [sys.executable, "-W", "ignore", __file__],
        input=json.dumps([setup, lines]), capture_output=True, text=True, cwd=folder,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr[-3000:]
    return json.loads(done.stdout.splitlines()[-1])


def value(code: str, space: dict) -> str:
    """The repr of the last expression, or the error with its type."""
    *before, last = ast.parse(code).body
    try:
        exec(compile(ast.Module(before, []), "typed", "exec"), space)
        if isinstance(last, ast.Expr):
            return repr(eval(compile(ast.Expression(last.value), "typed", "eval"), space))
        exec(compile(ast.Module([last], []), "typed", "exec"), space)
        return ""
    except (ValueError, TypeError, KeyError, OSError) as error:
        return f"{type(error).__name__}: {error}"
    except Exception:
        return traceback.format_exc()


if __name__ == "__main__":
    setup, lines = json.load(sys.stdin)
    space: dict = {}
    exec(f"{START}\n{setup}", space)
    found = {name: value(code, dict(space)) for name, code in lines.items()}
    print("\n" + json.dumps(found))
