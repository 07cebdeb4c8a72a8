"""librosa, loaded by one process at a time.

librosa compiles its beat tracker by numba when it is first used, and numba keeps the result in
files. Two processes that write these at the same time leave halves that do not fit together, and
whoever reads them from then on dies (numba issue 10128). Two notebooks that are run at once would
do that, so a process waits here while another one compiles:
`from ...conditions.compiled import librosa`.
Notebook: 11
"""

import os
from contextlib import ExitStack
from pathlib import Path

import numpy as np
import platformdirs
from filelock import FileLock

__all__ = ["librosa"]


def lock_file() -> Path:
    """The file that a process holds while it loads librosa: one for each cache of numba."""
    chosen = os.environ.get("NUMBA_CACHE_DIR")
    return Path(chosen or platformdirs.user_cache_path("motiondiff_edu")) / "librosa.lock"


with ExitStack() as _held:
    try:
        lock_file().parent.mkdir(parents=True, exist_ok=True)
        _held.enter_context(FileLock(lock_file()))
    except OSError:
        pass  # nothing can be written here, so numba does not keep what it compiles either

    import librosa

    # two beats a second: the first call compiles what the import did not
    clicks = np.zeros(300, dtype=np.float32)
    clicks[::31] = 1
    librosa.beat.beat_track(onset_envelope=clicks, sr=16_000, hop_length=256, units="time")
