"""Before any test: a cache of compiled functions for each of the workers that run tests and
notebooks side by side.

librosa compiles with numba, which keeps what it compiled in files. Two processes that fill one
folder at the same time leave halves that do not fit together, and who reads them next dies (numba
issue 10128).
"""

import os
from pathlib import Path

WORKER = os.environ.get("PYTEST_XDIST_WORKER")  # gw0, gw1 ...; unset where there is but one process

if WORKER:
    os.environ.setdefault("NUMBA_CACHE_DIR", str(Path(__file__).parent / "build" / "numba" / WORKER))
