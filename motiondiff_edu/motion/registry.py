"""Functions that other layers add to a Motion: readers and writers of files, and its player.

    writers.register(".csv")(lambda motion, path: ...)      # now motion.save("walk.csv") works
A function is registered when its module is imported. `announce` names that module beforehand; it is
imported at the first use of the ending. So motion/ does not depend on the layers that draw it.
"""

import importlib
from collections.abc import Callable


class Registry:
    """Functions by name; some lie in modules that are imported at first use."""

    def __init__(self) -> None:
        self._functions: dict[str, Callable] = {}
        self._announced: dict[str, str] = {}

    def announce(self, module: str, *names: str) -> None:
        """Declare that `module` (a dotted name) registers these names when it is imported."""
        self._announced |= dict.fromkeys(names, module)

    def register(self, *names: str) -> Callable[[Callable], Callable]:
        """A decorator that stores the function under these names."""

        def remember(function: Callable) -> Callable:
            self._functions |= dict.fromkeys(names, function)
            return function

        return remember

    def names(self) -> list[str]:
        """All names, in the order of their registration."""
        return list(self._announced | self._functions)

    def get(self, name: str) -> Callable | None:
        """The function of this name, or None."""
        if name not in self._functions and name in self._announced:
            importlib.import_module(self._announced[name])
        return self._functions.get(name)


readers = Registry()  # ".bvh" -> read(path) -> Motion
writers = Registry()  # ".bvh" -> write(motion, path)
shows = Registry()  # "player" -> show(motion) -> the MIME bundle of a notebook's output
