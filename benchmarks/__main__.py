"""Run the benchmarks, each in its own process.

python -m benchmarks [import | frame | mel | unet | walker | player | mover ...]

Records go to benchmarks/results/*.json; `python -m tools.results --render` puts them into
docs/RESULTS.md. On a shared machine only the ratios are meaningful: both sides are timed in turn,
in one run.
"""

import os
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent
BENCHMARKS = {
    "import": "import_time.py",
    "frame": "modiff_frame.py",
    "mel": "logmel.py",
    "sampler": "sampler_overhead.py",
    "unet": "unet.py",
    "walker": "walker_80s.py",
    "player": "player_audio.py",
    "mover": "mover.py",
}


def main(names: list[str]) -> int:
    unknown = [name for name in names if name not in BENCHMARKS]
    if unknown:
        print(f"no benchmark is called {', '.join(unknown)}; there are: {', '.join(BENCHMARKS)}")
        return 2
    paths = [str(HERE.parent), *filter(None, [os.environ.get("PYTHONPATH")])]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(paths)}
    failed = []
    for name in names or BENCHMARKS:
        print(f"\n== {name}: python benchmarks/{BENCHMARKS[name]}", flush=True)
        command = [sys.executable, str(HERE / BENCHMARKS[name])]
        if subprocess.run(command, cwd=HERE.parent, env=environment, check=False).returncode:
            failed.append(name)
    if failed:
        print(f"\nfailed: {', '.join(failed)}")
    return len(failed)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
