"""Each worker that runs tests and notebooks gets a cache of compiled functions of its own.

It is set before any test begins. Where `make tracker` has compiled them, it begins as a copy of
that.

librosa compiles with numba, which keeps what it compiled in files. Two processes that fill one
folder at the same time leave halves that do not fit together, and the next process that reads them
crashes (numba issue 10128).
"""

import os
import shutil
from pathlib import Path

WORKER = os.environ.get("PYTEST_XDIST_WORKER")  # gw0, gw1 ...; unset where there is but one process

if WORKER:
    caches = Path(__file__).parent / "build" / "numba"
    numba_cache, begun = caches / WORKER, caches / f"{WORKER}.begun"
    if (caches / "first").is_dir() and not numba_cache.exists():
        shutil.rmtree(begun, ignore_errors=True)
        shutil.copytree(caches / "first", begun)
        begun.rename(numba_cache)  # a run that is stopped leaves no half of it
    os.environ.setdefault("NUMBA_CACHE_DIR", str(numba_cache))
