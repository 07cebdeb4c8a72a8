"""Which files are recordings: they were read, and this process did not write them.

`Motion.save` and the editor do not replace a recording, because it would be lost. A file that this
process wrote, and nobody changed since, can be read back and written again.
"""

from pathlib import Path

_read: set[Path] = set()
_written: dict[Path, tuple[int, int]] = {}  # as `_stamp` saw it after it was written


def note_read(path: Path) -> None:
    """Remember that a file was read."""
    place = _place(path)
    if _written.get(place) != _stamp(place):
        _read.add(place)


def note_written(path: Path) -> None:
    """Remember that a file was written by this process: nothing of a recording is left in it."""
    place = _place(path)
    _read.discard(place)
    _written[place] = _stamp(place)


def is_recording(path: Path) -> bool:
    """Whether a recording would be lost if this file were replaced."""
    return _place(path) in _read


def is_ours(path: Path) -> bool:
    """Whether this process wrote the file that is there, and nobody changed it since."""
    place = _place(path)
    return place.exists() and _written.get(place) == _stamp(place)


def _place(path: Path) -> Path:
    """The same for all ways to name a file."""
    return path.absolute().resolve()


def _stamp(place: Path) -> tuple[int, int]:
    """The time of the last change in nanoseconds, and the size in bytes; (0, 0) for no file."""
    if not place.exists():
        return 0, 0
    found = place.stat()
    return found.st_mtime_ns, found.st_size
