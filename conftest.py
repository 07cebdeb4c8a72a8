"""Each worker that runs tests and notebooks gets a cache of compiled functions of its own.

It is set before any test begins.

librosa compiles with numba, which keeps what it compiled in files. Two processes that fill one
folder at the same time leave halves that do not fit together, and the next process that reads them
crashes (numba issue 10128).
"""

import os
from pathlib import Path

WORKER = os.environ.get("PYTEST_XDIST_WORKER")  # gw0, gw1 ...; unset where there is but one process

if WORKER:
    numba_cache = Path(__file__).parent / "build" / "numba" / WORKER
    os.environ.setdefault("NUMBA_CACHE_DIR", str(numba_cache))
