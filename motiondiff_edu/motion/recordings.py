"""Which files are recordings: they were read, and this process did not write them.

`Motion.save` and the editor do not replace a recording, because it would be lost. A file that this
process wrote, and nobody changed since, can be read back and written again.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from .arguments import MotionError


class Recordings:
    """The files that were read, and those that were written, as they were then."""

    def __init__(self) -> None:
        self._read: set[Path] = set()
        self._written: dict[Path, tuple[int, int]] = {}

    def note_read(self, path: Path) -> None:
        """Remember that a file was read."""
        if not self.is_ours(path):
            self._read.add(_place(path))

    @contextmanager
    def writing(self, path: Path, overwrite: bool) -> Iterator[None]:
        """Inside, the file is written: then nothing of a recording is left in it.

        Raises MotionError for a recording, unless `overwrite`.
        """
        if path in self and not overwrite:
            raise MotionError(
                f"{path} was read, and it would be lost: choose another name, or save it with "
                "overwrite=True"
            )
        yield
        place = _place(path)
        self._read.discard(place)
        self._written[place] = _stamp(place)

    def __contains__(self, path: Path) -> bool:
        """Whether a recording would be lost if this file were replaced."""
        return _place(path) in self._read

    def is_ours(self, path: Path) -> bool:
        """Whether this process wrote the file that is there, and nobody changed it since."""
        place = _place(path)
        return place.exists() and self._written.get(place) == _stamp(place)


recordings = Recordings()  # of this process, for every motion that is read or saved


def _place(path: Path) -> Path:
    """The same for all ways to name a file."""
    return path.absolute().resolve()


def _stamp(place: Path) -> tuple[int, int]:
    """The time of the last change in nanoseconds, and the size in bytes; (0, 0) for no file."""
    if not place.exists():
        return 0, 0
    found = place.stat()
    return found.st_mtime_ns, found.st_size
